"""State of the page: the tables of a case, and their forms as file, command and Python code.

A :class:`State` contains the tables of a case file, which the link of the page holds as JSON. File,
command line and Python code generated from it define the same problem and give the same digits.
"""

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pprint import pformat
from typing import Any
from urllib.parse import urlencode

from viscotack.errors import InputError
from viscotack.files.toml import parse_toml, toml_value
from viscotack.model.materials.passport import Passport
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.problem.case_file import case_of_tables, passport_of
from viscotack.model.problem.nouns import known
from viscotack.model.problem.problem import Problem
from viscotack.model.problem.tables import Reading

# Of a case that is sent: it states a few dozen numbers.
_MOST_KEYS = 200
_WHERE = "the case"

Tables = Mapping[str, Mapping[str, Any]]


@dataclass(frozen=True)
class State:
    """A case, as the tables of a case file.

    Parameters
    ----------
    tables : mapping
        Name of a table -> its keys and values, as in a case file: text with units, dimensionless
        numbers, lists of these.
    also : tuple of classes
        User-defined laws, materials and shapes.

    Raises
    ------
    ValueError
        If the tables are not tables of texts and numbers, or too many.

    Examples
    --------
    >>> print(State({"sphere": {"radius": "5.19 mm"}, "material": {"poisson_ratio": 0.5}}).toml)
    [sphere]
    radius = "5.19 mm"
    <BLANKLINE>
    [material]
    poisson_ratio = 0.5
    <BLANKLINE>
    """

    tables: Tables
    also: tuple[Any, ...] = ()

    def __post_init__(self) -> None:
        tables = self.tables
        if not isinstance(tables, Mapping) or not all(
            isinstance(table, Mapping) for table in tables.values()
        ):
            raise InputError(
                f"{_WHERE} must be tables with keys, such as {{'sphere': {{'radius': '5 mm'}}}}, "
                f"got {tables!r:.80}"
            )
        if sum(len(table) for table in tables.values()) > _MOST_KEYS:
            raise InputError(f"{_WHERE} has more than {_MOST_KEYS} keys")
        plain = {
            str(name): {str(key): _plain(value) for key, value in table.items()}
            for name, table in tables.items()
        }
        # a [profile] by its slope is a cone, and a page has one way to state it
        cone = {"profile": "cone"} if "slope" in plain.get("profile", {}) else {}
        tables = {cone.get(name, name): table for name, table in plain.items()}
        object.__setattr__(self, "tables", tables)

    @cached_property
    def problem(self) -> Problem:
        """The problem in SI; ValueError if the tables do not define one."""
        return case_of_tables(self.tables, where=_WHERE, also=self.also)

    @cached_property
    def passport(self) -> Passport | None:
        """The passport of the material at its temperature; None if numbers define it."""
        return passport_of(self.tables, Reading(_WHERE, known(self.also)))[0]

    @property
    def query(self) -> str:
        """The query of a link to the page with this state."""
        return urlencode({"state": json.dumps({"case": self.tables})})

    @property
    def toml(self) -> str:
        """The state as a case file."""
        lines = []
        for name, table in self.tables.items():
            lines += [f"[{_key(name)}]"]
            lines += [f"{_key(key)} = {toml_value(value)}" for key, value in table.items()]
            lines.append("")
        return "\n".join(lines)

    def command(self, *, accuracy: float = DEFAULT_ACCURACY, until: str = "detached") -> str:
        """Return the command lines that simulate and predict it, once it is saved as case.toml."""
        flags = "" if accuracy == DEFAULT_ACCURACY else f" --accuracy {accuracy!r}"
        flags += "" if until == "detached" else f" --until {until}"
        return f"viscotack simulate case case.toml{flags}\nviscotack predict case.toml\n"

    def python(self, *, accuracy: float = DEFAULT_ACCURACY, until: str = "detached") -> str:
        """Return the Python that simulates it, with every digit."""
        flags = "" if accuracy == DEFAULT_ACCURACY else f", accuracy={accuracy!r}"
        flags += "" if until == "detached" else f", until={until!r}"
        said = f"result = solve(problem{flags})\nprint(summary(result))\n"
        if self.also:
            return (
                "from viscotack import read_case, solve, summary\n\n"
                "# also= contains the user-defined classes of the case\n"
                f'problem = read_case("case.toml", also=also)\n{said}'
            )
        problem = pformat(self.problem, width=88).replace("\n", f"\n{'':10}")
        names = sorted({"solve", "summary", *re.findall(r"\b([A-Z]\w*)\(", problem)})
        return f"from viscotack import {', '.join(names)}\n\nproblem = {problem}\n{said}"


def state_of_toml(text: str, also: Iterable[Any] = ()) -> State:
    """Read a state from the text of a case file.

    Raises
    ------
    ValueError
        If it is not TOML.
    """
    return State(parse_toml(text, _WHERE), tuple(also))


def _plain(value: Any, depth: int = 0) -> Any:
    """Check a value of a table, and return it."""
    if isinstance(value, list | tuple) and depth < 3:
        return [_entry(entry, depth) for entry in value]
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise InputError(f"{_WHERE}: a value must be text, a number or a list, got {value!r:.60}")
    if not isinstance(value, str) and (abs(value) > 1e300 or value != value):
        raise InputError(f"{_WHERE}: a number must be finite and below 1e300, got {value!r:.60}")
    return value


def _entry(value: Any, depth: int) -> Any:
    # a move may be a table as well: {approach = "10 um/s", to = "1 mN"}
    if isinstance(value, Mapping):
        return " ".join(f"{str(key).replace('_', ' ')} {word}" for key, word in value.items())
    return _plain(value, depth + 1)


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name)
