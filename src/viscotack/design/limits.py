r"""What bounds the forces of a design: the solid at the ends of its spectrum, and the speeds.

The pull-off force of a sphere lies between those of the relaxed and of the instantaneous solid
(:mod:`viscotack.theory.sphere.bounds`). For N pads

.. math:: \frac32 \pi R \Delta\gamma N f(\mu) \le P \le
          \frac32 \pi R \Delta\gamma N \frac{f(\mu k^{1/3})}{k},

with the elastic f from 1 (JKR) to 4/3 (rigid), and so their ratio is at most 1/k times that of both
f. The bounds are those of simulations at all rates, not a proof.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product
from math import inf

import numpy as np

from viscotack.errors import InputError
from viscotack.prediction.closed_forms import lennard_jones_alike
from viscotack.theory.elastic.lennard_jones import pull_off_ratio
from viscotack.units import readable

from .fast import FastTier, Pad
from .space import DesignSpace, Targets

# Number of radii at which bounds are computed.
_RADII = 33
# Preload of a pad of which only the groups are needed [N].
_LIGHT = 1e-12


@dataclass(frozen=True)
class Limit:
    """The most or least that designs reach of one target.

    Attributes
    ----------
    target : str
        "hold", "release", "ratio", "work" or "dead_load".
    wanted, reach : float
        The target, and the largest force, ratio or work, or the smallest force to release [N, 1
        or J].
    cause : str
        "solid" for the relaxed and instantaneous solid, "speeds" for the best design between the
        bounds, by the fast tier.
    why : str
        The bound with its numbers.
    """

    target: str
    wanted: float
    reach: float
    cause: str
    why: str

    @property
    def excludes(self) -> bool:
        """Whether the target is out of reach."""
        return self.wanted < self.reach if self.target == "release" else self.wanted > self.reach

    @property
    def words(self) -> str:
        """The bound as a sentence, where it excludes the target."""
        unit = {"ratio": "1", "work": "J"}.get(self.target, "N")
        least, most = (
            ("at most", "at least") if self.target == "release" else ("at least", "at most")
        )
        cause = {"solid": "the solid permits", "speeds": "designs between the bounds reach"}
        return (
            f"out of reach: {self.target.replace('_', ' ')} of {least} "
            f"{readable(self.wanted, unit)}; {cause[self.cause]} {most} "
            f"{readable(self.reach, unit)}: {self.why}"
        )


def wanted(targets: Targets) -> dict[str, float]:
    """Return the targets with the ratio that hold and release imply."""
    return replace(targets, ratio=targets.least_ratio, preload=None).stated


def solid_limits(fast: FastTier, space: DesignSpace, targets: Targets) -> tuple[Limit, ...]:
    """Return the bounds by the relaxed and the instantaneous solid, the widest of all materials.

    They are those of spheres on a half-space; of works, layers and other tips none is known.
    """
    if space.thickness is not None or space.exponent is not None:
        return ()
    each = [_of_material(name, fast, space) for name in fast.materials]
    found = []
    for target, value in wanted(targets).items():
        if target == "work":
            continue
        select = min if target == "release" else max
        reach, why = select((one[target] for one in each), key=lambda pair: pair[0])
        found.append(Limit(target, value, reach, "solid", why))
    return tuple(found)


def _of_material(name: str, fast: FastTier, space: DesignSpace) -> Mapping[str, tuple[float, str]]:
    """Return the bound of each target and its words, for one material."""
    most, least, ratio = (-inf, ""), (inf, ""), (-inf, "")
    moduli = [None] if space.modulus is None else [space.modulus.low, space.modulus.top]
    radii = np.geomspace(space.radius.low, space.radius.top, _RADII).tolist()
    for R, modulus in product(radii, moduli):
        room = space.most_pads(R)
        if not room:
            continue
        try:
            problem = fast.problem(Pad(name, R, _LIGHT, 1.0, modulus))
        except InputError:  # the sphere is too small for the range of attraction
            continue
        groups = lennard_jones_alike(problem.groups())
        k, unit = groups.modulus_ratio, problem.scales().force
        slow, fast_one = (float(pull_off_ratio(groups.tabor * x)) for x in (1.0, k ** (1 / 3)))
        words = f"{readable(unit, 'N', digits=3)} (1.5 pi R dg, R = {readable(R, 'm', digits=3)})"
        few, many = int(space.pads.low), room
        most = max(
            most,
            (
                many * unit * fast_one / k,
                f"{many} times {words} times {fast_one / k:.4g} (f/k) of the instantaneous solid",
            ),
        )
        least = min(
            least,
            (few * unit * slow, f"{few} times {words} times {slow:.3g} (f) of the relaxed solid"),
        )
        ratio = max(
            ratio,
            (
                fast_one / slow / k,
                f"instantaneous over relaxed modulus (1/k = {1 / k:.4g}), times "
                f"{fast_one / slow:.3g} for the range of attraction",
            ),
        )
    return {"hold": most, "release": least, "ratio": ratio, "dead_load": most}
