"""Records of benchmarks, and the numbers of pages that quote them.

A record, `benchmarks/records/NAME.json`, holds what a benchmark measured, with its command, date,
commit and processor. A page names the source of a number in a comment, which readers do not see:

    134<!-- = speed.median --> times faster, 0.14 %<!-- = published.force.median --> apart

The comment stands behind the number that it names, in the same line; a percentage is a hundred
times the recorded share, and `* 1e3` is any other factor. A comment on a line of its own names the
source of all numbers of the paragraph or table below it, which are lines of text in the record:

    <!-- = speed.table -->
    | case | times faster |

A number is a result if another version of the package, another machine or another draw could change
it, and only results need a source. Definitions are the others: inputs of an example, conditions,
units, references and names. Known by form are years and numbers of equations, figures, tables and
versions; exponents, fractions and multiples of pi; numbers of list items; m x n; values behind the
name of an input (mu, k, n, nu, Tabor number, modulus ratio, rate, seed, accuracy); the level of an
interval; a speed, temperature or frequency behind "at"; and the heading and the first column of a
table, which name its cases. Other definitions have the mark `<!-- = given -->`: behind a number,
above a block, or above a heading, where it covers the section.

Sources are `above`, the numbers that the code blocks above show, which tests compare with what
commands print; values of records; `computed.NAME`, what a function of `computed.py` computes now;
`kept.NAME.PATH` of replication/kept; and `viscotack.MODULE.NAME`, a constant of the package.
`python benchmarks/docs_check.py` compares them, with `--write` renews the page, with `--count`
counts numbers by source, and with `--list` prints results without one. `--quote PAGE` puts marked
blocks that no record has into a record of the folder `stated`, as the page states them: for what
takes hours to measure again. A value that a benchmark writes comes before it.
"""

from __future__ import annotations

import json
import os
import platform
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "benchmarks/records"
KEPT = ROOT / "replication/kept"
DIGITS = 5
NUMBER = re.compile(r"(?<![\w.])[-+−]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:e[-+]?\d+)?(?!\w)")
MARK = re.compile(r" ?<!-- = ([\w.-]+)(?: \* ([\d.e+-]+))? -->")
# Lines below a mark that has a line of its own.
BLOCK = re.compile(r"((?: *(?!<!-- =)\S.*(?:\n|\Z))+)")
# What a command writes between two comments, and is compared by a test of its own.
WRITTEN = re.compile(r"(?s)<!-- (?!= )[^>]+ -->\n.*?<!-- end[^>]*-->")
_CODE = re.compile(r"(?ms)^ *(```|~~~).*?^ *\1 *$|^ {4}[^\n]*$")
# The mark of a definition.
GIVEN = "given"
# The source of what the page shows in a code block above.
ABOVE = "above"
_VALUE = r"[-+−±]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?"
_VALUES = rf"{_VALUE}(?:(?:,|[ ]and|[ ]to|[ ]or|,[ ]and)[ ]{_VALUE})*"
_NAMES = r"mu|μ|μeff|k|n|ν|nu|b|[Tt]abor[ ]numbers?|[Mm]odulus[ ]ratios?|seeds?|accurac\w+|rates?"
_INPUT = rf"(?:{_NAMES})(?:[ ](?:=|of|from|above|below|between|at|up[ ]to|beyond|to|is))*"
_FORMS = re.compile(
    rf"""(?mx)
    \b(?:Eqs?|Figs?|Secs?|Tables?|Figures?|Sections?|[Cc]hapter|[Pp]art|[Vv]ersions?|Python|FMI|ISO
       |IR|SciPy|pymoo|uPlot|NiceGUI|Octave|Runtime|HTTP|API|SHA|UTF|Latin)s?[.]?[- ]\d[\d.]*
       (?:(?:,|[ ]and|[ ]to)[ ]\d[\d.]*)*
    | \((?:[^()\n]*[ ,])?(?:18|19|20)\d\d(?:;[^()\n]*)?\) | [A-Z]\w+,?[ ](?:18|19|20)\d\d\b
    | \b\d{{4}}-\d\d-\d\d\b | \b(?:doi|arXiv):\S+ | \b\d+[ ]x[ ]\d+\b
    | ^[ ]*\d+\.[ ]
    | \^\(?[-−]?\d+(?:/\d+)?\)? | (?<![\w./])\d+/\d+(?![\w./]) | [\d./]+[ ]?(?:pi|π)\b
    | (?<![\w.])\d/(?=[A-Za-zτμ(])
    | (?<![\w.]){_INPUT}[ ]{_VALUES}
    | \b90[ ]?%[ ](?=(?:interval|band|region|prediction|level)) | (?<=interval[ ]of[ ])90[ ]%
    | \bat[ ]{_VALUES}[ ](?:[nuµm]?m/s|degC|K|[mkMG]?Hz)\b
    | ^[ ]*\|.*\n(?=[ ]*\|[ ]?[-:]) | ^[ ]*\|[^|\n]*\|
    """
)
# Code, targets of links, comments and names of files are no prose.
_NO_PROSE = re.compile(r"(?s)`[^`\n]*`|\]\([^)\n]*\)|<!--.*?-->|<[^>\n]*>|https?://\S+")


@dataclass(frozen=True)
class Quote:
    """A number, or the numbers of a block, and what their source has.

    Attributes
    ----------
    source : str
        As the comment names it.
    place : tuple of int
        Where the text begins and ends in the page.
    shown, found : str
        Text of the page, and of the source in the digits of the page.
    """

    source: str
    place: tuple[int, int]
    shown: str
    found: str

    @property
    def agrees(self) -> bool:
        """Whether every number is that of the source, rounded."""
        return not self.difference

    @property
    def difference(self) -> str:
        """The first number of the page that its source does not have."""
        here, there = numbers(self.shown), numbers(self.found)
        if len(here) != len(there):
            return f"{len(here)} numbers shown, {len(there)} recorded"
        first = next((pair for pair in zip(here, there, strict=True) if len({*pair}) > 1), None)
        return f"shown: {first[0]}, recorded: {first[1]}" if first else ""

    @property
    def as_stated(self) -> bool:
        """Whether the source is a record of what the page stated."""
        name, _, key = self.source.partition(".")
        return key not in _values(FOLDER / f"{name}.json") and key in _values(_stated(name))


def write(name: str, values: dict[str, Any]) -> None:
    """Write what this program measured, with command, date, commit and processor.

    Values of the record that are not given are kept.
    """
    command = " ".join(["python", f"benchmarks/{Path(sys.argv[0]).name}", *sys.argv[1:]])
    facts = {"commit": commit(), "processor": processor()}
    _write(FOLDER / f"{name}.json", {"command": command}, facts, values)


def _write(
    path: Path, origin: dict[str, str], facts: dict[str, str], values: dict[str, Any]
) -> None:
    kept = _values(path) | _plain(values)
    content = origin | {"date": date.today().isoformat()} | facts | {"values": kept}
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", "utf-8")


def _values(path: Path) -> dict[str, Any]:
    return _content(path)["values"] if path.exists() else {}


def _stated(name: str) -> Path:
    return FOLDER / "stated" / f"{name}.json"


def value(source: str) -> Any:
    """Return the value of a source.

    Raises
    ------
    LookupError
        If there is no such record or no such value in it.
    """
    first, *rest = source.split(".")
    if first == "viscotack":
        return _constant(source)
    if first == "computed":
        return _part(computed(rest[0]), rest[1:], source)
    if first == "kept":
        path = KEPT / f"{rest[0]}.json"
        return _part(_content(path)["numbers"] if path.exists() else {}, rest[1:], source)
    measured, stated = _values(FOLDER / f"{first}.json"), _values(_stated(first))
    if not measured and not stated:
        raise LookupError(f"{source}: there is no record {first}.json")
    return _part(stated | measured, rest, source)


@cache
def computed(name: str) -> Any:
    """Return what a function of `computed.py`, beside this file, computes."""
    from computed import COMPUTED

    if name not in COMPUTED:
        raise LookupError(f"computed.{name}: computed.py has {', '.join(COMPUTED)}")
    return COMPUTED[name]()


def quotes(page: str, *, missing: bool = False) -> Iterator[Quote]:
    """Yield the numbers and blocks of a page that name a source.

    With `missing`, blocks whose source has no value are yielded without one.
    """
    bare = _blank(_CODE, page)
    prose = _blank(_NO_PROSE, bare)
    for mark in MARK.finditer(bare):
        source, line = mark[1], bare.rfind("\n", 0, mark.start()) + 1
        if source == GIVEN:
            continue
        if not bare[line : mark.start()].strip():
            block = BLOCK.match(bare, mark.end() + 1)
            if block is None:
                raise LookupError(f"no lines stand below the comment of {source}")
            found = _above(page, block) if source == ABOVE else _lines(source, missing)
            yield Quote(source, block.span(), block[0], found)
            continue
        before = [*NUMBER.finditer(prose, line, mark.start())]
        if not before:
            raise LookupError(f"no number stands before the comment of {source}")
        if source == ABOVE:
            yield Quote(source, before[-1].span(), before[-1][0], _above(page, before[-1]))
            continue
        share = "%" in prose[before[-1].end() : mark.start()]
        number = float(value(source)) * float(mark[2] or (100 if share else 1))
        yield Quote(source, before[-1].span(), before[-1][0], rounded(number, before[-1][0]))


def _above(page: str, place: re.Match[str]) -> str:
    """Return those numbers of a part of a page that its code blocks above show, rounded."""
    blocks = " ".join(match[0] for match in _CODE.finditer(page[: place.start()]))
    shown = [float(number.replace(",", "")) for number in NUMBER.findall(blocks)]
    found = numbers(place[0])
    return " ".join(x for x in found if any(rounded(value, x) == x for value in shown))


def renewed(page: str) -> str:
    """Return a page with the numbers of its sources, in the digits that it has."""
    for quote in reversed([*quotes(page)]):
        if not (quote.agrees or quote.as_stated or quote.source == ABOVE):
            page = page[: quote.place[0]] + quote.found + page[quote.place[1] :]
    return page


def rounded(number: float, shown: str) -> str:
    """Return a number in the digits, and with the signs, of a number that is shown."""
    digits, _, power = shown.partition("e")
    decimals = len(digits.partition(".")[2])
    if power:
        found = f"{number:.{decimals}e}".split("e")
        text = f"{found[0]}e{int(found[1])}"
    else:
        text = f"{number:{',' if ',' in digits else ''}.{decimals}f}"
    if shown[0] in "+-−":
        return text.replace("-", "−") if shown[0] == "−" else f"{'+' if number >= 0 else ''}{text}"
    return text.lstrip("-")


def numbers(text: str) -> list[str]:
    """Return the numbers of a text, as they are written, but for those in code and links."""
    return NUMBER.findall(_blank(_NO_PROSE, _blank(_CODE, text)))


def kinds(page: str) -> Iterator[tuple[int, str, str]]:
    """Yield line, text and kind of every number in the prose of a page, in order.

    Kinds are `written`, `measured`, `as stated`, `given` (a definition) and `no source`.
    """
    prose = _blank(_NO_PROSE, _blank(_CODE, page))
    bare = _blank(_FORMS, prose)
    spans = [(match.span(), "written") for match in WRITTEN.finditer(page)]
    for quote in quotes(page):
        spans.append((quote.place, "as stated" if quote.as_stated else "measured"))
    spans += [(place, GIVEN) for place in _given(page)]
    for number in NUMBER.finditer(prose):
        at = number.start()
        kind = next((kind for (begin, end), kind in spans if begin <= at < end), "no source")
        if kind in ("as stated", "no source") and bare[at : number.end()] != number[0]:
            kind = GIVEN
        yield page.count("\n", 0, at) + 1, number[0], kind


def count(page: str) -> dict[str, int]:
    """Return how many numbers the prose of a page has, by kind."""
    return Counter(kind for _, _, kind in kinds(page))


def _given(page: str) -> Iterator[tuple[int, int]]:
    """Yield where definitions begin and end that a page marks."""
    bare = _blank(_CODE, page)
    for mark in MARK.finditer(bare):
        line = bare.rfind("\n", 0, mark.start()) + 1
        if mark[1] != GIVEN:
            continue
        if bare[line : mark.start()].strip():
            prose = _blank(_NO_PROSE, bare)
            yield [*NUMBER.finditer(prose, line, mark.start())][-1].span()
        elif heading := re.match(r"(#+) ", bare[mark.end() + 1 :]):
            begin = mark.end() + 1 + heading.end()
            end = re.search(rf"(?m)^#{{1,{len(heading[1])}}} ", bare[begin:])
            yield begin, begin + end.start() if end else len(page)
        else:
            block = BLOCK.match(bare, mark.end() + 1)
            if block is None:
                raise LookupError("no lines stand below the comment of a definition")
            yield block.span()


def quoted(page: Path) -> list[str]:
    """Put blocks of a page that no record has into their records, and return their sources."""
    found: dict[str, dict[str, Any]] = {}
    for quote in quotes(page.read_text("utf-8"), missing=True):
        if not quote.found:
            name, _, key = quote.source.partition(".")
            lines = (" ".join(numbers(line)) for line in quote.shown.splitlines())
            found.setdefault(name, {})[key] = [line for line in lines if line]
    for name, values in found.items():
        script = ROOT / f"benchmarks/{name}.py"
        words = str((script if script.exists() else page).relative_to(ROOT))
        _write(_stated(name), {"stated in": words}, {}, values)
    return [f"{name}.{key}" for name, values in found.items() for key in values]


def processor() -> str:
    """Return the kind of processor."""
    try:
        words = Path("/proc/cpuinfo").read_text("utf-8")
        return next(x.split(":")[1].strip() for x in words.splitlines() if "model name" in x)
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def _blank(what: re.Pattern[str], text: str) -> str:
    """Return a text of the same length with spaces in the place of what a pattern finds."""
    return what.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def _lines(source: str, missing: bool) -> str:
    """Return the text of a block's source, or "" where it may be missing."""
    try:
        lines = value(source)
    except LookupError:
        if missing:
            return ""
        raise
    if not isinstance(lines, list):
        raise LookupError(f"{source}: a block needs lines of text, the record has {lines!r}")
    return "\n".join(lines) + "\n"


def _constant(source: str) -> Any:
    """Return a constant of a module of the package, or an element of one."""
    module, names = source, list[str]()
    while find_module(module) is None:
        module, _, name = module.rpartition(".")
        names.insert(0, name)
    if not names or not hasattr(import_module(module), names[0]):
        raise LookupError(f"{source}: {module} has no constant {'.'.join(names)}")
    found = getattr(import_module(module), names[0])
    return _part(list(found) if isinstance(found, tuple) else found, names[1:], source)


def find_module(name: str) -> Any:
    """Return the specification of a module, None if there is none."""
    try:
        return find_spec(name)
    except ModuleNotFoundError:  # its parent is a module and no package
        return None


def _part(found: Any, names: list[str], source: str) -> Any:
    for name in names:
        try:
            found = found[int(name) if isinstance(found, list) else name]
        except (LookupError, ValueError, TypeError):
            raise LookupError(f"{source}: its source has no {name!r}") from None
    return found


def _content(path: Path) -> dict[str, Any]:
    return json.loads(path.read_text("utf-8"))


def commit() -> str:
    """Return the commit of this checkout."""
    command = ["git", "rev-parse", "--short", "HEAD"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env=os.environ)
    return done.stdout.strip()


def _plain(found: Any) -> Any:
    if isinstance(found, dict):
        return {str(key): _plain(part) for key, part in found.items()}
    if isinstance(found, list | tuple):
        return [_plain(part) for part in found]
    if isinstance(found, str | bool | int):
        return found
    return float(f"{float(found):.{DIGITS}g}")
