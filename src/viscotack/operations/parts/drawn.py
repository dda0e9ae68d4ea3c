"""Curves of a rig's files as the page draws them."""

from pathlib import Path
from typing import Any

from .plain import drawn

# Points of a measured curve.
_MOST = 1500


def retraction(cycle: Any) -> dict[str, Any]:
    """Return the retraction of a cycle as it is drawn."""
    back = cycle.retraction
    every = max((back.stop - back.start) // _MOST, 1)
    return {
        "file": Path(cycle.source.path).name,
        "cycle": cycle.number,
        "depth": drawn(cycle.depth[back][::every]),
        "force": drawn(cycle.force[back][::every]),
        "pull_off_force": cycle.pull_off_force.value,
        "pull_off_force_uncertainty": cycle.pull_off_force.uncertainty,
        "pull_off_depth": cycle.pull_off_depth.value,
        "speed": cycle.speed.value,
        "speed_uncertainty": cycle.speed.uncertainty,
        "preload": cycle.preload.value,
    }
