"""The learning study: ``python -m research.replication.learning --table FILE --out DIR``."""

import json
from pathlib import Path
from typing import Annotated

import typer
from typer import Option

from viscotack import InputError

from ..table import read_detachments
from ..words import application, wrong_input
from .report import summary, write_study
from .study import check, study

app = application()


@app.command()
def learning(
    table: Annotated[
        Path,
        Option(
            "--table",
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
    as_json: Annotated[
        bool, Option("--json", help="Print one JSON object on standard output instead of words.")
    ] = False,
) -> None:
    """Train the models of the thesis's chapter 5 again, and judge them on what they have not seen.

    Linear regression, tree, random forest, XGBoost and a network, without and with the analytic
    descriptor; on random rows as in its Tables 5.1 to 5.4, and on modulus ratios, exponents,
    Tabor numbers and solids that are new to the model. With 6,000 rows and --jobs 2 it takes
    about a quarter of an hour. Needs pip install --editable '.[replication]'.

    Example: python -m research.replication.learning --table rows.csv --out study --jobs 2
    """
    with wrong_input():
        if out.exists() and not out.is_dir():
            raise InputError(f"cannot write to {out}: it is a file; give the name of a folder")
        rows = read_detachments(table)
        check(rows)
        # that it may not be written to is better known now than after the study
        out.mkdir(parents=True, exist_ok=True)
    done = study(
        rows,
        seed=seed,
        jobs=jobs,
        quick=quick,
        progress=lambda part: typer.echo(f"{part} ...", err=True),
    )
    files = write_study(done, out, source=table.name)
    typer.echo(f"wrote {files[-1]}", err=True)
    said = summary(done.numbers)
    found = {"said": said, "files": [str(file) for file in files]}
    typer.echo(json.dumps(found, indent=2, allow_nan=False) if as_json else "\n".join(said))


if __name__ == "__main__":
    app(prog_name="python -m research.replication.learning")
