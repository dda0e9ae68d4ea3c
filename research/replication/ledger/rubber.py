"""Claims of sections 4.6 and 4.7: a glass lens on silicone rubber."""

import numpy as np

from viscotack.theory import persson_brener, rate

from ..figures.cases import LENS, PDMS, PDMS_WORK, K, solid
from ..figures.lens import TIP, V1, measured
from .claim import Measured, Of, listed


def highest(of: Of) -> Measured:
    k = PDMS.modulus_ratio
    here = k * float(persson_brener.amplification(1e9, material=PDMS))
    read = K * float(persson_brener.amplification(1e9, material=solid(K, 0.2)))
    return Measured(
        here, f"{100 * here:.2g} % of 1/k; the curve k = 0.1, n = 0.2 has {100 * read:.0f} %"
    )


def speed_needed(of: Of) -> Measured:
    speeds = [
        float(np.log10(persson_brener.speed(part / PDMS.modulus_ratio, material=PDMS)))
        for part in (0.5, 0.9, 0.95)
    ]
    words = f"log10 v̂ = {listed('{:.2f}', speeds)} for 50, 90, 95 % of 1/k"
    return Measured(speeds[1], words)


def retraction(of: Of) -> Measured:
    reduced = (1e9 / rate.COEFFICIENT) ** (1 / rate.EXPONENT)
    found = reduced * TIP / PDMS.tau0
    return Measured(found, f"{found:.2f} m/s")


def radius_needed(of: Of) -> Measured:
    a = (1.5 / PDMS.modulus_ratio / 0.3) ** (1 / 2.7)
    unit = (np.pi * LENS**2 * PDMS_WORK / PDMS.contact_modulus) ** (1 / 3)
    return Measured(1e3 * a * unit, f"â = {a:.1f}, {1e3 * a * unit:.2f} mm beside R = 5.19 mm")


def _off(of: Of, name: str, beside: str) -> tuple[np.ndarray, np.ndarray]:
    n = of("4.10")
    i = n["range"].index(name)
    return n["force"][i] / n[beside] - 1, n["error"][i]


def short(of: Of) -> Measured:
    off, error = _off(of, "30.8 nm", "linear")
    n = of("4.10")
    i = n["range"].index("30.8 nm")
    return Measured(
        float(off[0]),
        f"{n['force'][i][0]:.2f} ± {100 * np.nanmax(error):.1g} % mN at 1 µm/s, thesis "
        f"{n['linear'][0]:.2f}; {100 * np.min(off):+.0f} to {100 * np.max(off):+.0f} % over the "
        "series",
    )


def ratio_axis(of: Of) -> Measured:
    off = {}
    for name in ("30.8 nm", "200 nm"):
        beside = 1 / (1 + _off(of, name, "linear")[0]) - 1
        off[name] = f"{100 * np.min(beside):+.0f} to {100 * np.max(beside):+.0f} % with {name}"
    printed = 1 + np.sqrt(of("4.10")["linear_crack_speed"] / V1)
    return Measured(
        float(1 / (1 + _off(of, "30.8 nm", "linear")[0][0]) - 1),
        f"beside the printed {printed[0]:.2f} to {printed[-1]:.2f}: {', '.join(off.values())}",
    )


def middle(of: Of) -> Measured:
    off, error = _off(of, "200 nm", "linear")
    return Measured(
        float(np.max(np.abs(off))),
        f"{100 * np.min(off):+.1f} to {100 * np.max(off):+.1f} % at nine speeds (errors below "
        f"{100 * np.nanmax(error):.1g} %)",
    )


def quasi_static(of: Of) -> Measured:
    off, _ = _off(of, "1.55 um", "linear")
    return Measured(
        float(off[-1]), f"{100 * off[0]:+.0f} % at 1 µm/s, {100 * off[-1]:+.0f} % at 1000 µm/s"
    )


def twice(of: Of) -> Measured:
    n = of("limits")["lens"]
    off = n["simulated"] / n["crack"] - 1
    pairs = listed("{:.2f}/{:.2f}", n["simulated"], n["crack"])
    return Measured(
        float(np.max(np.abs(off))),
        f"{pairs} mN simulated/steady crack at 1, 10, 100, 1000 µm/s (band "
        f"{100 * np.max(n['band']):.1g} %)",
    )


def crack_speed(of: Of) -> Measured:
    n = of("4.10")
    i = n["range"].index("30.8 nm")
    ratio = n["crack_speed"][i] / n["linear_crack_speed"]
    return Measured(
        float(np.max(ratio)), f"cracks run {np.min(ratio):.1f} to {np.max(ratio):.1f} times as fast"
    )


def limit(of: Of) -> Measured:
    n = of("4.10")
    above = {}
    for name, force in zip(n["range"], n["force"], strict=True):
        above[name] = 1e6 * n["speed"][n["measured"] / force > 1.15]
    words = ", ".join(
        f"{f'{v[0]:.2g} µm/s' if v.size else 'none'} for {name.replace('um', 'µm')}"
        for name, v in above.items()
    )
    return Measured(float(above["200 nm"][0]), f"measured 15 % above simulated from: {words}")


def doubling(of: Of) -> Measured:
    v = V1
    linear = float(persson_brener.amplification(v * PDMS.tau0 / TIP, material=PDMS))
    ratio = float(measured(v)) / linear
    return Measured(
        ratio, f"{ratio:.2f} with Eq. 4.21 and l0 = 30.0 nm in its place; 2 by the printed fit"
    )


def reading(of: Of) -> Measured:
    n = of("4.9")["simulated"]
    words = "; ".join(
        f"μ = {p['tabor']:.3g} is read as {p['carpick']['tabor']:.2g} and "
        f"{p['carpick']['work_of_adhesion']:.3f} J/m²"
        for p in n.values()
    )
    return Measured(float(n["1.55 um"]["carpick"]["tabor"]), f"simulated: {words}")


def slow_enough(of: Of) -> Measured:
    n = of("4.9")["simulated"]
    ratio = {
        name: float(p["pull_off_force"] / p["elastic_pull_off_force"]) for name, p in n.items()
    }
    words = listed("{:.2f} ({})", ratio.values(), ratio).replace("um", "µm")
    return Measured(ratio["200 nm"], f"{words} of the elastic force at 0.98 µm/s")


def exponent(of: Of) -> Measured:
    n = of("gent-schultz")
    v = 1e6 * n["speed"]
    inside = (v >= 1) & (v <= 1000)
    light, heavy = (n[name]["exponent"][inside] for name in ("1.5 mN", "150 mN"))
    close = 1e6 * float(np.interp(0.27, heavy, n["speed"][inside]))
    return Measured(
        float(np.max(heavy)),
        f"{np.min(light):.2f} to {np.max(light):.2f} from 1.5 mN at 1 to 1000 µm/s, "
        f"{np.min(heavy):.2f} to {np.max(heavy):.2f} from 150 mN, 0.27 at {close:.0f} µm/s",
    )


def arms(of: Of) -> Measured:
    n = of("4.8")
    inside = n["frequency"] < 1e15
    off = [
        float(np.max(np.abs(n[f"arms_{x}"][inside] / n[x][inside] - 1)))
        for x in ("storage", "loss")
    ]
    return Measured(
        off[1],
        f"18 arms follow the power law within {100 * off[0]:.0f} % (E′), {100 * off[1]:.0f} % (E″)",
    )


def pinned(of: Of) -> Measured:
    n = of("printed-algorithm")
    off = n["force"] / n["expected"]
    words = "; ".join(
        f"N = {nodes:g}: {listed('{:.4g}', row)}"
        for nodes, row in zip(n["nodes"], off, strict=True)
    )
    at = listed("{:g}", n["tabor"])
    return Measured(
        float(np.min(off[:, -1])),
        f"{words} times the elastic force at μ = {at} (below 1: given up)",
    )
