"""The command ``viscotack schema``: what a problem may say, for other programs and for people."""

import json
from typing import Annotated

import typer
from typer import Option

from viscotack.problem.nouns import own_nouns

from .commands import With, application, wrong_input


@application.command("schema")
def schema_command(
    as_words: Annotated[
        bool, Option("--words", help="Tables in Markdown for people, in place of the schema.")
    ] = False,
    own: With = None,
) -> None:
    """Print the JSON schema of a problem: every number with its unit, symbol and range.

    It describes the object `problem` of --json, which results and campaigns keep as well.

    Example: viscotack schema > problem.schema.json
    """
    from viscotack.problem.schema import schema, words

    with wrong_input():
        also = own_nouns(own or ())
        text = words(also) if as_words else json.dumps(schema(also), indent=2)
    typer.echo(text)
