"""Three regimes of detachment from a layer, slow and fast, and the exact elastic curve.

Claims: strength for b < b0, b^-1/2 up to b1 = 4a/pi, the half-plane beyond; fast retraction moves
b0 to b0/k. The exact curve, which the thesis does not have, is smooth and 23.5 % higher at b1.

Seen: The envelope of the thesis as lines, the exact elastic stress dashed. They part over a decade
around b1, where the exact one is 23.5 % higher; fast retraction moves b0 by 1/k and b1 not at all.

Needs: nothing.

Costs: milliseconds.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from viscotack.theory import punch

from ..bench import Bench, Numbers
from .cases import SIZE as HALF_WIDTH
from .cases import K
from .style import COLOURS, decades, panels

# With these lengths are in a0 and stresses in sigma0.
PAD = punch.Pad(
    half_width=HALF_WIDTH,
    contact_modulus=2 / np.pi,
    work_of_adhesion=1.0,
    strength=1.0,
    base=punch.Frictionless(),
)


def numbers(bench: Bench) -> Numbers:
    """Return envelopes and exact stress [sigma0] by thickness [a0], and where regimes meet."""
    b = np.geomspace(0.1, 1e4, 161)
    slow, fast = punch.limits(b, PAD, modulus_ratio=K)
    exact = np.asarray(PAD.elastic_stress(b))
    ends = punch.regime_thicknesses(PAD, modulus_ratio=K)
    return {
        "thickness": b,
        "slow": np.asarray(slow),
        "fast": np.asarray(fast),
        "exact_slow": np.minimum(exact, 1),
        "exact_fast": np.minimum(exact / np.sqrt(K), 1),
        "b0": float(ends.cohesive),
        "b0_fast": float(ends.cohesive_fast),
        "b1": float(ends.half_plane),
        "exact_over_envelope_at_b1": float(
            PAD.elastic_stress(ends.half_plane) / punch.pull_off_stress(ends.half_plane, PAD)
        ),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the envelopes as lines and the exact curves dashed."""
    (ax,) = panels(figure, 1, 1)
    for i, (name, word) in enumerate((("slow", "slow, $E_0$"), ("fast", r"fast, $E_\infty$"))):
        ax.plot(numbers["thickness"], numbers[name], color=COLOURS[i], label=f"envelope, {word}")
        exact = numbers[f"exact_{name}"]
        ax.plot(numbers["thickness"], exact, "--", color=COLOURS[i], label=f"exact elastic, {word}")
    decades(ax)
    for name, word in (("b0", "$b_0$"), ("b0_fast", "$b_0/k$"), ("b1", "$b_1$")):
        ax.axvline(numbers[name], color="0.6", lw=0.8)
        ax.text(numbers[name] * 1.06, 0.055, word)
    ax.set_ylim(0.05, 1.3)
    ax.set_xlabel("layer thickness $b/a_0$")
    ax.set_ylabel(r"pull-off stress / $\sigma_0$")
    ax.legend(loc="upper right")
