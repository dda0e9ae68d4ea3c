r"""What the body under the indenter must satisfy: reciprocity, a positive energy, the thick limit.

The compliance of a body, the displacement of node i under a unit force on node j for E* = 1, is
symmetric (Betti) and positive definite.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.bem.bodies.halfspace import influence, nodal_areas
from viscotack.bem.bodies.layer import layer_influence, nodal_lengths
from viscotack.geometry import HalfSpace, Layer

from . import doors
from .findings import Finding, Report, holds, report, rises, same

# What collocation may be off from its symmetric part, and hats from a point of a node.
_DISCRETE = 0.05


def check_body(body: Any) -> Report:
    """Check a body: symmetry and sign of its compliance, and its limits.

    Parameters
    ----------
    body : HalfSpace, Layer, or an object with ``compliance(nodes)``
        The last gives the displacement at node i of a unit force on node j, for E* = 1 and nodes
        that ascend from 0. A body with a ``base`` has its transfer function checked as well.

    Examples
    --------
    >>> from viscotack.geometry import HalfSpace
    >>> check_body(HalfSpace()).passed
    True
    """
    return report(body, (_compliance, _transfer, _record))


def _matrix(body: Any, nodes: npt.NDArray[np.float64]) -> Any:
    if hasattr(body, "compliance"):
        return np.asarray(body.compliance(nodes))
    if isinstance(body, HalfSpace):
        return influence(nodes) / nodal_areas(nodes)
    return layer_influence(nodes, body.thickness, body.base) / nodal_lengths(nodes)


def _compliance(body: Any) -> Iterator[Finding]:
    """Check the compliance of the body."""
    unit = body.thickness if isinstance(body, Layer) else 1.0
    nodes = unit * np.linspace(0.0, 3.0, 61)
    B = _matrix(body, nodes)
    yield holds("compliance is finite", bool(np.all(np.isfinite(B))), "numbers", "inf or nan")
    even = (B + B.T) / 2
    # the hat at the axis is half a cone, and the last is cut off
    off = float(np.max(np.abs((B - B.T)[2:-1, 2:-1])) / np.max(np.abs(even)))
    yield holds("reciprocity: compliance is symmetric", off < _DISCRETE, f"< {_DISCRETE}", off)
    least = float(np.min(np.linalg.eigvalsh(even)) / np.max(np.abs(even)))
    yield holds("energy is positive: compliance is positive definite", least > 0, "> 0", least)
    own = float(np.min(np.diag(B)))
    yield holds("a force moves its own node into the body", own > 0, "> 0", own)


def _transfer(body: Any) -> Iterator[Finding]:
    """Check the transfer function of a layer."""
    base = getattr(body, "base", None)
    if base is None:
        return
    t = np.geomspace(1e-4, 50.0, 400)
    kappa = np.asarray(base.transfer(t))
    yield same("a thick layer is a half-space: transfer tends to 1", kappa[-1], 1.0, rtol=1e-3)
    thin, factor = 2 * kappa[0] / t[0], base.foundation
    name = "a thin layer is a foundation: transfer tends to c t/2"
    yield same(name, thin, factor, rtol=1e-3, atol=1e-3)
    # a bonded incompressible layer bulges, and kappa passes 1 by little
    yield holds(
        "transfer is positive and at most 1",
        bool(np.all((kappa > 0) & (kappa < 1.2))),
        "0 to 1.2",
        (float(np.min(kappa)), float(np.max(kappa))),
    )
    yield rises("transfer rises with the thickness where the layer is thin", kappa[t < 0.5])


def _record(body: Any) -> Iterator[Finding]:
    """Check the round trip through a record."""
    if isinstance(body, HalfSpace | Layer):
        yield from doors.through_record(body)
