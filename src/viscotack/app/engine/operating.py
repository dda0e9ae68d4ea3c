"""Operations as tasks of the worker processes, with plain data as input and output."""

import base64
import io
import os
from collections.abc import Callable, Sequence
from contextlib import chdir
from typing import Any

from viscotack.app.operations.request import (
    DRAWN,
    WORDS,
    Answer,
    Caller,
    Request,
    answered,
    plain,
    write,
)
from viscotack.errors import InputError


def warm() -> None:
    """Run slow initialisations once."""
    from viscotack.app.operations.parts.solid import FIRST
    from viscotack.model.problem.accuracy import LOOSEST_ACCURACY
    from viscotack.model.problem.case_file import case_of_tables
    from viscotack.simulate import solve

    problem = case_of_tables(FIRST)
    solve(problem, accuracy=LOOSEST_ACCURACY, until="pull-off", estimate_error=False)


def run_request(
    asked: Request,
    outputs: tuple[str, ...],
    folder: str,
    *,
    tell: Callable[[dict[str, Any]], None],
    also: tuple[Any, ...],
) -> dict[str, Any]:
    """Answer a request; return the record of the answer, with other outputs in ``beside``.

    `outputs` are names of files, "words" or "drawn"; `folder` has the files that were sent.
    """
    wanted = _wanted(type(asked), outputs)
    caller = Caller(lambda told: tell(plain(dict(told))), wanted, also, sent=True)
    try:
        # so that files have their names in answers, and not the place where they lie
        with chdir(folder):
            answer = answered(asked, caller)
            return answer.record() | _beside(type(asked), answer, wanted)
    except InputError as error:
        # surfaces know their file by its whole path
        error.args = (str(error).replace(f"{os.path.realpath(folder)}{os.sep}", ""),)
        raise
    except FileNotFoundError as error:
        raise InputError(f"there is no file {error.filename}") from None
    except OSError as error:
        raise InputError(str(error)) from None


def _wanted(kind: type[Request], outputs: Sequence[str]) -> frozenset[str]:
    known = {WORDS, DRAWN, *(output.name for output in kind.outputs)}
    unknown = [name for name in outputs if name not in known]
    if unknown:
        raise InputError(
            f"outputs must be among {', '.join(sorted(known))}, got {unknown[0]!r:.60}"
        )
    needed = {output.name for output in kind.outputs if output.needed}
    return frozenset(outputs) | needed


def _beside(kind: type[Request], answer: Answer, wanted: frozenset[str]) -> dict[str, Any]:
    """Return the requested files, pictures as SVG and binary files in base 64."""
    files: dict[str, str] = {}
    for output in kind.outputs:
        if output.name not in wanted:
            continue
        stream = io.BytesIO()
        if output.name in answer.pictures:
            answer.pictures[output.name]().savefig(stream, format="svg")
        elif output.name in answer.files:
            write(answer.files[output.name], stream)
        else:
            continue
        content = stream.getvalue()
        binary = output.kind == "binary"
        files[output.name] = (
            base64.b64encode(content).decode() if binary else content.decode("utf-8")
        )
    beside: dict[str, Any] = {"files": files} if files else {}
    if WORDS in wanted:
        beside |= {"words": str(answer), "notes": list(answer.notes)}
    if DRAWN in wanted and answer.drawn is not None:
        beside["drawn"] = plain(answer.drawn())
    return {"beside": beside} if beside else {}
