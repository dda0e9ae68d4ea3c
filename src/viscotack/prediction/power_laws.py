"""Surrogate of spheres on power laws by retardation, as a tier, and its inputs."""

from __future__ import annotations

import numpy as np

from viscotack.arrays import Array
from viscotack.model.geometry import HalfSpace, Sphere
from viscotack.model.materials import RetardationPowerLaw
from viscotack.model.protocol import AtDepth, AtForce, AtRadius
from viscotack.model.traction import LennardJones
from viscotack.prediction.surrogate import physics, store

from .beyond import beyond
from .learned import INSIDE, further_prediction, out_of_range, within
from .prediction import Prediction
from .tier import SURROGATE, Question, Verified

VERIFIED = Verified(
    shapes=(Sphere,),
    bodies=(HalfSpace,),
    laws=(LennardJones,),
    solids=(RetardationPowerLaw,),
    starts=(AtDepth, AtForce, AtRadius),
)


def by_power_laws(asked: Question) -> Prediction:
    """Evaluate the surrogate of power laws, including its extrapolation."""
    learned = asked.model or store.shipped()
    rows, out = asked.once(inputs_of_sphere)
    if not out:
        return within(asked, learned, learned.tests(rows), SURROGATE, INSIDE)
    further = None
    if asked.model is None and np.isfinite(rows).all():
        further = beyond(learned, rows, asked.confidence)
    return further_prediction(asked, further, SURROGATE, out)


def inputs_of_sphere(asked: Question) -> tuple[Array, str]:
    """Return the inputs of a test for the surrogate, shape (1, 5), and those out of range in words.

    Exponent and rate of another solid, and the depth of a start that is not known, are nan.
    """
    groups, learned, start = asked.groups, store.shipped(), asked.groups.start
    row, no_start = np.full(len(physics.INPUTS), np.nan), ""
    row[:2] = groups.tabor, groups.modulus_ratio
    if isinstance(groups.material, RetardationPowerLaw):
        row[[physics.EXPONENT, physics.RATE]] = (
            groups.material.exponent,
            groups.rate * groups.material.tau0,
        )
    if isinstance(start, AtDepth):
        row[physics.PRELOAD] = start.depth
    elif learned.inside(row[None])[0, physics.TABOR]:
        by = "force" if isinstance(start, AtForce) else "contact_radius"
        try:
            row[physics.PRELOAD] = learned.start_depth(groups.tabor, **{by: getattr(start, by)})
        except ValueError as error:
            no_start = str(error)
    scales, si = asked.problem.scales(), {}
    if scales is not None:
        si = {"preload": (scales.length, "m"), "rate": (scales.length / scales.time, "m/s")}
    out = out_of_range(learned, row, {"preload": "h0", "rate": "h0/tau0"}, si)
    return row[None], "; ".join([*out.values(), *filter(None, [no_start])])


TIERS = {SURROGATE: ((VERIFIED,), by_power_laws)}
