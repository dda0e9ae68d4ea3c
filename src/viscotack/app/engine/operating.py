"""Operations as tasks of the worker processes, with plain data as input and output."""

import base64
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.operations import operation
from viscotack.operations.declare.answer import DRAWN, WORDS, Answer, Caller
from viscotack.operations.declare.options import Operation, answered, respelled, take
from viscotack.operations.parts.json_data import plain

from .page_tasks import Asked, Tell

# The curve of a simulation as it grows.
_POINTS = "points"


@dataclass(frozen=True)
class Sent:
    """The files of a request; other files are not accessible.

    Attributes
    ----------
    folder : Path
        Where the files lie.
    names : frozenset of str
        Their names.
    also : tuple of classes
        User-defined classes of the operator of the server.
    """

    folder: Path
    names: frozenset[str]
    also: tuple[Any, ...] = ()

    def file(self, name: str) -> Path:
        """Return the path of a file that was sent."""
        if name not in self.names:
            there = ", ".join(sorted(self.names)) or "none"
            raise InputError(
                f"no file {name!r:.80} was sent with the request (sent: {there}); send it as a "
                "part of a multipart/form-data request"
            )
        return self.folder / name

    def within(self, path: Path) -> "Sent":
        """Return the place of the names that stand in a file: they were sent with it as well."""
        return self


def warm() -> None:
    """Run slow initialisations once."""
    from viscotack.methods import solve
    from viscotack.operations.parts.examples import FIRST
    from viscotack.problem.accuracy import LOOSEST_ACCURACY
    from viscotack.problem.case_file import case_of_tables

    problem = case_of_tables(FIRST)
    solve(problem, accuracy=LOOSEST_ACCURACY, until="pull-off", estimate_error=False)


def run_operation(asked: Asked, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Run an operation; return the record of the answer, with other outputs in ``beside``.

    `asked` has the word of the ``operation``, its options as ``given``, ``files``: the paths that
    were sent, and ``outputs``: names of files, "words" or "drawn".
    """
    kind = operation(asked["operation"])
    paths = [Path(file) for file in asked.get("files", ())]
    folder = paths[0].parent if paths else Path()
    place = Sent(folder, frozenset(path.name for path in paths), also)
    # paths on the server are removed from messages
    shown = f"{folder}/" if paths else ""
    try:
        wanted = _wanted(kind, asked.get("outputs", ()))
        question = take(kind, asked["given"], place)
        caller = Caller(lambda told: tell(plain(dict(told))), wanted, also, folder=folder)
        answer = answered(question, caller)
        # files first: what an answer counts while it writes them is in its record
        beside = _beside(kind, answer, wanted)
        return _without(shown, _record(answer) | beside)
    except InputError as error:
        words = respelled(error, kind)
        raise type(words)(_without(shown, str(words))) from None
    except FileNotFoundError as error:
        raise InputError(f"there is no file {_without(shown, str(error.filename))}") from None
    except OSError as error:
        raise InputError(_without(shown, str(error))) from None


def _without(folder: str, value: Any) -> Any:
    """Return an answer in which files have their names, and not the place where they lay."""
    if not folder:
        return value
    if isinstance(value, dict):
        return {key: _without(folder, entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_without(folder, entry) for entry in value]
    return value.replace(folder, "") if isinstance(value, str) else value


def _record(answer: Answer) -> dict[str, Any]:
    found = plain(answer.record())
    return found if isinstance(found, dict) else {"answer": found}


def _wanted(kind: type[Operation], outputs: Sequence[str]) -> frozenset[str]:
    known = {WORDS, DRAWN, *(output.name for output in kind.outputs)}
    unknown = [name for name in outputs if name not in known]
    if unknown:
        raise InputError(
            f"outputs must be among {', '.join(sorted(known))}, got {unknown[0]!r:.60}"
        )
    needed = {output.name for output in kind.outputs if output.needed}
    return frozenset(outputs) | needed | {_POINTS}


def _beside(kind: type[Operation], answer: Answer, wanted: frozenset[str]) -> dict[str, Any]:
    """Return the requested files, pictures as SVG and binary files in base 64."""
    files: dict[str, str] = {}
    for output in kind.outputs:
        if output.name not in wanted:
            continue
        stream = io.BytesIO()
        if output.name in answer.pictures:
            answer.pictures[output.name]().savefig(stream, format="svg")
        elif output.name in answer.files:
            answer.files[output.name](stream)
        else:
            continue
        content = stream.getvalue()
        binary = output.kind == "binary"
        files[output.name] = (
            base64.b64encode(content).decode() if binary else content.decode("utf-8")
        )
    beside: dict[str, Any] = {"files": files} if files else {}
    if WORDS in wanted:
        beside |= {"words": answer.words(), "notes": list(answer.notes)}
    if DRAWN in wanted and answer.drawn is not None:
        beside["drawn"] = plain(answer.drawn())
    return {"beside": beside} if beside else {}
