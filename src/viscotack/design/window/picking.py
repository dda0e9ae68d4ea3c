r"""Map of speed and preload: where a stamp picks an object from a donor and prints it.

At a donor the stamp picks if the contact of donor and object opens; on a receiver it prints if the
contact of stamp and object opens. A critical speed is where the contact that opens changes, at one
preload. Its band is the range over which steady cracks do not decide.

**Probability that a contact of two in series opens, if works and preload scatter.** Works of
adhesion and the preload are log-normal with relative standard deviations. With the logarithms x of
the work of the first contact, y of that of the second and p of the preload, relative to their
means, the first contact opens below a critical work :math:`x < c(y, p)`. To first order :math:`c =
c_0 + \alpha y + \beta p`, so

.. math:: P = \Phi\!\left(\frac{c_0}{\sqrt{\sigma_1^2 + \alpha^2 \sigma_2^2 +
          \beta^2 \sigma_p^2}}\right).

The critical work comes from bisection with steady cracks in series. Two elastic spheres of equal
range open by their pull-off forces, which are proportional to the works, so there
:math:`\alpha = 1` and :math:`\beta = 0`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from math import exp, inf, isfinite, isinf, isnan, log, sqrt
from statistics import NormalDist
from typing import Annotated, Any

from viscotack.cards import Quantity, conform
from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.protocol import AtForce, Retraction
from viscotack.model.traction import ages
from viscotack.simulate.in_series import CRACKS, SIMULATION, SeriesOpening, opening_by_cracks

from .simulated import simulate_in_series


def which_opens(
    first: Problem,
    second: Problem,
    *,
    simulate: bool = False,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
) -> SeriesOpening:
    """Return which of two contacts in series opens first when one machine pulls them apart.

    Parameters
    ----------
    first, second : Problem
        Both contacts of the rigid object, in SI, with equal protocols: a relaxed start at a force
        (:class:`viscotack.AtForce`), a speed of the drive, and perhaps the stiffness of the
        machine. Each has its own shape, body, material and law.
    simulate : bool
        Simulate both contacts in one march if steady cracks do not decide.
    accuracy, time_limit : float
        Of the simulation, as for :func:`viscotack.solve`.

    Returns
    -------
    SeriesOpening
        The contact that opens, or None with the reason.

    Raises
    ------
    ValueError
        If the protocols differ or are of another kind, a shape is not one of revolution, or a
        contact has no relaxed start under the common force.

    Examples
    --------
    An elastic donor against an elastic stamp: the smaller pull-off force decides.

    >>> from viscotack import AtForce, Elastic, LennardJones, Problem, Retraction, Sphere
    >>> from dataclasses import replace
    >>> donor = Problem(
    ...     material=Elastic(rubbery_modulus=2e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-7),
    ...     geometry=Sphere(radius=1e-3),
    ...     protocol=Retraction(start=AtForce(1e-4), speed=1e-5),
    ... )
    >>> stamp = replace(donor, geometry=Sphere(radius=2e-3))
    >>> found = which_opens(donor, stamp)
    >>> found.opened, f"{found.tension * 1e6:.0f} uN"
    (0, '238 uN')
    """
    check_pair(first, second)
    try:
        found = opening_by_cracks(first, second)
    except OutOfRange as reason:
        found = SeriesOpening(why=str(reason))
    if found.opened is not None or not simulate:
        return found
    try:
        result = simulate_in_series(first, second, accuracy=accuracy, time_limit=time_limit)
    except OutOfRange as reason:
        return SeriesOpening(method=SIMULATION, why=f"{found.why}; {reason}")
    opened, held = result.opened, result.held
    return SeriesOpening(
        opened,
        result.tension,
        None if isnan(held) else held,
        nominal=opened,
        corners=(opened, opened),
        method=SIMULATION,
        why=found.why
        if opened is not None
        else f"both contacts open together, or the run stopped: {result.status}",
    )


def check_pair(first: Problem, second: Problem) -> None:
    """Raise an InputError unless two problems are contacts of one object in a machine."""
    for problem in (first, second):
        if problem.geometry.symmetry != "revolution":
            raise InputError(
                f"two contacts in series need shapes of revolution, got a {problem.geometry.word} "
                "in plane strain, whose force is per length; take a disc"
            )
        test = problem.protocol
        if not isinstance(test.start, AtForce) or test.moves or test.speed is None:
            raise InputError(
                "two contacts in series start relaxed at a common force and are pulled apart at a "
                "speed, without other moves; take Retraction(start=AtForce(force), speed=speed)"
            )
    if first.protocol != second.protocol:
        raise InputError(
            "both contacts of an object need the same protocol, got "
            f"{first.protocol} and {second.protocol}"
        )


def aged(problem: Problem, dwell: float) -> Problem:
    """Return a contact with the work of adhesion that its interface has after a dwell [s].

    The law at rest is multiplied by 1 + G(t) and no longer ages, which holds for a pull much
    shorter than the dwell. An interface that does not age is returned unchanged.

    Examples
    --------
    >>> from viscotack import AtForce, Elastic, LennardJones, Retraction, Sphere
    >>> from viscotack.model.traction import SaturatingAgeing
    >>> law = SaturatingAgeing(0.05, 1e-7, reference_time=10.0, largest_growth=2.0)
    >>> rubber = Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)
    >>> contact = Problem(rubber, law, Sphere(1e-3), Retraction(AtForce(1e-3), 1e-5))
    >>> aged(contact, 1e3).traction
    LennardJones(work_of_adhesion=0.15000000000000002, equilibrium_gap=1e-07)
    """
    if not dwell >= 0:
        raise InputError(f"a dwell must not be negative, got {dwell:.4g} s")
    law: Any = problem.traction
    if not ages(law):
        return problem
    work = law.work_of_adhesion * (1 + float(law.growth_after(dwell)))
    return replace(problem, traction=replace(law.at_rest, work_of_adhesion=work))


# Tolerance of a critical work, relative, and standard deviations to which it is searched.
_CLOSE, _FAR = 2e-3, 4.0
# Part of a standard deviation by which work and preload are moved for the slopes.
_PART = 0.5
# Largest slope of the critical work that is expected, for the range of the search.
_STEEP = 1.5
_Share = Annotated[
    float, Quantity("1", "s", "relative standard deviation", least=0, most=0.5, example="0.1")
]


@dataclass(frozen=True)
class WindowScatter:
    """Relative standard deviations of the works of stamp, donor and receiver, and of the preload.

    Each lies between 0 and 0.5.
    """

    stamp: _Share = 0.0
    donor: _Share = 0.0
    receiver: _Share = 0.0
    preload: _Share = 0.0

    def __post_init__(self) -> None:
        conform(self)


@dataclass(frozen=True)
class Chance:
    """Probability, and its interval by the bands of the strengths of both contacts."""

    value: float
    low: float
    high: float


def opening_chance(
    first: Problem, second: Problem, *, works: tuple[float, float], preload: float = 0.0
) -> Chance:
    """Return the probability that the first of two contacts in series opens, by critical works.

    Parameters
    ----------
    first, second : Problem
        Both contacts, as for :func:`viscotack.which_opens`.
    works, preload : float
        Relative standard deviations of both works of adhesion and of the preload.

    Raises
    ------
    OutOfRange
        If steady cracks do not cover a contact.
    ValueError
        As for :func:`viscotack.which_opens`.
    """
    check_pair(first, second)
    reach = _FAR * sqrt(works[0] ** 2 + _STEEP**2 * works[1] ** 2 + preload**2)

    def opens(x: float, y: float, p: float) -> SeriesOpening:
        """Return what opens with factors exp(x), exp(y) on the works and exp(p) on preload."""
        return opening_by_cracks(_moved(first, x, p), _moved(second, y, p))

    def critical(y: float = 0.0, p: float = 0.0) -> float:
        """Return ln of the critical work of the first contact; infinite beyond the reach."""
        low, high = -reach, reach
        if opens(low, y, p).nominal != 0:
            return -inf
        if opens(high, y, p).nominal == 0:
            return inf
        while high - low > _CLOSE:
            half = (low + high) / 2
            low, high = (half, high) if opens(half, y, p).nominal == 0 else (low, half)
        return (low + high) / 2

    middle, center = opens(0.0, 0.0, 0.0), critical()
    if isinf(center):
        chance = float(center > 0)
        ends = (chance, chance) if middle.opened is not None else (0.0, 1.0)
        return Chance(chance, *ends)
    variance = works[0] ** 2
    for name, deviation in (("y", works[1]), ("p", preload)):
        if deviation > 0:
            step = _PART * deviation
            ends = [critical(**{name: sign * step}) for sign in (-1.0, 1.0)]
            low, high = (center if isinf(each) else each for each in ends)
            variance += ((high - low) / (2 * step) * deviation) ** 2
    band = sum(middle.bands or ())
    chances = (NormalDist().cdf((center + off) / sqrt(variance)) for off in (0.0, -band, band))
    return Chance(*chances)


def _moved(problem: Problem, work: float, preload: float) -> Problem:
    law, test = problem.traction, problem.protocol
    start = test.start
    assert isinstance(start, AtForce)
    changed: Any = law
    if work != 0:
        changed = replace(changed, work_of_adhesion=exp(work) * law.work_of_adhesion)
    force = AtForce(exp(preload) * start.force) if preload != 0 else start
    return replace(problem, traction=changed, protocol=replace(test, start=force))


STAMP, DONOR, RECEIVER = "stamp", "donor", "receiver"
PICK, PRINT, BOTH, NEITHER, UNDECIDED = "pick", "print", "pick and print", "neither", "undecided"
# Tolerance of ln of a critical speed by steady cracks, of its interval, and of one by simulation.
_RESOLUTION, _OF_INTERVAL, _SIMULATED = 5e-3, 0.03, 0.1
_MOST_CELLS = 10_000


@dataclass(frozen=True)
class Cell:
    """One speed and preload of a map.

    Attributes
    ----------
    speed, preload : float
        Speed of the drive [m/s] and common force of the relaxed start [N].
    donor, receiver : SeriesOpening or None
        Which contact opens at the donor and on the receiver, 0 being that of donor or receiver and
        1 that of the stamp; None without one.
    pick, print : Chance or None
        Probability that the stamp picks from the donor, and that it prints on the receiver; None
        without scatter, without a donor or a receiver, or if steady cracks do not cover the
        contacts.
    """

    speed: float
    preload: float
    donor: SeriesOpening | None
    receiver: SeriesOpening | None
    pick: Chance | None = None
    print: Chance | None = None

    @property
    def transfer(self) -> float | None:
        """Probability to pick and to print, of independent contacts; None if one is unknown."""
        if self.pick is None or self.print is None:
            return None
        return self.pick.value * self.print.value

    @property
    def word(self) -> str:
        """What the stamp does: pick, print, pick and print, neither or undecided."""
        known = [each for each in (self.donor, self.receiver) if each is not None]
        if any(each.opened is None for each in known):
            return UNDECIDED
        picks = self.donor is not None and self.donor.opened == 0
        prints = self.receiver is not None and self.receiver.opened == 1
        return {(1, 1): BOTH, (1, 0): PICK, (0, 1): PRINT, (0, 0): NEITHER}[picks, prints]

    @property
    def why(self) -> str:
        """Reasons for an undecided cell."""
        known = {DONOR: self.donor, RECEIVER: self.receiver}
        reasons = (f"{name}: {x.why}" for name, x in known.items() if x is not None and x.why)
        return "; ".join(reasons)


@dataclass(frozen=True)
class CriticalSpeed:
    """Speed at which another contact of the object opens, at one preload.

    Attributes
    ----------
    base : str
        "donor" or "receiver".
    preload : float
        Common force of the relaxed start [N].
    speed : float
        Critical speed [m/s].
    interval : tuple of (float or None)
        Speeds [m/s] between which steady cracks do not decide; None at an end outside the speeds of
        the map. Of simulations: two speeds, 10 % apart or less, at which they differ.
    below, above : str
        What opens at lower and at higher speeds: "donor", "receiver" or "stamp".
    method : str
        "steady cracks" or "simulation".
    """

    base: str
    preload: float
    speed: float
    interval: tuple[float | None, float | None]
    below: str
    above: str
    method: str


@dataclass(frozen=True)
class Window:
    """Map of picking and printing of a stamp, by speed and preload.

    Attributes
    ----------
    speeds, preloads : tuple of float
        Speeds of the drive [m/s] and preloads [N], ascending.
    cells : tuple of Cell
        All speeds of the first preload, then of the next.
    critical_speeds : tuple of CriticalSpeed
        By base and preload.
    """

    speeds: tuple[float, ...]
    preloads: tuple[float, ...]
    cells: tuple[Cell, ...]
    critical_speeds: tuple[CriticalSpeed, ...]


def window(
    stamp: Problem,
    *,
    donor: Problem | None = None,
    receiver: Problem | None = None,
    speeds: Sequence[float],
    preloads: Sequence[float],
    stiffness: float | None = None,
    scatter: WindowScatter | None = None,
    simulate: bool = False,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Window:
    """Return where a stamp picks an object from a donor, and where it prints it on a receiver.

    Parameters
    ----------
    stamp, donor, receiver : Problem
        Contacts of the object with the stamp, and with a donor, a receiver, or both, in SI. Their
        protocols are replaced.
    speeds, preloads : sequence of float
        Speeds of the drive [m/s] and common forces of the relaxed start [N].
    stiffness : float or None
        Of the machine [N/m]; None for a rigid one.
    scatter : WindowScatter, optional
        Scatter of works and preload, for the probabilities to pick and to print.
    simulate : bool
        Simulate the cells that steady cracks do not decide; each takes seconds.
    accuracy : float
        Of the simulations.
    time_limit : float, optional
        Longest time of one simulation [s]; its cell is then undecided.
    progress : callable, optional
        Called with the completed fraction, 0 to 1.

    Raises
    ------
    ValueError
        If there is no donor and no receiver, a speed is not positive, or a contact is not one of
        revolution.

    Examples
    --------
    >>> from viscotack import AtForce, Elastic, LennardJones, Problem, Retraction, Sphere
    >>> from viscotack import StandardSolid
    >>> law = LennardJones(work_of_adhesion=0.1, equilibrium_gap=1e-7)
    >>> stamp = Problem(
    ...     material=StandardSolid(
    ...         rubbery_modulus=1e6, glassy_modulus=10e6, tau0=1e-3, poisson_ratio=0.5
    ...     ),
    ...     traction=law,
    ...     geometry=Sphere(radius=1e-3),
    ...     protocol=Retraction(start=AtForce(1e-3), speed=1e-5),
    ... )
    >>> donor = Problem(
    ...     material=Elastic(rubbery_modulus=1e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.2, equilibrium_gap=2e-7),
    ...     geometry=Sphere(radius=1e-3),
    ...     protocol=stamp.protocol,
    ... )
    >>> found = window(stamp, donor=donor, speeds=[1e-6, 1e-3], preloads=[1e-3])
    >>> [cell.word for cell in found.cells]
    ['neither', 'pick']
    """
    bases = {DONOR: donor, RECEIVER: receiver}
    known = {name: base for name, base in bases.items() if base is not None}
    if not known:
        raise InputError("a window needs a donor, a receiver, or both beside the stamp")
    V, F = _ascending("speeds", speeds), _ascending("preloads", preloads)
    if V[0] <= 0:
        raise InputError(f"speeds must be positive, got {V[0]:g} m/s")
    if len(V) * len(F) > _MOST_CELLS:
        raise InputError(f"a map has at most {_MOST_CELLS:,} cells, got {len(V) * len(F):,}")

    def pair(base: Problem, preload: float, speed: float) -> tuple[Problem, Problem]:
        pull = Retraction(start=AtForce(preload), speed=speed, stiffness=stiffness)
        return replace(base, protocol=pull), replace(stamp, protocol=pull)

    def opening(base: Problem, preload: float, speed: float) -> SeriesOpening:
        how = {"simulate": simulate, "accuracy": accuracy, "time_limit": time_limit}
        try:
            return which_opens(*pair(base, preload, speed), **how)
        except InputError as reason:  # no relaxed contact exists
            return SeriesOpening(why=str(reason))

    def chance(name: str, preload: float, speed: float) -> Chance | None:
        if scatter is None or name not in known:
            return None
        works = getattr(scatter, name), scatter.stamp
        try:
            both = pair(known[name], preload, speed)
            return opening_chance(*both, works=works, preload=scatter.preload)
        except InputError:
            return None

    rows, criticals = [], []
    for number, preload in enumerate(F):
        found: dict[str, list[SeriesOpening]] = {}
        for name, base in known.items():
            at = partial(opening, base, preload)
            found[name] = [at(speed) for speed in V]
            criticals += _critical_speeds(at, name, preload, V, found[name])
        for i, speed in enumerate(V):
            answers = {name: each[i] for name, each in found.items()}
            pick, keep = (chance(name, preload, speed) for name in (DONOR, RECEIVER))
            prints = keep and Chance(1 - keep.value, 1 - keep.high, 1 - keep.low)
            both = answers.get(DONOR), answers.get(RECEIVER)
            rows.append(Cell(speed, preload, *both, pick, prints))
        if progress is not None:
            progress((number + 1) / len(F))
    return Window(V, F, tuple(rows), tuple(criticals))


def _ascending(name: str, values: Sequence[float]) -> tuple[float, ...]:
    numbers = tuple(sorted({float(x) for x in values}))
    if not numbers or not all(isfinite(x) for x in numbers):
        raise InputError(f"{name} must be finite numbers, at least one, got {list(values)!r}")
    return numbers


@dataclass(frozen=True)
class _Change:
    """Two speeds between which another contact opens: `below` at the lower one, then `above`."""

    low: float
    high: float
    below: int
    above: int

    @property
    def middle(self) -> float:
        return sqrt(self.low * self.high)


def _critical_speeds(
    opening: Callable[[float], SeriesOpening],
    name: str,
    preload: float,
    speeds: tuple[float, ...],
    found: list[SeriesOpening],
) -> Iterator[CriticalSpeed]:
    """Yield the critical speeds of a base at a preload."""
    words = (name, STAMP)
    nominal, *corners = (_changes(speeds, row) for row in zip(*map(_opened, found), strict=True))
    for change in nominal:
        ends = [found[speeds.index(speed)].method for speed in (change.low, change.high)]
        method = SIMULATION if SIMULATION in ends else CRACKS
        to = _SIMULATED if method == SIMULATION else _RESOLUTION
        change = _narrowed(opening, 0, change, to)
        interval: tuple[float | None, float | None] = change.low, change.high
        if method == CRACKS:
            known = []
            for k, changes in enumerate(corners, start=1):
                alike = [x for x in changes if (x.below, x.above) == (change.below, change.above)]
                # none is inside the speeds of the map
                if alike:
                    nearest = min(alike, key=lambda x: abs(log(x.middle / change.middle)))
                    known.append(_narrowed(opening, k, nearest, _OF_INTERVAL).middle)
            low, high = min(known, default=None), max(known, default=None)
            if len(known) == 1:
                low, high = (low, None) if known[0] <= change.middle else (None, high)
            interval = low, high
        below, above = words[change.below], words[change.above]
        yield CriticalSpeed(name, preload, change.middle, interval, below, above, method)


def _opened(found: SeriesOpening) -> tuple[int | None, ...]:
    """Return the contact that opens by the strengths, and in both corners of their bands."""
    return found.nominal, *found.corners


def _changes(speeds: Sequence[float], opened: Sequence[int | None]) -> list[_Change]:
    """Return the changes of the opening contact between neighbouring speeds."""
    known = [(v, each) for v, each in zip(speeds, opened, strict=True) if each is not None]
    return [_Change(v, w, a, b) for (v, a), (w, b) in pairwise(known) if a != b]


def _narrowed(
    opening: Callable[[float], SeriesOpening], which: int, change: _Change, to: float
) -> _Change:
    """Return a change between closer speeds, by bisection up to this ln of their ratio."""
    while log(change.high / change.low) > to:
        found = _opened(opening(change.middle))[which]
        if found is None:
            break
        if found == change.below:
            change = replace(change, low=change.middle)
        else:
            change = replace(change, high=change.middle)
    return change
