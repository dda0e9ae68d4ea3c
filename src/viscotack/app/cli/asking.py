"""Commands that ask what a problem takes: their flags are read from the cards."""

import inspect
from collections.abc import Callable
from functools import lru_cache
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from viscotack.operations.declare.questions import Question

_ANSWERS = "viscotack.answers"


def asking(questions: tuple[Question, ...]) -> type[TyperCommand]:
    """Return the class of a command that has a flag for each question beside its own.

    ``@application.command("advise", cls=asking(SPHERE.questions))``; :func:`answers` has what was
    given.
    """

    class Asking(TyperCommand):
        def __init__(self, *args: Any, params: Any = None, **kwargs: Any) -> None:
            own = list(params or [])
            # arguments in front, then the problem, then what is to be done with it
            front = [p for p in own if p.param_type_name == "argument"]
            rest = [p for p in own if p not in front]
            super().__init__(*args, params=[*front, *_flags(questions), *rest], **kwargs)

    return Asking


def answers(context: typer.Context) -> dict[str, Any]:
    """Return the answers to the questions of a command, by their names; None where not given."""
    return dict(context.meta.get(_ANSWERS, {}))


@lru_cache(maxsize=8)
def _flags(questions: tuple[Question, ...]) -> tuple[Any, ...]:
    """Return the options of the questions, made by the library of the command line."""

    def ask(**answers: Any) -> None:
        """Do nothing: only the options of this command are used."""

    ask.__signature__ = inspect.Signature([_parameter(q) for q in questions])  # type: ignore[attr-defined]
    only = typer.Typer(add_completion=False)
    only.command()(ask)
    made = typer.main.get_command(only).params
    return tuple(option for option in made if option.name != "help")


def _parameter(question: Question) -> inspect.Parameter:
    kind: Any = str if question.text else float
    option = typer.Option(
        f"--{question.name}",
        metavar="WORDS" if question.many else "TEXT" if question.text else "NUMBER",
        help=question.words,
        show_default=False,
        expose_value=False,
        callback=_kept(question.name),
    )
    hint = Annotated[list[kind] | None if question.many else kind | None, option]
    return inspect.Parameter(
        question.name.replace("-", "_"),
        inspect.Parameter.KEYWORD_ONLY,
        default=None,
        annotation=hint,
    )


def _kept(name: str) -> Callable[..., Any]:
    def keep(context: typer.Context, value: Any) -> Any:
        context.meta.setdefault(_ANSWERS, {})[name] = value
        return value

    return keep
