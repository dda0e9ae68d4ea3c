r"""Coefficients of the first-order correction of the steady crack in a round contact.

Notation of section 5 of the manuscript: with x = r - a and the fields multiplied by sqrt(r/a) the
round contact obeys the plane equations up to terms of order 1/a^2. The terms of order 1/a are

* the factors (1 + x/2a) of tractions and (1 - x/2a) of openings;
* the next far field, :math:`A_2 x^{3/2}`, :math:`A_2 = (13/12 + g/3) A/a`;
* the change of the speed while the zone passes, :math:`n = d \ln V/d \ln a`.

The linear system is solved on the boundary nodes of `second_code.half_plane`. The
result is :math:`\Gamma_{eff}/\Gamma - 1 = (T + g T_g + n T_n) \lambda/a`.
"""

import json
from pathlib import Path

import numpy as np

from research.replication.second_code import half_plane

KEPT = Path(__file__).with_name("kept") / "line_tension.json"
RATIOS, SPEEDS = (0.1, 0.01), tuple(10.0 ** np.arange(-1.5, 4.6, 0.5))
# Radius within which the kept coefficients are computed, over Gamma E0* h0^2/dg.
RADIUS = 32.0
# Radii of the elastic crack, in E0* h0^2/dg.
RADII = (1e2, 1e3, 1e4, 1e5)

ELEMENTS, DEGREE = 160, 14
# Relative difference of the speeds of the derivative by the speed.
_APART = 0.02
# Decades between the speeds that lead to a crack.
_STEP = 0.5


def coefficients(solid, speed, *, largest, elements=ELEMENTS):
    """Return energy, T, T_g, T_n, and the shift s of a crack [E0* h0^2/dg] within a radius."""
    edge = half_plane.boundary(elements, DEGREE, largest)
    options = dict(elements=elements, degree=DEGREE, largest=largest, step=_STEP)
    if speed == 0:
        crack = half_plane.cracks(solid, [0.0], **options)[0]
        faster = crack
    else:
        around = [speed * np.exp(-_APART / 2), speed, speed * np.exp(_APART / 2)]
        slower, crack, faster = half_plane.cracks(solid, around, **options)
    x, e, A = edge.x, crack.elastic, crack.amplitude
    n, middle = x.size, x.size // 2
    lag = half_plane.memory(x, solid.instantaneous, solid.modes, speed)
    _, stiffness = half_plane.lennard_jones(crack.gap)
    matrix = np.zeros((n + 1, n + 1))
    matrix[:n, :n] = edge.matrix + (2 * edge.weight * stiffness)[:, None] * lag
    matrix[:n, n] = edge.load
    matrix[n, :n] = lag[middle]
    # sources of order 1/a: geometry, next far field, change of the speed
    geometry = x / 2 * crack.traction - stiffness * (lag @ (x * e)) / 2
    sources = [
        np.append(-2 * edge.weight * geometry, (lag @ (x * e))[middle] / 2),
        np.append(-edge.load_next * A, 0.0),
    ]
    if speed == 0:
        sources.append(np.zeros(n + 1))
    else:
        late = np.zeros(n)
        for weight, time in solid.modes:
            one = ((weight, time),)
            before = half_plane.memory(x, 0.0, one, around[0]) @ slower.elastic
            after = half_plane.memory(x, 0.0, one, around[2]) @ faster.elastic
            changes = (after - before) / _APART * speed * time
            late += half_plane.memory(x, 0.0, ((1.0, time),), speed) @ changes
        sources.append(np.append(-2 * edge.weight * stiffness * late, -late[middle]))
    found = np.linalg.solve(matrix, np.column_stack(sources))[n]
    root = np.sqrt(np.abs(x))
    back, front = x < 0, x > 0
    moment = np.sum((edge.weight * e / (2 * root))[back])
    moment -= 2 * np.sum((edge.weight * root * crack.traction)[front])
    shift = 4 / (np.pi * A) * moment
    # about the tip of the far field, not about the origin
    geometry, far, late = found / A
    base = geometry + 13 / 12 * (far - 1.5 * shift) + shift / 2
    by_next = (far - 1.5 * shift) / 3
    return crack.energy, 2 * base, 2 * by_next, 2 * late, shift


def kept_rows():
    """Return the coefficients of standard solids over the speed, in works of adhesion Gamma."""
    rows = []
    for k in RATIOS:
        solid = half_plane.Solid.standard(k)
        for speed in SPEEDS:
            rough = half_plane.cracks(solid, [speed], elements=60, degree=12, step=_STEP)[0].energy
            energy, *parts, _ = coefficients(solid, speed, largest=RADIUS * rough, elements=70)
            T, T_g, T_n = (float(x / energy) for x in parts)
            rows.append({"k": k, "speed": speed, "energy": energy, "T": T, "T_g": T_g, "T_n": T_n})
            print(rows[-1], flush=True)
    return rows


def elastic_rows():
    """Return the coefficient of the elastic crack within radii, which grows as their logarithm."""
    solid, rows = half_plane.Solid(1.0, ()), []
    for radius in RADII:
        elements = int(18 * np.log10(radius)) + 54
        rows.append(
            {
                "radius": radius,
                "T": float(coefficients(solid, 0.0, largest=radius, elements=elements)[1]),
            }
        )
    return rows


def main():
    """Compute and keep all rows."""
    found = {"elastic": elastic_rows(), "rows": kept_rows()}
    found = {
        name: [{key: float(f"{x:.6g}") for key, x in row.items()} for row in rows]
        for name, rows in found.items()
    }
    KEPT.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
