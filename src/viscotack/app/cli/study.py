"""The command ``viscotack study``: do what a file asks."""

from pathlib import Path
from typing import Annotated

from typer import Argument

from viscotack.errors import InputError
from viscotack.operations import operation
from viscotack.operations.declare.options import respelled

from .commands import AsJson, With, application, wrong_input


@application.command("study")
def study_command(
    file: Annotated[
        Path,
        Argument(
            metavar="STUDY.toml",
            help='What is asked: operation = "identify rates", its options by name, and a table '
            "[write] with the files to be written; docs/operations.md describes it.",
            show_default=False,
        ),
    ],
    own: With = None,
    as_json: AsJson = False,
) -> None:
    """Do what a study file asks, any operation with its options.

    Names of files in it are relative to its folder. The answer is that of the command of the
    operation.

    Example: viscotack study lens.toml
    """
    with wrong_input():
        from viscotack.operations.declare.study import read_study
        from viscotack.problem.nouns import own_nouns

        from .reading import carry_out, checked

        also = own_nouns(own or ())
        asked = read_study(file, known=operation, usual="identify rates", also=also)
        kind = type(asked.operation)
        files = {output: asked.write.get(output.name) for output in kind.outputs}
        try:
            files = checked(files, (*asked.kept, *(own or ())), as_json=as_json)
            carry_out(asked.operation, files, own or (), also, as_json)
        except InputError as error:
            raise respelled(error, kind) from None
