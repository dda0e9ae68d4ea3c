"""Claims of chapter 3: a punch on a layer."""

import numpy as np

from ..figures.cases import SIZE as HALF_WIDTH
from .claim import Measured, Of, listed

_B0, _B1 = 4 / np.pi, 4 / np.pi * HALF_WIDTH


def history(of: Of) -> Measured:
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


def history_of_a_sphere(of: Of) -> Measured:
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


def slow_slope(of: Of) -> Measured:
    found = [_slope(of, i) for i in range(4)]
    words = f"{listed('{:.2f}', found)} at rates 0.1, 1, 10, 100 (3 b0 < b < b1/3)"
    return Measured(found[0], words)


def fast_slope(of: Of) -> Measured:
    found = _slope(of, 3)
    return Measured(found, f"{found:.2f} at rate 100 between 3 b0 and b1/3")


def between(of: Of) -> Measured:
    n = of("3.6")
    above = float(np.max(n["stress"] / n["fast"][:, None])) - 1
    below = float(np.min(n["stress"] / n["slow"][:, None])) - 1
    return Measured(
        1e3 * max(above, -below),
        f"+{1e3 * above:.1f} ‰ of the fast, {1e3 * below:.1f} ‰ of the slow one at most",
    )


def strength(of: Of) -> Measured:
    n = of("3.6")
    thin = n["thickness"] < 0.5 * _B0
    near = (n["thickness"] > 0.8 * _B0) & (n["thickness"] < _B0)
    least, there = float(np.min(n["stress"][thin])), float(np.min(n["stress"][near]))
    return Measured(least, f"{least:.4f} up to b0/2, {there:.3f} close to b0 at rate 0.1")


def plateau(of: Of) -> Measured:
    n = of("3.6")
    at = np.array(
        [np.exp(np.interp(np.log(_B1), np.log(n["thickness"]), np.log(s))) for s in n["stress"].T]
    )
    ratio = at / n["stress"][-1]
    words = f"{listed('{:.2f}', ratio)} times the stress at b = 10 a, by rate"
    return Measured(float(ratio[0]), words)


def envelope(of: Of) -> Measured:
    exact = float(of("3.3")["exact_over_envelope_at_b1"])
    n = of("limits")
    simulated, theory = n["at_b1_limit"], n["at_b1_exact"]
    return Measured(
        exact,
        f"{exact:.4f} times the envelope, exact; simulated, extrapolated to small zones, "
        f"{100 * (simulated / theory - 1):+.2f} %",
    )


def narrow(of: Of) -> Measured:
    slow, fast = of("limits")["narrow_punch"]
    return Measured(fast, f"{fast:.3f} at rate 1e4, {slow:.3f} at 0.01 (a = 5 a0, b = 50 a0)")


def ligament_left(of: Of) -> Measured:
    found = {name: float(part["ligament"]) for name, part in of("3.7").items()}
    return Measured(found["10"], listed("{:.2f} at b = {} a", found.values(), found))


def largest(of: Of) -> Measured:
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


def reaches(of: Of) -> Measured:
    n = of("3.9")
    energy = n["inset_energy"][:, -1]
    return Measured(float(energy[1]), listed("{:.2f} for a = {:g} a0", energy, n["inset_size"]))


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


def greenwood(of: Of) -> Measured:
    return _beside(of, "3.9", "greenwood")


def persson(of: Of) -> Measured:
    return _beside(of, "A.1", "persson_brener")


def gain_of_layers(of: Of) -> Measured:
    n = of("3.8")
    gain = n["force"][:, -1] ** 2 / n["force"][:, 0] ** 2
    words = f"σ² rises by {listed('{:.2f}', gain)} for b = 3.24 to 32.42 a0"
    return Measured(float(gain[0]), words)


def bell(of: Of) -> Measured:
    n = of("3.10")
    work = n["separation"]
    top = np.max(work, axis=1)
    slow, fast = work[:, 0], work[:, -1]
    thin, thick = (" / ".join(f"{w[i]:.2f}" for w in (slow, top, fast)) for i in (0, -1))
    words = f"slow / largest / fast: {thin} to {thick} Δγ0 for b = 3.24 to 32.42 a0"
    return Measured(float(top[-1]), words)


def slow_work(of: Of) -> Measured:
    n = of("3.10")
    over = n["separation"][:, 0] / n["elastic"]
    words = f"{listed('{:.2f}', over)} of the elastic work at rate 0.001"
    return Measured(float(over[0]), words)
