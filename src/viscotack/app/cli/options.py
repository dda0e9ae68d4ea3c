"""Options that several commands have."""

from typing import Annotated, Any

from typer import Option

from viscotack.operations.declare.questions import SPHERE


def flag(name: str, metavar: str, words: str) -> Any:
    """Return an option of a command that states a problem."""
    return Option(name, metavar=metavar, help=words, show_default=False)


_WORDS = {question.name: question.words for question in SPHERE.questions}
Ratio = Annotated[float | None, flag("--modulus-ratio", "K", _WORDS["modulus-ratio"])]
Exponent = Annotated[float | None, flag("--exponent", "N", _WORDS["exponent"])]
