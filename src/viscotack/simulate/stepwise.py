"""A simulation that its caller advances piece by piece, for closed loops."""

from __future__ import annotations

from dataclasses import replace
from math import isinf

from viscotack.errors import InputError
from viscotack.simulate.history import Snapshot
from viscotack.simulate.machine import Leg
from viscotack.simulate.march import advanced
from viscotack.simulate.settings import Settings
from viscotack.simulate.two_contacts import Part, begun_run


class SteppedSimulation:
    """A contact at its relaxed start, moved by a drive in pieces of constant speed.

    All is dimensionless, as in a result. The equations and steps are those of a history
    (:mod:`.march`), but the next piece of it may depend on what the last one did.

    Parameters
    ----------
    part : Part
        The contact, with modes for the shortest step and for the time of all pieces.
    stiffness : float
        Of the spring between drive and indenter; infinite for a rigid machine.
    least_step : float
        Length of the first step.
    settings : Settings
        Mesh and steps.
    """

    def __init__(
        self, part: Part, stiffness: float, *, least_step: float, settings: Settings
    ) -> None:
        self._leg = Leg(stiffness, 0.0, least_step=least_step)
        spring = None if isinf(stiffness) else stiffness
        self._run, self._at = begun_run(part, self._leg, settings, spring)

    @property
    def now(self) -> Snapshot:
        """Time, depth, force and edge at present."""
        return self._at.seen

    @property
    def apart(self) -> bool:
        """Whether the surfaces have separated."""
        return self._run.history.outcome == "detached"

    @property
    def tension(self) -> float:
        """Largest tension of all steps so far, positive."""
        return max(-min(step.force for step in self._run.history.snapshots), 0.0)

    def move(self, speed: float, duration: float) -> Snapshot:
        """Move the drive at a speed for a time, and return the observed state.

        Parameters
        ----------
        speed : float
            Of the drive, positive into the solid [h0 per time unit].
        duration : float
            Positive [time unit].

        Raises
        ------
        ValueError
            If no equilibrium is found, or the limit on steps is reached.
        """
        leg = replace(self._leg, rate=speed, duration=duration)
        run = replace(self._run, legs=(leg,))
        self._at = advanced(run, self._at, leg)
        if (outcome := run.history.outcome) not in ("", "end", "detached"):
            raise InputError(f"the contact cannot be moved on: {outcome}")
        if outcome == "end":
            run.history.outcome = ""
        return self.now
