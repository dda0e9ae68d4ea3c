"""Sentences on a fitted slow test, made from its numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from viscotack.model.materials.passport import Passport
from viscotack.units import readable, readable_interval

from .likelihood import EVIDENCE, Interval
from .temperatures import assumed_temperature

if TYPE_CHECKING:
    from .slow_tests import ModelFit, SamePull, SlowTestFit


def upper_bound_words(fit: SlowTestFit) -> list[str]:
    """Return the reasons why the work of a fit is an upper bound; empty for a slow test."""
    said = []
    if fit.inelastic:
        said.append(
            f"residuals are {fit.residual:.2g} times the noise: no elastic law fits. If the test "
            "was not slow, energy dissipated at a viscoelastic edge appears as a longer range; use "
            "a slower test, or `viscotack identify rates`"
        )
    if fit.modulus is not None and fit.contradicts_modulus:
        modulus, uncertainty = (readable(x, "Pa") for x in fit.modulus)
        said.append(
            f"the fitted E0* {readable(fit.best.contact_modulus, 'Pa')} is {fit.modulus_apart:.2g} "
            f"standard deviations from the given {modulus} +- {uncertainty}: the contact was not "
            "that of the relaxed solid, or the given modulus or the compliance of the rig is wrong"
        )
    if fit.same_pull is not None and fit.same_pull.fast:
        said.append(
            f"{_of_pull(fit, fit.same_pull)}: the test was not slow. Use a slower test, or "
            "`viscotack identify rates`"
        )
    return said


def slow_words(fit: SlowTestFit) -> list[str]:
    """Return sentences on the result and on what the data do not determine."""
    alike, reasons, level = fit.alike, fit.upper_bound, fit.level
    names = [one.model.upper() for one in alike]
    if reasons:
        most = readable(fit.work_of_adhesion.high, "J/m2")
        said = [
            f"the work of adhesion is at most {most} ({level:.0%}), an upper bound: an elastic fit "
            "does not determine it from this test",
            *reasons,
        ]
    elif fit.undetermined:
        works = [_work(one, one.intervals["work_of_adhesion"], level) for one in alike]
        by_each = " or ".join(f"{x} by {name}" for x, name in zip(works, names, strict=True))
        apart = alike[1].criterion - alike[0].criterion
        said = [
            f"the work of adhesion is undetermined between models: {by_each} (criteria "
            f"{apart:.1f} apart, {EVIDENCE:g} would be evidence); contact radii from a camera, "
            "or E0* with its uncertainty, distinguish them"
        ]
    else:
        work = _work(alike[0], fit.work_of_adhesion, level)
        said = [f"work of adhesion {work} by {' and '.join(names)}"]
    if len(names) > 1 and (reasons or not fit.undetermined):
        others = " and ".join(names[1:])
        said.append(
            f"the data do not distinguish {names[0]} from {others} (criteria within {EVIDENCE:g})"
        )
    ranged = next((one for one in fit.fits if "tabor" in one.intervals), None)
    if ranged is not None and not reasons:
        said.append(_of_range(ranged, names, level))
    if fit.test.against == "depth":
        said.append(
            "the zero of depth was also fitted; without a camera the range is poorly determined"
        )
    if fit.same_pull is None and fit.material is not None:
        said.append("without speed and preload the material cannot show whether the test was slow")
    if fit.same_pull is not None and not fit.same_pull.fast:
        said.append(_of_pull(fit, fit.same_pull))
    if isinstance(fit.material, Passport):
        known = () if fit.test.temperature is None else (fit.test.temperature,)
        said += assumed_temperature(fit.material, known)
    return said


def _of_pull(fit: SlowTestFit, pull: SamePull) -> str:
    """Return whether the test was slow on its material."""
    at = (
        f"at {readable(fit.test.speed or 0.0, 'm/s')}, {readable(pull.work, 'J/m2')} and a range "
        f"of {readable(pull.gap, 'm', digits=2)}"
    )
    if pull.assumed is not None:
        at += (
            f", assumed at a Tabor number of {pull.assumed:g} because the data do not determine it"
        )
    if pull.error:
        return f"whether the test was slow is not checked {at}: {pull.error}"
    if pull.ratio is None:
        return f"whether the test was slow is not known {at}: simulate this pull"
    said = f"the material gives {pull.ratio:.4g} times the slow force {at}"
    return said if pull.fast else f"{said}: the test was slow"


def _work(fit: ModelFit, ends: Interval, level: float) -> str:
    both = readable_interval(ends.low, ends.high, "J/m2")
    return f"{readable(fit.work_of_adhesion, 'J/m2')} ({both}, {level:.0%})"


def _of_range(fit: ModelFit, alike: list[str], level: float) -> str:
    """Describe the range; `alike` are the models that the data do not distinguish."""
    ends, name = fit.intervals["tabor"], fit.model.upper()
    if ends.told:
        both = f"({ends.low:.3g} to {ends.high:.3g}, {level:.0%})"
        return f"Tabor number {fit.tabor:.3g} {both} by {name}"
    if ends.closed_below and "DMT" not in alike:
        return (
            f"the Tabor number is above {ends.low:.3g} ({level:.0%}, {name}); these data give no "
            "upper bound, hence no range of attraction: JKR is sufficient"
        )
    if ends.closed_above and "JKR" not in alike:
        return (
            f"the Tabor number is below {ends.high:.3g} ({level:.0%}, {name}); these data give no "
            "lower bound: DMT is sufficient"
        )
    return f"these data do not determine the range of attraction ({name})"
