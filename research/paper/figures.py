"""Figures of the manuscript, from its numbers."""

from pathlib import Path

import matplotlib as mpl
import matplotlib.style
import matplotlib.ticker
import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from research.cases import reduced
from research.replication.second_code.half_plane import Solid, cracks

from . import closed_forms
from .numbers import coefficient, crack, factors, kept

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
SPEEDS = 10.0 ** np.arange(-3, 5.01, 0.1)
# Speeds of the zones that are drawn, rates and Tabor numbers of contacts.
ZONES = (0.0, 1.0, 100.0)
TABOR, RATES = (10.0, 100.0, 1000.0), 10.0 ** np.arange(-3, 4.01, 0.5)
CYCLE_RATES = 10.0 ** np.arange(-2.5, 3.01, 0.5)


def _panels(count, width=6.6, height=2.7):
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, np.atleast_1d(figure.subplots(1, count))


def energies():
    """Draw energies over the speed, of opening and closing cracks."""
    figure, (left, right) = _panels(2)
    rows = kept("agreement")["plane"]
    cases = ((0.1, None, "k = 0.1"), (0.01, None, "k = 0.01"), (0.1, 0.6, "k = 0.1, n = 0.6"))
    for colour, (k, n, label) in zip(COLOURS, cases, strict=False):
        for sign in (1, -1):
            values = crack(k, n).amplification(sign * SPEEDS)
            left.loglog(SPEEDS, values, color=colour, label=label if sign > 0 else None)
        own = [r for r in rows if (r["modulus_ratio"], r["exponent"]) == (k, n)]
        left.plot(
            [abs(r["speed"]) for r in own],
            [r["energy"] for r in own],
            "o",
            ms=4,
            mfc="none",
            color=colour,
        )
    left.axhline(1, color="0.7", lw=0.6)
    left.set(xlabel=r"speed $|V|$", ylabel=r"energy $\Gamma$")
    left.legend(loc="upper left")
    for colour, form in zip(COLOURS, closed_forms.FORMS, strict=False):
        length = closed_forms.length_of_strength(form, crack(0.1).traction.reduced().strength)
        off = closed_forms.deviations(form, SPEEDS, crack(0.1), length)
        right.semilogx(SPEEDS, 100 * off, color=colour, label=form)
        best, _ = closed_forms.best_length(form, 10.0 ** np.arange(-2, 3.01, 0.25), crack(0.1))
        off = closed_forms.deviations(form, SPEEDS, crack(0.1), best)
        right.semilogx(SPEEDS, 100 * off, "--", color=colour)
    right.axhline(0, color="0.7", lw=0.6)
    right.set(xlabel=r"speed $V$", ylabel="deviation from the steady crack, %", ylim=(None, 42))
    right.legend(loc="upper left")
    return figure


def zones():
    """Draw gap and traction of cracks at three speeds, by both codes."""
    figure, (left, right) = _panels(2)
    found = cracks(Solid.standard(0.1), ZONES, elements=110, degree=14, step=0.5)
    for colour, speed, own in zip(COLOURS, ZONES, found, strict=False):
        profile = crack(0.1).at(speed)
        scale = profile.amplification
        left.plot(profile.position / scale, profile.gap, color=colour, label=f"V = {speed:g}")
        right.plot(profile.middle / scale, profile.traction, color=colour)
        left.plot(own.position[::3] / scale, own.gap[::3], "o", ms=3, mfc="none", color=colour)
        right.plot(
            own.position[::3] / scale, own.traction[::3], "o", ms=3, mfc="none", color=colour
        )
    left.set(xlim=(-1, 4), ylim=(0.9, 6), ylabel=r"gap $h/h_0$")
    right.set(xlim=(-1, 4), ylim=(-0.1, 1.1), ylabel=r"tension $\sigma h_0/\Delta\gamma$")
    for ax in (left, right):
        ax.set_xlabel(r"position $x/(\Gamma\lambda)$")
    left.legend()
    return figure


def coefficients():
    """Draw the coefficients of the first order over the speed."""
    figure, axes = _panels(3, height=2.3)
    rows = kept("line_tension")["rows"]
    names = ("T", r"$\mathcal{T}$"), ("T_g", r"$\mathcal{T}_g$"), ("T_n", r"$\mathcal{T}_n$")
    for ax, (name, label) in zip(axes, names, strict=True):
        for colour, k in zip(COLOURS, (0.1, 0.01), strict=False):
            own = [r for r in rows if r["k"] == k]
            speeds = [r["speed"] for r in own]
            ax.semilogx(
                speeds, [r[name] for r in own], "o-", ms=3, color=colour, label=f"k = {k:g}"
            )
        ax.set(xlabel=r"speed $V$", ylabel=label)
    axes[0].set_ylim(0, None)
    axes[0].legend()
    return figure


def quasi_steady():
    """Draw the excess of the factor over its size for edges of one speed."""
    figure, (ax,) = _panels(1, width=4.2, height=3.0)
    rows = kept("quasi_steady")["rows"]
    for colour, speed in zip(COLOURS, sorted({r["speed"] for r in rows}), strict=False):
        own = [r for r in rows if r["speed"] == speed]
        x = [r["effective"] for r in own]
        label = "elastic" if speed == 0 else f"V = {speed:g}, Γ = {own[0]['energy']:.2f}"
        seen = [(r["factor"] - 1) / r["size"] for r in own]
        ax.semilogx(x, seen, "o", ms=4, mfc="none", color=colour, label=label)
        # below this the cut of the tail lies within the zone
        wide = [r for r in own if speed > 1 or r["effective"] > 5]
        ax.plot([r["effective"] for r in wide], [r["T"] for r in wide], color=colour)
    own = [r for r in rows if r["speed"] == 0]
    ax.plot(
        [r["effective"] for r in own],
        [(r["rule"] - 1) / r["size"] for r in own],
        "k:",
        label=r"rule $f(\mu\Gamma^{-1/3})$",
    )
    ax.set(
        xlabel=r"effective Tabor number $\mu\Gamma^{-1/3}$",
        ylabel=r"(factor − 1) $a/(\Gamma\lambda)$",
        ylim=(0, None),
    )
    ax.xaxis.set_minor_formatter(mpl.ticker.NullFormatter())
    ax.set_xticks([3, 5, 10, 20], ["3", "5", "10", "20"])
    ax.legend()
    return figure


def factor():
    """Draw simulated factors beside the rule and the derived one."""
    figure, (left, right) = _panels(2)
    data, rows = factors(), kept("range_factor")["rows"]
    x, inside = data["effective"], data["inside"]
    left.plot(x, (data["simulated"] - 1) / data["size"], "ko", ms=3.5, label="simulated")
    left.plot(x, (data["rule"] - 1) / data["size"], "x", color=COLOURS[1], label="rule")
    left.plot(x, (data["bounded"] - 1) / data["size"], "+", color=COLOURS[0], label="derived")
    limit = np.array([coefficient(row) for row in rows])
    left.plot(x, limit, ".", ms=3, color=COLOURS[2], label="derived, first order alone")
    left.set(ylabel=r"(factor − 1) $a/(\Gamma\lambda)$", ylim=(0, 1))
    left.legend()
    for name, marker, colour in (("rule", "x", COLOURS[1]), ("bounded", "+", COLOURS[0])):
        off = 100 * (data[name] / data["simulated"] - 1)
        label = "derived" if name == "bounded" else name
        right.plot(x[inside], off[inside], marker, color=colour, label=label)
        right.plot(x[~inside], off[~inside], marker, color=colour, alpha=0.35)
    right.axhline(0, color="0.7", lw=0.6)
    right.set(ylabel="error of the pull-off force, %")
    right.legend(title="pale: nearly elastic or glassy", title_fontsize=7)
    for ax in (left, right):
        ax.set_xlabel(r"effective Tabor number $\mu\Gamma^{-1/3}$")
    return figure


def contacts():
    """Draw pull-off forces over the rate, from rest and of cycles at one speed; and the bound."""
    figure, axes = _panels(3, height=2.4)
    left, middle, right = axes
    for colour, tabor in zip(COLOURS, TABOR, strict=False):
        found = [(rate, _from_rest(tabor, rate)) for rate in RATES]
        good = [(rate, force) for rate, force in found if np.isfinite(force)]
        left.semilogx(*zip(*good, strict=True), color=colour, label=f"$\\mu$ = {tabor:g}")
    left.set(xlabel=r"rate $r\tau/(\mu h_0)$", ylabel=r"pull-off force / JKR's", ylim=(0, None))
    left.legend()
    forces = [_cycle(rate) for rate in CYCLE_RATES]
    middle.semilogx(CYCLE_RATES, forces, "o-", ms=3, color=COLOURS[1])
    middle.axhline(1, color="0.7", lw=0.6)
    middle.set(xlabel=r"rate of the cycle $r\tau/(\mu h_0)$", ylabel="pull-off force / JKR's")
    middle.set_ylim(0, None)
    bound = kept("work-bound")["numbers"]
    right.loglog(bound["glassy_tabor"], bound["share"], "o", ms=2, mfc="none", mew=0.5, color="0.4")
    right.axhline(1, color=COLOURS[1])
    right.set(xlabel=r"glassy Tabor number $\mu k^{1/3}$", ylabel="work to pull-off / bound")
    return figure


def _force(groups):
    """Return the pull-off force, nan where the theory does not hold."""
    try:
        return vt.crack_contact(groups).pull_off_force
    except vt.OutOfRange:
        return np.nan


def _from_rest(tabor, rate):
    """Return the pull-off force from a relaxed start."""
    start = vt.AtRadius(4.0)
    return _force(vt.Groups(tabor=tabor, material=reduced(0.1), start=start, rate=rate * tabor))


def _cycle(rate, tabor=30.0):
    """Return the pull-off force of a contact that is made and opened at one speed."""
    groups = vt.Groups(
        tabor=tabor,
        material=reduced(0.1),
        start=vt.Apart(5.0),
        moves=(vt.Approach(rate * tabor, vt.AtDepth(6 * tabor)),),
        rate=rate * tabor,
    )
    return _force(groups)


FIGURES = (energies, zones, coefficients, quasi_steady, factor, contacts)


def write(folder):
    """Write all figures into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for draw in FIGURES:
        with mpl.style.context(Path(__file__).with_name("paper.mplstyle")):
            draw().savefig(folder / f"{draw.__name__}.png")
