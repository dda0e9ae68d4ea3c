"""Error estimate of a hysteresis, from a coarser run and the energy balance.

The losses of solid, interface and jumps over a cycle are summed independently of the work at the
indenter. The difference between the two is one part of the error; the energy lost by remeshing is
another.
"""

from __future__ import annotations

import numpy as np

from viscotack.result import Outcome, Result
from viscotack.result.loops import Loop, loop_of, lost_in
from viscotack.result.parts import Span, spans

# Shares in the error: of the difference to the companion over what its errors exceed those of the
# run by; of the energy that is missing after the cycle; of what moving between meshes took; and of
# the hysteresis times the accuracy. Each alone is small by chance now and then.
_DIFFERENCE, _MISSING, _MESHES, _FLOOR = 1.5, 1.0, 0.5, 0.15


def hysteresis_errors(
    result: Result, coarse: Result, accuracy: float, coarser: float
) -> tuple[float, ...] | None:
    """Return the relative error of the hysteresis of each cycle, nan where its loop is open.

    None where no loop closed, or the companion went another way.
    """
    cycles, others = spans(result), spans(coarse)
    loops = [loop_of(result, span) for span in cycles]
    if coarse.outcome is Outcome.STOPPED or len(cycles) != len(others):
        return None
    if all(loop is Loop.OPEN for loop in loops):
        return None
    errors = []
    for span, other, loop in zip(cycles, others, loops, strict=True):
        lost = lost_in(result, span, loop)
        differs = abs(lost - lost_in(coarse, other, loop))
        error = _DIFFERENCE * differs / (coarser - 1) + _missed(result, span)
        error += _FLOOR * accuracy * abs(lost)
        errors.append(error / max(abs(lost), np.finfo(float).tiny))
    return tuple(float(error) for error in errors)


def _missed(result: Result, span: Span) -> float:
    """Return the shares of what the energies of a cycle miss, and of what the meshes took."""
    energy = result.energy
    assert energy is not None, "a simulation has its energies"
    spent = energy.elastic + energy.interface + energy.spring + energy.heat + energy.interface_heat
    missing = energy.drive - spent - energy.jumps - energy.transfer
    ends = [span.first, span.last]
    meshes = abs(float(np.diff(energy.transfer[ends])[0]))
    return _MISSING * abs(float(np.diff(missing[ends])[0])) + _MESHES * meshes
