"""Status text of a run, and plausibility checks of its results."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from viscotack.clock import TimeUp
from viscotack.errors import InputError
from viscotack.model.geometry import HalfSpace, Sphere, end
from viscotack.model.protocol import Apart
from viscotack.model.traction import Traction, has_rest
from viscotack.result import Outcome, Result
from viscotack.result.observables import pull_off_force
from viscotack.simulate.equilibrium import why
from viscotack.simulate.history import History

# Relative energy imbalance above which a run is rejected; good runs stay below 1e-3.
_LARGEST_RESIDUAL = 1e-2


# A force is unresolved if its estimated error exceeds the requested accuracy by this factor.
_UNRESOLVED = 10.0
# What a rigid sphere pulls off with at most, by Derjaguin, over what one of JKR does; whatever the
# law, an elastic one is between them.
_DERJAGUIN = 4 / 3


def judged(result: Result) -> Result:
    """Return the result, marked as stopped if its force is not reliable."""
    if result.outcome is Outcome.STOPPED:
        return result
    doubt = _unresolved(result) or _beyond_shape(result) or _out_of_bounds(result)
    if not doubt:
        return result
    return replace(result, status=f"{Outcome.STOPPED} because {doubt}; ask for a better accuracy")


def _unresolved(result: Result) -> str:
    """Return a message if the estimated error of the force is too large, otherwise ""."""
    error, asked = (result.error_estimate or {}).get("force", 0.0), result.accuracy or np.inf
    if not error > _UNRESOLVED * asked:
        return ""
    return (
        f"the pull-off force is not resolved: its error is estimated at {100 * error:.2g} %, "
        f"beside {100 * asked:.2g} % requested"
    )


def _beyond_shape(result: Result) -> str:
    """Return a message if the contact grew beyond the known profile, otherwise ""."""
    groups = result.groups
    known, largest = end(groups.geometry), float(np.nanmax(result.contact_radius, initial=0.0))
    # radii are in pi^(1/3) beta, shapes in beta
    if groups.in_plane_strain or largest * np.pi ** (1 / 3) <= known:
        return ""
    return (
        f"the contact spread to {largest:.4g} (pi R^2 dg0/E0*)^(1/3), and its profile is known to "
        f"{known / np.pi ** (1 / 3):.4g}: press less, or give rows farther out"
    )


def _out_of_bounds(result: Result) -> str:
    """Return a message if a pull-off force violates theoretical bounds, otherwise "".

    Of a sphere on a half-space that starts in a relaxed contact. An elastic one pulls off with 1 to
    4/3 of the force of JKR, unless it starts beyond the force minimum; of a viscoelastic one the
    solid may answer as stiffly as it can, and what the crack takes is that over k.
    """
    groups = result.groups
    sphere = isinstance(groups.geometry, Sphere) and isinstance(groups.body, HalfSpace)
    if not sphere or isinstance(groups.start, Apart) or groups.moves or groups.rate is None:
        return ""
    try:
        force = pull_off_force(result)
    except InputError:  # there is none
        return ""
    k = groups.material.modulus_ratio
    stated = (result.error_estimate or {}).get("force", _UNRESOLVED * (result.accuracy or 0.0))
    before_minimum = float(result.force[0]) > float(np.min(result.force))
    least = 1.0 if k == 1 and before_minimum else 0.0
    most = np.inf if has_rest(groups.traction) else _DERJAGUIN / k
    if least * (1 - stated) <= force <= most * (1 + stated):
        return ""
    return (
        f"the pull-off force, {force:.4g}, is none that theory allows, {least:g} to {most:.4g} "
        "(1.5 pi R dg0), so that the mesh does not resolve the contact"
    )


def status_of(history: History, residual: float, law: Traction) -> str:
    """Return the status text of a run, which begins with a value of `Outcome`."""
    last = history.snapshots[-1]
    if history.outcome == "time":
        return out_of_time(history.reason, f"at a depth of {last.depth:.4g} h0")
    if residual > _LARGEST_RESIDUAL:
        return (
            f"{Outcome.STOPPED} because {100 * residual:.2g} % of the energy is not accounted for; "
            "ask for a better accuracy, and mind that Tabor numbers above 10 are not tested"
        )
    if history.outcome == "shut":
        return (
            f"{Outcome.STOPPED} because beyond a depth of {last.depth:.4g} h0 "
            f"{why(law, history.pressed)}"
        )
    if history.outcome == "lost":
        return (
            f"{Outcome.STOPPED} because no equilibrium of the surface was found at a depth of "
            f"{last.depth:.4g} h0; ask for a better accuracy"
        )
    if history.outcome == "steps":
        return (
            f"{Outcome.STOPPED} because the bound of {len(history.snapshots) - 1} steps was met "
            f"at a depth of {last.depth:.4g} h0; raise accuracy or settings.most_steps"
        )
    if history.outcome == "unheld":
        return (
            f"{Outcome.STOPPED} because a force of {last.force:.4g} is to be held or lowered with "
            f"the surfaces apart, at a depth of {last.depth:.4g} h0, where nothing bears it; press "
            "the surfaces together before"
        )
    if not any(snapshot.edge > 0 for snapshot in history.snapshots):
        nearest = max(snapshot.depth for snapshot in history.snapshots)
        return f"{Outcome.NEVER}: the test went to a depth of {nearest:.4g} h0; approach further"
    if history.outcome == "pull-off":
        return f"{Outcome.IN_CONTACT} just past the pull-off, where the run was to end"
    if history.outcome == "end" and last.edge > 0:
        return f"{Outcome.IN_CONTACT} at the end of the test"
    touched = max(snapshot.time for snapshot in history.snapshots if snapshot.edge > 0)
    jumps = [event for event in history.events if event.kind == "jump out of contact"]
    out = [event for event in jumps if event.time >= touched]
    if out:
        words = f"{Outcome.JUMPED} at depth {out[-1].depth:.4g} h0 out of contact"
        if history.left:
            parts = "a part" if history.left == 1 else f"{history.left} parts"
            words += f" under a dead load, which falls on: {parts} of the test after it not made"
        return words
    return str(Outcome.DETACHED)


def out_of_time(limit: TimeUp | str, where: str) -> str:
    """Return the status text of a run that reached its time limit."""
    return f"{Outcome.STOPPED} because {limit} {where}; give more time, or ask for less accuracy"
