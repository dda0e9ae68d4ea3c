"""Records as lines for people: a quantity whose name ends with its SI unit gets a prefix."""

from collections.abc import Mapping
from numbers import Real
from typing import Any

from viscotack.model.problem.outputs import Unit
from viscotack.units import readable

# Ends of names, as `Unit.tail` spells them -> unit; the longest first.
_TAILS = {Unit("", "", "", si).tail: si for si in ("J/m^2", "N/m", "m/s", "Pa", "N", "J", "m", "s")}


def record_words(record: Mapping[str, Any]) -> str:
    """Return a record as lines: name, and value with its unit; a list of two numbers is a range.

    Examples
    --------
    >>> print(record_words({"pull_off_force_N": 4.31e-3, "tabor": 2.0}))
      pull_off_force                              4.31 mN
      tabor                                       2
    """
    return "\n".join(_line(name, value) for name, value in record.items())


def _line(name: str, value: Any) -> str:
    tail = next((tail for tail in _TAILS if name.endswith(f"_{tail}")), None)
    unit = "1" if tail is None else _TAILS[tail]
    text = "none" if value is None else value
    if isinstance(value, Real) and not isinstance(value, bool):
        text = readable(float(value), unit, digits=5)
    elif isinstance(value, list):
        text = readable(value[0], unit, digits=5, to=value[1])
    return f"  {name if tail is None else name.removesuffix(f'_{tail}'):<42}  {text}"
