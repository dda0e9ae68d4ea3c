"""Surrogate of the theory of a crack at the edge, for large Tabor numbers, as a tier."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import OutOfRange
from viscotack.prediction.surrogate import physics, short_range, store
from viscotack.simulate.crack_contact.by_crack import curve_bands, not_measured
from viscotack.theory.elastic.lennard_jones import pull_off_ratio
from viscotack.theory.elastic.relaxed import contact_in_groups

from .power_laws import VERIFIED, inputs_of_sphere
from .prediction import Prediction, of_theory, with_curve
from .tier import LEARNED_CRACK, Question

# Tabor number from which the theory of the crack is used as it is.
_FADED = 20.0


def by_learned_crack(asked: Question) -> Prediction:
    """Evaluate the surrogate of the crack theory."""
    groups, learned = asked.groups, store.shipped("short range")
    given, out = asked.once(inputs_of_sphere)
    rows = given.copy()
    if np.isnan(rows[0, physics.PRELOAD]) and rows[0, physics.TABOR] >= short_range.LOW[0]:
        contact = contact_in_groups(groups.start, tabor=groups.tabor)
        rows[0, physics.PRELOAD] = np.nan if contact is None else contact.depth * groups.tabor
    tests = learned.tests(rows)
    assert isinstance(tests, short_range.ShortRangeContact)
    if not learned.inside(tests).all():
        raise OutOfRange("out of the training range of the surrogate of the crack theory")
    said = learned.evaluate(tests)
    if not tests.holds(said)[0]:
        raise OutOfRange("the crack theory behind the surrogate does not hold there")
    if elsewhere := not_measured(groups):
        raise OutOfRange(f"the band of the crack theory was not measured here: {elsewhere}")

    error = learned.constants["error"][:, 0]
    zones, energy, effective = (
        float(said.more[name][0]) for name in ("zones", "amplification", "effective")
    )
    bands = error + curve_bands(energy, effective, zones)
    factors = _at_seam(groups.tabor, given)
    force, work = said.pull_off_force * factors[0], said.work_to_pull_off * factors[1]
    said = replace(said, pull_off_force=force, work_to_pull_off=work)
    # factors of the ends of the intervals of force, work, curve and travel
    low, high = 1 - bands, 1 + bands
    least = max(force[0] * low[0], min(force[0], float(pull_off_ratio(groups.tabor))))

    why = (
        f"surrogate of the theory 'crack contact', within {error[0]:.2%} of it: effective Tabor "
        f"number {effective:.3g}, travel of {zones:.3g} zones to the pull-off; not simulated "
        f"detachments, because {out}"
    )
    if factors[0] != 1:
        why += (
            f"; times {factors[0]:.4g}, with which it meets the simulations at a Tabor number of 10"
        )
    found = of_theory(asked, float(force[0]), float(bands[0]), LEARNED_CRACK, why, inside=True)
    found = replace(found, interval=(float(least), found.interval[1]))
    if np.isnan(work[0]) or not tests.agree(said)[0]:
        return replace(found, why=f"{why}; no work and no curve: its networks are not certain")
    between = float(work[0] * low[1]), float(work[0] * high[1])
    found = replace(found, work_to_pull_off=float(work[0]), work_interval=between)
    return with_curve(found, tests.curves(said), bands[2], np.array([low[3], high[3]]))


def _at_seam(tabor: float, rows: Array) -> Array:
    """Return the factors that make force and work continuous at a Tabor number of 10, shape (2,).

    They are the ratios of the surrogate of simulations to that of the theory there, for the same
    depth and rate, and tend to 1 at ``_FADED``; 1 without both. The factor of a work that is
    doubtful there is nan.
    """
    seam, rows = physics.LIMITS["tabor"][1], rows.copy()
    rows[0, physics.TABOR] = seam
    simulated, theory = store.shipped(), store.shipped("short range")
    if tabor >= _FADED or not (simulated.inside(rows).all() and theory.inside(rows).all()):
        return np.ones(2)
    answers, said = simulated.evaluate(rows), theory.evaluate(rows)
    force_doubtful, work_doubtful = simulated.doubtful(rows, answers)[0].tolist()
    if force_doubtful or not theory.tests(rows).holds(said)[0]:
        return np.ones(2)
    ratio = np.append(
        answers.pull_off_force / said.pull_off_force,
        np.nan if work_doubtful else answers.work_to_pull_off / said.work_to_pull_off,
    )
    return ratio ** float(1 - np.log(tabor / seam) / np.log(_FADED / seam))


TIERS = {LEARNED_CRACK: ((VERIFIED,), by_learned_crack)}
