r"""Prony series for and from other programs, each in its own convention.

They differ in four things, and every silent error is one of them:

==========  ==============================  ==========================  =====================
program     modulus of the elastic part     strength of a branch        rate of a branch
==========  ==============================  ==========================  =====================
abaqus      long-term E (stated so)         g_i = G_i/G(0), k_i alike   relaxation time
ansys       instantaneous E                 alpha_i = G_i/G(0)          relaxation time
comsol      long-term E                     G_m [Pa]                    relaxation time
radioss     long-term E (of the /MAT)       G_i, K_i [pressure]         decay 1/(relax. time)
tamaas      long-term E                     shear modulus G_i           relaxation time
rheojax     long-term G_inf                 shear modulus G_i [Pa]      relaxation time
pyvisco     instantaneous E_0               alpha_i = E_i/E_0           relaxation time
reptate     none: a mode 1e4 times slower   shear modulus G_i [Pa]      relaxation time
==========  ==============================  ==========================  =====================

The Poisson ratio is constant here, so that shear and bulk relax alike; where a program has a bulk
series it is written too. A file that comes in with another bulk series is refused. A Poisson ratio
of 0.5 goes to a program that forbids it with a bulk modulus, which does not relax, or not at all.
"""

from viscotack.errors import InputError
from viscotack.materials import checks
from viscotack.materials.branched_solids import Prony
from viscotack.materials.exchange import (
    abaqus,
    ansys,
    comsol,
    pyvisco,
    radioss,
    reptate,
    rheojax,
    tamaas,
)
from viscotack.materials.exchange.units import SI, Card, Units
from viscotack.materials.shift import Shift

CODES = {
    "abaqus": abaqus,
    "ansys": ansys,
    "comsol": comsol,
    "radioss": radioss,
    "tamaas": tamaas,
    "rheojax": rheojax,
    "pyvisco": pyvisco,
    "reptate": reptate,
}
# Programs that refuse a Poisson ratio of 0.5, or divide by zero.
COMPRESSIBLE = ("abaqus", "ansys", "comsol", "radioss")
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
    """Return a Prony series as text for another program.

    Parameters
    ----------
    material : Prony
        The solid; make one of a power law by :func:`viscotack.materials.conversion.prony_form`.
    code : str
        "abaqus", "ansys", "comsol", "radioss", "tamaas", "rheojax", "pyvisco" or "reptate".
    units : Units
        Units of the numbers in the text, stated in its first lines.
    notes : tuple of str
        Lines to begin with, as comments: name, temperature, error of the series.
    bulk_modulus : float, optional
        Of a solid with a Poisson ratio of 0.5, for a program that forbids that ratio [Pa]; it does
        not relax. About 2e9 for rubber.
    shift : WLF, Arrhenius or TabulatedShift, optional
        How times change with temperature, seen from that of the material; written for Abaqus
        (``*TRS``) and Ansys (``TB,SHIFT``), said in a comment for the others.

    Raises
    ------
    ValueError
        If the program forbids a Poisson ratio of 0.5 and no bulk modulus is given, or one is given
        that has no place.

    Notes
    -----
    Numbers have 17 digits (Radioss: 13, its columns are narrow), so that reading them back gives
    the same series to round-off. Where a program wants ratios to the instantaneous modulus, the
    small difference 1 - sum(g) is the modulus ratio k: what its ratios lose in digits is lost
    1/k times in the modulus it computes. Do not round them by hand.

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
        if not incompressible or code not in COMPRESSIBLE:
            raise InputError(
                "a bulk modulus is for a Poisson ratio of 0.5 and a program that forbids it "
                f"({', '.join(COMPRESSIBLE)}), got {material.poisson_ratio:g} and {code}"
            )
        checks.positive("bulk_modulus", bulk_modulus, "Pa")
        if bulk_modulus < material.glassy_modulus / 3:
            raise InputError(
                f"a bulk modulus of {bulk_modulus:g} Pa is below the glassy shear modulus, "
                f"{material.glassy_modulus / 3:g} Pa: such a solid is not nearly incompressible"
            )
    elif incompressible and code in COMPRESSIBLE:
        raise InputError(
            f"{code} forbids a Poisson ratio of 0.5; give the bulk modulus (bulk_modulus=2e9, on "
            'the command line --bulk-modulus "2 GPa": about that of rubber), or a material with '
            "a ratio below 0.5"
        )
    card = Card(material, bulk_modulus, shift)
    if shift is not None and code not in _SHIFTED:
        notes = (*notes, "its shift with temperature has no place here: export at each temperature")
    return module.written(card, units, (*notes, *card.notes()))


def imported(text: str, code: str, *, units: Units | None = None, **also: float) -> Prony:
    """Return the Prony series that a text for another program states.

    Parameters
    ----------
    text : str
        Text in the format of the program; commands that are not about the series are passed over.
    code : str
        One of those of :func:`exported`.
    units : Units, optional
        Units of its numbers; left out, the comment "units: pressure ..., time ..." must say them.
    **also : float
        What the format does not hold: for comsol, radioss and reptate ``rubbery_modulus``
        (long-term Young's modulus [Pa]) and ``poisson_ratio``, unless a comment of this package
        states them; for rheojax and pyvisco ``poisson_ratio``.

    Raises
    ------
    ValueError
        If something is missing, is not a number, or cannot be a solid with a constant Poisson
        ratio; with the line.
    """
    return _module(code).read(text, units, **also)


def _module(code: str):
    if code not in CODES:
        raise InputError(f"the program must be one of {', '.join(CODES)}, got {code!r}")
    return CODES[code]
