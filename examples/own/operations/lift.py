"""The operation ``theory lift``: the mass that a sticky sphere lifts slowly, by JKR."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from viscotack.operations import Answer, Caller, Operation
from viscotack.operations.declare.cards import Number


@dataclass(frozen=True, kw_only=True)
class Lift(Operation):
    """Compute the mass that a sticky sphere lifts slowly (JKR).

    Example: viscotack theory lift --radius "5 mm" --work-of-adhesion "50 mJ/m^2"
    """

    word: ClassVar = "theory lift"

    radius: Annotated[float, Number("Sphere radius.", unit="m", above=0, example='"5 mm"')]
    work_of_adhesion: Annotated[float, Number("Work of adhesion.", unit="J/m^2", above=0)]
    gravity: Annotated[float, Number("Acceleration of free fall.", unit="m/s^2", above=0)] = 9.81

    def answer(self, caller: Caller) -> Answer:
        """Divide the pull-off force by the acceleration."""
        from viscotack.theory import jkr

        force = jkr.pull_off_force(radius=self.radius, work_of_adhesion=self.work_of_adhesion)
        mass = force / self.gravity
        return Answer(
            mass, record=lambda: {"mass_kg": mass}, words=lambda: f"lifts {mass * 1e3:.3g} g"
        )
