"""Any axisymmetric profile: waves against Guduru, the disc against Kendall, random worn tips.

    python benchmarks/profiles.py [--cases N] [--plot FILE.png]

Prints the pull-off of a wavy sphere over theory and its gain over the smooth sphere with the rate,
that of a disc over Kendall's, and energy and outcome of N random problems.
"""

import argparse
from dataclasses import replace
from typing import Any

import numpy as np

import viscotack as vt
from viscotack.theory import wavy

ELASTIC = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
RELAXING = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
UNITS: Any = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
KENDALL = np.sqrt(8 * np.pi) / (1.5 * np.pi)
WAVES = ((0.06, 0.5), (0.2, 1.0), (0.6, 1.0))
RATES = (1e-3, 1e-1, 1.0, 10.0, 100.0)
RADII = np.linspace(0.0, 6.0, 241)


def pulled(groups: vt.Groups, accuracy: float = 3e-3) -> float:
    """Return the pull-off force without its error."""
    return vt.solve(
        groups, until="pull-off", accuracy=accuracy, estimate_error=False
    ).pull_off_force


def waves() -> None:
    """Print simulated pull-offs of wavy spheres over those of theory."""
    for amplitude, wavelength in WAVES:
        shape = vt.WavySphere(1.0, amplitude, wavelength)
        end = wavy.pull_off(amplitude=amplitude, wavelength=wavelength, **UNITS)
        theory = -end.force / (1.5 * np.pi)
        found = []
        for tabor in (4.0, 8.0, 16.0):
            start = vt.AtDepth(6.0 * tabor)
            found.append(pulled(vt.Groups(tabor, ELASTIC, start, 1.0, geometry=shape)) / theory)
        ratios = " ".join(f"{x:.4f}" for x in found)
        print(f"waves A {amplitude} L {wavelength}: theory {theory:.4f}, mu 4 8 16: {ratios}")


def fading() -> list[float]:
    """Return the gain by waves over the smooth sphere at each rate."""
    gain = []
    for rate in RATES:
        case = vt.Groups(
            4.0, RELAXING, vt.AtDepth(12.0), rate, geometry=vt.WavySphere(1.0, 0.06, 0.5)
        )
        gain.append(pulled(case) / pulled(replace(case, geometry=vt.Sphere(1.0))))
        print(f"waves A 0.06 L 0.5, mu 4, k 0.1, rate {rate:g}: gain {gain[-1]:.3f}")
    return gain


def discs() -> None:
    """Print simulated pull-offs of discs over Kendall's."""
    for law in (vt.Dugdale(1.0, 1.0), vt.LennardJones(1.0, 1.0)):
        case = vt.Groups(4.0, ELASTIC, vt.AtDepth(0.0), 1.0, geometry=vt.Disc(1.0), traction=law)
        found = [pulled(replace(case, tabor=mu)) / KENDALL for mu in (4.0, 8.0, 16.0)]
        more = (4 * found[-1] - found[-2]) / 3
        ratios = " ".join(f"{x:.4f}" for x in found)
        print(f"disc, {law.word}: mu 4 8 16: {ratios}, extrapolated {more:.4f}")


def drawn(luck: np.random.Generator) -> vt.Groups:
    """Return a random problem."""
    kind = luck.choice(["waves", "worn", "cup", "groove", "disc"])
    a, b = luck.uniform(0.3, 1.2), luck.uniform(0.2, 1.0)
    height = 10 ** luck.uniform(-1.5, 0.5)
    formulas = {
        "worn": lambda r: max(r * r - a * a, 0.0) / 2,
        "cup": lambda r: r * r / 2 + height * np.exp(-((r / a) ** 2)),
        "groove": lambda r: r * r / 2 + height * np.exp(-(((r - a) / (b / 3)) ** 2)),
    }
    if kind == "waves":
        shape: Any = vt.WavySphere(1.0, 10 ** luck.uniform(-2, -0.3), luck.uniform(0.3, 1.2))
    elif kind == "disc":
        shape = vt.Disc(1.0) if b < 0.6 else vt.Disc(1.0, 0.2 * a, 0.2 * a * b)
    else:
        shape = vt.MeasuredProfile.sampled(formulas[kind], RADII)
        shape = shape.reduced(1.0, 1 / shape.equivalent_radius(1.0))
    k = 10 ** luck.uniform(-2, -0.3)
    solid = (
        ELASTIC,
        replace(RELAXING, glassy_modulus=1 / k),
        vt.RetardationPowerLaw(
            rubbery_modulus=1.0,
            glassy_modulus=1 / k,
            exponent=luck.uniform(0.3, 0.9),
            tau0=1.0,
            poisson_ratio=0.0,
        ),
    )[luck.integers(3)]
    tabor = 10 ** luck.uniform(-0.5, 0.9)
    deep = luck.uniform(0.0, 3.0) * tabor
    apart = luck.random() < 0.4
    return vt.Groups(
        tabor=tabor,
        material=solid,
        start=vt.Apart(10.0 + 2 * tabor) if apart else vt.AtDepth(deep),
        moves=(vt.Approach(10 ** luck.uniform(-1, 1), vt.AtDepth(deep)),) if apart else (),
        rate=10 ** luck.uniform(-1, 2),
        geometry=shape,
        stiffness=10 ** luck.uniform(-1.5, 0.5) if luck.random() < 0.25 else None,
    )


def random_problems(cases: int) -> None:
    """Print what became of random problems."""
    luck, residuals, refused = np.random.default_rng(37), [], []
    for number in range(cases):
        case = drawn(luck)
        try:
            result = vt.solve(case, until="pull-off")
        except (vt.InputError, vt.SimulationError) as reason:
            refused.append(str(reason))
            print(f"  case {number}, {case.geometry.word}: {reason}")
            continue
        residuals.append(result.energy_residual or 0.0)
        if residuals[-1] > 1e-3:
            print(f"  case {number}, {case.geometry.word}: residual {residuals[-1]:.1e}")
    print(
        f"{cases} random problems: {len(refused)} refused, the others miss "
        f"{np.median(residuals):.1e} of the energy in the median, {max(residuals):.1e} at most"
    )


def draw(gain: list[float], path: str) -> None:
    """Draw the curve of a wavy sphere beside that of the smooth one, and the fading gain."""
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
    for shape, name in ((vt.Sphere(1.0), "smooth"), (vt.WavySphere(1.0, 0.06, 0.5), "waves")):
        case = vt.Groups(8.0, ELASTIC, vt.AtDepth(24.0), 1.0, geometry=shape)
        result = vt.solve(case, accuracy=3e-3, estimate_error=False)
        left.plot(result.depth, result.force, label=name)
    left.axhline(0, color="0.8", lw=0.8, zorder=0)
    left.set(xlabel=r"depth [$h_0$]", ylabel=r"force [$1.5\,\pi R\,\Delta\gamma_0$]")
    left.legend(frameon=False)
    right.semilogx(RATES, gain, "o-")
    right.axhline(1, color="0.8", lw=0.8, zorder=0)
    right.set(xlabel=r"rate [$h_0/\tau_0$]", ylabel="pull-off force, waves over smooth")
    figure.savefig(path, dpi=130)


def main() -> None:
    """Print all, and draw what is asked for."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--cases", type=int, default=60)
    options.add_argument("--plot", default="")
    asked = options.parse_args()
    waves()
    gain = fading()
    if asked.plot:
        draw(gain, asked.plot)
    discs()
    random_problems(asked.cases)


if __name__ == "__main__":
    main()
