"""Forces between the pads that theories predicted: radial basis functions of logarithms.

A theory takes about 0.1 s, too long for every design of a search. The interpolation suggests
designs, and the theory then predicts each of them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import RBFInterpolator

from viscotack.arrays import Array

from .fast import FastTier, Force, Pad
from .space import OF_PADS

# Numbers of a pad.
_NUMBERS = 3 + len(OF_PADS)
# Pads more than variables that an interpolation needs.
_MORE = 2


def interpolated(fast: FastTier, material: str) -> FastTier | None:
    """Return a tier that interpolates between the known pads of a material; None for too few."""
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
    places = np.array([_logarithms(pad) for pad in answered])
    forces = np.array(
        [[f.value / p.radius, f.low / p.radius, f.high / p.radius] for p, f in answered.items()]
    )
    # cubic functions with linear terms
    fitted = RBFInterpolator((places / spans)[:, varied], np.log(forces), kernel="cubic", degree=1)
    # pads that a theory does not predict refuse those nearest to them
    reasons = [None if pad in answered else str(force) for pad, force in known.items()]
    method = next(iter(answered.values())).method

    def force(pad: Pad) -> Force | str:
        at = _logarithms(pad)
        reason = reasons[int(np.argmin(np.sum(((pads - at) / spans) ** 2, axis=1)))]
        if reason is not None:
            return reason
        logarithms = fitted((at[None] / spans)[:, varied])[0]
        value, low, high = (pad.radius * np.exp(logarithms)).tolist()
        return Force(value, low, high, method)

    # loads that are held come from theories that are fast
    return replace(fast, between=force)


def _logarithms(pad: Pad) -> Array:
    more = [getattr(pad, name) or 1.0 for name in OF_PADS]
    return np.log([pad.radius, pad.preload, pad.speed, *more])
