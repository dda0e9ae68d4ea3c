r"""The range factor of the pull-off force: the rule of the package beside the derived one.

    python -m research.paper.range_factor

For each kept simulation of :mod:`.range_cases` computes the pull-off force of forces of no range,
the factor f of the package at the effective Tabor number, and the first-order factor of section 5,

.. math:: 1 + (T + g T_g + n T_n) \frac{\lambda}{a}, \quad g = \frac{d \ln \Gamma}{d \ln a}, \quad
          n = \frac{d \ln V}{d \ln a},

with coefficients of the steady crack at the speed of pull-off (:mod:`.line_tension`) and the slopes
of the same theory. Keeps `paper/kept/range_factor.json`; rows that are kept are not computed again.
"""

import json
from pathlib import Path

import numpy as np

from research.replication.second_code.half_plane import Solid
from viscotack.theory import SteadyCrack, lennard_jones
from viscotack.theory.crack.contact import profile_of, recede

from .line_tension import coefficients
from .range_cases import KEPT as CASES
from .range_cases import groups_of

KEPT = Path(__file__).with_name("kept") / "range_factor.json"
# Radii within which the coefficients are computed, over that of the zone [Gamma E0* h0^2/dg], and
# elements.
RADII, ELEMENTS = (8.0, 32.0), 60
# Radius up to which the tail of the law counts, over that of the contact: elastic pull-off forces
# at a Tabor number of 10 have the coefficient within this radius.
CUT = 0.075
_AROUND = 4


def row_of(case):
    """Return the numbers of one simulated case."""
    groups = groups_of(case)
    crack, profile = SteadyCrack(groups.material, groups.traction), profile_of(groups.geometry)
    tabor = case["tabor"]
    curves = recede(
        crack,
        profile,
        radius=np.array([case["radius"] * np.pi ** (1 / 3)]),
        rate=np.array([case["rate"] / tabor]),
        tabor=np.array([tabor]),
    )
    a, force, energy, speed = (
        x[:, 0] for x in (curves.radius, curves.force, curves.amplification, curves.speed)
    )
    i = int(np.argmin(force))
    near = slice(max(i - _AROUND, 1), i + _AROUND + 1)
    slopes = [np.polyfit(np.log(a[near]), np.log(y[near]), 1)[0] for y in (energy, speed)]
    modes = crack.modes
    solid = Solid(modes.instantaneous, tuple(zip(modes.weights, modes.times, strict=True)))
    # the coefficient grows with the radius that counts, by the tail of the law
    radii = [part * energy[i] for part in RADII]
    near, far = (
        np.array(coefficients(solid, speed[i], largest=L, elements=ELEMENTS)[1:4]) for L in radii
    )
    growth = (far[0] - near[0]) / np.log(radii[1] / radii[0])
    T, T_g, T_n = near
    T = T - growth * np.log(radii[0] / (CUT * tabor**2 * a[i]))
    effective = tabor * energy[i] ** (-1 / 3)
    short = -force[i] / (1.5 * np.pi)
    size = 1 / (tabor**2 * a[i])
    first = (T + slopes[0] * T_g + slopes[1] * T_n) * size
    return {
        "i": case["i"],
        "k": case["k"],
        "exponent": case["exponent"],
        "tabor": tabor,
        "energy": energy[i],
        "effective": effective,
        "g": slopes[0],
        "n": slopes[1],
        "T": T / energy[i],
        "growth": growth / energy[i],
        "T_g": T_g / energy[i],
        "T_n": T_n / energy[i],
        "size": size * energy[i],
        "simulated": case["simulated"] / short,
        "package": case["contact"] / short,
        "effective_rule": float(lennard_jones.pull_off_ratio(effective)),
        "first_order": 1 + first,
    }


def main():
    """Compute and keep all rows."""
    rows = json.loads(KEPT.read_text())["rows"] if KEPT.exists() else []
    known = {row["i"] for row in rows}
    for case in json.loads(CASES.read_text())["rows"]:
        if "simulated" not in case or case["i"] in known:
            continue
        row = {k: v if v is None else round(float(v), 7) for k, v in row_of(case).items()}
        row["i"] = case["i"]
        rows.append(row)
        print(row, flush=True)
        KEPT.write_text(json.dumps({"rows": sorted(rows, key=lambda r: r["i"])}, indent=1) + "\n")


if __name__ == "__main__":
    main()
