"""An interface that grows with speed, found from pull-off forces at six speeds.

A lens on rubber is pulled off at 1 um/s to 1 mm/s. Its interface becomes stronger the faster it
opens; forces are computed with that very law, and have 1 % of noise. The work of adhesion is known
from a slow test.

Prints the fit and draws ``out/growing_interface.png``. Time: one to two minutes.
"""

from pathlib import Path

import numpy as np

import viscotack as vt
from viscotack.identify import PullOff, RateSeries, forecast_rates, identify_rates
from viscotack.lab.tack import Measured

RUBBER = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=5e6, tau0=1e-2, poisson_ratio=0.5)
LENS, PRELOAD, WORK, RANGE = 5e-3, 4e-3, 0.1, 50e-9
SPEEDS = np.geomspace(1e-6, 1e-3, 6)
PICTURE = Path("out/growing_interface.png")
LAW = vt.GentSchultz.of(vt.LennardJones(WORK, RANGE), reference_speed=1e-4, exponent=0.5)


def force(speed: float) -> float:
    """Return the pull-off force [N] at a speed [m/s]."""
    problem = vt.Problem(
        material=RUBBER,
        traction=LAW,
        geometry=vt.Sphere(LENS),
        protocol=vt.Retraction(start=vt.AtForce(PRELOAD), speed=speed),
    )
    return vt.crack_contact(problem).pull_off_force * problem.scales().force


def draw(series, forecast, path: Path) -> None:
    """Draw the measured forces, and the band of the forecast from the slowest speed on."""
    import matplotlib.pyplot as plt
    import matplotlib.style

    with matplotlib.style.context("viscotack.plot.viscotack"):
        figure, axes = plt.subplots(figsize=(8.0, 5.2))
        speed = forecast.speed * 1e6
        axes.fill_between(speed, 1e3 * forecast.low, 1e3 * forecast.high, alpha=0.3, label="band")
        axes.plot(speed, 1e3 * forecast.force, label="fit and forecast")
        measured = [1e3 * each.force.value for each in series]
        axes.plot(SPEEDS * 1e6, measured, "o", mfc="white", label="measured")
        axes.plot(speed[-1], 1e3 * force(forecast.speed[-1]), "x", color="k", label="truth")
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set_xlabel("retraction speed [µm/s]")
        axes.set_ylabel("pull-off force [mN]")
        axes.set_title("An interface that grows with speed")
        axes.legend()
        vt.save_figure(figure, path)


def main(ranges=(10e-9, 250e-9), picture: Path = PICTURE):
    """Pull, identify, forecast; return the fit."""
    rng = np.random.default_rng(0)
    series = []
    for speed in SPEEDS:
        measured = force(speed) * (1 + 0.01 * rng.standard_normal())
        series.append(PullOff(float(speed), Measured(measured, 0.01 * measured), PRELOAD))
    fit = identify_rates(
        RateSeries(
            series,
            material=RUBBER,
            radius=LENS,
            gaps=ranges,
            work_of_adhesion=(WORK, 0.02 * WORK),
            growth=True,
        )
    )
    for sentence in fit.words:
        print(sentence)
    fast = 3 * SPEEDS[-1]
    forecast = forecast_rates(fit, [*SPEEDS, fast])
    low, high = 1e3 * forecast.low[-1], 1e3 * forecast.high[-1]
    print(f"at {fast:.3g} m/s {low:.1f} to {high:.1f} mN; truly {1e3 * force(fast):.1f} mN")
    picture.parent.mkdir(parents=True, exist_ok=True)
    draw(series, forecast, picture)
    print(f"Picture: {picture}")
    return fit


if __name__ == "__main__":
    main()
