"""Pull-off force of a lens whose edge follows a Gent-Schultz law while its bulk is relaxed.

Claims: with the exponent 0.41 of the law the force scales with the power 0.27 of the speed.

Seen: The exponent of the force rises and, from a light preload, falls again; 0.27 is one point of
it.

Needs: Eq. 4.28 with the printed constants; the lens of section 4.6 from a preload of 1.5 mN and
from 100 times as much.

Costs: a second.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

from viscotack.theory import jkr

from ..bench import Bench, Numbers
from .cases import LENS, PDMS, PDMS_WORK, PRELOAD
from .figure_4_10 import V0, XI
from .style import COLOURS, decades, panels

SIZE = (9.0, 3.8)
_CASE = {"radius": LENS, "contact_modulus": PDMS.contact_modulus, "work_of_adhesion": PDMS_WORK}
_LENGTH = (np.pi * LENS**2 * PDMS_WORK / PDMS.contact_modulus) ** (1 / 3)
_HEIGHT = _LENGTH**2 / LENS
SPEEDS = np.geomspace(1e-7, 1e-1, 49)
PRELOADS = {"1.5 mN": PRELOAD, "150 mN": 100 * PRELOAD}


def pull_off(speed: float, preload: float) -> float:
    r"""Return the pull-off force over that of JKR.

    Lengths in :math:`(\pi R^2 \Delta\gamma_0/E_0^*)^{1/3}`, heights in their square over R:

    .. math:: G = \frac{(a^2 - \delta)^2}{2a}, \quad
              \frac{da}{d\delta} = \frac{v_0}{r} (G - 1)^{1/\xi}, \quad
              P = \frac43 \left(a \delta - \frac{a^3}{3}\right)
    """
    at = float(jkr.contact_radius_at_force(preload, **_CASE)) / _LENGTH
    start = at**2 - np.sqrt(2 * at)
    # the edge moves by one length in the time in which the drive moves by one height
    ratio = V0 / speed * _HEIGHT / _LENGTH

    def slope(travel: float, a: Any) -> Any:
        energy = (a**2 - start + travel) ** 2 / (2 * a)
        return -ratio * np.maximum(energy - 1, 0.0) ** (1 / XI)

    def gone(travel: float, a: Any) -> float:
        return float(a[0] - 0.02 * at)

    gone.terminal = True  # type: ignore[attr-defined]
    path = solve_ivp(
        slope,
        (0.0, 500.0 * at),
        [at],
        method="LSODA",
        rtol=1e-8,
        atol=1e-10,
        events=gone,
        max_step=at / 40,
    )
    a, depth = path.y[0], start - path.t
    return float(np.max(-4 / 3 * (a * depth - a**3 / 3)))


def numbers(bench: Bench) -> Numbers:
    """Return force over JKR and its local exponent by speed [m/s] and preload."""
    found: Numbers = {"speed": SPEEDS}
    for name, preload in PRELOADS.items():
        force = np.array([pull_off(float(v), preload) for v in SPEEDS])
        found[name] = {"force": force, "exponent": np.gradient(np.log(force), np.log(SPEEDS))}
    return found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw forces by speed, and the local exponents."""
    left, right = panels(figure, 1, 2)
    v = 1e6 * numbers["speed"]
    for i, name in enumerate(PRELOADS):
        style = {"color": COLOURS[i], "label": f"from {name}"}
        left.plot(v, numbers[name]["force"], **style)
        right.plot(v, numbers[name]["exponent"], **style)
    decades(left)
    decades(right, y=False)
    right.axhline(0.27, color="k", ls="--", lw=1, label="thesis, 0.27")
    right.axhline(3 * XI / (3 + XI), color="0.5", ls=":", lw=1, label=r"$3\xi/(3+\xi)$")
    right.axvspan(1, 1000, color="0.94", zorder=0)
    for ax in (left, right):
        ax.set_xlabel("retraction speed [µm/s]")
    left.set_ylabel("pull-off force over JKR")
    right.set_ylabel("local exponent")
    right.legend()
