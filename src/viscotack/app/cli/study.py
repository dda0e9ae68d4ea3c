"""The commands ``viscotack study ...``: what others did, done again and judged."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Option

from viscotack.errors import InputError

from .commands import AsJson, application, wrong_input

studies = typer.Typer(
    help="Repeat a published study, and say what it is worth.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
application.add_typer(studies, name="study")


@studies.callback()
def _group() -> None:
    """Keep the name of the one study that there is."""


@studies.command("surrogates")
def surrogates(
    data: Annotated[
        Path,
        Option(
            "--data",
            metavar="FILE",
            help="Detachments, a row each: CSV or Parquet of viscotack campaign export, or the "
            "table that the authors of the thesis published.",
            show_default=False,
        ),
    ],
    out: Annotated[
        Path,
        Option(
            "--out",
            metavar="DIR",
            help="Folder for report.html, numbers.json, tables and figures; made if missing.",
            show_default=False,
        ),
    ],
    seed: Annotated[int, Option("--seed", min=0, help="Of every draw; 42 is the authors'.")] = 42,
    jobs: Annotated[
        int, Option("--jobs", metavar="N", min=1, help="Processes of this machine, a thread each.")
    ] = 1,
    quick: Annotated[
        bool,
        Option("--quick", help="Small models, to see that it works; the numbers mean nothing."),
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Train the models of the thesis's chapter 5 again, and judge them on what they have not seen.

    Linear regression, tree, random forest, XGBoost and a network, without and with the analytic
    descriptor; on random rows as in its Tables 5.1 to 5.4, and on modulus ratios, exponents,
    Tabor numbers and solids that are new to the model. With 6,000 rows and --jobs 2 it takes
    about a quarter of an hour. Needs pip install 'viscotack[learn]'.

    Example: viscotack study surrogates --data rows.csv --out study --jobs 2
    """
    with wrong_input():
        found = _studied(data, out, seed=seed, jobs=jobs, quick=quick)
    typer.echo(
        json.dumps(found, indent=2, allow_nan=False) if as_json else "\n".join(found["said"])
    )


def _studied(data: Path, out: Path, **settings: Any) -> dict[str, Any]:
    """Return what was found and written; the page and its files are in the folder then."""
    from viscotack.surrogate.study import study
    from viscotack.surrogate.study_report import summary, write_study
    from viscotack.surrogate.table import read_detachments

    if out.exists() and not out.is_dir():
        raise InputError(f"cannot write to {out}: it is a file; give the name of a folder")
    try:
        rows = read_detachments(data)
        done = study(rows, progress=lambda part: typer.echo(f"{part} ...", err=True), **settings)
    except ModuleNotFoundError as error:
        # the sentence says what to install
        raise InputError(str(error)) from None
    files = write_study(done, out, source=data.name)
    typer.echo(f"wrote {files[-1]}", err=True)
    return {"said": summary(done.numbers), "files": [str(file) for file in files]}
