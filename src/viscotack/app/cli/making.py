"""Commands made from requests: the options of a command are the fields of its request."""

import inspect
import re
from collections.abc import Container, Iterator, Mapping
from inspect import cleandoc
from pathlib import Path
from typing import Annotated, Any, get_args

import typer
from pydantic.fields import FieldInfo
from typer.core import TyperCommand
from typer.main import get_command

from viscotack.app.operations import operation
from viscotack.app.operations.flags import OF_FILE, Flag, flags_of
from viscotack.app.operations.options import (
    Contact,
    File,
    Number,
    Option,
    Rows,
    choices_of,
    flag_of,
    is_many,
    option_of,
    quoted,
)
from viscotack.app.operations.request import Request, options, request_of
from viscotack.errors import InputError
from viscotack.units import readable

from .commands import AsJson, Force, With, wrong_input
from .running import carry_out

_SETTINGS = {"max_content_width": 100}
_CASE = "A problem in SI with units (docs/input.md), instead of the options of the problem."
# Sections of a help text, beside those of requests.
_ALWAYS = "General"
_FILES = "Files to write (- is standard output, for text)"


class BySubject(TyperCommand):
    """A command whose help lists its options by subject."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write arguments, then the options of each section."""
        sections: dict[str, list[tuple[str, str]]] = {}
        parameters: Any = self.get_params(ctx)
        for each in parameters:
            is_argument = each.param_type_name == "argument"
            record = (each.metavar, each.help) if is_argument else each.get_help_record(ctx)
            sections.setdefault(each.rich_help_panel or _ALWAYS, []).append(record)
        for title, records in sections.items():
            with formatter.section(title):
                formatter.write_dl(records)


def command_of(name: str) -> Any:
    """Make a command, as the library of the command line has it."""
    kind, last = operation(name), name.rpartition(" ")[2]

    def command(**said: Any) -> None:
        _run(kind, said)

    parameters = list(_parameters(kind))
    command.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    alone = typer.Typer(add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None)
    words = _copied(cleandoc(kind.__doc__ or ""))
    alone.command(last, cls=BySubject, help=words, context_settings=_SETTINGS)(command)
    return get_command(alone)


def _copied(words: str) -> str:
    """Return a docstring whose examples keep their lines and can be copied from the help."""

    def kept(found: re.Match[str]) -> str:
        lines = found["command"].replace("\n", " \\\n    ")
        return f"\b\n{found['title']}:\n  {lines}"

    example = r"^(?P<title>[^\n:]+): (?P<command>viscotack (?:.|\n(?!\n))+)"
    return re.sub(example, kept, words, flags=re.MULTILINE)


def _parameters(kind: type[Request]) -> Iterator[inspect.Parameter]:
    found = {name: (option_of(info), info) for name, info in options(kind).items()}
    # arguments first
    for name, (option, info) in sorted(found.items(), key=lambda each: not each[1][0].argument):
        if isinstance(option, Contact):
            yield from _of_problem(option, found)
        elif not (isinstance(option, Rows) and option.elsewhere):
            yield _of_option(name, option, info, _section(kind, name))
    how: dict[str, Any] = {"metavar": "FILE", "show_default": False, "rich_help_panel": _FILES}
    for output in kind.outputs:
        flags = output.flags or (f"--{output.name}",)
        words = typer.Option(*flags, help=output.words, **how)
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


def _section(kind: type[Request], name: str) -> str:
    """Return the section of an option: that of the class that declares it, if it has no command."""
    of: Any = next(x for x in kind.__mro__ if name in vars(x).get("__annotations__", {}))
    return Request.section if "word" in vars(of) else of.section


def _of_option(name: str, option: Option, info: FieldInfo, section: str) -> inspect.Parameter:
    # all values are text; the request converts them
    kind: Any = list[str] if is_many(info) else str
    told, needed, default = option.words, info.is_required(), info.default
    how: dict[str, Any] = {"help": told, "show_default": False, "rich_help_panel": section}
    flags = option.flags or (flag_of(name, option),)
    if option.argument:
        how["rich_help_panel"] = "Arguments"
        words = typer.Argument(metavar=option.metavar or name.upper(), **how)
    elif info.annotation is bool:
        kind = bool
        flags = (f"{flags[0]}/--no-{flags[0].removeprefix('--')}",) if default is True else flags
        how["show_default"] = bool(default)
        words = typer.Option(*flags, **how)
    else:
        unit = getattr(option, "unit", "1")
        if not needed and default not in (None, (), "", 0):
            how["help"] += f" [default: {default if unit == '1' else readable(default, unit)}]"
        kinds = get_args(info.annotation) or (info.annotation,)
        usual = "NUMBER" if int in kinds or isinstance(option, Number) else "TEXT"
        usual = "FILE" if isinstance(option, File) else usual
        usual = "QUANTITY" if unit != "1" else usual
        usual = f"[{'|'.join(choices_of(info))}]" if choices_of(info) else usual
        words = typer.Option(*flags, metavar=option.metavar or usual, **how)
    return _parameter(name, kind if needed else kind | None, words, needed=needed)


def _of_problem(option: Contact, own: Container[str]) -> Iterator[inspect.Parameter]:
    """Yield the parameters of a problem: words and files, and flags that are no own options."""
    only, needed = option.spelling == "case", option.spelling != "flags"
    told = option.words if needed else f"{option.words} {_CASE}"
    how: dict[str, Any] = {"show_default": False, "rich_help_panel": "Arguments"}
    words = typer.Argument(metavar=option.metavar or "CASE.toml", help=told, **how)
    kind: Any = str if only else list[str] if needed else list[str] | None
    yield _parameter("problem_", kind, words, needed=needed)
    flags = OF_FILE if only else flags_of(option.indenters)
    for name, flag in flags.items():
        if name in own or (option.in_si and not flag.si):
            continue
        usual = flag.metavar or ("NUMBER" if flag.pure else "QUANTITY")
        how["rich_help_panel"] = Request.section if only else _stated_in(flag)
        words = typer.Option(f"--{name.replace('_', '-')}", metavar=usual, help=flag.words, **how)
        yield _parameter(f"of_{name}", list[str] | None if flag.many else str | None, words)


def _stated_in(flag: Flag) -> str:
    """Return the section of a flag of a problem."""
    if not flag.pure:
        return "The contact in SI, numbers with units" if flag.si else "The contact in a file"
    if not flag.si:
        return "The contact without dimensions"
    return "The contact, in SI or without dimensions [in these units]"


def _run(kind: type[Request], said: dict[str, Any]) -> None:
    """Run an operation with its options; write its files and its answer."""
    as_json, own = said.pop("json_"), said.pop("with_", None) or ()
    force = said.pop("force_", False)
    with wrong_input(kind):
        given = {name: said[name] for name in kind.model_fields if name in said}
        for option in map(option_of, kind.model_fields.values()):
            if isinstance(option, Contact):
                given |= _problem(option, said)
        asked = request_of(kind, given)
        files = {output: said[output.name] for output in kind.outputs}
        carry_out(asked, files, own, force=force, as_json=as_json)


def _problem(option: Contact, said: Mapping[str, Any]) -> dict[str, Any]:
    """Return the input for a problem: an indenter with flags, or a file; and a table of cases."""
    flags = {n.removeprefix("of_"): x for n, x in said.items() if n.startswith("of_") and x}
    named = [said["problem_"]] if option.spelling == "case" else list(said["problem_"] or ())
    found: dict[str, str] = {}
    for word in named[named[:1] == ["case"] :]:
        is_table = option.table and Path(word).suffix.lower() in (".csv", ".xlsx")
        kind = "indenter" if word in option.indenters else option.table if is_table else "case"
        if kind in found:
            raise InputError(f"give one of each kind, got {found[kind]} and {word}")
        if option.table in found:
            table = found[option.table]
            raise InputError(f"give the problem {word} before its table of cases {table}")
        if kind == "case" and not Path(word).suffix and option.spelling == "word":
            known = ", ".join(option.indenters)
            raise InputError(f"give one of {known}, or a file CASE.toml, got {word!r}")
        found[kind] = word
    table = {option.table: found.pop(option.table)} if option.table in found else {}
    if not found and option.spelling == "flags":
        # the first indenter that has all flags that were given
        has_all = (w for w in option.indenters if flags.keys() <= flags_of((w,)).keys())
        found["indenter"] = next(has_all, option.indenters[0])
    if not found and table and flags:
        raise InputError(f"{table[option.table]} is a table of cases; leave out {quoted(flags)}")
    return table | ({"problem": found | flags} if found else {})
