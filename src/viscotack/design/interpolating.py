"""Forces between the pads that theories predicted: radial basis functions of logarithms.

A theory takes about 0.1 s, too long for every design of a search. The interpolation suggests
designs, and the theory then predicts each of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RBFInterpolator

from viscotack.arrays import Array

from .fast import FastTier, Force, Pad
from .space import OF_PADS

# Numbers of a pad.
_NUMBERS = 3 + len(OF_PADS)
# Pads more than variables that an interpolation needs.
_MORE = 2


@dataclass(frozen=True, eq=False)
class Interpolation:
    """Forces of pads of one material by interpolation.

    Attributes
    ----------
    pads : ndarray, shape (n, 7)
        ln of radius, preload, speed and of what else a pad has, of the known pads.
    reasons : tuple of (str or None)
        Reason why a theory does not predict a pad; such pads refuse those nearest to them.
    spans : ndarray, shape (7,)
        Ranges of the logarithms, 1 for those that do not vary.
    logarithms : callable
        Returns ln of force and of the ends of its interval over the radius.
    method : str
        Name of the tier.
    fast : FastTier
        The theories, which give held loads fast enough.
    """

    pads: Array
    reasons: tuple[str | None, ...]
    spans: Array
    logarithms: Callable[[Array], Array]
    method: str
    fast: FastTier

    def held(self, pad: Pad, time: float) -> Force | str:
        """Return the dead load that a pad holds for a time [s], or a reason."""
        return self.fast.held(pad, time)

    def force(self, pad: Pad) -> Force | str:
        """Return the interpolated force of a pad, or the reason of the nearest known pad."""
        at = _logarithms(pad)
        nearest = int(np.argmin(np.sum(((self.pads - at) / self.spans) ** 2, axis=1)))
        if (reason := self.reasons[nearest]) is not None:
            return reason
        value, low, high = (pad.radius * np.exp(self.logarithms(at[None])[0])).tolist()
        return Force(value, low, high, self.method)


def interpolation(fast: FastTier, material: str) -> Interpolation | None:
    """Return the interpolation between the known pads of a material; None for too few of them."""
    known = {pad: force for pad, force in fast.known.items() if pad.material == material}
    answered = {
        pad: force for pad, force in known.items() if not isinstance(force, str) and force.low > 0
    }
    pads = np.array([_logarithms(pad) for pad in known]).reshape(-1, _NUMBERS)
    spans = np.ptp(pads, axis=0) if len(pads) else np.zeros(_NUMBERS)
    varied = spans > 0
    if len(answered) < np.count_nonzero(varied) + _MORE:
        return None
    spans = np.where(varied, spans, 1.0)
    at = np.array([_logarithms(pad) for pad in answered])
    forces = np.array(
        [[f.value / p.radius, f.low / p.radius, f.high / p.radius] for p, f in answered.items()]
    )
    # cubic functions with linear terms
    fitted = RBFInterpolator((at / spans)[:, varied], np.log(forces), kernel="cubic", degree=1)
    return Interpolation(
        pads,
        tuple(None if pad in answered else str(force) for pad, force in known.items()),
        spans,
        lambda x: fitted((x / spans)[:, varied]),
        next(iter(answered.values())).method,
        fast,
    )


def _logarithms(pad: Pad) -> Array:
    more = [getattr(pad, name) or 1.0 for name in OF_PADS]
    return np.log([pad.radius, pad.preload, pad.speed, *more])
