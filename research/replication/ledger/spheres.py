"""Claims of chapter 4 and of appendices IV, VIII and IX: a sphere on a half-space."""

import numpy as np

from viscotack.theory import persson_brener

from ..figures import edge_speed, starts
from ..figures.cases import ALPHA, CHAPTER_4, TABOR, K, elastic_ratio, solid
from .claim import Measured, Of, listed


def slow_force(of: Of) -> Measured:
    n = of("limits")
    words = listed("{:.4f} at μ = {:g}", n["slow"], n["tabor"])
    at = float(n["slow"][n["tabor"] == TABOR][0])
    return Measured(at, f"{words} (errors below {100 * np.nanmax(n['slow_error']):.1g} %)")


def slow_twice(of: Of) -> Measured:
    n = of("limits")
    crept, elastic = float(n["slow_viscoelastic"]), float(elastic_ratio(TABOR))
    return Measured(
        crept / elastic, f"{crept:.4f} viscoelastic at rate 1e-4, {elastic:.4f} elastic table"
    )


def fast_force(of: Of) -> Measured:
    n = of("limits")
    words = listed("{:.4f} from {:g} h0", n["fast"], n["depth"])
    return Measured(
        float(n["fast"][-1]), f"{words}; theory {float(n['fast_theory']):.4f} for k P/P_JKR"
    )


def dmt(of: Of) -> Measured:
    n = of("5.8")
    top = float(np.max(n["simulated"][0, 0]))
    return Measured(K * top, f"{K * top:.3f} at μ = 0.05 from 150 h0, rate 1e8; limit 4/3")


def alpha(of: Of) -> Measured:
    n = of("alpha")
    i = int(np.argmin(np.abs(n["modulus_ratio"] - K)))
    found = {name: float(n[name]["alpha"][i]) for name in ("as it is", "over f", "steady")}
    return Measured(
        found["over f"],
        f"{found['over f']:.3f} ± {found['over f'] * float(n['over f']['left'][i]):.3f} of the "
        f"force over f(μ), {found['as it is']:.3f} as it is, {found['steady']:.3f} of the steady "
        "crack",
    )


def alpha_by_k(of: Of) -> Measured:
    n = of("alpha")
    found = n["over f"]["alpha"]
    words = listed("{:.3f} (k = {:g})", found, n["modulus_ratio"])
    return Measured(float(np.ptp(found) / ALPHA), words)


def alpha_steady(of: Of) -> Measured:
    n = of("alpha")
    found = n["steady"]["alpha"]
    return Measured(float(found[4]), listed("{:.3f} (k = {:g})", found, n["modulus_ratio"]))


def agreement(of: Of) -> Measured:
    n = of("4.6")
    off = np.concatenate([edge_speed.off(n, name) for name in n["simulated"]])
    return Measured(
        float(np.max(np.abs(off))),
        f"{100 * np.min(off):+.1f} to {100 * np.max(off):+.1f} %, five solids, k = 0.1",
    )


def steady(of: Of) -> Measured:
    n = of("4.6")
    ratio = [
        n["theory"][name]["persson_brener"] / n["theory"][name]["steady"] - 1
        for name in n["simulated"]
    ]
    most, least = float(np.max(ratio)), float(np.min(ratio))
    return Measured(
        most, f"Persson-Brener {100 * least:+.1f} to {100 * most:+.1f} % of the steady crack"
    )


def range_correction(of: Of) -> Measured:
    n = of("4.6")
    off = []
    for name, some in n["simulated"].items():
        ratio = elastic_ratio(TABOR * some["energy"] ** (-1 / 3))
        off.append((1 + edge_speed.off(n, name, "steady")) / ratio - 1)
    every = np.concatenate(off)
    slow = np.concatenate(
        [o[s["energy"] < 5] for o, s in zip(off, n["simulated"].values(), strict=True)]
    )
    return Measured(
        float(np.max(np.abs(slow))),
        f"{100 * np.min(slow):+.1f} to {100 * np.max(slow):+.1f} % for Γ < 5, "
        f"{100 * np.min(every):+.1f} % at worst, near 1/k",
    )


def standard_solid(of: Of) -> Measured:
    v = np.geomspace(1e-3, 1e5, 400)
    standard = np.asarray(persson_brener.amplification(v, material=solid(K)))
    off = np.asarray(persson_brener.amplification(v, material=solid(K, 1.6))) / standard - 1
    n = of("4.6")["simulated"]
    simulated = n["1.6"]["energy"] / n["0"]["energy"] - 1
    return Measured(
        float(np.max(np.abs(off))),
        f"theory {100 * np.min(off):+.1f} to {100 * np.max(off):+.1f} % at equal crack speed, "
        f"simulation {100 * np.min(simulated):+.1f} to {100 * np.max(simulated):+.1f} % at equal "
        "rate",
    )


def spectrum(of: Of) -> Measured:
    forces = [float(curve["pull_off_force"]) for curve in of("4.3")["exponent"]["curves"]]
    words = f"P̂ = {listed('{:.3f}', forces)} for n = 0.6, 0.8, 1.6"
    return Measured(forces[-1] / forces[0], words)


def speed_fit(of: Of) -> Measured:
    n = of("4.7")
    k01 = n["modulus_ratio"] == K
    ratio, at = n["speed"] / n["fitted_speed"], n["speed"][k01] / n["fitted_speed"]
    return Measured(
        float(np.nanmax(at)),
        f"{np.nanmin(at):.2f} to {np.nanmax(at):.1f} times the fit at k = 0.1, "
        f"{np.nanmin(ratio):.2f} to {np.nanmax(ratio):.0f} from k = 0.01 on",
    )


def refitted(of: Of) -> Measured:
    n = of("4.7")
    rate = np.broadcast_to(n["reduced_rate"], n["speed"].shape)
    known = np.isfinite(n["speed"]) & (n["speed"] > 0)
    x, y = np.log(rate[known]), np.log(n["speed"][known])
    slope, level = np.polyfit(x, y, 1)
    scatter = float(np.exp(np.std(y - level - slope * x)))
    return Measured(
        float(slope),
        f"{np.exp(level):.2f} r̂^{slope:.3f}, with a scatter of a factor {scatter:.1f}, on our "
        "143 cases",
    )


def tangents(of: Of) -> Measured:
    n = of("4.6")["tangent"]
    words = "; ".join(f"{b:.2f}, {m:.2f} (n = {e})" for e, (b, m) in n.items())
    return Measured(float(n["1.6"][1]), f"β, m = {words}")


def _within(of: Of, k: float) -> Measured:
    off = edge_speed.of_ratio(of("4.7"), k)
    share = 100 * float(np.mean(np.abs(off) <= 0.15))
    return Measured(
        share,
        f"{share:.0f} % of {off.size} cases; predicted {100 * np.min(off):+.0f} to "
        f"{100 * np.max(off):+.0f} %",
    )


def within_01(of: Of) -> Measured:
    return _within(of, 0.1)


def within_001(of: Of) -> Measured:
    return _within(of, 0.01)


def threshold(of: Of) -> Measured:
    factor, slope, _ = starts.power_law(of("4.5"))
    return Measured(slope, f"{factor:.2f} a^{slope:.2f} by the rule of slope 0.1")


def collapse(of: Of) -> Measured:
    _, _, scatter = starts.power_law(of("4.5"))
    return Measured(scatter, f"they do, with a scatter of {100 * scatter:.0f} % of the force")


def threshold_radius(of: Of) -> Measured:
    n = of("4.5")
    a, force = np.ravel(n["threshold"]), np.ravel(n["force_at_threshold"])
    rising = np.isfinite(a) & (force > 1.3 * CHAPTER_4) & (force < 0.8 * CHAPTER_4 / K)
    off = (force[rising] / 0.3) ** (1 / 2.7) / a[rising] - 1
    return Measured(
        100 * float(np.median(off)),
        f"its radii are {100 * np.min(off):.0f} to {100 * np.max(off):.0f} % too large, "
        f"{100 * np.median(off):.0f} % in the median",
    )


def preload_lowers(of: Of) -> Measured:
    n = of("4.5")
    j = int(np.argmin(np.abs(n["rate"] - 100)))
    i = int(np.argmin(np.abs(n["exponent"] - 0.8)))
    force = n["force"][i, j]
    top, end = float(np.max(force)), float(force[-1])
    at = float(n["start"][int(np.argmax(force))])
    return Measured(
        100 * (end / top - 1),
        f"P̂ falls from {top:.2f} (start {at:.2f}) to {end:.2f} (start 8): n = 0.8, rate 100",
    )


def above(of: Of) -> Measured:
    n = of("4.5")
    top = float(np.nanmax(n["force"]))
    bound = CHAPTER_4 / K * float(elastic_ratio(TABOR * K ** (1 / 3)))
    return Measured(top, f"P̂ up to {top:.2f}; limit 1.5 f(μk^(1/3))/k = {bound:.2f}")


def start(of: Of) -> Measured:
    n = of("4.4")
    top = np.nanmax(n["force"], axis=1)
    return Measured(float(top[0]), f"largest P̂ {listed('{:.2f} from {:g}', top, n['start'])}")


def slow_coefficient(of: Of) -> Measured:
    v = 1e-6
    worst = 0.0
    for n in (0.2, 0.6, 1.6):
        gain = float(persson_brener.amplification(v, material=solid(K, n))) - 1
        worst = max(worst, (-0.0125 + 3.136 * n) / (gain / v) - 1)
    return Measured(
        100 * worst, f"exact: πn(1 − k); printed up to {100 * worst:.0f} % too high at k = 0.1"
    )


def second_law(of: Of) -> Measured:
    n = of("A.3")
    found = n["m2_fitted_small_k"]
    words = listed("{:.2f} (n = {:g})", found, n["exponent"])
    return Measured(
        float(found[-1]), f"{words}, k = 1e-4, v̂ from 1 to 1000; limit n/(1 + n) or 1/2"
    )


def upper(of: Of) -> Measured:
    n = of("A.7")
    fast = float(np.max(n["simulated"][n["simulated_rate"] >= 0.999e3]) / n["glassy"])
    return Measured(fast, f"at most {fast:.2f} of Eq. 43 at rates from 1e3 on")


def upper_between(of: Of) -> Measured:
    n = of("A.7")
    i = int(np.nanargmax(n["simulated"]))
    top = float(n["simulated"][i])
    return Measured(
        top / float(n["glassy"]),
        f"{top:.1f} ± {100 * float(n['error'][i]):.1g} % at rate {n['simulated_rate'][i]:.3g}, "
        f"where Eq. 43 is {n['glassy']:.1f}",
    )


def upper_fast(of: Of) -> Measured:
    n = of("A.6")
    ratio = n["simulated"] / n["estimate"]
    words = listed("{:.2f} (μ = {:g})", ratio, n["tabor"])
    return Measured(float(np.max(ratio)), f"{words} of Eq. 43 at rate 1e5")


def lower(of: Of) -> Measured:
    n, slow = of("work-bound"), of("A.7")
    ends = float(np.nanmin(slow["simulated"])) / float(slow["rubbery"])
    return Measured(
        ends,
        f"{ends:.2f} of Eq. 46 at rate 0.01 from 73 h0; but {n['rows_below_eq_46']} of "
        f"{n['rows']} rows from shallow starts are below, down to {n['least_over_eq_46']:.2f}",
    )


def bound_at_all_rates(of: Of) -> Measured:
    n = of("work-bound")
    soft, middle, _, stiff = n["largest_by_ratio"]
    return Measured(
        float(n["largest_short"]),
        f"in {n['short_rows']} rows with μk^(1/3) > 1 at most {stiff:.2f} of it at k ≥ 0.3, "
        f"{middle:.2f} at k of 0.05 to 0.2, {soft:.2f} below; "
        f"long ranges leave it (μk^(1/3) = {n['largest_at_tabor']:.2g}: {n['largest']:.1f})",
    )
