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
==========  ==============================  ==========================  =====================

The Poisson ratio is constant here, so that shear and bulk relax alike; where a program has a bulk
series it is written too. A file that comes in with another bulk series is refused.
"""

from viscotack.errors import InputError
from viscotack.materials.exchange import abaqus, ansys, comsol, radioss, tamaas
from viscotack.materials.exchange.units import SI, Units
from viscotack.materials.solids import Prony

CODES = {
    "abaqus": abaqus,
    "ansys": ansys,
    "comsol": comsol,
    "radioss": radioss,
    "tamaas": tamaas,
}

__all__ = ["CODES", "SI", "Units", "exported", "imported"]


def exported(material: Prony, code: str, *, units: Units = SI, notes: tuple[str, ...] = ()) -> str:
    """Return a Prony series as text for another program.

    Parameters
    ----------
    material : Prony
        The solid; make one of a power law by :func:`viscotack.materials.conversion.prony_form`.
    code : str
        "abaqus", "ansys", "comsol", "radioss" or "tamaas".
    units : Units
        Units of the numbers in the text, stated in its first lines.
    notes : tuple of str
        Lines to begin with, as comments: name, temperature, error of the series.

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
    return _module(code).written(material, units, notes)


def imported(text: str, code: str, *, units: Units | None = None, **also: float) -> Prony:
    """Return the Prony series that a text for another program states.

    Parameters
    ----------
    text : str
        Text in the format of the program; commands that are not about the series are passed over.
    code : str
        "abaqus", "ansys", "comsol", "radioss" or "tamaas".
    units : Units, optional
        Units of its numbers; left out, the comment "units: pressure ..., time ..." must say them.
    **also : float
        What the format does not hold: for comsol and radioss ``rubbery_modulus`` (long-term
        Young's modulus [Pa]) and ``poisson_ratio``, unless a comment of this package states them.

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
