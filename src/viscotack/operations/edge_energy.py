"""The operation ``edge-energy``: energy at the edge of a simulated contact against its speed."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np

from .declare.answer import Answer, Caller, picture
from .declare.cards import File
from .declare.options import Operation
from .simulate import saved

# Rows of the printed table.
_ROWS = 8


@dataclass(frozen=True, kw_only=True)
class EdgeEnergy(Operation):
    """Evaluate the energy at the contact edge against its speed, from a simulated pull-off.

    The result must be the retraction of a sphere from a relaxed contact. Fits the relation of Gent
    and Schultz to the energies, separates the contributions of bulk and interface, and gives the
    slope of the surface at the edge.

    Example: viscotack simulate sphere lens.toml --save lens.npz, then viscotack edge-energy
    lens.npz --plot edge.png
    """

    word: ClassVar = "edge-energy"
    outputs: ClassVar = (picture(),)
    takes_own: ClassVar = True

    file: Annotated[Path, File("A result that --save wrote.", metavar="FILE.npz", argument=True)]

    def answer(self, caller: Caller) -> Answer:
        """Load the result and evaluate its edge."""
        from viscotack.pictures.edge_energy import draw_edge_energy
        from viscotack.result.edge_energy import edge_energy

        result = saved(self.file, caller)
        found = edge_energy(result)
        unit = "m/s" if result.scales is not None else "(R^2 dg/E0*)^(1/3) per time unit"
        return Answer(
            found,
            record=lambda: _record(found, unit),
            words=lambda: _words(found, unit),
            pictures={"plot": lambda: draw_edge_energy(found, unit)},
        )


def _record(found: Any, unit: str) -> dict[str, Any]:
    return {
        "speed": found.speed.tolist(),
        "amplification": found.amplification.tolist(),
        "bulk": found.bulk.tolist(),
        "interface": found.interface.tolist(),
        "unit_of_speed": unit,
        "reference_speed": found.reference_speed,
        "exponent": found.exponent,
        "strain": found.strain,
        "words": list(found.words),
    }


def _words(found: Any, unit: str) -> str:
    """Format the answer as text: some rows, evenly spaced in the logarithm of the speed."""
    speed = found.speed
    wanted = np.geomspace(speed.min(), speed.max(), _ROWS)
    near = {int(np.argmin(np.abs(np.log(speed / v)))) for v in wanted}
    rows = sorted(near, key=lambda i: speed[i])
    columns = ("speed", "amplification", "bulk", "interface")
    lines = [f"speed of the edge in {unit}, energies in works of adhesion"]
    lines += ["  ".join(f"{name:>13}" for name in columns)]
    lines += ["  ".join(f"{getattr(found, name)[i]:>13.4g}" for name in columns) for i in rows]
    v0, n = found.reference_speed, found.exponent
    lines.append(f"Gent and Schultz: 1 + (v/v0)^n with v0 {v0:.4g} and n {n:.3f}")
    return "\n".join([*lines, *found.words])
