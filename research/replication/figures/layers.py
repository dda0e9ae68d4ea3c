"""A punch on layers: regimes by thickness, and what the interface looks like."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import punch as theory

from ..bench import Bench, Numbers
from .cases import SIZE as HALF_WIDTH
from .cases import K, Work, glassy_punch, punch, solid, table
from .style import COLOURS, MARKERS, SIMULATED, decades, panels

# With these lengths are in a0 and stresses in sigma0.
PAD = theory.Pad(
    half_width=HALF_WIDTH,
    contact_modulus=2 / np.pi,
    work_of_adhesion=1.0,
    strength=1.0,
    base=theory.Frictionless(),
)


def numbers_3_3(bench: Bench) -> Numbers:
    """Return envelopes and exact stress [sigma0] by thickness [a0], and where regimes meet."""
    b = np.geomspace(0.1, 1e4, 161)
    slow, fast = theory.limits(b, PAD, modulus_ratio=K)
    exact = np.asarray(PAD.elastic_stress(b))
    ends = theory.regime_thicknesses(PAD, modulus_ratio=K)
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
            PAD.elastic_stress(ends.half_plane) / theory.pull_off_stress(ends.half_plane, PAD)
        ),
    }


def draw_3_3(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    for i, (name, word) in enumerate((("slow", "slow, $E_0$"), ("fast", r"fast, $E_\infty$"))):
        ax.plot(numbers["thickness"], numbers[name], color=COLOURS[i], label=f"envelope, {word}")
        exact = numbers[f"exact_{name}"]
        ax.plot(numbers["thickness"], exact, "--", color=COLOURS[i], label=f"exact elastic, {word}")
    decades(ax)
    for name, word in (("b0", "$b_0$"), ("b0_fast", "$b_0/k$"), ("b1", "$b_1$")):
        ax.axvline(numbers[name], color="0.6", lw=0.8)
        ax.text(numbers[name] * 1.06, 0.055, word)
    ax.set(ylim=(0.05, 1.3), xlabel="layer thickness $b/a_0$")
    ax.set_ylabel(r"pull-off stress / $\sigma_0$")
    ax.legend(loc="upper right")


RATES = (0.1, 1.0, 10.0, 100.0)


def numbers_3_6(bench: Bench) -> Numbers:
    """Return stresses [sigma0] by thickness [a0] and rate, of elastic layers, and of LEFM."""
    b = HALF_WIDTH * np.geomspace(1e-3, 10, 30)
    found = table(bench.each, [Work(punch(float(x), r)) for x in b for r in RATES], (30, 4))
    slow = table(bench.each, [Work(punch(float(x), 1.0, material=solid(1.0))) for x in b])
    fast = table(bench.each, [Work(glassy_punch(float(x))) for x in b])
    exact = np.asarray(PAD.elastic_stress(b))
    return {
        "thickness": b,
        "rate": np.array(RATES),
        "stress": found["force"],
        "error": found["force_error"],
        "slow": slow["force"],
        "fast": fast["force"],
        "exact_slow": exact,
        "exact_fast": exact / np.sqrt(0.1),
    }


def draw_3_6(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    b = numbers["thickness"]
    for name, style in (("slow", "--"), ("fast", "-")):
        exact = np.minimum(numbers[f"exact_{name}"], 1)
        ax.plot(b, exact, "k" + style, lw=1, label=f"elastic theory, {name}")
        ax.plot(b, numbers[name], "k:", lw=1)
    for i, rate in enumerate(numbers["rate"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        ax.plot(b, numbers["stress"][:, i], **style, label=rf"rate {rate:g} $h_0/\tau$")
    ax.plot([], [], "k:", lw=1, label="elastic, simulated")
    decades(ax)
    ax.set_yticks([0.1, 0.2, 0.5, 1.0], ["0.1", "0.2", "0.5", "1"])
    ax.minorticks_off()
    ax.set(xlabel="layer thickness $b/a_0$", ylabel=r"pull-off stress / $\sigma_0$")
    ax.legend()


RATE = 100.0
OVER_WIDTH = (0.001, 0.25, 10.0)
_STRENGTH = 16 / (9 * np.sqrt(3))
_POINTS = 120


def numbers_3_7(bench: Bench) -> Numbers:
    """Return place [a], tension [sigma0] and gap - 1 [h0] at three moments of three layers."""
    return {f"{b:g}": of for b, of in zip(OVER_WIDTH, bench.each(moments, OVER_WIDTH), strict=True)}


def moments(over_width: float) -> dict[str, Any]:
    """Return the fields half way to the pull-off, at it, and when half of the stress is gone."""
    result = vt.solve(
        punch(over_width * HALF_WIDTH, RATE), fields=True, estimate_error=False, throw=False
    )
    fields, force = result.fields, -result.force
    assert fields is not None
    top = int(np.argmax(force))
    before = int(np.argmax(force > 0.5 * force[top]))
    later = np.flatnonzero(force[top:] < 0.5 * force[top])
    after = top + int(later[0]) if later.size else len(force) - 1
    found: dict[str, Any] = {"ligament": vt.ligament_at_pull_off(result)}
    for name, step in (("before", before), ("at", top), ("after", after)):
        at = int(np.argmin(np.abs(fields["time"] - result.time[step])))
        # meshes of fewer nodes are filled up
        here = np.flatnonzero(np.isfinite(fields["radius"][at]))
        x = fields["radius"][at][here] / np.max(fields["radius"][at][here])
        some = np.unique(np.linspace(0, x.size - 1, _POINTS).astype(int))
        found[name] = {
            "place": x[some],
            "tension": -fields["pressure"][at][here][some] / _STRENGTH,
            "opening": fields["gap"][at][here][some] - 1,
        }
    return found


def draw_3_7(numbers: Numbers, figure: Figure) -> None:
    axes = panels(figure, 3, 2, sharex=True)
    for row, (over_width, of) in enumerate(numbers.items()):
        left, right = axes[2 * row : 2 * row + 2]
        for i, (name, word) in enumerate(
            (("before", "half way"), ("at", "pull-off"), ("after", "after it"))
        ):
            some = of[name]
            style = {"color": COLOURS[(0, 1, 2)[i]], "lw": 2.2 if name == "at" else 1.2}
            left.plot(some["place"], some["tension"], **style, label=word)
            right.plot(some["place"], some["opening"], **style)
        left.set_ylabel(r"tension / $\sigma_0$")
        right.set_ylabel("gap / $h_0 - 1$")
        right.set_yscale("symlog", linthresh=0.1)
        left.set_title(f"$b$ = {float(over_width):g} $a$, ligament {of['ligament']:.2f} $a$")
    for ax in axes[-2:]:
        ax.set_xlabel("place $x/a$")
    axes[0].legend()
