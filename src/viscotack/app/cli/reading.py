"""Command-line commands generated from the declarations of operations."""

import inspect
import json
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from inspect import cleandoc
from pathlib import Path
from time import monotonic
from typing import Annotated, Any, get_args

import typer
from typer.core import TyperCommand, TyperOption
from typer.main import get_command

from viscotack.errors import InputError
from viscotack.files.text import harmless
from viscotack.operations import operation
from viscotack.operations.declare.answer import Answer, Caller, Output
from viscotack.operations.declare.cards import File, Number, Switch, Whole
from viscotack.operations.declare.options import Here, Operation, Option, answered, options, take
from viscotack.operations.declare.questions import OF_FILE, Question
from viscotack.operations.declare.statement import Stated, indenter_named
from viscotack.operations.declare.wording import flag

from .commands import AsJson, Force, With, wrong_input
from .writing import Writing, check_files

_SETTINGS = {"max_content_width": 100}
# Seconds between two lines of progress.
LINES = 10.0
_CASE = "A problem in SI with units (docs/input.md), instead of the options of the problem."


class Once(TyperCommand):
    """A command that rejects a repeated option that has one value, where the last would win."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments."""
        if args and not ctx.resilient_parsing:
            given = Counter(self.make_parser(ctx).parse_args(list(args))[2])
            for option, times in given.items():
                if times == 1 or not isinstance(option, TyperOption):
                    continue
                if not (option.multiple or option.is_flag):
                    raise typer.BadParameter("it is given twice and has one value", ctx, option)
        return super().parse_args(ctx, args)


def command_of(word: str, name: str | None = None) -> Any:
    """Make the command of an operation.

    Parameters
    ----------
    word : str
        Of the operation.
    name : str, optional
        Of the command where the operation has several: an indenter, or "case".

    Returns
    -------
    Command
        As the library of the command line has it.
    """
    kind = operation(word)
    if name is None:
        card = next((o.card for o in options(kind) if isinstance(o.card, Stated)), None)
        indenter = "" if card is not None and card.spelling == "case" else None
        words = kind.__doc__ or ""
    else:
        indenter, words = "" if name == "case" else name, kind.helps[name]
    alone = typer.Typer(add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None)
    last = (name or word).rpartition(" ")[2]
    made = alone.command(last, cls=Once, help=cleandoc(words), context_settings=_SETTINGS)
    made(_command(kind, indenter))
    return get_command(alone)


def _command(kind: type[Operation], indenter: str | None) -> Callable[..., None]:
    """Create the function of a command; Typer reads its options from the signature."""

    def command(**said: Any) -> None:
        _run(kind, indenter, said)

    parameters = list(_parameters(kind, indenter))
    command.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return command


def _parameters(kind: type[Operation], indenter: str | None) -> Iterator[inspect.Parameter]:
    found = options(kind)
    arguments = [option for option in found if option.card.argument]
    for option in arguments:
        yield from _of_option(option, indenter)
    for option in found:
        if option not in arguments:
            yield from _of_option(option, indenter)
    for output in kind.outputs:
        flags = output.flags or (f"--{output.name}",)
        words = typer.Option(*flags, metavar=output.metavar, help=output.words, show_default=False)
        needed = output.needed
        yield _parameter(output.name, Path if needed else Path | None, words, needed=needed)
    if kind.takes_own:
        yield _parameter("with_", *get_args(With))
    if kind.outputs:
        yield _parameter("force_", *get_args(Force), default=False)
    yield _parameter("json_", *get_args(AsJson), default=False)


def _parameter(
    name: str, kind: Any, words: Any, *, default: Any = None, needed: bool = False
) -> inspect.Parameter:
    return inspect.Parameter(
        name,
        inspect.Parameter.KEYWORD_ONLY,
        default=inspect.Parameter.empty if needed else default,
        annotation=Annotated[kind, words],
    )


def _of_option(option: Option, indenter: str | None) -> Iterator[inspect.Parameter]:
    card = option.card
    if isinstance(card, Stated):
        yield from _of_problem(option.name, card, indenter)
        return
    if isinstance(card, File) and card.elsewhere:
        return
    # all values are text; the cards convert them
    kind: Any = bool if isinstance(card, Switch) else list[str] if option.many else str
    if card.argument:
        words = typer.Argument(
            metavar=card.metavar or option.name.upper(), help=option.words, show_default=False
        )
        yield _parameter(option.name, kind, words, needed=option.needed)
        return
    flags: tuple[str, ...] = () if option.uncertainty else card.flags
    flags = flags or (option.flag,)
    told = option.words
    if isinstance(card, Switch):
        if option.default is True:
            flags = (f"{flags[0]}/--no-{flags[0].removeprefix('--')}",)
        words = typer.Option(*flags, help=told, show_default=bool(option.default))
        yield _parameter(option.name, bool | None, words)
        return
    if not option.needed and option.default not in (None, (), "", 0):
        told += f" [default: {option.default}]"
    metavar = card.metavar or ("NUMBER" if isinstance(card, Number | Whole) else "TEXT")
    choices = getattr(card, "choices", ())
    if choices and not card.metavar:
        metavar = f"[{'|'.join(choices)}]"
    words = typer.Option(*flags, metavar=metavar, help=told, show_default=False)
    yield _parameter(
        option.name, kind if option.needed else kind | None, words, needed=option.needed
    )


def _of_problem(name: str, card: Stated, indenter: str | None) -> Iterator[inspect.Parameter]:
    """Yield the parameters of a problem: a file, or the numbers of an indenter."""
    if card.spelling == "word":
        words = typer.Argument(metavar=card.metavar, help=card.words, show_default=False)
        yield _parameter(f"{name}__what", str, words, needed=True)
    only = card.spelling == "case"
    told = card.words if only else _CASE
    if card.table:
        told += " Or, after a problem, a table of cases that change it."
    metavar = "CASES.csv" if card.table else "CASE.toml"
    words = typer.Argument(metavar=metavar, help=told, show_default=False)
    yield _parameter(f"{name}__case", Path if only else Path | None, words, needed=only)
    for question in _questions(card, indenter):
        yield _of_question(name, question)


def _questions(card: Stated, indenter: str | None) -> tuple[Question, ...]:
    if indenter == "":
        return OF_FILE
    if indenter is not None:
        return indenter_named(indenter).questions
    asked: dict[str, Question] = {}
    for word in card.indenters:
        asked = {q.name: q for q in indenter_named(word).questions} | asked
    return tuple(asked.values())


def _of_question(name: str, question: Question) -> inspect.Parameter:
    kind: Any = str if question.text else float
    words = typer.Option(
        f"--{question.name}",
        metavar="WORDS" if question.many else "TEXT" if question.text else "NUMBER",
        help=question.words,
        show_default=False,
    )
    hint = list[kind] | None if question.many else kind | None
    return _parameter(f"{name}__{question.name.replace('-', '_')}", hint, words)


def _run(kind: type[Operation], indenter: str | None, said: dict[str, Any]) -> None:
    """Run an operation with its options; write its files and its answer."""
    as_json, own = said.pop("json_"), said.pop("with_", None) or ()
    force = said.pop("force_", False)
    with wrong_input():
        given = _given(kind, indenter, said)
        from viscotack.problem.nouns import own_nouns

        also = own_nouns(own)
        asked = take(kind, given, Here(also=also))
        files = {output: said[output.name] for output in kind.outputs}
        files = checked(files, force=force, as_json=as_json)
        carry_out(asked, files, own, also, as_json)


def carry_out(
    asked: Operation,
    files: Mapping[Output, Path | None],
    own: Iterable[str | Path],
    also: tuple[Any, ...],
    as_json: bool,
) -> None:
    """Run an operation, show its progress, and write the requested outputs.

    Parameters
    ----------
    asked : Operation
        The operation with its options.
    files : mapping
        Output -> file; None if not requested.
    own : iterable of path
        Files with user-defined classes.
    also : tuple of classes
        The user-defined classes.
    as_json : bool
        Whether the answer is printed as one JSON object.
    """
    wants = frozenset(output.name for output, file in files.items() if file is not None)
    paths = tuple(str(Path(file).resolve()) for file in own)
    with progress() as tell:
        answer = answered(asked, Caller(tell, wants, also, paths))
    finish(answer, files, as_json)


def checked(
    files: Mapping[Output, Path | None], *, force: bool, as_json: bool
) -> dict[Output, Path | None]:
    """Return the files to write, including default ones."""
    found = {
        output: Path(output.usual) if file is None and output.usual and not as_json else file
        for output, file in files.items()
    }
    if missing := [o.flag for o, file in found.items() if o.needed and file is None]:
        raise InputError(f"{missing[0]} is missing; give the output file")
    check_files(found, force=force, as_json=as_json)
    return found


def finish(answer: Answer, files: Mapping[Output, Path | None], as_json: bool) -> None:
    """Write the requested files of an answer, print it, and exit with its status."""
    write = Writing()
    for output, file in files.items():
        if output.name in answer.pictures:
            write.picture(file, answer.pictures[output.name])
        elif output.name in answer.files:
            write(output.said, file, answer.files[output.name])
    for note in answer.notes:
        typer.echo(harmless(note), err=True)
    text = json.dumps(answer.record(), indent=2, allow_nan=False) if as_json else answer.words()
    if text:
        write.answer(text)
    write.end()
    if answer.status:
        raise typer.Exit(answer.status)


def _given(kind: type[Operation], indenter: str | None, said: Mapping[str, Any]) -> dict[str, Any]:
    """Return the given values by the names of the options."""
    given: dict[str, Any] = {}
    for option in options(kind):
        if isinstance(option.card, Stated):
            given |= _problem(option, indenter, said)
        else:
            given.setdefault(option.name, said.get(option.name))
    return given


def _problem(option: Option, indenter: str | None, said: Mapping[str, Any]) -> dict[str, Any]:
    """Return the input for a problem: an indenter with numbers, or a file."""
    card, name = option.card, option.name
    assert isinstance(card, Stated)
    prefix = f"{name}__"
    answers = {
        key.removeprefix(prefix): value
        for key, value in said.items()
        if key.startswith(prefix) and value not in (None, [], ())
    }
    case, what = answers.pop("case", None), answers.pop("what", None)
    if case is not None and what is not None and _is_table(card, case):
        if _is_table(card, what):
            raise InputError(f"give one table of cases, got {what} and {case}")
        alone = {f"{prefix}{key}": value for key, value in answers.items()}
        return _problem(option, indenter, alone | {f"{prefix}what": what}) | {card.table: str(case)}
    if what is not None and what not in card.indenters:
        return _of_file(option, what, case, answers)
    word = (
        what
        or indenter
        or (_first_with(card, answers) if indenter is None and case is None else None)
    )
    if case is None and not word:
        return {name: None}
    stated = {"indenter": word} if word else {}
    return {name: stated | answers | ({} if case is None else {"case": str(case)})}


def _first_with(card: Stated, answers: Mapping[str, Any]) -> str:
    """Return the first indenter that asks for all that was given."""
    given = {name.replace("_", "-") for name in answers}
    for word in card.indenters:
        if given <= {question.name for question in indenter_named(word).questions}:
            return word
    return card.indenters[0]


def _of_file(
    option: Option, what: str, case: Path | None, answers: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the input for a problem if a file is given in place of an indenter."""
    card = option.card
    assert isinstance(card, Stated)
    if case is not None and _is_table(card, what):
        raise InputError(f"give the problem {case} before its table of cases {what}")
    if case is not None:
        raise InputError(f"give one file, got {what} and {case}")
    if _is_table(card, what):
        if flags := [flag(name) for name in answers]:
            raise InputError(f"{what} is a table of cases; remove {', '.join(flags)}")
        return {card.table: what, option.name: None}
    if not Path(what).suffix:
        raise InputError(f"{card.expected}, got {what!r}")
    return {option.name: {"case": what, **answers}}


def _is_table(card: Stated, file: str | Path) -> bool:
    """Return whether a file is a table of cases, by its ending."""
    return bool(card.table) and Path(file).suffix.lower() in (".csv", ".xlsx")


@contextmanager
def progress() -> Iterator[Callable[[Mapping[str, Any]], None]]:
    """Show a progress bar on standard error if it is a terminal; yields its update function."""
    if not sys.stderr.isatty():
        yield _lines()
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    # the remaining time assumes that work is proportional to the completed share
    times = (
        TimeElapsedColumn(),
        TextColumn("gone, about"),
        TimeRemainingColumn(),
        TextColumn("to go"),
    )
    words = (TextColumn("{task.fields[words]}", markup=False),)
    first = (TextColumn("{task.description}"), BarColumn())
    with Progress(*first, *times, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=1.0, visible=False, words="")

        def tell(told: Mapping[str, Any]) -> None:
            if "share" in told:
                said = told.get("words", "")
                bar.columns = (*first, *(words if said else times))
                doing = told.get("doing", "")
                bar.update(
                    task, completed=told["share"], description=doing, words=said, visible=True
                )

        yield tell


def _lines() -> Callable[[Mapping[str, Any]], None]:
    """Return a function that prints progress lines, for output that is not a terminal."""
    last = monotonic()

    def tell(told: Mapping[str, Any]) -> None:
        nonlocal last
        is_due = told.get("urgent") or monotonic() - last > LINES
        if "words" in told and is_due:
            last = monotonic()
            typer.echo(harmless(told["words"]), err=True)

    return tell
