r"""Export and import of Prony series for other programs, each with its own convention.

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

from viscotack.errors import InputError
from viscotack.model.materials import checks
from viscotack.model.materials.branched_solids import Prony
from viscotack.model.materials.exchange import (
    abaqus,
    ansys,
    comsol,
)
from viscotack.model.materials.exchange.units import SI, Card, Units
from viscotack.model.materials.shift import Shift

CODES = {
    "abaqus": abaqus,
    "ansys": ansys,
    "comsol": comsol,
}
_SHIFTED = ("abaqus", "ansys")

__all__ = ["CODES", "SI", "Units", "exported", "imported"]


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
    module = _module(code)
    incompressible = material.poisson_ratio == 0.5
    if bulk_modulus is not None:
        if not incompressible:
            raise InputError(
                "bulk_modulus applies only to a Poisson ratio of 0.5, got "
                f"{material.poisson_ratio:g}"
            )
        checks.positive("bulk_modulus", bulk_modulus, "Pa")
        if bulk_modulus < material.glassy_modulus / 3:
            raise InputError(
                f"bulk_modulus = {bulk_modulus:g} Pa must exceed the glassy shear modulus, "
                f"{material.glassy_modulus / 3:g} Pa, for a nearly incompressible solid"
            )
    elif incompressible:
        raise InputError(
            f"{code} forbids a Poisson ratio of 0.5; give the bulk modulus (bulk_modulus=2e9, on "
            'the command line --bulk-modulus "2 GPa", about that of rubber), or use a material '
            "with a ratio below 0.5"
        )
    card = Card(material, bulk_modulus, shift)
    if shift is not None and code not in _SHIFTED:
        notes = (*notes, "this format has no temperature shift: export at each temperature")
    return module.written(card, units, (*notes, *card.notes()))


def imported(text: str, code: str, *, units: Units | None = None, **also: float) -> Prony:
    """Import the Prony series from a text of another program.

    Parameters
    ----------
    text : str
        Text in the format of the program; commands unrelated to the series are ignored.
    code : str
        One of those of :func:`exported`.
    units : Units, optional
        Units of the numbers; by default from the comment "units: pressure ..., time ...".
    **also : float
        Constants that the format of comsol lacks: ``rubbery_modulus`` (long-term Young's modulus
        [Pa]) and ``poisson_ratio``, unless a comment of this package states them.

    Raises
    ------
    ValueError
        If something is missing, is not a number, or does not describe a solid with a constant
        Poisson ratio; the message names the line.
    """
    return _module(code).read(text, units, **also)


def _module(code: str):
    if code not in CODES:
        raise InputError(f"the program must be one of {', '.join(CODES)}, got {code!r}")
    return CODES[code]
