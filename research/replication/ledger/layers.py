"""Claims of chapter 3: a punch on a layer."""

from __future__ import annotations

import numpy as np

from ..figures.cases import SIZE as HALF_WIDTH
from ..figures.cases import K
from .claim import Claim, Measured, Of, Verdict

_B0, _B1 = 4 / np.pi, 4 / np.pi * HALF_WIDTH


def _history(of: Of) -> Measured:
    n = of("3.5")
    change = n["change"]
    worst = float(np.max(np.abs(change)))
    spread = float(np.max(np.ptp(change, axis=1)))
    at = n["thickness"][int(np.argmax(np.max(np.abs(change), axis=1)))]
    error = 100 * float(np.nanmax(n["error"]))
    return Measured(
        100 * worst,
        f"{100 * worst:.2g} % beside the relaxed start, {100 * spread:.2g} % between protocols, "
        f"at b = {at:.3g} a0 (numerical error below {error:.2g} %)",
    )


def _history_of_a_sphere(of: Of) -> Measured:
    n = of("histories")
    worst = float(np.min(n["change"]))
    i = np.unravel_index(int(np.argmin(n["change"])), n["change"].shape)
    middle = n["change"][0, 1, 2]
    return Measured(
        100 * worst,
        f"{100 * worst:.3g} ± {100 * n['error'][i]:.1g} % pressed at {n['approach'][i[2]]:.0e} "
        f"and pulled at {n['rate'][i[1]]:g} h0/τ0, {100 * middle:.0f} % pressed at 100, below 1 "
        "% pulled at 10",
    )


def _slope(of: Of, rate: int) -> float:
    n = of("3.6")
    some = (n["thickness"] > 3 * _B0) & (n["thickness"] < _B1 / 3)
    x, y = np.log(n["thickness"][some]), np.log(n["stress"][some, rate])
    return float(np.polyfit(x, y, 1)[0])


def _slow_slope(of: Of) -> Measured:
    found = [_slope(of, i) for i in range(4)]
    words = ", ".join(f"{x:.2f}" for x in found)
    return Measured(found[0], f"{words} at rates 0.1, 1, 10, 100 (3 b0 < b < b1/3)")


def _fast_slope(of: Of) -> Measured:
    found = _slope(of, 3)
    return Measured(found, f"{found:.2f} at rate 100 between 3 b0 and b1/3")


def _between(of: Of) -> Measured:
    n = of("3.6")
    above = float(np.max(n["stress"] / n["fast"][:, None])) - 1
    below = float(np.min(n["stress"] / n["slow"][:, None])) - 1
    return Measured(
        1e3 * max(above, -below),
        f"+{1e3 * above:.1f} ‰ of the fast, {1e3 * below:.1f} ‰ of the slow one at most",
    )


def _strength(of: Of) -> Measured:
    n = of("3.6")
    thin = n["thickness"] < 0.5 * _B0
    near = (n["thickness"] > 0.8 * _B0) & (n["thickness"] < _B0)
    least, there = float(np.min(n["stress"][thin])), float(np.min(n["stress"][near]))
    return Measured(least, f"{least:.4f} up to b0/2, {there:.3f} close to b0 at rate 0.1")


def _plateau(of: Of) -> Measured:
    n = of("3.6")
    at = np.array(
        [np.exp(np.interp(np.log(_B1), np.log(n["thickness"]), np.log(s))) for s in n["stress"].T]
    )
    ratio = at / n["stress"][-1]
    words = ", ".join(f"{x:.2f}" for x in ratio)
    return Measured(float(ratio[0]), f"{words} times the stress at b = 10 a, by rate")


def _envelope(of: Of) -> Measured:
    exact = float(of("3.3")["exact_over_envelope_at_b1"])
    n = of("limits")
    simulated, theory = n["at_b1_limit"], n["at_b1_exact"]
    return Measured(
        exact,
        f"{exact:.4f} times the envelope, exact; simulated, extrapolated to small zones, "
        f"{100 * (simulated / theory - 1):+.2f} %",
    )


def _narrow(of: Of) -> Measured:
    slow, fast = of("limits")["narrow_punch"]
    return Measured(fast, f"{fast:.3f} at rate 1e4, {slow:.3f} at 0.01 (a = 5 a0, b = 50 a0)")


def _ligament(of: Of) -> Measured:
    n = of("3.7")
    found = {name: float(part["ligament"]) for name, part in n.items()}
    words = ", ".join(f"{x:.2f} at b = {name} a" for name, x in found.items())
    return Measured(found["10"], words)


def _largest(of: Of) -> Measured:
    n = of("3.9")
    thin = n["inset_thickness"] <= 5
    whole = n["inset_whole"] / n["inset_allowed"]
    ligament = n["inset_energy"] / n["inset_allowed"]
    off = float(np.max(np.abs(whole[:, thin] - 1)))
    return Measured(
        off,
        f"with the whole contact within {100 * off:.2g} % up to 5 a0; with the ligament of Eq. "
        f"3.30 {np.max(ligament[:, thin]):.2f} times; at b0/k {np.min(whole):.2f} times",
    )


def _reaches(of: Of) -> Measured:
    n = of("3.9")
    at = {
        f"{a:g}": float(e) for a, e in zip(n["inset_size"], n["inset_energy"][:, -1], strict=True)
    }
    words = ", ".join(f"{e:.2f} for a = {a} a0" for a, e in at.items())
    return Measured(at["64.84"], words)


def _beside(of: Of, name: str, part: str) -> Measured:
    n = of(name)
    theory = n[part]
    off = []
    for i in range(len(n["thickness"])):
        known = np.isfinite(n["speed"][i]) & (n["speed"][i] > 1) & (n["speed"][i] < 1e6)
        there = np.interp(
            np.log(n["speed"][i][known]), np.log(theory["speed"]), theory["energy"][i]
        )
        off.append(n["energy"][i][known] / there - 1)
    every = np.concatenate(off)
    return Measured(
        float(np.max(np.abs(every))),
        f"simulated {100 * np.min(every):+.0f} to {100 * np.max(every):+.0f} %, median "
        f"{100 * np.median(np.abs(every)):.0f} %; worst for b = "
        f"{n['thickness'][int(np.argmax([np.max(np.abs(o)) for o in off]))]:g} a0",
    )


def _greenwood(of: Of) -> Measured:
    return _beside(of, "3.9", "greenwood")


def _persson(of: Of) -> Measured:
    return _beside(of, "A.1", "persson_brener")


def _gain(of: Of) -> Measured:
    n = of("3.8")
    gain = n["force"][:, -1] ** 2 / n["force"][:, 0] ** 2
    words = ", ".join(f"{x:.2f}" for x in gain)
    return Measured(float(gain[0]), f"σ² rises by {words} for b = 3.24 to 32.42 a0")


def _bell(of: Of) -> Measured:
    n = of("3.10")
    work = n["separation"]
    top = np.max(work, axis=1)
    slow, fast = work[:, 0], work[:, -1]
    thin, thick = (" / ".join(f"{w[i]:.2f}" for w in (slow, top, fast)) for i in (0, -1))
    words = f"slow / largest / fast: {thin} to {thick} Δγ0 for b = 3.24 to 32.42 a0"
    return Measured(float(top[-1]), words)


def _slow_work(of: Of) -> Measured:
    n = of("3.10")
    over = n["separation"][:, 0] / n["elastic"]
    return Measured(
        float(over[0]), ", ".join(f"{x:.2f}" for x in over) + " of the elastic work at rate 0.001"
    )


CLAIMS = (
    Claim(
        "history-punch",
        "Sec. 3.5.1, Fig. 3.5",
        "The history changes the pull-off stress negligibly [%]",
        "2 %",
        _history,
        (0, 2),
        Verdict.HOLDS,
        "six protocols, fourteen thicknesses, rate 10",
    ),
    Claim(
        "history-sphere",
        "Sec. 3.6",
        "…in contrast with a Hertzian geometry [%]",
        "large",
        _history_of_a_sphere,
        (-95, -50),
        Verdict.HOLDS,
        "a sphere pressed fast and pulled at once holds much less: the claim is one of the punch",
    ),
    Claim(
        "slope",
        "Sec. 3.3, 3.5.2",
        "σ_po ∝ b^(−1/2) between b0 and b1",
        -0.5,
        _slow_slope,
        (-0.52, -0.42),
        Verdict.CORRECTED,
        "when slow; faster, the stress is near the strength over much of that range",
    ),
    Claim(
        "fast-slope",
        "Sec. 3.5.2",
        "…at every rate",
        -0.5,
        _fast_slope,
        (-0.42, -0.1),
        Verdict.FAILS,
        "b0 moves to b0/k, and b1 does not: 0.8 decades are left of 1.8",
    ),
    Claim(
        "between-elastic",
        "Sec. 3.5.2",
        "All rates lie between the two elastic layers [‰]",
        0.0,
        _between,
        (0, 2),
        Verdict.HOLDS,
        "within the numerical errors, 0.08 % at most",
    ),
    Claim(
        "cohesive",
        "Eq. 3.13",
        "σ_po = σ0 for b < b0",
        1.0,
        _strength,
        (0.99, 1.001),
        Verdict.CORRECTED,
        "well below b0; at b0 a slow layer is rounded off",
    ),
    Claim(
        "half-plane",
        "Sec. 3.3, 3.5.2",
        "For b > b1 the stress does not depend on b",
        1.0,
        _plateau,
        (1.1, 1.5),
        Verdict.CORRECTED,
        "at b1 it is 23.5 % above its plateau in theory, which begins at 3 a (5 %) to 5 a (2 %)",
    ),
    Claim(
        "b1",
        "Eq. 3.11, 3.12",
        "At b1 = 4a/π the two laws meet",
        1.0,
        _envelope,
        (1.234, 1.236),
        Verdict.CORRECTED,
        "they cross there, and the exact stress is 23.5 % above both",
    ),
    Claim(
        "narrow",
        "Sec. 3.3.2",
        "Punches with a < a0/k reach the strength when fast",
        1.0,
        _narrow,
        (0.75, 1.0),
        Verdict.CORRECTED,
        "nearly: at a = 5 a0 a cohesive zone of its own length is left at the edge",
    ),
    Claim(
        "ligament",
        "Sec. 3.5.2, Fig. 3.7",
        "The crack has run before the pull-off, farther in thicker layers",
        "a_c < a",
        _ligament,
        (0.7, 0.9),
        Verdict.HOLDS,
        "rate 100",
    ),
    Claim(
        "size-limit",
        "Eq. 3.31",
        "The largest Δγ_eff/Δγ0 is (π/4) b/a0",
        0.0,
        _largest,
        (0, 0.06),
        Verdict.CORRECTED,
        "with a_c = a, and for b well below b0/k, where it is rounded off",
    ),
    Claim(
        "full-gain",
        "Fig. 3.9",
        "At b = 32.42 a0 the gain is 1/k",
        1 / K,
        _reaches,
        (9.9, 10.2),
        Verdict.CORRECTED,
        "a chance of that width: narrower punches exceed it, wider ones do not reach it",
    ),
    Claim(
        "greenwood-layer",
        "Eq. 3.35, Fig. 3.9",
        "Greenwood limited by size agrees fairly",
        "fairly good",
        _greenwood,
        (0.1, 0.4),
        Verdict.HOLDS,
        "where the limit is (π/4) b/a0 it is too low at high speed",
    ),
    Claim(
        "persson-layer",
        "App. II, Fig. A.1",
        "Persson-Brener limited by size agrees",
        "good",
        _persson,
        (0.1, 0.4),
        Verdict.HOLDS,
        "as Greenwood's: the two differ by 5 %",
    ),
    Claim(
        "same-gain",
        "Sec. 3.5.2",
        "From slow to fast the gain is the same for all b > b0",
        "the same",
        _gain,
        (2, 4),
        Verdict.FAILS,
        "thin layers end at their strength, as Eq. 3.31 itself says",
    ),
    Claim(
        "bell",
        "Fig. 3.10",
        "The work of separation has a bell over the speed",
        "bell",
        _bell,
        (6, 8),
        Verdict.HOLDS,
        "22 rates over seven decades",
    ),
    Claim(
        "slow-work",
        "Sec. 3.5.2",
        "At low rates there is little dissipation",
        1.0,
        _slow_work,
        (1.1, 1.3),
        Verdict.CORRECTED,
        "the crack runs away at the end, however slow the drive: 20 % are left",
    ),
)
