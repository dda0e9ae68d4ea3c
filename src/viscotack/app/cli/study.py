"""The command ``viscotack study``: run the operation of a study file."""

from pathlib import Path
from typing import Annotated

from typer import Argument

from .commands import AsJson, Force, With, application, wrong_input


@application.command("study")
def study_command(
    file: Annotated[
        Path,
        Argument(
            metavar="STUDY.toml",
            help='A study: operation = "identify rates", its options by name, and a table [write] '
            "with the output files; docs/operations.md describes it.",
            show_default=False,
        ),
    ],
    own: With = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run the operation of a study file with its options.

    File names in the study are relative to its folder. The output is the same as of the command of
    the operation.

    Example: viscotack study lens.toml
    """
    with wrong_input():
        from viscotack.app.operations.study import read_study

        from .running import carry_out

        study = read_study(file)
        files = {output: study.write.get(output.name) for output in study.request.outputs}
        carry_out(study.request, files, own or (), force=force, as_json=as_json, study=file)
