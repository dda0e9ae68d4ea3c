"""Forces of a design and their margins over the targets, by the fast tier."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, log

from .fast import Force, Forces, Pad
from .space import HOLD, RATIO, RELEASE, Choice, Targets


@dataclass(frozen=True)
class Candidate:
    """A design with its forces by the fast tier.

    Attributes
    ----------
    choice : Choice
        The design.
    hold, release : Force or None
        Pull-off force of all pads [N] at the two speeds, with 90 % interval; None if no target
        depends on it.
    margins : mapping of str to float
        For each target ln of the force over the target, or of the target over the force, by the
        less favourable ends of the intervals; positive if the target is met.
    best_margins : mapping of str to float
        The same by the more favourable ends.
    """

    choice: Choice
    hold: Force | None
    release: Force | None
    margins: Mapping[str, float]
    best_margins: Mapping[str, float]

    @property
    def margin(self) -> float:
        """Margin of the worst target, which the search maximises."""
        return min(self.margins.values())

    @property
    def is_possible(self) -> bool:
        """Whether the intervals leave it open that every target is met."""
        return min(self.best_margins.values()) >= 0


def pads_of(choice: Choice, targets: Targets) -> dict[str, Pad]:
    """Return one pad at the hold and at the release speed, as far as targets need them."""
    each = choice.preload / choice.pads
    speeds = {HOLD: choice.hold_speed, RELEASE: choice.release_speed}
    needed = {HOLD: targets.needs_hold, RELEASE: targets.needs_release}
    return {
        name: Pad(choice.material, choice.radius, each, speed)
        for name, speed in speeds.items()
        if needed[name] and speed is not None
    }


def judged(choice: Choice, fast: Forces, targets: Targets) -> Candidate | str:
    """Return a design with its forces and margins, or the reason why no tier predicts a force."""
    found: dict[str, Force] = {}
    for name, pad in pads_of(choice, targets).items():
        force = fast.force(pad)
        if isinstance(force, str):
            return force
        N = choice.pads
        found[name] = Force(N * force.value, N * force.low, N * force.high, force.method)
    hold, release = found.get(HOLD), found.get(RELEASE)
    low, high = (None if hold is None else (hold.low, hold.high)[i] for i in (0, 1))
    least, most = (None if release is None else (release.low, release.high)[i] for i in (0, 1))
    return Candidate(
        choice,
        hold,
        release,
        margins_of(targets, low, most),
        margins_of(targets, high, least),
    )


def margins_of(targets: Targets, hold: float | None, release: float | None) -> dict[str, float]:
    """Return the margin of each target for forces of all pads [N]."""
    over = {
        HOLD: lambda wanted: _ln(hold, wanted),
        RELEASE: lambda wanted: -_ln(release, wanted),
        RATIO: lambda wanted: _ln(hold, wanted) - _ln(release, 1.0),
    }
    return {name: over[name](wanted) for name, wanted in targets.stated.items()}


def _ln(force: float | None, over: float) -> float:
    """Return ln of a force over another number; the interval of a poor theory may reach 0."""
    assert force is not None, "checked with the space"
    return log(force / over) if force > 0 else -inf
