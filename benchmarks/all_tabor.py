"""From Bradley to JKR and beyond: `python benchmarks/all_tabor.py`, about two minutes.

The pull-off force of a sphere against the Tabor number from 0.01 to 1e6, as `solve` answers it: one
curve for each solid, simulated where forces reach far, by the contact whose edge is a steady crack
where they do not. Both are drawn where both answer. Makes docs/all_tabor.png.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.style
import numpy as np

import viscotack as vt

PICTURE = Path(__file__).parents[1] / "docs" / "all_tabor.png"
TABOR = np.geomspace(0.01, 1e6, 25)
# Both answers are asked between these.
BOTH = (5.0, 200.0)
NEUTRAL = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0}
SOLIDS = {
    "elastic": vt.Elastic(**NEUTRAL),
    "standard solid, k = 0.1": vt.StandardSolid(**NEUTRAL, glassy_modulus=10.0, tau0=1.0),
    "power law, k = 0.1, n = 0.5": vt.RetardationPowerLaw(
        **NEUTRAL, glassy_modulus=10.0, exponent=0.5, tau0=1.0
    ),
}
# Retraction in a contact's depth, about (mu + 1) h0, for each unit of time.
RATE, RADIUS = 0.3, 3.5


def case(tabor: float, material: object) -> vt.Groups:
    """Return the same relaxed contact at another Tabor number."""
    # small Tabor numbers have no contact that adhesion holds: a load does
    start = vt.AtRadius(RADIUS)
    return vt.Groups(tabor=tabor, material=material, start=start, rate=RATE * (tabor + 1))


def main() -> None:
    """Ask, print and draw."""
    with matplotlib.style.context("viscotack.pictures.viscotack"):
        from matplotlib.figure import Figure

        figure = Figure(figsize=(9.0, 5.6), layout="constrained")
        axes = figure.subplots()
        for i, (name, solid) in enumerate(SOLIDS.items()):
            print(f"{name}\n{'mu':>10}{'force':>10}  by", flush=True)
            found = []
            for tabor in TABOR:
                result = vt.solve(
                    case(float(tabor), solid), until="pull-off", accuracy=5e-3, estimate_error=False
                )
                found.append((tabor, vt.pull_off_force(result), result.method == "simulation"))
                print(f"{tabor:>10.3g}{found[-1][1]:>10.4f}  {result.method}")
            mu, force, simulated = (np.array(column) for column in zip(*found, strict=True))
            axes.plot(mu, force, "-", color=f"C{i}", label=name)
            axes.plot(mu[simulated], force[simulated], "o", color=f"C{i}", ms=5)
            crack = [t for t in TABOR if t > BOTH[0]]
            theory = [vt.crack_contact(case(float(t), solid)).pull_off_force for t in crack]
            axes.plot(crack, theory, "s", color=f"C{i}", mfc="white", ms=8, zorder=1)
        axes.plot([], [], "ko", ms=5, label="simulated")
        axes.plot([], [], "ks", mfc="white", ms=8, label="contact with a crack for its edge")
        axes.axhline(4 / 3, color="0.6", lw=1, ls=":")
        axes.text(TABOR[-1], 4 / 3, "Bradley, elastic", ha="right", va="bottom", color="0.4")
        axes.set_xscale("log")
        axes.set_xlabel("Tabor number")
        axes.set_ylabel(r"pull-off force [1.5$\pi R\,\Delta\gamma_0$]")
        axes.set_ylim(bottom=0)
        axes.legend()
        figure.savefig(PICTURE, dpi=100)
    print(f"Picture: {PICTURE}")


if __name__ == "__main__":
    main()
