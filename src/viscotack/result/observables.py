"""Observables of a result, as reported by a tack test. All are dimensionless."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.model.geometry import Layer
from viscotack.model.problem.case_file import run_id, to_dict
from viscotack.model.problem.outputs import Unit
from viscotack.threads import caught_warnings

from . import Outcome, Result
from .cycles import cycle_rows, time_held
from .opening import PullOff, peaks_in, pull_off_in, tension_work
from .parts import spans

# Relative error of the work to pull-off above which it is rejected.
_MEANINGLESS = 0.5


def pull_off(result: Result) -> PullOff:
    """Return the state at the force minimum of the last retraction.

    The minimum is that of a cubic through the four steps around the lowest one (a parabola for
    three steps), so its value is of fourth and its place of third order in the step. Where the
    machine reverses, stops or holds a force, the lowest force does not count as a pull-off.
    :func:`viscotack.result.cycles.cycles` returns the pull-offs of all cycles.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    PullOff
        Force, depth, time, contact radius and crack speed.

    Raises
    ------
    InputError
        If the run failed, the surfaces were never in contact, the force is nowhere tensile, or it
        has no minimum, because it still decreases where the run ends without a jump, or was set by
        the machine.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{pull_off(result).force:.2f} at {pull_off(result).depth:.2f} h0"
    '3.98 at 4.27 h0'
    """
    if result.outcome is Outcome.STOPPED:
        raise InputError(f"the run failed and has no observables: {result.status}")
    return pull_off_in(result, spans(result)[-1])


def peaks(result: Result) -> tuple[PullOff, ...]:
    """Return the states at all peaks of the tension in the last retraction, in order of time.

    A fast retraction from a deep start may have two: one while the bulk is glassy, and one after it
    has relaxed. The largest is the pull-off. Peaks are separate if the tension between them falls
    by at least 3 % of the smaller one, and of the unit of force.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    tuple of PullOff
        Empty without tension.

    Raises
    ------
    InputError
        If the run failed, or the surfaces were never in contact.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> [f"{peak.force:.2f}" for peak in peaks(result)]
    ['3.98']
    """
    if result.outcome is Outcome.STOPPED:
        raise InputError(f"the run failed and has no observables: {result.status}")
    return peaks_in(result, spans(result)[-1])


def other_peak(result: Result) -> PullOff:
    """Return the state at the second-largest peak of the tension.

    Raises
    ------
    InputError
        If there is no pull-off, or only one peak.
    """
    found = pull_off(result)
    others = [peak for peak in peaks(result) if peak.time != found.time]
    if not others:
        raise InputError("the force has only one peak")
    return max(others, key=lambda peak: peak.force)


def other_peak_force(result: Result) -> float:
    """Return the tension at the other peak, positive [1.5 pi R Delta-gamma_0]; ValueError if none.

    For a punch it is a stress [sigma_0].
    """
    return other_peak(result).force


def depth_at_other_peak(result: Result) -> float:
    """Return the depth at the other peak [h_0], positive into the solid; ValueError if none."""
    return other_peak(result).depth


def work_to_other_peak(result: Result) -> float:
    """Return the work of the drive to the other peak, as `work_to_pull_off`; ValueError if none."""
    return work_to(result, other_peak(result))


def work_to(result: Result, peak: PullOff) -> float:
    """Return the work of the drive from zero force to a peak, in the unit of work."""
    return _given(result, tension_work(result, spans(result)[-1], peak, until=-peak.depth))


def equal_peak(result: Result) -> PullOff | None:
    """Return the other peak if it equals the pull-off within the stated error, or None."""
    error = (result.error_estimate or {}).get("force", 0.0)
    try:
        found, other = pull_off(result), other_peak(result)
    except InputError:
        return None
    return other if found.force - other.force <= error * (found.force + other.force) else None


def pull_off_force(result: Result) -> float:
    """Return the pull-off force, the positive number -min(force) [1.5 pi R Delta-gamma_0].

    For a punch it is the pull-off stress.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    float
        [1.5 pi R Delta-gamma_0], for a punch [sigma_0].

    Raises
    ------
    InputError
        If the result has no pull-off, as :func:`pull_off`.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{pull_off_force(result):.2f}"
    '3.98'
    """
    return pull_off(result).force


def depth_at_pull_off(result: Result) -> float:
    """Return the depth at the force minimum [h_0], positive into the solid.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    float
        [h_0].

    Raises
    ------
    InputError
        If the result has no pull-off, as :func:`pull_off`.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{depth_at_pull_off(result):.2f}"
    '4.27'
    """
    return pull_off(result).depth


def contact_radius_at_pull_off(result: Result) -> float:
    """Return the contact radius at the force minimum [(pi R^2 Delta-gamma_0/E_0*)^(1/3)].

    For a punch it is the half length of the contact [a_0].

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    float
        [(pi R^2 Delta-gamma_0/E_0*)^(1/3)], for a punch [a_0].

    Raises
    ------
    InputError
        If the result has no pull-off, as :func:`pull_off`.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{contact_radius_at_pull_off(result):.2f}"
    '1.47'
    """
    return pull_off(result).contact_radius


def crack_speed_at_pull_off(result: Result) -> float:
    """Return the speed of the receding edge at the force minimum, positive.

    Its unit is (R^2 Delta-gamma_0/E_0*)^(1/3) per time unit, without the pi of the radius unit; for
    a punch h_0 per time unit. If the edge of a punch vanishes within a few steps after the minimum,
    place and speed are those of a cubic of the travel as a function of the place, through its last
    four points; nan if it vanished more than a step before.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    float
        Positive while the contact shrinks.

    Raises
    ------
    InputError
        If the result has no pull-off, as :func:`pull_off`.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{crack_speed_at_pull_off(result):.1f}"
    '1.6'
    """
    factor = result.problem.outputs.of("edge_speed").factor(result.groups)
    return pull_off(result).crack_speed * factor


def work_to_pull_off(result: Result) -> float:
    """Return the work of the drive from zero force to the force minimum.

    This is the integral of -force over the decreasing depth, from the last zero crossing of the
    force in retraction, or from a start in tension, to the minimum [1.5 pi R Delta-gamma_0 h_0; for
    a punch Delta-gamma_0, per unit area]. Jumps contribute nothing. The minimum is flat, so this
    number is less certain than the pull-off force.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    float
        Positive.

    Raises
    ------
    InputError
        If there is no pull-off, or the work is not determined: the retraction begins next to the
        force minimum, so that the stated error is half of the work or more; or two peaks of the
        force are equal within its stated error, each with its own work.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{work_to_pull_off(result):.1f}"
    '16.6'
    """
    found = pull_off(result)
    work = work_to(result, found)
    if other := equal_peak(result):
        raise InputError(
            f"two peaks of the force, {found.force:.4g} and {other.force:.4g}, are equal within "
            f"its error, so the work is either {work:.4g}, to a depth of {found.depth:.4g} h0, or "
            f"{work_to(result, other):.4g}, to {other.depth:.4g} h0; request a better accuracy"
        )
    error = (result.error_estimate or {}).get("work", 0.0)
    if error > _MEANINGLESS:
        raise InputError(
            f"the error of the work to pull-off, {work:.2g}, is half of it or more, because the "
            "retraction begins near the force minimum; request a better accuracy, or "
            "start deeper"
        )
    return work


def work_of_separation(result: Result) -> float:
    """Return the work of the drive from zero force to full separation, in the unit of work.

    Like `work_to_pull_off`, but to the end of the run, plus the remaining energy of the
    interface, which the drive must still supply. It is added if the result contains the interface
    energy relative to infinity (negative at the start); otherwise the far tail is missing, about
    1.8 over the last gap in h_0 for a sphere.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    float
        Positive, in the unit of :func:`work_to_pull_off`.

    Raises
    ------
    InputError
        If the run did not end in separation.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="detached", accuracy=0.02, estimate_error=False)
    >>> f"{work_of_separation(result):.1f}"
    '37.3'
    """
    if result.outcome not in (Outcome.DETACHED, Outcome.JUMPED):
        raise InputError(
            f"the surfaces have not separated; the run ended: {result.status}; "
            "solve with until='detached'"
        )
    interface = np.zeros(1) if result.energy is None else result.energy.interface
    left = -float(interface[-1]) if interface[0] < 0 else 0.0
    found, end = pull_off(result), -float(result.depth[-1])
    return _given(result, tension_work(result, spans(result)[-1], found, until=end) + left)


def pull_off_stress(result: Result) -> float:
    """Return the pull-off stress of a punch, the largest mean tension over its area [sigma_0].

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    float
        [sigma_0], positive.

    Raises
    ------
    InputError
        If the result is not that of a punch; use the pull-off force for other indenters.

    Examples
    --------
    >>> from viscotack import AtDepth, FlatPunch, Groups, Layer, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(
    ...     tabor=None, cohesion=0.05, geometry=FlatPunch(20.0), body=Layer(3.0),
    ...     material=solid, start=AtDepth(1.0), rate=1.0,
    ... )
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{pull_off_stress(result):.3f}"
    '0.886'
    """
    result.problem.outputs.check_has("pull_off_stress")
    return pull_off(result).force


def ligament_at_pull_off(result: Result) -> float:
    """Return the fraction of the half width of a punch that is in contact at pull-off, a_c/a.

    If the whole contact opens simultaneously it is the ligament just before; nan if there never was
    one.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    float
        In [0, 1].

    Raises
    ------
    InputError
        If the result is not that of a punch, or has no pull-off, as :func:`pull_off`.

    Examples
    --------
    >>> from viscotack import AtDepth, FlatPunch, Groups, Layer, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(
    ...     tabor=None, cohesion=0.05, geometry=FlatPunch(20.0), body=Layer(3.0),
    ...     material=solid, start=AtDepth(1.0), rate=1.0,
    ... )
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{ligament_at_pull_off(result):.2f}"
    '0.84'
    """
    size, found = _punch(result).geometry.half_width, pull_off(result)
    half_length = found.contact_radius
    if np.isnan(half_length):
        before = result.contact_radius[result.time <= found.time]
        known = before[np.isfinite(before)]
        half_length = float(known[-1]) if known.size else np.nan
    return half_length / size


def effective_surface_energy(result: Result) -> float:
    r"""Return the effective surface energy from the pull-off stress of a punch [Delta-gamma_0].

    .. math:: \frac{\Delta\gamma_{eff}}{\Delta\gamma_0} = \frac{\pi}{4 \zeta}
              \hat\sigma_{po}^2 \frac{b}{a_0} \left(\frac{a}{a_c}\right)^2

    Eq. 3.30 of Maghami, PhD thesis (2025). Valid for layers thinner than :math:`b_1 = 4 \zeta
    a/\pi`; thicker layers cause a ``UserWarning``, and
    :func:`viscotack.theory.punch.curve.surface_energy` should be used.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    float
        [Delta-gamma_0].

    Raises
    ------
    InputError
        If the body is not a layer, or a bonded one with a Poisson ratio of 0.5.

    Examples
    --------
    >>> from viscotack import AtDepth, FlatPunch, Groups, Layer, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(
    ...     tabor=None, cohesion=0.05, geometry=FlatPunch(20.0), body=Layer(3.0),
    ...     material=solid, start=AtDepth(1.0), rate=1.0,
    ... )
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{effective_surface_energy(result):.2f}"
    '2.59'
    """
    from viscotack.theory.punch.curve import thin_layer_surface_energy

    groups = _punch(result)
    if not isinstance(groups.body, Layer):
        raise InputError(f"the thin-layer formula needs a layer, got a {groups.body.word}")
    # in units of sigma_0 and a_0, E_0* times Delta-gamma_0 is 2/pi
    energy = thin_layer_surface_energy(
        pull_off(result).force,
        thickness=groups.body.thickness,
        half_width=groups.geometry.half_width,
        ligament=min(ligament_at_pull_off(result), 1.0) * groups.geometry.half_width,
        contact_modulus=2 / np.pi,
        base=groups.body.base,
    )
    return float(energy)


# Names in summaries and rows of campaigns besides the observables.
_TAKEN = frozenset(
    "status outcome cycles accuracy_met error_estimate error_estimate_work error_estimate_depth "
    "energy_residual shallow_start events wall_time_s statistics problem run_id versions name "
    "tabor modulus_ratio exponent rate profile_exponent size thickness cohesion preload "
    "preload_force preload_radius steps nodes modes "
    "newton_iterations jumps travel_to_pull_off accuracy until method".split()
)


@dataclass(frozen=True)
class Observable:
    """A user-defined number of a result: ``summary(result, also=(mine,))``.

    Attributes
    ----------
    name : str
        Key in summaries and column in campaigns.
    words : str
        Description.
    measure : str
        Measured quantity: "force", "depth", "radius", "speed", "work", "time" or "1". It defines
        the unit for the geometry, and the SI unit.
    function : callable
        Computes the number from a `Result`, dimensionless in that unit; raises ValueError if
        undefined.

    Examples
    --------
    >>> def steepest(result):
    ...     return float(np.max(np.abs(np.diff(result.force))))
    >>> Observable("largest_step", "largest step of the force", "force", steepest).words
    'largest step of the force'
    """

    name: str
    words: str
    measure: str
    function: Callable[[Result], float]

    def __post_init__(self) -> None:
        taken = self.name in {*_OBSERVABLES, *_TAKEN}
        if not self.name.isidentifier() or taken or "_at_" in self.name:
            raise InputError(
                f"name must be a new one without _at_, such as 'rise_time', got {self.name!r}, "
                "which summaries and campaigns already use or reserve"
            )
        measures = ("force", "depth", "radius", "speed", "work", "time", "1")
        if self.measure not in measures:
            raise InputError(f"measure must be one of {', '.join(measures)}, got {self.measure!r}")


def summary(result: Result, also: Iterable[Observable] = ()) -> dict[str, Any]:
    """Return the observables and the statistics of a run, ready for JSON.

    Numbers are dimensionless, with the names and units of :mod:`viscotack.model.problem.outputs`;
    for a problem in SI they are repeated under names that end in the unit. Undefined numbers are
    None. All summaries of one kind of problem have the same keys, followed by those of `also`.
    `cycles` has a row per cycle of the test, see :mod:`viscotack.result.cycles`.

    Parameters
    ----------
    result : Result
        Result of a simulation.
    also : iterable of Observable
        Additional numbers.

    Returns
    -------
    dict
        Numbers, texts, lists and None.

    Raises
    ------
    InputError
        If an additional observable fails.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> f"{summary(result)['pull_off_force']:.2f}, {summary(result)['outcome']}"
    '3.98, still in contact'
    """
    kind, scales = result.problem.outputs, result.scales
    answer: dict[str, Any] = {"status": result.status, "outcome": str(result.outcome)}
    units: dict[str, Unit] = {}
    for name, output in kind.observables.items():
        answer[name], note = _number(_OBSERVABLES[name], result)
        units[name] = output.unit
        if output.noted:
            answer[f"{name}_note"] = note
    for own in also:
        units[own.name] = kind.units[own.measure]
        try:
            answer[own.name] = _number(own.function, result)[0]
        except Exception as error:
            raise InputError(
                f"the observable {own.name} failed: {type(error).__name__}: {error}"
            ) from error
    if scales is not None:
        for name, unit in units.items():
            if unit.scale:
                value, scale = answer[name], getattr(scales, unit.scale)
                answer[f"{name}_{unit.tail}"] = None if value is None else value * scale
    return answer | {
        **result.groups.inputs,
        "cycles": [] if result.outcome is Outcome.STOPPED else cycle_rows(result),
        "accuracy": result.accuracy,
        "accuracy_met": result.accuracy_met,
        "method": result.method,
        "error_estimate": _plain(result.error_estimate),
        "energy_residual": result.energy_residual,
        "shallow_start": result.shallow_start and asdict(result.shallow_start),
        "events": [_plain(vars(event)) for event in result.events],
        "wall_time_s": result.statistics.get("wall_time_s"),
        "statistics": _plain(result.statistics),
        "problem": to_dict(result.problem),
        "run_id": run_id(result.problem),
        "versions": dict(result.versions),
    }


_OBSERVABLES: dict[str, Callable[[Result], float]] = (
    {
        function.__name__: function
        for function in (
            pull_off_force,
            depth_at_pull_off,
            pull_off_stress,
            contact_radius_at_pull_off,
            ligament_at_pull_off,
            crack_speed_at_pull_off,
            effective_surface_energy,
            work_to_pull_off,
            work_of_separation,
            other_peak_force,
            depth_at_other_peak,
            work_to_other_peak,
        )
    }
    | {"other_peak_stress": other_peak_force}
    | {"time_to_detachment": time_held}
)


def number_of(name: str, result: Result) -> tuple[float | None, str | None]:
    """Return the observable of a name and its note, as in a summary; None if it is undefined."""
    return _number(_OBSERVABLES[name], result)


def _number(
    observable: Callable[[Result], float], result: Result
) -> tuple[float | None, str | None]:
    """Return an observable and its note; None if it is undefined."""
    with caught_warnings("always") as said:
        try:
            value = observable(result)
        except ValueError as error:
            return None, str(error)
    notes = [str(each.message) for each in said if issubclass(each.category, UserWarning)]
    note = "; ".join(notes) or None
    return (float(value) if np.isfinite(value) else None), note


def _punch(result: Result) -> Any:
    groups = result.groups
    if not groups.in_plane_strain:
        raise InputError(
            "this observable is defined for a punch, but the result belongs to another indenter"
        )
    return groups


def _given(result: Result, work: float) -> float:
    """Convert a work to the unit of its kind of problem."""
    return work * result.problem.outputs.energy_factor(result.groups)


def _plain(values: Mapping[str, Any] | None) -> dict[str, Any] | None:
    if values is None:
        return None
    return {k: v.item() if isinstance(v, np.generic) else v for k, v in values.items()}
