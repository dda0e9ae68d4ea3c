"""Fit a material model to measured moduli, with intervals and cautions.

:func:`fit` fits every model and returns a report of the quality of the fit.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from viscotack.errors import InputError
from viscotack.model.materials.words import FITS_ONLY
from viscotack.threads import one_blas_thread
from viscotack.units import readable

from .cautions import few_arms_caution, misfit_cautions, series_cautions, undetermined
from .observed import Data, Observed, observed, only, thinned
from .power_law import KINDS, fit_constants, fitted_constants
from .prony import fit_series, with_noise
from .report import ALIKE, FitReport, information_criterion

MODELS = (*KINDS, "prony")
# Candidates of `best`: contacts can be simulated on all of them.
SOLIDS = tuple(model for model in MODELS if model not in FITS_ONLY)


def fit(
    data: Data,
    *,
    poisson_ratio: float,
    model: str = "best",
    arms: int | None = None,
    known: Mapping[str, float] | None = None,
    loss: bool = True,
    level: float = 0.9,
    draws: int = 100,
    seed: int = 0,
) -> FitReport:
    r"""Fit a material model to a master curve, one sweep, or a test over time.

    Minimises the sum of squares of ln(measured/fitted) over all numbers. Storage and loss modulus
    have equal weights, unless the scatter of one about its own smooth curve is more than twice the
    other's: then each is weighted by its scatter.

    Parameters
    ----------
    data : MasterCurve, FrequencySweeps, RelaxationTest or CreepTest
        Measurement at one temperature. Shear moduli are converted to tensile ones by the Poisson
        ratio, because all materials of this package are tensile.
    poisson_ratio : float
        Poisson ratio nu, in [0, 0.5], constant; 0.5 for rubber, about 0.35 for a glass.
    model : str
        "power-law" (:class:`RetardationPowerLaw`), "relaxation-power-law", "sls",
        "fractional-zener", "prony"; "fractional-maxwell" or "fractional-kelvin-voigt", which have
        no plateau, so contacts cannot be simulated on them; or "best": all except these two are
        fitted, and of those within 2 of the smallest corrected Akaike criterion the one with the
        fewest constants is chosen.
    arms : int, optional
        Number of relaxation times of a Prony series, on a logarithmic grid; up to 12 times are
        optimised. By default the criterion chooses. Arms of zero modulus are dropped. A caution
        states the accuracy lost by few arms.
    known : mapping, optional
        Constants that are not fitted, in SI, such as ``{"glassy_modulus": 3e9}`` for a plateau
        known from elsewhere. For all models except "prony" and "best".
    loss : bool
        Whether to fit the loss modulus; False if it contradicts the storage modulus.
    level : float
        Confidence level of the intervals and the band.
    draws : int
        Number of solids to sample from the uncertainty; 0: none, and no intervals of a Prony
        series.
    seed : int
        Seed of the random numbers; the same seed gives the same report.

    Returns
    -------
    FitReport
        Material, intervals, residuals, and cautions.

    Raises
    ------
    ValueError
        If the data are unsuitable, a model or constant is unknown, or options contradict each
        other.

    Notes
    -----
    Intervals assume that the model is right. They account for noise that grows towards one end, for
    errors common to a sweep and for instrument drift; correlated errors widen them. Intervals of
    a Prony series are given for its plateaus only, over all series on a dense grid of times,
    because its single arms are not determined.

    Examples
    --------
    Fitting the rounded moduli of a standard solid recovers its constants:

    >>> import numpy as np
    >>> from viscotack.lab.sweeps import MasterCurve
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> omega = np.geomspace(0.1, 1e4, 16)
    >>> modulus = solid.complex_modulus(omega)
    >>> storage, loss = np.round(modulus.real, -3), np.round(modulus.imag, -3)
    >>> report = fit(MasterCurve(293.15, omega, storage, loss, "E"), poisson_ratio=0.5, model="sls")
    >>> f"{report.material.tau0:.3f} s, {report.material.glassy_modulus / 1e6:.2f} MPa"
    '0.100 s, 10.00 MPa'
    """
    if model not in (*MODELS, "best"):
        raise InputError(f"model must be one of {', '.join(MODELS)} or best, got {model!r}")
    if not 0 < level < 1:
        raise InputError(f"level must lie between 0 and 1, got {level}")
    if arms is not None and model != "prony":
        raise InputError(f"arms apply to the model prony only, got model {model}")
    if known and model in ("prony", "best"):
        raise InputError(f"known constants apply to {', '.join(KINDS)} only, got model {model}")
    seen = observed(data, poisson_ratio=poisson_ratio)
    if not loss:
        seen = only(seen, "storage")
    with one_blas_thread():
        seen = with_noise(thinned(seen))
        tried = [_tried(seen, each) for each in _affordable(seen)] if model == "best" else []
        alike = _alike(tried)
        if alike:
            model = alike[0].model
        cautions: tuple[str, ...] = ()
        more = {"level": level, "draws": draws, "seed": seed}
        if model == "prony":
            found = fit_series(seen, arms=arms, **more)
            if arms is not None:
                cautions = few_arms_caution(seen, found)
            if draws:
                # a misfit of few arms is no contradiction of the moduli
                cautions += series_cautions(seen, found, few=bool(cautions))
        else:
            found = fit_constants(seen, model=model, known=known or {}, **more)
        if tried:
            found = replace(found, compared=tuple((one.model, one.criterion) for one in tried))
        cautions = (*misfit_cautions(seen, found.material, found.scatter), *cautions)
        unknown = undetermined(seen, found.material, found.intervals)
        return FitReport(
            **vars(found),
            model=model,
            observed=seen,
            level=level,
            undetermined=(*unknown, *_undecided(alike)),
            cautions=(*cautions, *seen.source.notes[-1:]) if seen.points else cautions,
        )


class Tried(NamedTuple):
    """A model fitted without intervals: its solid, criterion and number of constants."""

    model: str
    material: Any
    criterion: float
    constants: int


def _alike(tried: Sequence[Tried]) -> list[Tried]:
    """Return the models that the data do not distinguish from the best, the simplest first."""
    least = min((one.criterion for one in tried), default=0.0)
    alike = [one for one in tried if one.criterion <= least + ALIKE]
    return sorted(alike, key=lambda one: (one.constants, one.criterion))


def _undecided(alike: Sequence[Tried]) -> tuple[str, ...]:
    """Return a sentence on the models that the data do not distinguish, with their plateaus."""
    if len(alike) < 2:
        return ()
    least = min(one.criterion for one in alike)
    each = [
        f"{one.model} ({one.constants} constants, criterion {one.criterion - least:+.1f}; "
        f"rubbery {readable(one.material.rubbery_modulus, 'Pa', digits=3)}, glassy "
        f"{readable(one.material.glassy_modulus, 'Pa', digits=3)})"
        for one in alike
    ]
    return (
        f"the data do not distinguish {' from '.join(each)}; the one with the fewest constants is "
        "used (--model fits another)",
    )


def _affordable(data: Observed) -> list[str]:
    """Return the models with fewer constants than numbers."""
    constants = {model: 3 if model in ("sls", "prony") else 4 for model in SOLIDS}
    found = [model for model in SOLIDS if data.values.size > constants[model] + 3]
    if not found:
        raise InputError(
            f"{data.values.size} numbers are too few to compare models; name the one to fit"
        )
    return found


def _tried(data: Observed, model: str) -> Tried:
    """Fit a model without intervals."""
    if model == "prony":
        found = fit_series(data)
        return Tried(model, found.material, found.criterion, found.constants)
    material, constants = fitted_constants(data, model=model, known={})
    criterion = information_criterion(data.weighed(data.residuals(material)), constants)
    return Tried(model, material, criterion, constants)
