"""Numerical settings of a simulation, derived from the requested accuracy."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace

import numpy as np

from viscotack.cards import card_of
from viscotack.model.geometry import Body, Layer
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY, Accuracy
from viscotack.model.traction import Traction, softening
from viscotack.simulate.mesh import EndedGrading, Grading
from viscotack.simulate.surface import resolved

# With fewer nodes over the length in which the gap opens, a slow edge is caught by the nodes.
_FEWEST_NODES = 2.5
# Numbers of nodes are stated for laws whose tension falls no more steeply than this.
_SOFTENING = 1.2
# A law with a step is averaged over panels (:mod:`.surface`). This factor of mesh refinement
# keeps the nodes from pinning the edge. Number of zones that stay fine, as the law is zero past its
# step.
_FINEST, _STEP_ZONES = 8.0, 2.0
# Lengths of the relaxed crack's zone that stay fine around the first edge, for what remembers.
_SCAR_ZONES = 2.0
# A bonded layer with a foundation compliance below this is sheared sideways rather than compressed.
# Its nodes must resolve the thickness in the whole contact, by default three nodes per thickness.
_INCOMPRESSIBLE, _SQUEEZED = 0.2, 1.5


@dataclass(frozen=True)
class Settings:
    """Mesh, steps and modes of a simulation; dimensionless numbers for experts.

    All parts are second order, halving every length divides the error by four, but for the nodes
    around the edge, which are of third order.

    Attributes
    ----------
    accuracy : float
        Relative error of the pull-off force that the rest is made for; no error estimate falls far
        below.
    nodes_per_zone : float
        Nodes over the length in which the gap opens at the edge.
    fine_zones : float
        The nodes are finest within this many such lengths of the edge.
    growth_inside, growth_outside : float
        Relative growth of the node distance from there to the centre and outwards.
    reach : float
        Rigid gap at the last node [range of the law]; the tail beyond is added in closed form.
    step_error : float
        Largest error of a linear load in a step, as displacement [range of the law].
    force_change : float
        Largest change of the force in a step, relative to its size + 1.5 pi R dg0.
    travel, first_travel : float
        Largest and first travel of the drive in a step [mu h0 + range of the law].
    imbalance : float
        Energy that may go missing in a step, relative to the largest term of the books.
    mode_tolerance : float
        Error of the compliance that the retardation modes may have, relative.
    most_steps : int
        Largest number of steps of a run.

    Notes
    -----
    Change `accuracy` first, which refines all parts together; it is the argument of
    :func:`viscotack.solve`. Change a single part with ``dataclasses.replace`` to see its share in
    an error, or raise `most_steps` for a long protocol that stops for want of steps.

    Examples
    --------
    The default:

    >>> for name, value in vars(Settings.for_accuracy(2e-3)).items():
    ...     print(f"{name} {value:g}")
    accuracy 0.002
    nodes_per_zone 4.8
    fine_zones 5
    growth_inside 0.065
    growth_outside 0.08
    reach 100
    step_error 0.0015
    force_change 0.05
    travel 0.05
    first_travel 0.0002
    imbalance 3e-05
    mode_tolerance 0.0001
    most_steps 200000
    """

    accuracy: float
    nodes_per_zone: float
    fine_zones: float
    growth_inside: float
    growth_outside: float
    reach: float
    step_error: float
    force_change: float
    travel: float
    first_travel: float
    imbalance: float
    mode_tolerance: float
    most_steps: int = 200_000

    @classmethod
    def for_accuracy(cls, accuracy: float) -> Settings:
        """Return the settings that keep the pull-off force within this relative error.

        Raises
        ------
        InputError
            If the accuracy is outside 1e-6 to 0.02.
        """
        accuracy = card_of(Accuracy).checked("accuracy", accuracy)
        scaled = _DEFAULT._scaled(float(np.sqrt(accuracy / DEFAULT_ACCURACY)))
        return replace(scaled, accuracy=accuracy, mode_tolerance=0.05 * accuracy)

    @property
    def coarseness(self) -> float:
        """Return the length of steps over that at the default accuracy."""
        return float(np.sqrt(self.accuracy / DEFAULT_ACCURACY))

    def grading(
        self, zone: float, law: Traction, outer_radius: float, *, more: float = 1.0
    ) -> Grading:
        """Return the grading of the nodes around a crack whose gap opens over a zone.

        A law that falls more steeply than most has nodes so much finer; `more` multiplies their
        number where the geometry asks for it.
        """
        steeper = min(max(1.0, softening(law) / _SOFTENING), _FINEST)
        spacing = zone / (self.nodes_per_zone * steeper * more)
        return Grading(
            spacing=spacing,
            half_width=zone * (self.fine_zones if resolved(law) else _STEP_ZONES),
            scar_spacing=spacing,
            scar_half_width=zone * _SCAR_ZONES,
            growth_inside=self.growth_inside,
            growth_outside=self.growth_outside,
            outer_radius=outer_radius,
        )

    def grading_to_end(self, zone: float, law: Traction, size: float, body: Body) -> EndedGrading:
        """Return the grading for a crack from the end of an indenter of this size on a body."""
        crack = self.grading(zone, law, size)
        # nodes lie on a lattice that begins at the end, and no scar beyond the middle
        spacing = min(crack.spacing, size / 8)
        finest = asdict(crack) | {"spacing": spacing, "scar_spacing": spacing}
        finest |= {"scar_half_width": min(crack.scar_half_width, size)}
        return EndedGrading(**finest, coarsest=self.widest(body))

    def widest(self, body: Body) -> float:
        """Return the largest distance of nodes in a contact with a body, in its unit of length."""
        if isinstance(body, Layer) and body.base.foundation < _INCOMPRESSIBLE:
            return _SQUEEZED * body.thickness / self.nodes_per_zone
        return np.inf

    def coarser(self, factor: float) -> Settings:
        """Return the settings whose errors, being of second order, are larger by this factor."""
        return replace(
            self._scaled(float(np.sqrt(factor))),
            accuracy=self.accuracy * factor,
            mode_tolerance=self.mode_tolerance * factor,
        )

    def _scaled(self, s: float) -> Settings:
        """Return the settings with steps and growths longer by a factor."""
        return replace(
            self,
            nodes_per_zone=max(self.nodes_per_zone / np.sqrt(s), _FEWEST_NODES),
            growth_inside=self.growth_inside * s,
            growth_outside=self.growth_outside * s,
            reach=self.reach / s,
            step_error=self.step_error * s * s,
            force_change=self.force_change * s,
            travel=self.travel * s,
            first_travel=self.first_travel * s,
            imbalance=self.imbalance * s * s,
        )


_DEFAULT = Settings(
    accuracy=DEFAULT_ACCURACY,
    nodes_per_zone=4.8,
    fine_zones=5,
    growth_inside=0.065,
    growth_outside=0.08,
    reach=100,
    step_error=1.5e-3,
    force_change=0.05,
    travel=0.05,
    first_travel=2e-4,
    imbalance=3e-5,
    mode_tolerance=0.05 * DEFAULT_ACCURACY,
)
