"""A contact behind a drive whose motion is decided while it goes, for closed loops."""

from __future__ import annotations

from dataclasses import replace
from math import isinf

import numpy as np

from viscotack.bem.ageing import finer
from viscotack.bem.body import Body
from viscotack.bem.books import SMALLEST_ENERGY, History, Snapshot
from viscotack.bem.machine import Leg
from viscotack.bem.march import advanced, first_place
from viscotack.bem.place import Run
from viscotack.bem.settings import Settings
from viscotack.bem.solver import contact_of, modes_of_run, relaxed_start
from viscotack.errors import InputError
from viscotack.problem import Groups
from viscotack.traction import has_rest


class LiveContact:
    """A contact at its relaxed start, moved by a drive in pieces of constant speed.

    All is dimensionless, as in a result. The equations and steps are those of a history
    (:mod:`.march`), but the next piece of it may depend on what the last one did.

    Parameters
    ----------
    groups : Groups
        The contact and its relaxed start; rate, moves and stiffness are not used.
    stiffness : float
        Of the spring between drive and indenter; infinite for a rigid machine.
    fastest : float
        Largest speed of the drive that will be asked for.
    period : float
        Duration of the shortest piece.
    longest : float
        Time that all pieces take at most, for the range of the relaxation modes.
    settings : Settings
        Mesh, steps and modes.
    """

    def __init__(
        self,
        groups: Groups,
        stiffness: float,
        *,
        fastest: float,
        period: float,
        longest: float,
        settings: Settings,
    ) -> None:
        contact = contact_of(groups)
        start = relaxed_start(groups, contact, settings)
        first = settings.first_travel * contact.travel / fastest
        self._leg = Leg(stiffness, 0.0, duration=period, least_step=min(first, period))
        modes = modes_of_run(groups.material, (self._leg,), longest, settings)
        grading = contact.grading(finer(settings, groups.traction, longest), start.depth)
        if not modes.weights:
            grading = replace(grading, scar_half_width=0.0)
        law = groups.traction if has_rest(groups.traction) else None
        body = Body(contact, modes, np.asarray(modes.weights), law)
        spring = None if isinf(stiffness) else stiffness
        history = History(SMALLEST_ENERGY * contact.span, spring)
        self._run = Run(body, settings, (self._leg,), False, history)
        self._at = first_place(self._run, start, grading)
        self._run.keep(self._at)

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
        """Move the drive at a speed for a while, and return what is seen then.

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
