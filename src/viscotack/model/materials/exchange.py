r"""Prony series for other programs; for Abaqus and Ansys also shift laws, and readers.

The conventions differ in three points:

==========  ==============================  ==========================  =====================
program     modulus of the elastic part     strength of a branch        rate of a branch
==========  ==============================  ==========================  =====================
abaqus      long-term E (stated so)         g_i = G_i/G(0), k_i alike   relaxation time
ansys       instantaneous E                 alpha_i = G_i/G(0)          relaxation time
comsol      long-term E                     G_m [Pa]                    relaxation time
==========  ==============================  ==========================  =====================

The Poisson ratio is constant here, so shear and bulk relax with the same ratios. If a program has a
bulk series, it is exported as well; an imported file with a different bulk series is rejected. All
three reject a Poisson ratio of 0.5, or divide by zero: such a solid is exported with a bulk modulus
that does not relax.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

from scipy.constants import gas_constant

from viscotack.errors import InputError
from viscotack.model.materials.branched_solids import Prony
from viscotack.model.materials.shift import WLF, Arrhenius, Shift
from viscotack.units import parse, positive

# Program -> how it marks a comment.
_MARKS = {"abaqus": "**", "ansys": "!", "comsol": "%"}
# Program and law -> how it states log10 A = -c1 (T - T0)/(c2 + T - T0), in Ansys minus it, or
# ln A = H/R (1/T0 - 1/T).
_SHIFTS = {
    ("abaqus", WLF): """** temperatures in kelvin
*TRS, DEFINITION=WLF
{reference_temperature!r}, {c1!r}, {c2!r}""",
    ("ansys", WLF): """! temperatures in kelvin: TOFFST,0
TB,SHIFT,1,1,3,WLF
TBDATA,1,{reference_temperature!r},{c1!r},{c2!r}""",
    (
        "abaqus",
        Arrhenius,
    ): """** temperatures in kelvin, energy in J/mol; the model needs *PHYSICAL CONSTANTS,
** ABSOLUTE ZERO=0., UNIVERSAL GAS CONSTANT=8.31446
*TRS, DEFINITION=ARRHENIUS
{reference_temperature!r}, {activation_energy!r}""",
    ("ansys", Arrhenius): """! temperatures in kelvin: TOFFST,0; ln A = H/R (1/T0 - 1/T)
TB,SHIFT,1,1,2,TN
TBDATA,1,{reference_temperature!r},{over_R!r}""",
}
_COMMENT = re.compile(r"units:\s*pressure\s+(\S+?),\s*time\s+(\S+)")


@dataclass(frozen=True)
class Units:
    """The units of the numbers in a file.

    Parameters
    ----------
    pressure : str
        Such as "Pa" or "MPa".
    time : str
        Such as "s" or "ms".

    Examples
    --------
    >>> Units("MPa", "ms").pascal, Units("MPa", "ms").second
    (1000000.0, 0.001)
    """

    pressure: str
    time: str

    def __post_init__(self):
        positive("a unit of pressure", self.pascal, "Pa")
        positive("a unit of time", self.second, "s")

    @property
    def pascal(self) -> float:
        """The unit of pressure in Pa."""
        return parse(f"1 {self.pressure}", "Pa")

    @property
    def second(self) -> float:
        """The unit of time in s."""
        return parse(f"1 {self.time}", "s")


SI = Units("Pa", "s")
_INCOMPRESSIBLE = "incompressible solid, written with a bulk modulus that does not relax"
_SAME = 1e-6  # relative difference of two series that are the same


def exported(
    material: Prony,
    code: str,
    *,
    units: Units = SI,
    notes: tuple[str, ...] = (),
    bulk_modulus: float | None = None,
    shift: Shift | None = None,
) -> str:
    """Export a Prony series as text for another program.

    Parameters
    ----------
    material : Prony
        The solid; for a power law use :func:`viscotack.model.materials.conversion.prony_form`
        first.
    code : str
        "abaqus", "ansys" or "comsol".
    units : Units
        Units of the numbers, stated in the first lines of the text.
    notes : tuple of str
        Comments at the beginning of the text: name, temperature, error of the series.
    bulk_modulus : float, optional
        Bulk modulus [Pa], constant in time, for a solid with a Poisson ratio of 0.5, which the
        programs forbid. About 2e9 for rubber.
    shift : WLF, Arrhenius or TabulatedShift, optional
        Temperature dependence of the times, relative to the temperature of the material; exported
        for Abaqus (``*TRS``) and Ansys (``TB,SHIFT``), mentioned in a comment for the others.

    Raises
    ------
    ValueError
        If the Poisson ratio is 0.5 and no bulk modulus is given, or one is given without need.

    Notes
    -----
    Numbers have 17 digits, so importing them gives the same series to round-off. For ratios to the
    instantaneous modulus, the small difference 1 - sum(g) is the modulus ratio k: a rounding error
    of the ratios is amplified by 1/k in the long-term modulus. Do not round them by hand.

    Examples
    --------
    >>> solid = Prony(rubbery_modulus=1e6, branches=[(9e6, 0.1)], poisson_ratio=0.4)
    >>> print(exported(solid, "abaqus", units=Units("MPa", "s")))
    ** units: pressure MPa, time s
    *MATERIAL, NAME=VISCOTACK
    *ELASTIC, MODULI=LONG TERM
    1.0, 0.4
    *VISCOELASTIC, TIME=PRONY
    0.9, 0.9, 0.1
    <BLANKLINE>
    """
    if code not in _MARKS:
        raise InputError(f"the program must be one of {', '.join(_MARKS)}, got {code!r}")
    glassy = material.glassy_modulus
    # an incompressible solid has another Young's modulus and Poisson ratio in the program
    tensile = glassy if code == "ansys" else material.rubbery_modulus
    modulus, nu = tensile, material.poisson_ratio
    if bulk_modulus is not None:
        if nu != 0.5:
            raise InputError(f"bulk_modulus applies only to a Poisson ratio of 0.5, got {nu:g}")
        K = positive("bulk_modulus", bulk_modulus, "Pa")
        if K < glassy / 3:
            raise InputError(
                f"bulk_modulus = {K:g} Pa must exceed the glassy shear modulus, {glassy / 3:g} Pa, "
                "for a nearly incompressible solid"
            )
        modulus = 9 * K * tensile / (9 * K + tensile)
        nu = (9 * K - 2 * tensile) / (9 * K + tensile) / 2
        less = 100 * glassy / (9 * K + glassy)
        notes = (
            *notes,
            f"{_INCOMPRESSIBLE}: {bulk_modulus!r} Pa",
            f"Young's modulus at short times is {less:.2g} % below the incompressible one",
        )
    elif nu == 0.5:
        raise InputError(
            f"{code} forbids a Poisson ratio of 0.5; give the bulk modulus (bulk_modulus=2e9, on "
            'the command line --bulk-modulus "2 GPa", about that of rubber), or use a material '
            "with a ratio below 0.5"
        )
    mark, scaled = _MARKS[code], modulus / units.pascal
    ratios = [(E / glassy, time / units.second) for E, time in material.branches]
    bulk = bulk_modulus is None
    if code == "abaqus":
        rows = [
            "*MATERIAL, NAME=VISCOTACK",
            "*ELASTIC, MODULI=LONG TERM",
            f"{scaled!r}, {nu!r}",
            "*VISCOELASTIC, TIME=PRONY",
            *(f"{g!r}, {g if bulk else 0.0!r}, {time!r}" for g, time in ratios),
        ]
    elif code == "ansys":
        rows = [f"MP,EX,1,{scaled!r}", f"MP,NUXY,1,{nu!r}"]
        for part in ("SHEAR", "BULK") if bulk else ("SHEAR",):
            rows.append(f"TB,PRONY,1,1,{len(ratios)},{part}")
            for first in range(0, len(ratios), 3):
                values = ",".join(f"{g!r},{time!r}" for g, time in ratios[first : first + 3])
                rows.append(f"TBDATA,{2 * first + 1},{values}")
    else:
        factor = _shear_factor(material.poisson_ratio) / units.pascal
        branches = enumerate(material.branches, 1)
        rows = [
            f"% linear elastic material: long-term Young's modulus {scaled!r}",
            f"% linear elastic material: Poisson ratio {nu!r}",
            "% by default only the deviatoric part relaxes: make the volumetric part relax with "
            "the same ratios, unless the solid is nearly incompressible",
            "% branch, shear modulus, relaxation time",
            *(f"{i} {E * factor!r} {time / units.second!r}" for i, (E, time) in branches),
        ]
    if isinstance(shift, WLF | Arrhenius) and (code, type(shift)) in _SHIFTS:
        over_R = getattr(shift, "activation_energy", 0.0) / gas_constant
        rows.append(_SHIFTS[code, type(shift)].format(**vars(shift), over_R=over_R))
    elif shift is not None:
        what = "no temperature shift: export at each temperature"
        if code != "comsol":
            what = "no shift table: fit a WLF or Arrhenius law"
        rows.append(f"{mark} this format has {what}")
    comments = [line for note in notes for line in note.splitlines()]
    stated = f"units: pressure {units.pressure}, time {units.time}"
    return "\n".join([*(f"{mark} {line}" for line in (*comments, stated)), *rows]) + "\n"


@dataclass(frozen=True)
class _Deck:
    """What a text states, in its own units: one elastic modulus and the branches.

    Branches are (line, shear, bulk, time); shear and bulk are ratios to the instantaneous modulus.
    """

    modulus: float | None
    poisson_ratio: float | None
    branches: list[tuple[int, float, float, float]]
    is_instantaneous: bool = False


def imported(text: str, code: str, *, units: Units | None = None) -> Prony:
    """Import the Prony series from a text of another program.

    Parameters
    ----------
    text : str
        Text in the format of the program; commands unrelated to the series are ignored.
    code : str
        "abaqus" or "ansys".
    units : Units, optional
        Units of the numbers; by default from the comment "units: pressure ..., time ...".

    Raises
    ------
    ValueError
        If something is missing, is not a number, or does not describe a solid with a constant
        Poisson ratio; the message names the line.
    """
    if code not in _READERS:
        raise InputError(f"the program must be one of {', '.join(_READERS)}, got {code!r}")
    if units is None:
        stated = _COMMENT.search(text)
        if stated is None:
            raise InputError(
                "the text does not state its units; give `pressure_unit` and `time_unit`, in "
                "Python units=Units('MPa', 's')"
            )
        units = Units(*stated.groups())
    deck = _READERS[code](text)
    nu = deck.poisson_ratio
    if deck.modulus is None or nu is None:
        raise InputError("the text lacks Young's modulus or the Poisson ratio")
    modulus = deck.modulus * units.pascal
    if not deck.branches:
        raise InputError("the text contains no branch of a Prony series")
    if _INCOMPRESSIBLE in text:
        modulus, nu = 3 * modulus * _shear_factor(nu), 0.5
    for line, shear, bulk, _ in deck.branches:
        if nu != 0.5 and abs(shear - bulk) > _SAME * max(shear, bulk):
            raise InputError(
                f"line {line}: shear and bulk relax differently ({shear:g} and {bulk:g}), so the "
                "Poisson ratio would depend on time, but here it must be constant. Make the bulk "
                "series equal to the shear series, or state an incompressible solid (Poisson "
                "ratio 0.5)"
            )
    rest = 1 - sum(sorted(g for _, g, _, _ in deck.branches))
    if rest <= 0:
        raise InputError(
            f"the ratios to the instantaneous modulus sum to {1 - rest:.12g}; a solid needs a sum "
            "below 1, otherwise its long-term modulus is not positive"
        )
    glassy = modulus if deck.is_instantaneous else modulus / rest
    return Prony(
        rubbery_modulus=modulus * rest if deck.is_instantaneous else modulus,
        branches=tuple((g * glassy, t * units.second) for _, g, _, t in deck.branches if g > 0),
        poisson_ratio=nu,
    )


def _of_abaqus(text: str) -> _Deck:
    """Read the series of the first ``*VISCOELASTIC`` with its ``*ELASTIC``."""
    keyword, instantaneous = "", False
    elastic: tuple[float, float] | tuple[None, None] = None, None
    rows: list[tuple[int, float, float, float]] = []
    for line, words in _lines(text, "**"):
        if words.startswith("*"):
            command = words.upper().replace(" ", "")
            if command.startswith("*MATERIAL"):
                if rows:
                    break
                elastic = None, None  # it belonged to another material
            keyword = command.split(",")[0]
            if keyword == "*ELASTIC":
                instantaneous = "MODULI=INSTANTANEOUS" in command
            if keyword == "*VISCOELASTIC" and "TIME=PRONY" not in command:
                raise InputError(f"line {line}: expected TIME=PRONY, got {words!r}")
        elif keyword in ("*ELASTIC", "*VISCOELASTIC"):
            values = [_number(w, line, "a value") if w.strip() else 0.0 for w in words.split(",")]
            if keyword == "*VISCOELASTIC":
                if len(values) < 3:
                    raise InputError(f"line {line}: expected g_i, k_i, tau_i, got {words!r}")
                rows.append((line, values[0], values[1], values[2]))
            elif elastic[0] is None and len(values) >= 2:
                elastic = values[0], values[1]
    if elastic[0] is None:
        raise InputError("there is no *ELASTIC with Young's modulus and Poisson ratio")
    return _Deck(*elastic, rows, instantaneous)


def _of_ansys(text: str) -> _Deck:
    """Read the series of ``TB,PRONY`` with ``MP,EX`` and ``MP,NUXY`` (or PRXY)."""
    constants: dict[str, float] = {}
    # part -> line of its TB, stated number of pairs, and numbers by their places
    tables: dict[str, tuple[int, float, dict[int, float]]] = {}
    part = ""
    for line, raw in _lines(text, "!"):
        words = [*(w.strip() for w in raw.split(",")), *[""] * 5]
        command = words[0].upper()
        if command == "MP" and words[3]:
            constants[words[1].upper()] = _number(words[3], line, words[1])
        elif command == "TB":
            part = (words[5].upper() or "SHEAR") if words[1].upper() == "PRONY" else ""
            if part:
                pairs = _number(words[4] or "0", line, "the number of pairs")
                tables[part] = line, pairs, {}
        elif command == "TBDATA" and part:
            table = tables[part][2]
            if not words[1] and table:
                raise InputError(
                    f"line {line}: TBDATA must begin with the position of its first number"
                )
            first = int(_number(words[1] or "1", line, "the place of TBDATA"))
            table |= {
                place: _number(word, line, "a value")
                for place, word in enumerate(words[2:], first)
                if word
            }
    if "SHEAR" not in tables:
        raise InputError("there is no TB,PRONY with SHEAR in the text")
    for line, pairs, table in tables.values():
        if pairs and len(table) != 2 * pairs:
            raise InputError(
                f"line {line}: TB states {pairs:g} pairs, but {len(table)} numbers follow"
            )
        if sorted(table) != list(range(1, len(table) + 1)) or len(table) % 2:
            raise InputError(
                f"line {line}: the numbers of TBDATA must be complete pairs from position 1"
            )
    line, _, shear = tables["SHEAR"]
    bulk = tables["BULK"][2] if "BULK" in tables else {}
    rows = []
    for place in range(1, max(len(shear), len(bulk)), 2):
        time = shear.get(place + 1, 0.0)
        same = abs(time - bulk.get(place + 1, 0.0)) <= _SAME * time
        rows.append((line, shear.get(place, 0.0), bulk.get(place, 0.0) if same else 0.0, time))
    nu = constants.get("NUXY", constants.get("PRXY"))
    return _Deck(constants.get("EX"), nu, rows, is_instantaneous=True)


_READERS = {"abaqus": _of_abaqus, "ansys": _of_ansys}


def _lines(text: str, comment: str) -> Iterator[tuple[int, str]]:
    """Yield number and text of each line that contains more than a comment."""
    for line, raw in enumerate(text.splitlines(), 1):
        if words := raw.split(comment)[0].strip():
            yield line, words


def _shear_factor(poisson_ratio: float) -> float:
    """Return G/E = 1/(2 (1 + nu))."""
    return 1 / (2 * (1 + poisson_ratio))


def _number(word: str, line: int, what: str) -> float:
    """Parse a number; raise an error that names the line."""
    try:
        value = float(word.lower().replace("d", "e"))  # Fortran writes 1.0D+00
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"line {line}: {what} must be a number, got {word!r}")
    return value
