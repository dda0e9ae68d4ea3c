"""Cards: symbol, unit, description and range of each number that a user can set.

A noun (material, traction law, shape, body, start or protocol) is a frozen dataclass. The type
annotation of each of its numbers contains a card::

    radius: Annotated[float, Quantity("m", "R", "radius of the sphere", above=0, example="5.19 mm")]

Command-line options, keys of files, columns of campaigns, the JSON schema and the tables of the
docs are generated from the cards. :func:`conform` checks the numbers of a noun against them.
"""

import math
import types
from dataclasses import MISSING, dataclass, fields
from functools import lru_cache
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

from viscotack.errors import InputError
from viscotack.units import as_given, finite

# Smallest and largest magnitude of a quantity in SI that a file or an option may state. Tips of
# microscopes (1 nm, 0.1 nN), creep (1 pm/s for years), glasses and gels lie far inside.
PLAUSIBLE = {
    "m": (1e-15, 1e2),
    "m/s": (1e-21, 1e5),
    "s": (1e-21, 1e18),
    "N": (1e-21, 1e9),
    "Pa": (1e-9, 1e14),
    "J/m^2": (1e-12, 1e6),
    "J/m2": (1e-12, 1e6),
}

# Magnitudes of tests in laboratories, from microscopes to gecko pads for climbers: what lies
# outside of these is computed, with a warning.
USUAL = {
    "m": (1e-11, 1.0),
    "m/s": (1e-12, 10.0),
    "N": (1e-12, 1e4),
    "Pa": (1e-1, 1e13),
    "J/m^2": (1e-7, 1e5),
}


# Examples of numbers whose card has none in their unit.
_EXAMPLES = {"Pa": "2 kPa", "Pa/m": "1 GPa/m", "1": "0.5"}


def unusual(name: str, number: float | None, unit: str) -> str:
    """Return a warning about a number in SI of an improbable magnitude; "" otherwise.

    Examples
    --------
    >>> unusual("radius", 2.0, "m")
    'radius of 2 m is improbable; check its unit'
    """
    smallest, largest = USUAL.get(unit, (0.0, math.inf))
    if not number or smallest <= abs(number) <= largest:
        return ""
    return f"{name} of {as_given(number, unit)} is improbable; check its unit"


def plausible(name: str, number: float, unit: str) -> float:
    """Return a number in SI that a user states; InputError if its magnitude is absurd.

    Numbers without dimensions, and objects made in Python, have no such range.

    Examples
    --------
    >>> plausible("radius", 1e3, "m")
    Traceback (most recent call last):
    ...
    viscotack.errors.InputError: radius must lie between 1e-15 and 100 m, got 1000 m; check its unit
    """
    smallest, largest = PLAUSIBLE.get(unit, (0.0, math.inf))
    if number and not smallest <= abs(number) <= largest:
        raise InputError(
            f"{name} must lie between {smallest:g} and {largest:g} {unit}, got {number:g} {unit}; "
            "check its unit"
        )
    return number


@dataclass(frozen=True)
class Quantity:
    """Card of a number: unit, symbol, description and range.

    Attributes
    ----------
    unit : str
        SI unit; "1" for a dimensionless number.
    symbol : str
        Symbol used in formulas.
    words : str
        Description, without the unit.
    above, least, most : float or None
        Open lower bound, closed lower bound and closed upper bound; None for no bound.
    example : str
        Example value as text with its unit, as in a file or a command-line option.
    measure : str
        Kind of quantity that the machine controls: "depth", "force", "radius", "speed", "time" or
        "stiffness". The geometry determines its unit, for example N for a sphere and Pa for a
        punch.
    advice : str
        Advice that is appended to the error message for a number out of range.

    Examples
    --------
    >>> Quantity("m", "R", "radius of the sphere", above=0).checked("radius", -0.005)
    Traceback (most recent call last):
    ...
    viscotack.errors.InputError: radius must be positive, got -5 mm
    """

    unit: str
    symbol: str
    words: str
    above: float | None = None
    least: float | None = None
    most: float | None = None
    example: str = ""
    measure: str = ""
    advice: str = ""

    def checked(self, name: str, value: Any, unit: str | None = None) -> float:
        """Convert a value to float and check it; InputError if it is out of range."""
        unit = self.unit if unit is None else unit
        number = finite(name, value, unit)
        low = self.above is not None and not number > self.above
        if (
            low
            or number < (self.least if self.least is not None else number)
            or (self.most is not None and number > self.most)
        ):
            cure = f"; {self.advice}" if self.advice else ""
            raise InputError(f"{name} must {self.range}, got {as_given(number, unit)}{cure}")
        return number

    def __post_init__(self) -> None:
        if self.above is not None and self.least is not None:
            raise InputError("a card has either `above` (open bound) or `least` (closed), not both")

    @property
    def range(self) -> str:
        """Range as text that completes a sentence with "must"; empty without a bound."""
        above, least, most = self.above, self.least, self.most
        if above is not None and most is not None:
            return f"lie in ({above:g}, {most:g}]"
        if least is not None and most is not None:
            return f"lie between {least:g} and {most:g}"
        if above is not None:
            return "be positive" if above == 0 else f"be above {above:g}"
        if least is not None:
            return f"be at least {least:g}"
        return "" if most is None else f"be at most {most:g}"

    def example_in(self, unit: str) -> str:
        """Return an example in a unit, which may be another one than that of the card."""
        return (self.example if unit == self.unit else "") or _EXAMPLES.get(unit, f"1 {unit}")

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Read a number of a table: text with its unit, or where the reader says so a number."""
        from pydantic_core import core_schema

        return core_schema.with_info_plain_validator_function(
            lambda value, info: info.context.number(self, value)
        )


@dataclass(frozen=True)
class Pairs:
    """Card of a list of pairs of numbers.

    Attributes
    ----------
    units : tuple of str
        SI units of the first and the second number of a pair.
    symbol, words, example, advice : str
        As for a `Quantity`; the advice is on the number of pairs.
    fewest, most : int
        Smallest and largest number of pairs.
    """

    units: tuple[str, str]
    symbol: str
    words: str
    example: str = ""
    fewest: int = 1
    most: int = 10_000
    advice: str = ""

    def checked(self, name: str, value: Any) -> tuple[tuple[float, float], ...]:
        """Convert pairs to floats and count them; InputError if they are not finite numbers."""
        try:
            first, second = self.units
            pairs = tuple((finite(name, x, first), finite(name, y, second)) for x, y in value)
        except (TypeError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(
                f"{name} must be pairs of numbers, {self.words}, got {value!r:.80}"
            ) from None
        if not self.fewest <= len(pairs) <= self.most:
            cure = f"; {self.advice}" if self.advice else ""
            raise InputError(
                f"{name} must be {self.fewest} to {self.most:,} pairs, got {len(pairs):,}{cure}"
            )
        return pairs

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Read the pairs of a table."""
        from pydantic_core import core_schema

        return core_schema.with_info_plain_validator_function(
            lambda value, info: info.context.pairs(self, value)
        )


class Exact:
    """Marks a whole number or a switch of a table, for which text and others are not converted."""

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
        """Accept values of the type itself."""
        return handler(source) | {"strict": True}


@dataclass(frozen=True)
class Field:
    """A number of a noun: its name, card and default, and whether it may be None."""

    name: str
    card: Any
    default: Any = MISSING
    optional: bool = False

    @property
    def needed(self) -> bool:
        """Whether the number has no default."""
        return self.default is MISSING


@lru_cache(maxsize=256)
def cards(noun: type, kind: type = Quantity) -> dict[str, Field]:
    """Return the fields of a noun that have a card, by name, in order of definition.

    Examples
    --------
    >>> from viscotack.model.geometry import Sphere
    >>> cards(Sphere)["radius"].card.unit
    'm'
    """
    hints = get_type_hints(noun, include_extras=True)
    found = {}
    for field in fields(noun):
        card = card_of(hints[field.name], kind)
        if card is not None:
            found[field.name] = Field(
                field.name, card, field.default, optional=type(None) in get_args(hints[field.name])
            )
    return found


def with_units(noun: Any) -> dict[str, Any]:
    """Return the numbers of a noun as the values of a table, with units and all digits.

    Examples
    --------
    >>> from viscotack.model.geometry import Sphere
    >>> with_units(Sphere(5.19e-3))
    {'radius': '0.00519 m'}
    """

    def said(value: float | None, unit: str) -> Any:
        return value if unit == "1" else f"{value!r} {unit}"

    found = {
        name: said(value, field.card.unit)
        for name, field in cards(type(noun)).items()
        if (value := getattr(noun, name)) is not None
    }
    for name, field in cards(type(noun), Pairs).items():
        first, second = field.card.units
        found[name] = [[said(a, first), said(b, second)] for a, b in getattr(noun, name)]
    return found


def card_of(annotation: Any, kind: type = Quantity) -> Any:
    """Return the card of an annotated number, such as a modulus ratio; None without one."""
    if get_origin(annotation) is Annotated:
        return next((x for x in annotation.__metadata__ if isinstance(x, kind)), None)
    if get_origin(annotation) in (Union, types.UnionType):
        return next((card for x in get_args(annotation) if (card := card_of(x, kind))), None)
    return None


def conform(noun: Any) -> None:
    """Convert the numbers of a noun to float and check their ranges; called in __post_init__.

    Raises
    ------
    ValueError
        If a value is not a number, or is out of range. The message contains the unit.
    """
    for field in cards(type(noun)).values():
        value = getattr(noun, field.name)
        if isinstance(value, str):
            raise InputError(
                f"{field.name} must be a number in {field.card.unit}, got {value!r}; "
                f"viscotack.parse({value!r}, {field.card.unit!r}) reads text"
            )
        if value is not None or not field.optional:
            object.__setattr__(noun, field.name, field.card.checked(field.name, value))
    for name, field in cards(type(noun), Pairs).items():
        object.__setattr__(noun, name, field.card.checked(name, getattr(noun, name)))


class Checked:
    """Base of frozen dataclasses whose numbers are checked against their cards, and no more."""

    def __post_init__(self) -> None:
        conform(self)


def check_carded(noun: type) -> None:
    """Raise InputError if a field of a class has no card."""
    bare = [f.name for f in fields(noun) if f.name not in {*cards(noun), *cards(noun, Pairs)}]
    if bare:
        raise InputError(
            f"{noun.__name__}.{', '.join(bare)} has no card and so no unit; annotate the field: "
            "Annotated[float, Quantity(...)]"
        )
