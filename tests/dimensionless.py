"""Dimensionless solids, of rubbery modulus and time 1, spheres and punches; exponents of errors."""

from dataclasses import replace

import numpy as np

from solids import creep_power_law, standard_solid
from viscotack.model.geometry import FlatPunch, Layer
from viscotack.model.materials import Elastic
from viscotack.model.problem import Groups


def standard(modulus_ratio=0.1):
    return standard_solid(1.0, 1 / modulus_ratio, 1.0, 0.0)


def power_law(modulus_ratio=0.1, exponent=0.6):
    return creep_power_law(1.0, 1 / modulus_ratio, exponent, 1.0, 0.0)


ELASTIC = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
SOLID = standard()


def sphere(start, *moves, rate=None, tabor=2.0, material=SOLID, **more):
    return Groups(tabor=tabor, material=material, start=start, rate=rate, moves=moves, **more)


def punch(start, *moves, size=64.85, thickness=3.24, cohesion=0.05, material=SOLID, **more):
    """Return the punch of the thesis on its sliding layer, with changes."""
    of_plane = {"geometry": FlatPunch(size), "body": Layer(thickness), "cohesion": cohesion}
    return sphere(start, *moves, tabor=None, material=material, **of_plane, **more)


def resized(groups, *, size=None, thickness=None, base=None, **others):
    """Replace the sizes and the base of a dimensionless punch, and other parts of it."""
    size = groups.geometry.half_width if size is None else size
    thickness = groups.body.thickness if thickness is None else thickness
    base = groups.body.base if base is None else base
    return replace(groups, geometry=FlatPunch(size), body=Layer(thickness, base), **others)


def slope(x, y):
    """Return the exponent with which y follows x, over all levels."""
    return np.polyfit(np.log(x), np.log(np.abs(y)), 1)[0]


def last_slope(x, y):
    """Return the exponent with which y follows x, on the last two levels."""
    return slope(x[-2:], y[-2:])
