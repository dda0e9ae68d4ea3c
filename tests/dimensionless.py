"""Solids of dimensionless problems, of rubbery modulus and time 1, and exponents of errors."""

import numpy as np

from viscotack.model.materials import Elastic, RetardationPowerLaw, StandardSolid


def standard(modulus_ratio=0.1):
    return StandardSolid(
        rubbery_modulus=1.0, glassy_modulus=1 / modulus_ratio, tau0=1.0, poisson_ratio=0.0
    )


def power_law(modulus_ratio=0.1, exponent=0.6):
    return RetardationPowerLaw(
        rubbery_modulus=1.0,
        glassy_modulus=1 / modulus_ratio,
        exponent=exponent,
        tau0=1.0,
        poisson_ratio=0.0,
    )


ELASTIC = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
SOLID = standard()


def slope(x, y):
    """Return the exponent with which y follows x, over all levels."""
    return np.polyfit(np.log(x), np.log(np.abs(y)), 1)[0]


def last_slope(x, y):
    """Return the exponent with which y follows x, on the last two levels."""
    return slope(x[-2:], y[-2:])
