"""The theories as tiers: five closed forms, and the contact whose edge is a steady crack."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from viscotack.errors import InputError, OutOfRange
from viscotack.model.geometry import Cone, HalfSpace, PowerLawProfile, Sphere
from viscotack.model.materials import Elastic, RetardationPowerLaw, StandardSolid
from viscotack.model.problem import Groups
from viscotack.model.problem.accuracy import at_least, outside
from viscotack.model.protocol import Apart, AtDepth, AtForce, AtRadius
from viscotack.model.traction import (
    Dugdale,
    Exponential,
    LennardJones,
    Tabulated,
    effective_range,
    softening,
)
from viscotack.prediction.closed_forms import (
    ClosedForms,
    Estimate,
    closed_forms,
    lennard_jones_alike,
)
from viscotack.prediction.prediction import Prediction, of_theory, with_curve
from viscotack.prediction.surrogate.line import Curves
from viscotack.prediction.tier import ANY, CRACK_CONTACT, Question, Verified
from viscotack.simulate.crack_contact.by_crack import (
    FURTHER,
    LEAST_TABOR,
    CrackContact,
    crack_contact,
    not_measured,
    unloading,
)
from viscotack.theory.elastic.relaxed import contact_in_groups, radius_without_adhesion

# Ranges where nine of ten cases are inside the bands of the closed forms; rate in h0/tau0. Other
# laws by their effective range and the steepest fall of the tension [strength^2/work].
CLOSED_FORM = Verified(
    shapes=(Sphere,),
    bodies=(HalfSpace,),
    laws=(LennardJones, Dugdale, Exponential, Tabulated),
    solids=(RetardationPowerLaw, StandardSolid),
    starts=(AtDepth, AtForce, AtRadius),
    ranges={
        "tabor": (0.3, 8.0),
        "modulus_ratio": (1e-3, 0.3),
        "exponent": (0.3, 1.6),
        "rate": (0.1, 1e8),
        "effective range": (0.69, 8.4),
        "steepest fall": (0.76, 6.7),
    },
)
# Elastic solids have one closed form, a table of simulations (tests/test_tiers.py).
ELASTIC = replace(
    CLOSED_FORM, laws=(LennardJones,), solids=(Elastic,), ranges={"tabor": (0.01, 1e6)}
)
# Error of the table of elastic forces; a viscoelastic solid is only nearly relaxed.
_TABLE_ERROR = 0.005
# Largest start for which the curves of the closed forms are computed, a radius in
# (pi R^2 dg0/E0*)^(1/3).
_LARGEST_START = 300.0
# Smallest and largest Tabor number, modulus ratio, depth [h0], and rate times retardation time over
# the depth, where the force may have two maxima of about the same height: one before the solid
# under the contact has relaxed, and one after it, when the edge is a crack. 90 % intervals of the
# surrogate of solids included only 67 to 79 % of the simulated forces there.
_TWO_PEAKS = ((0.05, 5.0), (1e-4, 1e-2), (20.0, 500.0), (0.5, 2.0))


def forms_of(asked: Question) -> ClosedForms:
    """Return the estimates of all closed forms."""
    return closed_forms(asked.groups)


def estimate_of(asked: Question, name: str) -> Estimate:
    """Return the estimate of a closed form, regardless of its allow-list."""
    return next(e for e in asked.once(forms_of).estimates if e.tier == name)


def closed_form_limits(asked: Question) -> str:
    """Name the number of a problem outside the measured range of the closed forms, or return ""."""
    groups = asked.groups
    if (radius := radius_without_adhesion(groups.start, tabor=groups.tabor)) > _LARGEST_START:
        return (
            f"the start is a contact of radius {radius:.4g} (pi R^2 dg0/E0*)^(1/3); the "
            f"theories are evaluated up to {_LARGEST_START:g}"
        )
    alike, material = lennard_jones_alike(groups), groups.material
    assert alike.rate is not None, "checked by the allow-list"
    values = {"tabor": alike.tabor, "modulus_ratio": groups.modulus_ratio}
    if isinstance(material, RetardationPowerLaw):
        values["exponent"] = material.exponent
    values["rate"] = alike.rate * material.time_unit
    if not isinstance(groups.traction, LennardJones):
        values["effective range"] = effective_range(groups.traction)
        values["steepest fall"] = softening(groups.traction)
    ranges = CLOSED_FORM.ranges
    if asked.once(forms_of).regime == "quasi-static":
        # slower retractions are even closer to the limit
        ranges = {**ranges, "rate": (0.0, ranges["rate"][1])}
    if words := outside(values, ranges):
        return words
    contact = contact_in_groups(alike.start, tabor=alike.tabor)
    if contact is None or contact.depth <= 0:
        return ""
    depth = float(contact.depth) * alike.tabor
    numbers = alike.tabor, groups.modulus_ratio, depth, values["rate"] / depth
    if all(low <= x <= high for x, (low, high) in zip(numbers, _TWO_PEAKS, strict=True)):
        return (
            "the force may have two maxima of about the same height, one before the solid under "
            f"the contact has relaxed and one after: {numbers[-1]:.2g} preload depths are "
            "retracted in the retardation time"
        )
    return ""


def by_closed_form(asked: Question, name: str) -> Prediction:
    """Evaluate a closed form."""
    groups = asked.groups
    elastic = isinstance(groups.material, Elastic)
    match groups.start:
        case AtDepth(depth=value) | AtForce(force=value) if elastic and value < 0:
            # the retraction may begin beyond the force minimum
            raise OutOfRange("the start is in tension; verified only for starts in compression")
    limits = (
        outside({"tabor": groups.tabor}, ELASTIC.ranges) if elastic else closed_form_limits(asked)
    )
    if limits:
        raise OutOfRange(limits)
    try:
        found = estimate_of(asked, name)
    except OverflowError:
        raise OutOfRange("the theory loses all digits there") from None
    if found.pull_off_force is None or found.error is None:
        raise OutOfRange(found.why)
    why = f"by the theory {name!r}: {found.why}"
    error = _TABLE_ERROR if elastic else found.error
    return of_theory(asked, found.pull_off_force, error, name, why)


# The theory describes a solid by its modulus and its creep, and was compared with simulations of
# several solids; `not_measured` lists the ranges.
CRACK_CONTACT_VERIFIED = Verified(
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


_CLOSED = {name: (CLOSED_FORM,) for name in ("unloading", "detachment", "rate-fit", "glassy")}
TIERS = {CRACK_CONTACT: ((CRACK_CONTACT_VERIFIED,), by_crack_contact)} | {
    name: (verified, partial(by_closed_form, name=name))
    for name, verified in {"elastic": (CLOSED_FORM, ELASTIC), **_CLOSED}.items()
}
