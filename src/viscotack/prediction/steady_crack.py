"""The contact whose edge is a steady crack, as a tier."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from viscotack.errors import InputError, OutOfRange
from viscotack.model.geometry import Cone, HalfSpace, PowerLawProfile, Sphere
from viscotack.model.problem import Groups
from viscotack.model.problem.ranges import at_least
from viscotack.model.protocol import Apart, AtDepth, AtForce, AtRadius
from viscotack.model.traction import Dugdale, Exponential, LennardJones, Tabulated
from viscotack.prediction.surrogate.line import Curves
from viscotack.simulate.crack_contact.by_crack import (
    LEAST_TABOR,
    CrackContact,
    crack_contact,
    unloading,
)
from viscotack.simulate.crack_contact.crack_band import FURTHER, not_measured

from .prediction import Prediction, of_theory, with_curve
from .tier import ANY, Question, Verified

CRACK_CONTACT = "crack contact"
# The theory describes a solid by its modulus and its creep, and was compared with simulations of
# several solids; `not_measured` lists the ranges.
VERIFIED = Verified(
    shapes=(Sphere, Cone, PowerLawProfile),
    bodies=(HalfSpace,),
    laws=(LennardJones, Dugdale, Exponential, Tabulated),
    solids=ANY,
    starts=(AtDepth, AtForce, AtRadius, Apart),
    moves=True,
    springs=True,
)
# Range-corrected Tabor number from which predictions of spheres use steady cracks: below it a
# simulation takes a second, and works are up to 4 % low, once 7 %.
_CRACK_TABOR = 5.0


def crack_of(asked: Question) -> CrackContact | InputError:
    """Return the contact whose edge is a steady crack, or the error."""
    try:
        return crack_contact(asked.problem)
    except InputError as error:
        return error
    except ValueError as error:  # from a user-defined material
        return InputError(str(error))


def crack_limits(groups: Groups) -> str:
    """Return why the band of a contact with a crack at its edge does not apply, or ""."""
    simple = not groups.moves and groups.stiffness is None and isinstance(groups.geometry, Sphere)
    if simple and not at_least(groups.effective_tabor, _CRACK_TABOR):
        return (
            f"the range-corrected Tabor number is {groups.effective_tabor:.3g}, and predictions "
            f"use steady cracks from {_CRACK_TABOR:g} on; the theory itself is valid from an "
            f"effective Tabor number of {LEAST_TABOR:g}"
        )
    if elsewhere := not_measured(groups):
        return f"its band was not measured here: {elsewhere}"
    return ""


def by_crack_contact(asked: Question) -> Prediction:
    """Evaluate the contact whose edge is a steady crack."""
    groups = asked.groups
    if out := crack_limits(groups):
        raise OutOfRange(out)
    found = asked.once(crack_of)
    if isinstance(found, InputError):
        raise OutOfRange(str(found))
    if found.pull_off_force is None:
        raise OutOfRange("the test reaches no pull-off")
    why = f"by the theory {CRACK_CONTACT!r}: {found.why}"
    work = found.work_to_pull_off
    plain = of_theory(asked, found.pull_off_force, found.band, CRACK_CONTACT, why, work=work)
    simple = asked.relaxed_start and not groups.moves and groups.stiffness is None
    if work is None or not simple or not isinstance(groups.geometry, Sphere):
        return plain
    _, of_work, of_curve, of_travel = found.band + FURTHER
    left, force, radius = unloading(found)[0][:, None]
    curves = Curves(found.depth_at_pull_off + left, force, radius)
    interval = (float(work * (1 - of_work)), float(work * (1 + of_work)))
    travel = np.array([1 - of_travel, 1 + of_travel])
    return with_curve(replace(plain, work_interval=interval), curves, of_curve, travel)
