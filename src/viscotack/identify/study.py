"""A study: the files and settings of a series of tack tests, and its evaluation."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.lab.tack import Cycle, Survey, survey
from viscotack.model.geometry import HalfSpace, Layer
from viscotack.model.materials import Material
from viscotack.model.materials.library import passport_of
from viscotack.model.materials.passport import Passport

from .approach import identify_approaches
from .computed import Computed
from .contact_time import check_dwells
from .pull_off import pull_offs
from .rate_fit import RateSeriesFit, identify_rates
from .rate_series import RateSeries

_APPROACHES = 3  # number of cycles whose approach bounds the range


@dataclass(frozen=True, kw_only=True)
class Study:
    """Tests of one sphere on one material at several speeds.

    Parameters
    ----------
    files : tuple of Path
        Files written by the rig.
    material : Passport, Material or str
        Passport, material, or the name or file of a passport.
    radius : float
        Radius of the sphere [m].
    body : HalfSpace or Layer
        Sample: thick, or a layer of known thickness.
    preload : float, optional
        Force under which contacts relaxed [N]; by default the force at the start of the retraction.
    temperature : float, optional
        Temperature of all tests [K]; by default that stated in each file, else that of the
        passport.
    temperature_uncertainty : float, optional
        Its standard uncertainty [K]; by default that of :func:`.identify_rates`.
    work_of_adhesion : (float, float), optional
        Value known from a slow test, with its standard uncertainty [J/m2].
    curves : bool
        Whether to fit whole curves, not only pull-offs.
    growth : bool
        Whether to fit an interface that grows with the opening speed.
    history : bool
        Whether to compute the forces with approach and dwell of each test.
    scatter : float
        Relative standard deviation between tests, if repeated tests do not show it.
    level : float
        Confidence level of all intervals and bands.
    reading, evaluation : mapping
        Keyword arguments of :func:`viscotack.lab.tack.read` and
        :func:`viscotack.lab.tack.evaluate`.
    title, notes : str
        Text for the report.
    """

    files: tuple[Path, ...]
    material: Passport | Material | str
    radius: float
    body: HalfSpace | Layer = HalfSpace()
    preload: float | None = None
    temperature: float | None = None
    temperature_uncertainty: float | None = None
    work_of_adhesion: tuple[float, float] | None = None
    curves: bool = False
    growth: bool = False
    history: bool = False
    scatter: float = 0.0
    level: float = 0.9
    reading: Mapping[str, Any] = field(default_factory=dict)
    evaluation: Mapping[str, Any] = field(default_factory=dict)
    title: str = ""
    notes: str = ""

    def __post_init__(self):
        if not self.files:
            raise InputError("a study needs at least one file of a rig, got none")

    def solid(self) -> Passport | Material:
        """Return the material at the temperature of the tests."""
        found = passport_of(self.material) if isinstance(self.material, str) else self.material
        if self.temperature is None:
            return found
        if not isinstance(found, Passport):
            raise InputError(
                "--temperature needs a material with a passport, which contains the shift of its "
                "times; omit it"
            )
        return found.moved_to(self.temperature)


@dataclass(frozen=True, eq=False)
class Answer:
    """Evaluated files of a study, the fitted interface, and the forces computed for it."""

    study: Study
    survey: Survey
    fit: RateSeriesFit
    computed: Computed


def answer(study: Study, kept: Path | None = None) -> Answer:
    """Evaluate a study: read files, average pull-offs and fit the rate series.

    Forces that an earlier identification computed are read from the file `kept`, and new ones are
    written to it.

    Raises
    ------
    OSError
        If a file cannot be opened.
    ValueError
        If no cycle is valid, or the series cannot be fitted.
    """
    solid = study.solid()
    found = survey(study.files, reading=study.reading, evaluation=study.evaluation)
    if not found.cycles:
        reasons = "\n  ".join(f"{path}: {why}" for path, why in found.reasons)
        raise InputError(f"no cycle of a tack test could be read:\n  {reasons}")
    check_dwells(found.cycles)
    series = pull_offs(found.cycles)
    if study.temperature is not None:
        series = [replace(one, temperature=study.temperature) for one in series]
    machine = [one.record.compliance for one in found.evaluations]
    computed = Computed() if kept is None else Computed.read(kept)
    compliance = study.evaluation.get("compliance") or max(machine)
    fit = identify_rates(
        RateSeries(
            series,
            material=solid,
            radius=study.radius,
            body=study.body,
            preload=study.preload,
            work_of_adhesion=study.work_of_adhesion,
            stiffness=1 / compliance if compliance > 0 else None,
            compliance_uncertainty=_relative(study.evaluation, compliance),
            temperature_uncertainty=study.temperature_uncertainty,
            curves=study.curves,
            growth=study.growth,
            history=study.history,
            scatter=study.scatter,
            level=study.level,
            range_bound=_range_bound(study, found.cycles, solid),
        ),
        computed=computed,
    )
    if kept is not None:
        computed.write(kept)
    return Answer(study, found, fit, computed)


def _range_bound(study: Study, cycles: Sequence[Cycle], solid: Passport | Material) -> float | None:
    """Return the upper bound of h0 from the approaches [m], the median of a few; None without."""
    if isinstance(study.body, Layer):
        return None
    material = solid.material if isinstance(solid, Passport) else solid
    fits, _ = identify_approaches(
        cycles[:: max(len(cycles) // _APPROACHES, 1)][:_APPROACHES],
        radius=study.radius,
        contact_modulus=material.contact_modulus,
        level=study.level,
    )
    return float(np.median([fit.bound for fit in fits])) if fits else None


def _relative(evaluation: Mapping[str, Any], compliance: float) -> float | None:
    """Return the relative uncertainty of the compliance; None where none is stated."""
    uncertainty = evaluation.get("compliance_uncertainty", 0.0)
    return uncertainty / compliance if uncertainty and compliance > 0 else None
