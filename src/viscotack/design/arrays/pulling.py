r"""Arrays of pads on a common backing: force, order of detachment and load sharing.

Pad i is at :math:`(x_i, y_i)` and rises by :math:`h_i` towards the counterface. The plate is
tilted and curved, so at the position z of its centre the pad would be at

.. math:: z + h_i - (x_i \cos\phi + y_i \sin\phi) \tan\alpha - \kappa r_i^2/2
          = d_i + \frac{F_i}{k} + \sum_{j \ne i} c_{ij} F_j,
          \qquad z + \frac{1}{K} \sum_i F_i = D_0 - V t,

with its depth d, the spring k of the backing under it, the interaction c through a common elastic
base, and the spring K of the machine. Each pad follows the curve F(d) of one pad that is pulled at
the speed V (:mod:`viscotack.simulate.curve_family`).

An elastic pad has no other curve. A viscoelastic pad has one for each history of its speed. With
k alone the plate moves at V, and the curve of a pad behind k is exact. The springs K and c take a
part of the travel: each pad is computed behind its share of them,

.. math:: \frac1k + \frac{n}{K} + \overline{\sum_j c_{ij}},

for n pads that touch, as if the others carried the same force. With equal pads this is exact. With
unequal ones the interval has a part of the difference to pads that move at V.

Where heights and works of adhesion scatter, the curve of one pad is computed once for a few starts
and works, and each drawn array takes its pads from it. The share of arrays that reach a force has
the interval of Wilson (1927), doi:10.1080/01621459.1927.10502953.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import cos, pi, sin, sqrt, tan
from typing import Annotated, Any

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.cards import Quantity, conform
from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.simulate.curve_family import Curve, Family, Pull, family, side_by_side

from .interacting import coupled, interactions

# Most pads of an array, and of one whose pads interact.
MOST_PADS, MOST_COUPLED = 2000, 200
# Part of the difference between shared and separate speeds that belongs to the interval, and the
# largest such part that was compared with simulations.
_OF_SHARE, _LARGEST_SHARE = 0.3, 0.1
# Pads whose drives at detachment differ by less than this fraction of the travel detach together.
_TOGETHER = 1e-9
# Tolerance of a start over the travel of a pad, and most rounds to reach the deepest one.
_TOLERANCE = 1e-12
_ROUNDS = 8
# Largest extrapolation of starts over the travel of a pad, elastic and viscoelastic.
_EXACT, _BEYOND = 1e-9, 0.02
# Levels at which a start is looked for, and most rounds in which pads at rest share the base.
_LEVELS, _SHARED = 60, 60


@dataclass(frozen=True)
class Backing:
    """What carries the pads of an array.

    Parameters
    ----------
    stiffness : float or None
        Spring of the machine behind the whole plate [N/m]; None if rigid.
    pad_stiffness : float or None
        Spring of the backing under each pad [N/m]; None if rigid.
    base_modulus : float or None
        Contact modulus E* of an elastic half-space that all pads share and through which they
        interact [Pa]; None without interaction.
    tilt, tilt_direction : float
        Angle of the plate [rad], and direction in which it rises away [rad] from x to y.
    curvature : float
        Curvature of the plate [1/m]; positive if its middle touches first.

    Examples
    --------
    >>> Backing(stiffness=2e3).pad_stiffness is None
    True
    """

    stiffness: (
        Annotated[float, Quantity("N/m", "K", "spring of the machine", above=0, example="2 kN/m")]
        | None
    ) = None
    pad_stiffness: (
        Annotated[float, Quantity("N/m", "k", "spring of a pad", above=0, example="300 N/m")] | None
    ) = None
    base_modulus: (
        Annotated[float, Quantity("Pa", "E*", "modulus of the base", above=0, example="2 MPa")]
        | None
    ) = None
    tilt: Annotated[float, Quantity("rad", "theta", "tilt", example="0.2 degree")] = 0.0
    tilt_direction: Annotated[
        float, Quantity("rad", "phi", "direction of the tilt", example="90 degree")
    ] = 0.0
    curvature: Annotated[
        float, Quantity("1/m", "kappa", "curvature of the plate", example="0.1 1/m")
    ] = 0.0

    def __post_init__(self) -> None:
        conform(self)
        if not abs(self.tilt) < pi / 18:
            raise InputError(
                f"the tilt must be below 10 degrees, got {np.degrees(self.tilt):.4g} degrees"
            )

    def rises(self, positions: Array) -> Array:
        """Return by how much pads at positions [m] are lifted towards the counterface [m]."""
        x, y = (positions - positions.mean(axis=0)).T
        along = x * cos(self.tilt_direction) + y * sin(self.tilt_direction)
        return -along * tan(self.tilt) - self.curvature * (x**2 + y**2) / 2


@dataclass(frozen=True)
class PadArray:
    """Pads of one kind on a backing.

    Parameters
    ----------
    pad : Problem
        One pad in SI; its protocol is replaced.
    positions : sequence of (float, float)
        Places of the pads [m].
    heights : sequence of float
        Heights of the pads over their mean plane [m]; equal when left out.
    works : sequence of float
        Factors on the work of adhesion of the pads; 1 when left out.
    backing : Backing
        What carries the pads; rigid, flat and parallel by default.

    Examples
    --------
    >>> from viscotack import AtForce, Elastic, LennardJones, Problem, Retraction, Sphere
    >>> pad = Problem(
    ...     material=Elastic(rubbery_modulus=2e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-8),
    ...     geometry=Sphere(radius=1e-3),
    ...     protocol=Retraction(start=AtForce(1e-4), speed=1e-5),
    ... )
    >>> array = PadArray(pad, grid(3, 4, 5e-3))
    >>> one, twelve = (
    ...     pull_array(each, speed=1e-5, preload=len(each.positions) * 1e-4)
    ...     for each in (PadArray(pad, [(0.0, 0.0)]), array)
    ... )
    >>> f"{twelve.pull_off_force / one.pull_off_force:.6f}"
    '12.000000'
    """

    pad: Problem
    positions: Sequence[tuple[float, float]]
    heights: Sequence[float] = ()
    works: Sequence[float] = ()
    backing: Backing = Backing()

    def __post_init__(self) -> None:
        count = len(self.positions)
        if not 0 < count <= MOST_PADS:
            raise InputError(f"an array has 1 to {MOST_PADS:,} pads, got {count:,}")
        if self.pad.geometry.symmetry != "revolution":
            raise InputError(
                f"the pads of an array are shapes of revolution, got a {self.pad.geometry.word} in "
                "plane strain, whose force is per length; take a disc"
            )
        if self.backing.base_modulus is not None and count > MOST_COUPLED:
            raise InputError(f"at most {MOST_COUPLED} pads may interact, got {count:,}")
        for name, usual in (("heights", 0.0), ("works", 1.0)):
            given = tuple(float(x) for x in getattr(self, name)) or (usual,) * count
            if len(given) != count or not np.all(np.isfinite(given)):
                raise InputError(f"{name} must be {count} finite numbers, one for each pad")
            object.__setattr__(self, name, given)

    @property
    def rises(self) -> Array:
        """Heights of the pads with tilt and curvature, over their mean [m]."""
        rises = np.array(self.heights) + self.backing.rises(np.array(self.positions, dtype=float))
        return rises - rises.mean()

    @property
    def are_equal(self) -> bool:
        """Whether all pads have the same height and work."""
        return bool(np.ptp(self.rises) == 0 and np.ptp(self.works) == 0)


def grid(rows: int, columns: int, spacing: float) -> tuple[tuple[float, float], ...]:
    """Return the places of pads in rows and columns at a spacing [m].

    Examples
    --------
    >>> grid(1, 2, 1e-3)
    ((0.0, 0.0), (0.001, 0.0))
    """
    return tuple((j * spacing, i * spacing) for i in range(rows) for j in range(columns))


@dataclass(frozen=True, eq=False)
class ArrayPull:
    """How an array detaches, in SI.

    Attributes
    ----------
    drive, force : ndarray
        Position of the drive relative to its start [m], not increasing, and total force [N],
        positive in compression.
    pull_off_force : float
        Largest tension [N].
    interval : tuple of float
        90 % interval of the pull-off force [N].
    work : float
        Work of the drive from the last zero of the force to the end [J].
    lost : float
        Energy lost in jumps that springs and neighbours drive [J].
    load_sharing : float
        Pull-off force over that of as many pads, each alone under the mean preload.
    released : ndarray
        Travel of the drive at which each pad has detached [m]; nan for a pad that never touched.
    order : tuple of int
        Numbers of the pads in the order in which they detach, also within a jump.
    jumps : tuple of (float, int)
        Travel of the drive [m] and number of pads, for every instant at which pads detach.
    start_force : ndarray
        Force of each pad at the start [N].
    method : str
        Tier of the curve of one pad: "steady cracks", "simulation".
    why : str
        What the interval consists of.
    """

    drive: Array
    force: Array
    pull_off_force: float
    interval: tuple[float, float]
    work: float
    lost: float
    load_sharing: float
    released: Array
    order: tuple[int, ...]
    jumps: tuple[tuple[float, int], ...]
    start_force: Array
    method: str
    why: str


def pull_array(
    array: PadArray,
    *,
    speed: float,
    preload: float,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> ArrayPull:
    """Pull an array of pads off from a relaxed start.

    Parameters
    ----------
    array : PadArray
        Pads and backing.
    speed : float
        Speed of the drive [m/s].
    preload : float
        Total force of the relaxed start [N], positive in compression.
    accuracy, time_limit : float
        Of a simulation of one pad, as for :func:`viscotack.solve`.
    progress : callable
        Called with the completed share.

    Raises
    ------
    ValueError
        If there is no relaxed start, or the pads stand too close for their interaction.
    """
    count = len(array.positions)
    pull = _pull(array, speed, accuracy, time_limit)
    pads = _family([array], pull, preload, progress)
    starts = _starts(array, pads, preload)
    touching = int(np.count_nonzero(starts >= 0))
    if touching < count and pull.shared > 0 and not pull.is_elastic:
        pull = replace(pull, shared=_shared(array, touching))
        pads = _family([array], pull, preload, progress)
    found = _pulled(array, pads, preload)
    alone = _alone(pads, preload / count)
    band, why = pads.band, f"the tier of one pad ({pads.band:.2%})"
    # every pad carries the same force if all are equal, unless more than two interact
    alike = array.are_equal and (array.backing.base_modulus is None or count <= 2)
    if pull.shared > 0 and not pull.is_elastic and not alike:
        apart = _pulled(array, _family([array], replace(pull, shared=0.0), preload), preload)
        off = abs(apart.curve.pull_off_force / found.curve.pull_off_force - 1)
        band += _OF_SHARE * off
        why += f", and pads that share the backing unequally ({_OF_SHARE * off:.2%})"
        if _OF_SHARE * off > _LARGEST_SHARE:
            raise OutOfRange(
                f"the speeds of the pads depend on how unequally they share the backing: the "
                f"pull-off force is uncertain by {_OF_SHARE * off:.0%}, and up to "
                f"{_LARGEST_SHARE:.0%} were compared with simulations; level the pads, or take a "
                "stiffer backing"
            )
    P = found.curve.pull_off_force
    travel = found.curve.start - found.curve.position
    return ArrayPull(
        drive=-travel,
        force=found.curve.force,
        pull_off_force=P,
        interval=(P * (1 - band), P * (1 + band)),
        work=found.curve.work,
        lost=found.curve.lost,
        load_sharing=P / (count * alone),
        released=found.released,
        order=found.order,
        jumps=_jumps(found.released, float(travel[-1])),
        start_force=found.start_force,
        method=pads.method,
        why=why,
    )


def _pull(array: PadArray, speed: float, accuracy: float, time_limit: float | None) -> Pull:
    """Return how one pad of an array is pulled if all pads touch."""
    shared = _shared(array, len(array.positions))
    return Pull(array.pad, speed, array.backing.pad_stiffness, shared, accuracy, time_limit)


@dataclass(frozen=True, eq=False)
class _Pulled:
    """Curve of the drive, travels and order in which pads detach, and forces at the start."""

    curve: Curve
    released: Array
    order: tuple[int, ...]
    start_force: Array


def _family(
    arrays: Sequence[PadArray],
    pull: Pull,
    preload: float,
    tell: Callable[[float], None] = lambda share: None,
) -> Family:
    """Return the curves of one pad that cover the starts of all pads of arrays."""
    first, deeper = arrays[0], 0.0
    count = len(first.positions)
    # pads among many neighbours sink less
    c = _compliances(first, 0.0)
    sunk = 0.0 if c is None else (c.sum(axis=1) - c.sum() / count) * preload / count
    rises = np.concatenate([each.rises - sunk for each in arrays])
    works = np.concatenate([each.works for each in arrays])
    for _ in range(_ROUNDS):
        pads = family(
            pull, force=preload / count, rises=rises, works=works, deeper=deeper, tell=tell
        )
        deepest = max(float(_starts(each, pads, preload).max()) for each in arrays)
        missing = deepest - pads.deepest
        if not missing > (_EXACT if pads.is_elastic else _BEYOND) * pads.span:
            return pads
        deeper += 1.2 * missing + _EXACT * pads.span
    raise InputError(
        f"a few of {count} pads would carry the preload of {preload:.4g} N; press less, or level "
        "the heights"
    )


def _starts(array: PadArray, pads: Family, preload: float) -> Array:
    """Return the positions of pads at rest under the preload [m], negative for those apart."""
    rises, works = array.rises, np.array(array.works)
    if array.are_equal and len(pads.curves[0]) == 1 and not pads.is_elastic:
        return pads.deepest + rises
    starts = _level(pads, rises, works, preload) + rises
    c = _compliances(array, pads.radius)
    if c is None:
        return starts
    for _ in range(_SHARED):
        sunk = rises - c @ pads.start_forces(starts, works)
        before, starts = starts, _level(pads, sunk, works, preload) + sunk
        if np.max(np.abs(starts - before)) < _TOLERANCE * pads.span:
            break
    return starts


def _level(pads: Family, rises: Array, works: Array, preload: float) -> float:
    """Return the position of the plate at which pads at rest carry the preload [m]."""

    def missing(levels: Array) -> Array:
        starts = (levels[:, None] + rises).ravel()
        force = pads.start_forces(starts, np.tile(works, levels.size))
        return force.reshape(levels.size, rises.size).sum(axis=1) - preload

    low, high = -float(rises.max()), pads.deepest - float(rises.min())
    while missing(np.array([high]))[0] < 0:
        high += max(high - low, pads.span)
    looked = np.linspace(high, low, _LEVELS)
    below = np.flatnonzero(missing(looked) < 0)
    if not below.size:
        raise InputError(
            f"no relaxed start of the array exists under a force of {preload:.4g} N; press harder"
        )
    # pads that touch may jump into contact, so the highest of several levels is taken
    ends = float(looked[below[0]]), float(looked[max(below[0] - 1, 0)])
    found: Any = scipy.optimize.brentq(
        lambda z: float(missing(np.array([z]))[0]), *ends, xtol=_TOLERANCE * pads.span
    )
    return float(found)


def _alone(pads: Family, force: float) -> float:
    """Return the pull-off force of one pad of the mean work under a force [N]."""
    if len(pads.curves[0]) == 1 and not pads.is_elastic:
        return pads.curve(pads.deepest).pull_off_force
    try:
        start = _level(pads, np.zeros(1), np.ones(1), force)
    except InputError:  # it carries more where it touches
        start = 0.0
    return pads.curve(min(start, pads.deepest)).pull_off_force


def _pulled(array: PadArray, pads: Family, preload: float) -> _Pulled:
    """Pull the pads with their curves."""
    rises, backing = array.rises, array.backing
    starts = _starts(array, pads, preload)
    touching = np.flatnonzero(starts >= 0).tolist()
    curves = [pads.curve(float(starts[i]), array.works[i]) for i in touching]
    heights = rises[touching]
    c = _compliances(array, pads.radius)
    if c is None:
        curves = [each.moved(-float(h)) for each, h in zip(curves, heights, strict=True)]
        plate = side_by_side(curves)
        ends = np.array([each.end for each in curves])
    else:
        plate, ends = coupled(curves, heights, c[np.ix_(touching, touching)])
    drive = plate.behind(backing.stiffness)
    released = np.full(len(array.positions), np.nan)
    # positions of the drive at which the plate has passed the ends
    soft = 0.0 if backing.stiffness is None else 1 / backing.stiffness
    least = np.minimum.accumulate(plate.position + plate.force * soft)
    place = np.searchsorted(-plate.position, -ends, side="left")
    released[touching] = drive.start - least[np.minimum(place, least.size - 1)]
    forces = np.zeros(len(array.positions))
    forces[touching] = [each.force[0] for each in curves]
    order = np.array(touching)[np.argsort(-ends, kind="stable")]
    return _Pulled(drive, released, tuple(order.tolist()), forces)


def shared_compliance(array: PadArray) -> float:
    """Return the compliance behind one of equal pads that all touch, with its own spring [m/N]."""
    own = array.backing.pad_stiffness
    return _shared(array, len(array.positions)) + (0.0 if own is None else 1 / own)


def _shared(array: PadArray, count: int) -> float:
    """Return the compliance that pads share, per force of one of some that touch [m/N]."""
    backing = array.backing
    soft = 0.0 if backing.stiffness is None else count / backing.stiffness
    c = _compliances(array, 0.0)
    return soft if c is None else soft + float(c.sum()) * count / len(c) ** 2


def _compliances(array: PadArray, radius: float) -> Array | None:
    """Return the interactions of all pads of a contact radius [m/N]; None without a base."""
    modulus = array.backing.base_modulus
    if modulus is None:
        return None
    return interactions(np.array(array.positions, dtype=float), modulus, radius=radius)


def _jumps(released: Array, travel: float) -> tuple[tuple[float, int], ...]:
    """Group pads that detach at the same travel of the drive."""
    known = np.sort(released[np.isfinite(released)])
    parts = np.split(known, np.flatnonzero(np.diff(known) > _TOGETHER * travel) + 1)
    return tuple((float(part[0]), int(part.size)) for part in parts if part.size)


# Most pads of all drawn arrays together.
_MOST_DRAWN = 500_000
# Standard deviations of the drawn numbers, which are cut beyond.
_CUT = 3.0
# Normal deviate of a 90 % interval.
_DEVIATE = 1.6449


@dataclass(frozen=True)
class Scatter:
    """Scatter of the pads of an array.

    Parameters
    ----------
    height : float
        Standard deviation of the heights [m].
    work : float
        Standard deviation of the works of adhesion over their mean.
    seed : int
        Of the random numbers, normal ones cut at three standard deviations.

    Examples
    --------
    >>> heights, works = Scatter(height=1e-6, seed=1).drawn(3)
    >>> [f"{height * 1e6:.2f} um" for height in heights]
    ['0.35 um', '0.82 um', '0.33 um']
    """

    height: Annotated[
        float, Quantity("m", "s", "standard deviation of the heights", example="1 um")
    ] = 0.0
    work: Annotated[
        float, Quantity("1", "s_w", "relative standard deviation of the works", example="0.1")
    ] = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        if not self.height >= 0 or not 0 <= self.work < 1 / _CUT:
            raise InputError(
                "the scatter of heights must not be negative and that of works must lie between 0 "
                f"and {1 / _CUT:.2f}, got {self.height:.4g} m and {self.work:.4g}"
            )

    def drawn(self, count: int, number: int = 0) -> tuple[Array, Array]:
        """Return heights [m] and factors on the works of an array; `number` counts arrays."""
        random = np.random.default_rng([self.seed, number])
        both = np.clip(random.standard_normal((2, count)), -_CUT, _CUT)
        return self.height * both[0], 1 + self.work * both[1]

    def of(self, array: PadArray, number: int = 0) -> PadArray:
        """Return an array with drawn deviations added to its heights and works."""
        heights, works = self.drawn(len(array.positions), number)
        return replace(
            array, heights=np.array(array.heights) + heights, works=np.array(array.works) * works
        )


@dataclass(frozen=True, eq=False)
class ArrayYield:
    """Share of drawn arrays that reach a force.

    Attributes
    ----------
    share : float
        Share of the arrays whose pull-off force reaches the load.
    interval : tuple of float
        Its 90 % interval, by the number of arrays.
    forces : ndarray
        Pull-off forces of the arrays, ascending [N].
    load : float
        The load [N].
    """

    share: float
    interval: tuple[float, float]
    forces: Array
    load: float


def array_yield(
    array: PadArray,
    scatter: Scatter,
    *,
    load: float,
    speed: float,
    preload: float,
    draws: int = 500,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> ArrayYield:
    """Return the share of arrays with scattered heights and works that reach a load.

    Parameters
    ----------
    array : PadArray
        The array without scatter.
    scatter : Scatter
        Scatter of heights and works, with the seed.
    load : float
        Force that an array has to reach [N], positive in tension.
    speed, preload : float
        As for :func:`viscotack.pull_array`.
    draws : int
        Number of arrays.
    accuracy, time_limit, progress
        As for :func:`viscotack.pull_array`.

    Raises
    ------
    ValueError
        If an array has no relaxed start, or as for :func:`viscotack.pull_array`.
    """
    check_draws(draws, len(array.positions))
    arrays = [scatter.of(array, number) for number in range(draws)]
    # they differ in heights and works only, so that the curves of one pad serve all of them
    pads = _family(arrays, _pull(array, speed, accuracy, time_limit), preload)
    forces = np.empty(draws)
    for number, each in enumerate(arrays):
        forces[number] = _pulled(each, pads, preload).curve.pull_off_force
        progress((number + 1) / draws)
    share = float(np.mean(forces >= load))
    return ArrayYield(share, wilson(share, draws), np.sort(forces), load)


def check_draws(draws: int, count: int) -> None:
    """Refuse more arrays of so many pads than are drawn."""
    if not 1 <= draws * count <= _MOST_DRAWN or draws < 1:
        raise InputError(
            f"draws: {draws:,} arrays of {count:,} pads; up to {_MOST_DRAWN:,} pads are drawn in "
            "all"
        )


def wilson(share: float, count: int) -> tuple[float, float]:
    """Return the 90 % interval of a share of a number of trials.

    Examples
    --------
    >>> low, high = wilson(0.9, 100)
    >>> f"{low:.3f} to {high:.3f}"
    '0.840 to 0.939'
    """
    z2 = _DEVIATE**2 / count
    middle = (share + z2 / 2) / (1 + z2)
    half = sqrt(z2 * share * (1 - share) + z2**2 / 4) / (1 + z2)
    return max(middle - half, 0.0), min(middle + half, 1.0)
