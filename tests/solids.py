"""Solids by numbers in order: relaxed and instantaneous modulus, shape, time, Poisson ratio."""

import viscotack as vt

_FIELDS = ("rubbery_modulus", "glassy_modulus", "tau0", "poisson_ratio")


def standard_solid(*numbers):
    return vt.StandardSolid(**dict(zip(_FIELDS, numbers, strict=True)))


def _shaped(kind, name):
    """Return a function of both moduli, the number of this name, time and Poisson ratio."""
    fields = (*_FIELDS[:2], name, *_FIELDS[2:])
    return lambda *numbers: kind(**dict(zip(fields, numbers, strict=True)))


creep_power_law = _shaped(vt.RetardationPowerLaw, "exponent")
relaxation_power_law = _shaped(vt.RelaxationPowerLaw, "exponent")
fractional_zener = _shaped(vt.FractionalZener, "order")
