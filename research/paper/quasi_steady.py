r"""Pull-off of spheres whose edge has one speed: the derived coefficient beside a full solution.

    python -m research.paper.quasi_steady

The second code (`second_code.sphere`) solves the round contact with the memory of
an edge of a steady speed. Without changes of the speed and of the energy the derived factor is
:math:`1 + T \lambda/a`. Keeps `paper/kept/quasi_steady.json`.
"""

import json
from pathlib import Path

import numpy as np

from research.replication.second_code.compare import extrapolated
from research.replication.second_code.half_plane import Solid, cracks
from viscotack.theory import lennard_jones

from .line_tension import coefficients
from .range_factor import CUT, RADII

KEPT = Path(__file__).with_name("kept") / "quasi_steady.json"
RATIO, SPEEDS, EFFECTIVE = 0.1, (0.0, 1.0, 10.0, 100.0), (3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0)


def rows_of(speed):
    """Return a row for each effective Tabor number; the elastic contact for a speed of 0."""
    solid = Solid.standard(RATIO) if speed else Solid(1.0, ())
    energy = cracks(solid, [speed])[0].energy
    radii = [part * energy for part in RADII]
    near, far = (coefficients(solid, speed, largest=L, elements=70)[1] for L in radii)
    growth = (far - near) / np.log(radii[1] / radii[0])
    rows = []
    for effective in EFFECTIVE:
        tabor = effective * energy ** (1 / 3)
        factor = extrapolated(tabor, solid=solid, speed=speed, energy=energy) / energy
        radius = (9 * np.pi * energy / 8) ** (1 / 3)
        size = energy / (tabor**2 * radius)
        T = (near - growth * np.log(radii[0] / (CUT * tabor**2 * radius))) / energy
        rows.append(
            {
                "speed": speed,
                "energy": energy,
                "effective": effective,
                "size": size,
                "factor": factor,
                "T": T,
                "rule": float(lennard_jones.pull_off_ratio(effective)),
            }
        )
        print(rows[-1], flush=True)
    return rows


def main():
    """Compute and keep all rows."""
    rows = [
        {key: float(f"{x:.7g}") for key, x in row.items()} for v in SPEEDS for row in rows_of(v)
    ]
    KEPT.write_text(json.dumps({"rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
