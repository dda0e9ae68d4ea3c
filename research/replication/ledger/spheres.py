"""Claims of chapter 4 and of appendices IV, VIII and IX: a sphere on a half-space."""

from __future__ import annotations

import numpy as np

from viscotack.theory import persson_brener

from ..figures import figure_4_5, figure_4_6, figure_4_7
from ..figures.cases import ALPHA, CHAPTER_4, TABOR, K, elastic_ratio, solid
from .claim import Claim, Measured, Of, Verdict


def _slow(of: Of) -> Measured:
    n = of("limits")
    at = {float(mu): float(f) for mu, f in zip(n["tabor"], n["slow"], strict=True)}
    words = ", ".join(f"{f:.4f} at μ = {mu:g}" for mu, f in at.items())
    return Measured(at[3.24], f"{words} (errors below {100 * np.nanmax(n['slow_error']):.1g} %)")


def _slow_twice(of: Of) -> Measured:
    n = of("limits")
    crept, elastic = float(n["slow_viscoelastic"]), float(elastic_ratio(TABOR))
    return Measured(
        crept / elastic, f"{crept:.4f} viscoelastic at rate 1e-4, {elastic:.4f} elastic table"
    )


def _fast(of: Of) -> Measured:
    n = of("limits")
    words = ", ".join(f"{f:.4f} from {d:g} h0" for d, f in zip(n["depth"], n["fast"], strict=True))
    return Measured(
        float(n["fast"][-1]), f"{words}; theory {float(n['fast_theory']):.4f} for k P/P_JKR"
    )


def _dmt(of: Of) -> Measured:
    n = of("5.8")
    top = float(np.max(n["simulated"][0, 0]))
    return Measured(K * top, f"{K * top:.3f} at μ = 0.05 from 150 h0, rate 1e8; limit 4/3")


def _alpha(of: Of) -> Measured:
    n = of("alpha")
    i = int(np.argmin(np.abs(n["modulus_ratio"] - K)))
    found = {name: float(n[name]["alpha"][i]) for name in ("as it is", "over f", "steady")}
    return Measured(
        found["over f"],
        f"{found['over f']:.3f} ± {found['over f'] * float(n['over f']['left'][i]):.3f} of the "
        f"force over f(μ), {found['as it is']:.3f} as it is, {found['steady']:.3f} of the steady "
        "crack",
    )


def _alpha_by_k(of: Of) -> Measured:
    n = of("alpha")
    words = ", ".join(
        f"{a:.3f} (k = {k:g})"
        for k, a in zip(n["modulus_ratio"], n["over f"]["alpha"], strict=True)
    )
    spread = float(np.ptp(n["over f"]["alpha"]) / ALPHA)
    return Measured(spread, words)


def _alpha_steady(of: Of) -> Measured:
    n = of("alpha")
    words = ", ".join(
        f"{a:.3f} (k = {k:g})"
        for k, a in zip(n["modulus_ratio"], n["steady"]["alpha"], strict=True)
    )
    return Measured(float(n["steady"]["alpha"][4]), words)


def _agreement(of: Of) -> Measured:
    n = of("4.6")
    off = np.concatenate([figure_4_6.off(n, name) for name in n["simulated"]])
    return Measured(
        float(np.max(np.abs(off))),
        f"{100 * np.min(off):+.1f} to {100 * np.max(off):+.1f} %, five solids, k = 0.1",
    )


def _steady(of: Of) -> Measured:
    n = of("4.6")
    ratio = [
        n["theory"][name]["persson_brener"] / n["theory"][name]["steady"] - 1
        for name in n["simulated"]
    ]
    most, least = float(np.max(ratio)), float(np.min(ratio))
    return Measured(
        most, f"Persson-Brener {100 * least:+.1f} to {100 * most:+.1f} % of the steady crack"
    )


def _range_correction(of: Of) -> Measured:
    n = of("4.6")
    off = []
    for name, some in n["simulated"].items():
        ratio = elastic_ratio(TABOR * some["energy"] ** (-1 / 3))
        off.append((1 + figure_4_6.off(n, name, "steady")) / ratio - 1)
    every = np.concatenate(off)
    slow = np.concatenate(
        [o[s["energy"] < 5] for o, s in zip(off, n["simulated"].values(), strict=True)]
    )
    return Measured(
        float(np.max(np.abs(slow))),
        f"{100 * np.min(slow):+.1f} to {100 * np.max(slow):+.1f} % for Γ < 5, "
        f"{100 * np.min(every):+.1f} % at worst, near 1/k",
    )


def _standard(of: Of) -> Measured:
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


def _spectrum(of: Of) -> Measured:
    n = of("4.3")["exponent"]
    forces = [float(c["pull_off_force"]) for c in n["curves"]]
    words = ", ".join(f"{f:.3f}" for f in forces)
    return Measured(forces[-1] / forces[0], f"P̂ = {words} for n = 0.6, 0.8, 1.6")


def _speed_fit(of: Of) -> Measured:
    n = of("4.7")
    k01 = n["modulus_ratio"] == K
    ratio, at = n["speed"] / n["fitted_speed"], n["speed"][k01] / n["fitted_speed"]
    return Measured(
        float(np.nanmax(at)),
        f"{np.nanmin(at):.2f} to {np.nanmax(at):.1f} times the fit at k = 0.1, "
        f"{np.nanmin(ratio):.2f} to {np.nanmax(ratio):.0f} from k = 0.01 on",
    )


def _refitted(of: Of) -> Measured:
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


def _tangents(of: Of) -> Measured:
    n = of("4.6")["tangent"]
    words = "; ".join(f"{b:.2f}, {m:.2f} (n = {e})" for e, (b, m) in n.items())
    return Measured(float(n["1.6"][1]), f"β, m = {words}")


def _within(of: Of, k: float) -> Measured:
    off = figure_4_7.of_ratio(of("4.7"), k)
    share = 100 * float(np.mean(np.abs(off) <= 0.15))
    return Measured(
        share,
        f"{share:.0f} % of {off.size} cases; predicted {100 * np.min(off):+.0f} to "
        f"{100 * np.max(off):+.0f} %",
    )


def _within_01(of: Of) -> Measured:
    return _within(of, 0.1)


def _within_001(of: Of) -> Measured:
    return _within(of, 0.01)


def _threshold(of: Of) -> Measured:
    factor, slope, _ = figure_4_5.power_law(of("4.5"))
    return Measured(slope, f"{factor:.2f} a^{slope:.2f} by the rule of slope 0.1")


def _collapse(of: Of) -> Measured:
    _, _, scatter = figure_4_5.power_law(of("4.5"))
    return Measured(scatter, f"they do, with a scatter of {100 * scatter:.0f} % of the force")


def _threshold_radius(of: Of) -> Measured:
    n = of("4.5")
    a, force = np.ravel(n["threshold"]), np.ravel(n["force_at_threshold"])
    rising = np.isfinite(a) & (force > 1.3 * CHAPTER_4) & (force < 0.8 * CHAPTER_4 / K)
    off = (force[rising] / 0.3) ** (1 / 2.7) / a[rising] - 1
    return Measured(
        100 * float(np.median(off)),
        f"its radii are {100 * np.min(off):.0f} to {100 * np.max(off):.0f} % too large, "
        f"{100 * np.median(off):.0f} % in the median",
    )


def _preload_lowers(of: Of) -> Measured:
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


def _above(of: Of) -> Measured:
    n = of("4.5")
    top = float(np.nanmax(n["force"]))
    bound = CHAPTER_4 / K * float(elastic_ratio(TABOR * K ** (1 / 3)))
    return Measured(top, f"P̂ up to {top:.2f}; limit 1.5 f(μk^(1/3))/k = {bound:.2f}")


def _start(of: Of) -> Measured:
    n = of("4.4")
    top = np.nanmax(n["force"], axis=1)
    words = ", ".join(f"{f:.2f} from {a:g}" for a, f in zip(n["start"], top, strict=True))
    return Measured(float(top[0]), f"largest P̂ {words}")


def _slow_coefficient(of: Of) -> Measured:
    v = 1e-6
    worst = 0.0
    for n in (0.2, 0.6, 1.6):
        gain = float(persson_brener.amplification(v, material=solid(K, n))) - 1
        worst = max(worst, (-0.0125 + 3.136 * n) / (gain / v) - 1)
    return Measured(
        100 * worst, f"exact: πn(1 − k); printed up to {100 * worst:.0f} % too high at k = 0.1"
    )


def _second_law(of: Of) -> Measured:
    n = of("A.3")
    words = ", ".join(
        f"{m:.2f} (n = {e:g})" for e, m in zip(n["exponent"], n["m2_fitted_small_k"], strict=True)
    )
    return Measured(
        float(n["m2_fitted_small_k"][-1]),
        f"{words}, k = 1e-4, v̂ from 1 to 1000; limit n/(1 + n) or 1/2",
    )


def _upper(of: Of) -> Measured:
    n = of("A.7")
    fast = float(np.max(n["simulated"][n["simulated_rate"] >= 0.999e3]) / n["glassy"])
    return Measured(fast, f"at most {fast:.2f} of Eq. 43 at rates from 1e3 on")


def _upper_between(of: Of) -> Measured:
    n = of("A.7")
    i = int(np.nanargmax(n["simulated"]))
    top = float(n["simulated"][i])
    return Measured(
        top / float(n["glassy"]),
        f"{top:.1f} ± {100 * float(n['error'][i]):.1g} % at rate {n['simulated_rate'][i]:.3g}, "
        f"where Eq. 43 is {n['glassy']:.1f}",
    )


def _upper_fast(of: Of) -> Measured:
    n = of("A.6")
    ratio = n["simulated"] / n["estimate"]
    words = ", ".join(f"{r:.2f} (μ = {mu:g})" for mu, r in zip(n["tabor"], ratio, strict=True))
    return Measured(float(np.max(ratio)), f"{words} of Eq. 43 at rate 1e5")


def _lower(of: Of) -> Measured:
    n, slow = of("work-bound"), of("A.7")
    ends = float(np.nanmin(slow["simulated"])) / float(slow["rubbery"])
    return Measured(
        ends,
        f"{ends:.2f} of Eq. 46 at rate 0.01 from 73 h0; but {n['rows_below_eq_46']} of "
        f"{n['rows']} rows from shallow starts are below, down to {n['least_over_eq_46']:.2f}",
    )


def _bound(of: Of) -> Measured:
    n = of("work-bound")
    soft, middle, _, stiff = n["largest_by_ratio"]
    return Measured(
        float(n["largest_short"]),
        f"in {n['short_rows']} rows with μk^(1/3) > 1 at most {stiff:.2f} of it at k ≥ 0.3, "
        f"{middle:.2f} at k of 0.05 to 0.2, {soft:.2f} below; "
        f"long ranges leave it (μk^(1/3) = {n['largest_at_tabor']:.2g}: {n['largest']:.1f})",
    )


OWN = (
    Claim(
        "upper-bound-between",
        "App. VIII (43)",
        "Between slow and fast the work may exceed the bound of the fast end",
        "not asked",
        _upper_between,
        (2, 3),
        Verdict.HOLDS,
        "μ = 3.2, k = 0.1, n = 1.6 from 73 h0, where the thesis draws it for fast rates alone",
    ),
    Claim(
        "bound-at-all-rates",
        "derived here",
        "W ≤ 1.1569 μπ^(2/3) k^(−5/3) at every rate",
        "none",
        _bound,
        (0.1, 1.0),
        Verdict.HOLDS,
        "for short range, proven below",
    ),
)

CLAIMS = (
    Claim(
        "slow-limit",
        "Sec. 4.5",
        "Slowly, P_po/P_JKR → 1",
        1.0,
        _slow,
        (1.030, 1.032),
        Verdict.CORRECTED,
        "→ f(μ), the elastic force at the range of the law",
    ),
    Claim(
        "slow-twice",
        "Sec. 4.3",
        "Slow retraction is elastic",
        1.0,
        _slow_twice,
        (0.999, 1.001),
        Verdict.HOLDS,
        "a viscoelastic march beside the elastic table",
    ),
    Claim(
        "fast-limit",
        "Sec. 4.4.1",
        "The largest P_po is P_JKR/k",
        1.0,
        _fast,
        (1.06, 1.08),
        Verdict.CORRECTED,
        "f(μk^(1/3)) times it, by superposition; from 73 h0 it is not reached yet",
    ),
    Claim(
        "dmt-limit",
        "Fig. 5.8",
        "Small Tabor numbers end at 4/(3k)",
        4 / 3,
        _dmt,
        (1.25, 1.34),
        Verdict.HOLDS,
        "approached from below with the depth",
    ),
    Claim(
        "exceeds",
        "Fig. 4.5",
        "P̂ saturates at 1.5/k",
        CHAPTER_4 / K,
        _above,
        (15.2, 16.2),
        Verdict.CORRECTED,
        "it exceeds it, by up to f(μk^(1/3))",
    ),
    Claim(
        "start",
        "Fig. 4.4",
        "A small start keeps the force from the full amplification",
        15.0,
        _start,
        (9, 13),
        Verdict.HOLDS,
        "n = 0.8; Fig. 4.4",
    ),
    Claim(
        "spectrum",
        "Sec. 4.4.1",
        "At a given rate the force grows with n",
        "> 1",
        _spectrum,
        (1.2, 2.5),
        Verdict.HOLDS,
        "at rate 10^2.5, start 3.61",
    ),
    Claim(
        "alpha",
        "Sec. 4.5",
        "α = π/9 makes Persson-Brener agree with the simulations",
        ALPHA,
        _alpha,
        (0.33, 0.37),
        Verdict.HOLDS,
        "least squares of ln Γ over nine rates, k = 0.1, n = 0.8",
    ),
    Claim(
        "alpha-by-k",
        "Sec. 4.5",
        "…at every k",
        0.0,
        _alpha_by_k,
        (0, 0.35),
        Verdict.CORRECTED,
        "nearly, if the force is divided by f(μ)",
    ),
    Claim(
        "alpha-steady",
        "Sec. 4.5",
        "α is a property of the law of forces",
        ALPHA,
        _alpha_steady,
        (0.3, 0.36),
        Verdict.CORRECTED,
        "without finite range and without fit, the steady crack has its own α for each k",
    ),
    Claim(
        "agreement",
        "Fig. 4.6",
        "Persson-Brener agrees excellently with the simulations",
        0.0,
        _agreement,
        (0, 0.06),
        Verdict.HOLDS,
        "errors of simulation below 0.1 %",
    ),
    Claim(
        "persson-steady",
        "Fig. 4.6",
        "…because it is right",
        0.0,
        _steady,
        (0.06, 0.12),
        Verdict.CORRECTED,
        "it is too high in between; at μ = 3.24 the finite range makes up for it: see below",
    ),
    Claim(
        "range",
        "Sec. 4.5",
        "At μ = 3.24 the contact is in the JKR limit",
        0.0,
        _range_correction,
        (0, 0.03),
        Verdict.CORRECTED,
        "the steady crack, times f(μΓ^(−1/3)) for the finite zone, meets the simulations instead",
    ),
    Claim(
        "standard-solid",
        "Sec. 4.2, 4.5",
        "A standard solid is close to n = 1.6",
        0.0,
        _standard,
        (0.06, 0.1),
        Verdict.HOLDS,
        "k = 0.1",
    ),
    Claim(
        "speed-fit",
        "Eq. 4.24",
        "The crack speed is 2.887 r̂^1.171 over ten decades",
        1.0,
        _speed_fit,
        (2, 15),
        Verdict.CORRECTED,
        "an order of magnitude, and in the rate of the authors' script",
    ),
    Claim(
        "speed-fit-again",
        "Eq. 4.24",
        "…its exponent",
        1.171,
        _refitted,
        (1.1, 1.35),
        Verdict.HOLDS,
        "a fit of our own crack speeds, k = 0.01 to 0.1; its points are not the thesis's",
    ),
    Claim(
        "tangents",
        "Fig. 4.6, inset",
        "In between Γ = β v̂^m",
        "not printed",
        _tangents,
        (0.3, 0.5),
        Verdict.OPEN,
        "the values of the inset are not printed; here those of the steepest tangent at k = 0.1",
    ),
    Claim(
        "within-15-percent",
        "Fig. 4.7",
        "It gives P_po within 15 % for k = 0.1 [% of cases]",
        100.0,
        _within_01,
        (85, 100),
        Verdict.HOLDS,
        "44 cases, rates 0.3 to 3e6, large starts",
    ),
    Claim(
        "within-15-percent-small-k",
        "Fig. 4.7",
        "…and for k = 0.01 [% of cases]",
        100.0,
        _within_001,
        (40, 80),
        Verdict.FAILS,
        "the crack speed at pull-off depends on k, and the fit does not",
    ),
    Claim(
        "threshold",
        "Fig. 4.5",
        "The threshold is P̂ = 0.3 a^2.7",
        2.7,
        _threshold,
        (2.0, 2.4),
        Verdict.FAILS,
        "by the thesis's own rule, on 36 forces by start",
    ),
    Claim(
        "threshold-radius",
        "Fig. 4.5",
        "…and says how far to press [%]",
        0.0,
        _threshold_radius,
        (30, 60),
        Verdict.CORRECTED,
        "on the safe side: one presses farther than needed",
    ),
    Claim(
        "collapse",
        "Fig. 4.5",
        "Thresholds of all n collapse",
        0.0,
        _collapse,
        (0.05, 0.2),
        Verdict.HOLDS,
        "by force, not by rate",
    ),
    Claim(
        "preload",
        "Sec. 4.4.1",
        "With the start the force grows to a plateau [%]",
        0.0,
        _preload_lowers,
        (-16, -8),
        Verdict.CORRECTED,
        "it has a maximum: a larger contact takes longer, its bulk creeps, and the edge is slower",
    ),
    Claim(
        "slow-coefficient",
        "App. IV",
        "Γ − 1 → (−0.0125 + 3.136 n) v̂ [%]",
        0.0,
        _slow_coefficient,
        (8, 12),
        Verdict.CORRECTED,
        "πn(1 − k), exact: the fit is that of k → 0",
    ),
    Claim(
        "second-law",
        "App. IV",
        "Beyond, Γ − 1 ∝ v̂^m2 with m2 = 0.5 at n = 1.6",
        0.5,
        _second_law,
        (0.45, 0.55),
        Verdict.HOLDS,
        "the values of the inset for broad spectra are not printed",
    ),
    Claim(
        "upper-bound",
        "App. VIII (43)",
        "(4/3) a_po² π^(2/3) μ bounds the work from above at fast rates",
        1.0,
        _upper,
        (0.6, 1.0),
        Verdict.HOLDS,
        "it is drawn from a rate of 1e3 on; no bound between (`upper-bound-between`)",
    ),
    Claim(
        "upper-bound-fast",
        "Fig. A.6",
        "…at rate 1e5",
        1.0,
        _upper_fast,
        (0.9, 1.0),
        Verdict.HOLDS,
        "with the printed radii; nothing proves it",
    ),
    Claim(
        "lower-bound",
        "App. IX (46)",
        "0.80182 μπ^(2/3) bounds the work from below",
        1.0,
        _lower,
        (1.0, 1.3),
        Verdict.CORRECTED,
        "from starts deep enough; slowly it is 0.80182 times its range factor",
    ),
)
