"""Pressure and gap under a sphere while it comes off. Draws ``out/fields.png``. Time: 2 seconds.

A power-law solid, ten times as stiff when it is struck as when it is given time, is pulled from a
relaxed depth of 73 h0 so fast that it answers nearly as glass.
"""

from pathlib import Path

import numpy as np

import viscotack as vt

MATERIAL = vt.RetardationPowerLaw(
    rubbery_modulus=1.0, glassy_modulus=10.0, exponent=0.8, tau0=1.0, poisson_ratio=0.0
)
PICTURE = Path("out/fields.png")


def run(rate: float = 316.23, accuracy: float = 2e-3) -> vt.Result:
    """Return the simulated detachment with its profiles."""
    case = vt.Groups(tabor=3.24, material=MATERIAL, start=vt.AtDepth(73.0), rate=rate)
    return vt.solve(case, accuracy=accuracy, fields=True)


def draw(result: vt.Result, path: Path) -> None:
    """Draw the profiles at the start, at zero force, at pull-off, and late in the detachment."""
    import matplotlib as mpl
    import matplotlib.style
    from matplotlib.figure import Figure

    fields, found = result.fields, vt.pull_off(result)
    if fields is None:
        raise ValueError("the result has no fields; solve with fields=True")
    lowest = int(np.argmin(result.force))
    moments = {
        "relaxed, pressed in": 0,
        "no force": int(np.argmin(np.abs(result.force[:lowest]))),
        "pull-off": lowest,
        "going": lowest + int(np.argmin(np.abs(result.force[lowest:] + 0.5 * found.force))),
    }
    colors = mpl.colormaps["viridis"](np.linspace(0.0, 0.8, len(moments)))
    with matplotlib.style.context("viscotack.plot.viscotack"):
        figure = Figure(figsize=(13.0, 5.6))
        left, right = figure.subplots(1, 2)
        for (words, step), color in zip(moments.items(), colors, strict=True):
            radius = fields["radius"][step]
            left.plot(radius, fields["pressure"][step], color=color, label=words)
            right.plot(radius, fields["gap"][step], color=color, label=words)
        widest = 1.25 * result.contact_radius[0]
        for axes in (left, right):
            axes.set_xlim(0, widest)
            axes.set_xlabel(r"radius / $(\pi R^2 \Delta\gamma_0/E_0^*)^{1/3}$")
        left.axhline(0, color="0.6", lw=1, zorder=0)
        left.set_ylabel(r"pressure / ($\Delta\gamma_0/h_0$), compression positive")
        left.set_title("Tension peaks at the edge")
        right.set_ylim(0, 10)
        right.set_ylabel(r"gap / $h_0$")
        right.set_title("The edge recedes")
        right.legend()
    path.parent.mkdir(parents=True, exist_ok=True)
    vt.save_figure(figure, path)


def main(rate: float = 316.23, accuracy: float = 2e-3, picture: Path = PICTURE) -> vt.Result:
    result = run(rate, accuracy)
    draw(result, picture)
    print(f"{result.status}; pull-off force {vt.pull_off_force(result):.3f} x 1.5 pi R dg0")
    print(f"Picture: {picture}")
    return result


if __name__ == "__main__":
    main()
