"""Requests: each task of a user as a pydantic model, whose fields are its options.

The command line, HTTP, the page, study files and Python make the same requests. A request holds
what was asked, as plain data; files, passports and problems that it names are read by its answer,
through the caller.
"""

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from inspect import cleandoc
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeVar, cast, get_args

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined, to_jsonable_python

from viscotack.errors import TOO_LARGE, InputError, wrong_value

from .options import Contact, Output, choices_of, is_many, option_of, quoted

if TYPE_CHECKING:
    from viscotack.files.whole import Target

    from .statement import Statement

# Rows of a table that an operation keeps in memory.
_MOST_ROWS = 100_000

Told = Mapping[str, Any]
# Content of a file: text, a table of columns or of rows with the same keys, or what writes it.
Content = str | Mapping[str, Any] | Sequence[Mapping[str, Any]] | Callable[["Target"], None]


@dataclass(frozen=True)
class Answer:
    """Result of an operation; its files and figures are made on demand.

    Attributes
    ----------
    found : object
        The result as a Python object.
    data : object
        The record: numbers in SI with the unit in the name.
    words : str or mapping, optional
        Text for the terminal, or what of the record is shown there; default: all of it.
    units : mapping
        Units of dimensionless numbers of the record by name, for the text.
    files : mapping
        Name of an output -> its content: text, columns or rows of a table, or a function that
        writes it to a target.
    pictures : mapping
        Name of an output -> function that returns a figure.
    drawn : callable, optional
        Returns curves for the page.
    notes : tuple of str
        Warnings and remarks, such as rejected files.
    status : int
        Exit status of the command: 1 if the simulation failed, 4 if some cases failed.
    """

    found: Any
    data: Any
    words: Any = None
    units: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, Content] = field(default_factory=dict)
    pictures: Mapping[str, Callable[[], Any]] = field(default_factory=dict)
    drawn: Callable[[], dict[str, Any]] | None = None
    notes: tuple[str, ...] = ()
    status: int = 0

    def record(self) -> Any:
        """Return the record as plain data, as printed by ``--json`` and returned over HTTP."""
        return plain(self.data)

    def write(self, output: str, target: "Target") -> None:
        """Write an output, whole or not at all; the name of a picture's file states its format."""
        if output in self.pictures:
            from viscotack.plot.style import save_figure

            save_figure(self.plot(output), cast("Path", target))
        else:
            write_file(self._of(output, self.files), target)

    def plot(self, output: str = "plot") -> Any:
        """Return the figure of an output."""
        return self._of(output, self.pictures)()

    def columns(self, output: str = "csv") -> Mapping[str, Any]:
        """Return an output as columns, such as pandas.DataFrame takes."""
        found = self._of(output, self.files)
        if isinstance(found, str) or callable(found):
            raise InputError(f"{output} is no table of columns; write it to a file")
        return found if isinstance(found, Mapping) else columns_of(found)

    def _of(self, output: str, known: Mapping[str, Any]) -> Any:
        """Return an output by name."""
        if output not in known:
            raise InputError(
                f"no {output!r:.60} in this answer; it has {', '.join(known) or 'none'}"
            )
        return known[output]

    def __str__(self) -> str:
        """Return the text for the terminal."""
        from .parts.record_words import record_words

        shown = self.data if self.words is None else self.words
        return shown if isinstance(shown, str) else record_words(plain(shown), self.units)


def write_file(content: Content, target: "Target") -> None:
    """Write the content of a file, whole or not at all."""
    from viscotack.files.text import write_table
    from viscotack.files.whole import write_whole

    if callable(content):
        content(target)
    elif isinstance(content, str):
        write_whole(target, content.encode())
    else:
        is_rows = not isinstance(content, Mapping)
        write_table(columns_of(content) if is_rows else content, target)


def columns_of(rows: Sequence[Mapping[str, Any]]) -> dict[str, list[Any]]:
    """Return rows as columns, those of the first row."""
    if not rows:
        raise InputError("there are no rows to write")
    return {name: [row.get(name) for row in rows] for name in rows[0]}


def plain(value: Any) -> Any:
    """Convert a value to JSON types: arrays to lists, objects to tables, NaN and infinity to None.

    Examples
    --------
    >>> import numpy as np
    >>> plain({"force": np.array([1.0, np.nan]), "steps": np.int64(3)})
    {'force': [1.0, None], 'steps': 3}
    """
    return to_jsonable_python(value, inf_nan_mode="null", fallback=lambda other: other.tolist())


def harmless_name(name: str) -> str:
    """Return the last part of a file name, without what has a meaning in paths or shells."""
    bare = re.split(r"[/\\]", name)[-1]
    name = re.sub(r"[^\w.+\- ()]", "_", bare).lstrip(".")[-100:]
    # a file system counts bytes, up to 255
    return name.encode()[-255:].decode(errors="ignore") or "file"


@dataclass(frozen=True)
class Caller:
    """Who asks: progress, wanted outputs, classes of the user, and where named files lie.

    Attributes
    ----------
    tell : callable
        Called with progress data: completed ``share``, current step ``doing``, message ``words``,
        and whether it is ``urgent``. An exception that it raises ends the operation.
    wants : frozenset of str
        Names of the outputs that will be written.
    also : tuple of classes
        User-defined laws, materials, shapes and observables.
    own : tuple of str
        Files that define them.
    folder : Path
        Base folder of relative file names.
    sent : bool
        Whether only files of the working folder may be named, by their last names: those of a
        request over HTTP.
    read : list of Path
        Files that were named so far, for those who write the outputs.
    """

    tell: Callable[[Told], None] = lambda told: None
    wants: frozenset[str] = frozenset()
    also: tuple[Any, ...] = ()
    own: tuple[str, ...] = ()
    folder: Path = Path()
    sent: bool = False
    read: list[Path] = field(default_factory=list)

    def share(self, share: float) -> None:
        """Tell the completed share."""
        self.tell({"share": share})

    def file(self, name: str | os.PathLike[str]) -> Path:
        """Return the path of a named file, which no output may overwrite."""
        text = os.fspath(name)
        if not text or "\0" in text:
            raise InputError(f"expected the name of a file, got {text!r:.60}")
        path = self.folder / text
        if self.sent:
            path = self.folder / harmless_name(text)
            if not path.is_file():
                raise InputError(f"no file called {path.name!r:.100} was sent with the request")
        self.read.append(path)
        return path

    def within(self, file: Path) -> Self:
        """Return the caller of the names inside a file, which are relative to its folder."""
        return self if self.sent else replace(self, folder=file.parent)

    def read_file(self, name: Path, reader: Callable[..., Any]) -> Any:
        """Return what a reader makes of a file, which may name other files in its folder."""
        file = self.file(name)
        return reader(file, also=self.also, beside=self.within(file).file)

    def rows(self, given: Any) -> tuple[Mapping[str, Any], ...]:
        """Return the rows of an option, which may be in a file."""
        if not isinstance(given, Path):
            return tuple(given)
        from viscotack.campaign.listed import read_words

        path = self.file(given)
        names, lines = read_words(path, empty=True)
        rows = tuple(dict(zip(names, row, strict=True)) for _, row in islice(lines, _MOST_ROWS + 1))
        if len(rows) > _MOST_ROWS:
            raise InputError(f"{path} has more than {_MOST_ROWS:,} rows; run a campaign")
        return rows


class Request(BaseModel):
    """Base class of requests; :func:`viscotack.app.operations.operation` returns one by name.

    The docstring is the help text: a summary line, details, and an example of the command. Each
    field has an `Option` in its annotation.

    Attributes
    ----------
    word : str
        Name of the operation and its command: ``identify rates``.
    outputs : tuple of Output
        Files that it can write.
    takes_own : bool
        Whether it accepts user-defined laws, materials, shapes or observables.
    local : str
        Why it is not available over HTTP; "" where it is.
    section : str
        Section of the help with the options of a class that is no operation itself.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    word: ClassVar[str]
    outputs: ClassVar[tuple[Output, ...]] = ()
    takes_own: ClassVar[bool] = False
    local: ClassVar[str] = ""
    section: ClassVar[str] = "Options"

    def answer(self, caller: Caller) -> Answer:
        """Compute the answer; implementations import numerical modules here, not on top."""
        raise NotImplementedError

    def stated(self, caller: Caller) -> "Statement":
        """Return the problem of the option `problem`."""
        from .statement import statement

        option = option_of(type(self).model_fields["problem"])
        assert isinstance(option, Contact), "declared as a problem"
        return statement(getattr(self, "problem", None), option, caller)

    def values(self, *names: str) -> dict[str, Any]:
        """Return options by name, as keywords of what computes the answer."""
        return {name: getattr(self, name) for name in names}

    def known(self, name: str) -> tuple[float, float] | None:
        """Return a known number and its standard uncertainty, of two options; None without."""
        both = getattr(self, name), getattr(self, f"{name}_uncertainty")
        if (both[0] is None) != (both[1] is None):
            raise InputError(
                f"{name} and {name}_uncertainty belong together; give both or neither", field=name
            )
        return None if both[0] is None else both

    def check(self) -> None:
        """Refuse options that exclude each other."""

    @model_validator(mode="after")
    def _checked(self) -> Self:
        self.check()
        return self

    @model_validator(mode="before")
    @classmethod
    def _given(cls, given: Any) -> Any:
        """Leave out empty values, and take a single value of a repeated option for a list."""
        if not isinstance(given, Mapping):
            return given
        found = {
            n: x for n, x in given.items() if x is not None and x != "" and x != [] and x != ()
        }
        for name, info in cls.model_fields.items():
            if name in found and is_many(info) and not isinstance(found[name], list | tuple):
                found[name] = [found[name]]
        return found


R = TypeVar("R", bound=Request)


def options(kind: type[Request]) -> dict[str, FieldInfo]:
    """Return the fields of a request, its own before those of its bases."""
    names = [n for each in kind.__mro__ for n in vars(each).get("__annotations__", {})]
    return {name: kind.model_fields[name] for name in names if name in kind.model_fields}


def request_of(kind: type[R], given: Mapping[str, Any]) -> R:
    """Return a request from what a user gave.

    Raises
    ------
    InputError
        If an option is unknown, missing or invalid; its `field` is the option.
    """
    try:
        return kind.model_validate(dict(given))
    except ValidationError as error:
        raise refusal(kind, error.errors(include_url=False)) from None


def refusal(kind: type[Request], errors: Any) -> InputError:
    """Return the error of a request from those that pydantic found."""
    if missing := [str(each["loc"][-1]) for each in errors if each["type"] == "missing"]:
        return InputError(f"{quoted(missing)} {'are' if missing[1:] else 'is'} missing")
    first = errors[0]
    known = [name for name in map(str, first["loc"]) if name in kind.model_fields]
    own = first.get("ctx", {}).get("error")
    if first["type"] == "extra_forbidden":
        name = str(first["loc"][-1])
        near = get_close_matches(name, kind.model_fields, n=1)
        meant = f"did you mean {near[0]}?" if near else f"it has {', '.join(kind.model_fields)}"
        return InputError(f"{kind.word} has no option {name!r:.60}; {meant}")
    if not known:
        return own if isinstance(own, InputError) else InputError(str(own or first["msg"]))
    words = wrong_value(first)
    joint = " " if words.startswith(("must ", "needs ", "lies ")) else ": "
    example = option_of(kind.model_fields[known[0]]).example
    more = f"; for example {example}" if example else ""
    return InputError(f"{known[0]}{joint}{words}{more}", field=known[0])


def answered(asked: Request, caller: Caller) -> Answer:
    """Run an operation; InputError if arithmetic overflows or a simulation stops early.

    A plain division by zero is a defect of the operation.
    """
    try:
        return asked.answer(caller)
    except (OverflowError, FloatingPointError):
        raise InputError(TOO_LARGE) from None
    except RuntimeError as error:
        # imported late, so that commands which do not simulate start fast
        from viscotack.simulate import SimulationError

        if not isinstance(error, SimulationError):
            raise
        raise InputError(str(error)) from None


def summary(kind: type) -> str:
    """Return the first sentence of an operation's docstring."""
    return cleandoc(kind.__doc__ or "").partition("\n\n")[0].replace("\n", " ")


def described(kind: type[Request]) -> dict[str, Any]:
    """Return name, description, options and outputs as plain data, for the forms of the page."""
    return {
        "word": kind.word,
        "path": kind.word.replace(" ", "/"),
        "summary": summary(kind),
        "help": cleandoc(kind.__doc__ or ""),
        "options": [_described(name, info) for name, info in options(kind).items()],
        "outputs": [
            {"name": x.name, "words": x.words, "kind": x.kind, "endings": x.endings}
            for x in kind.outputs
        ],
        "local": kind.local,
    }


def _described(name: str, info: FieldInfo) -> dict[str, Any]:
    option, default = option_of(info), info.default
    kinds = get_args(info.annotation) or (info.annotation,)
    form = option.form or ("choice" if choices_of(info) else "switch" if bool in kinds else "text")
    quoted = option.words.split('"')
    return {
        "name": name,
        # without commands and flags
        "words": re.sub(
            "`viscotack (.+?)`|--([a-z-]+)", lambda x: x[1] or x[2].replace("-", "_"), option.words
        ),
        "form": form,
        "unit": getattr(option, "unit", ""),
        "example": option.example.strip('"') or (quoted[1] if len(quoted) > 2 else ""),
        "choices": list(choices_of(info)),
        "default": default if isinstance(default, str | int | float | bool) else None,
        "needed": default is PydanticUndefined,
        "many": is_many(info),
    }
