"""Numbers and tables of the manuscript: from the package, and from kept JSON that is checked.

A kept number that a quick computation contradicts ends the build (:class:`Stale`).
"""

import csv
import json
from functools import cache
from pathlib import Path

import numpy as np

import viscotack as vt
from research.cases import reduced
from research.replication.second_code.compare import elastic, plane
from viscotack.theory import SteadyCrack, jkr, lennard_jones, maugis

from . import closed_forms
from .quasi_steady import CUT
from .range_cases import groups_of

HERE = Path(__file__).parent
AGREEMENT = HERE.parent / "replication" / "second_code" / "agreement.json"
MEASURED = HERE.parent / "measured_series"
WORK_BOUND = HERE.parent / "replication" / "kept" / "work-bound.json"
OPENING = (0.01, 0.1, 1.0, 10.0, 100.0, 1000.0)
COMPARED = 10.0 ** np.arange(-2, 3.01, 0.25)
SOLIDS = ((0.1, None), (0.01, None), (0.1, 0.6))
# Effective Tabor numbers between which errors are summed up.
BINS = ((2.0, 3.0), (3.0, 5.0), (5.0, 9.0))
# Energies, over 1 and times k, between which neither the elastic nor the glassy tail dominates.
MOVING, NOT_GLASSY = 1.6, 0.8
# The first draw that was simulated after these limits and the derived factor were settled.
FRESH = 49
# What the measured series has of each force.
_RATIOS = ("ratio", "error", "matched_low", "matched_high", "published_low", "published_high")
_RATIOS += ("no_loss",)


class Stale(Exception):
    """A kept number differs from its recomputation."""


@cache
def kept(name):
    """Return a kept JSON by name."""
    path = {"agreement": AGREEMENT, "work-bound": WORK_BOUND}.get(name)
    return json.loads((path or HERE / "kept" / f"{name}.json").read_text("utf-8"))


@cache
def crack(modulus_ratio, exponent=None):
    """Return the steady cracks of a solid with the Lennard-Jones law."""
    return SteadyCrack(reduced(modulus_ratio, exponent), vt.LennardJones(1.0, 1.0))


def check(name, old, new, tolerance):
    """Raise if a kept number and its recomputation differ by more than a relative tolerance."""
    if abs(new - old) > tolerance * abs(old):
        raise Stale(f"{name}: kept {old:.8g}, computed {new:.8g}; renew the kept file")


def checked():
    """Recompute in seconds what is kept, and return how many numbers were compared."""
    count = 0
    for row in kept("agreement")["plane"]:
        own = crack(row["modulus_ratio"], row["exponent"]).at(row["speed"])
        check(f"energy at {row['speed']}", row["package"], own.amplification, 2e-6)
        count += 1
    again = plane(0.1, None, (1.0,), elements=110, degree=14, step=0.5)[0]
    (row,) = (
        r
        for r in kept("agreement")["plane"]
        if (r["modulus_ratio"], r["exponent"], r["speed"]) == (0.1, None, 1.0)
    )
    check("energy by the second code", row["energy"], again["energy"], 2e-4)
    row = kept("agreement")["elastic"][0]
    check("elastic sphere", row["force"], elastic(row["tabor"])["force"], 1e-6)
    for row in kept("agreement")["elastic"]:
        own = float(lennard_jones.pull_off_ratio(row["tabor"]))
        check(f"elastic table at {row['tabor']}", row["package"], own, 1e-7)
    cases = {case["i"]: case for case in kept("range_cases")["rows"]}
    rows = kept("range_factor")["rows"]
    for row in rows[:: len(rows) // 6]:
        case = cases[row["i"]]
        force = vt.crack_contact(groups_of(case)).pull_off_force
        check(f"contact {row['i']}", case["contact"], force, 1e-5)
        count += 1
    for row in kept("quasi_steady")["rows"]:
        check("rule", row["rule"], float(lennard_jones.pull_off_ratio(row["effective"])), 1e-6)
        count += 1
    unit = float(jkr.work_to_instability(radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0))
    unit /= 1.5 * np.pi * np.pi ** (2 / 3)
    check("unit of the work bound", kept("work-bound")["numbers"]["unit"], unit, 1e-4)
    return count + 2 + len(kept("agreement")["elastic"])


def trajectory(row):
    """Return the factor by which the motion of the edge changes a first-order correction."""
    g, n = row["g"], row["n"]
    return 2 / (2 + g + (1 - g) * g / n)


def coefficient(row, cut=1.0, terms="gn"):
    """Return the derived first-order coefficient of a row, over its size Gamma lambda/a.

    ``cut`` multiplies the radius up to which the tail counts; ``terms`` are those beside geometry.
    """
    T = row["T"] + row["growth"] * np.log(cut)
    return trajectory(row) * (T + sum(row[x] * row[f"T_{x}"] for x in terms))


def bounded(first):
    """Return the factor that a first-order part gives, with the limit 4/3 of rigid bodies."""
    return 1 + first / (1 + 3 * first)


def dugdale(strength):
    """Return l/a and (f - 1) a/l of Maugis' solution at a strength, radius and energy being 1."""
    case = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
    force = float(maugis.pull_off_force(**case, strength=strength)) / (1.5 * np.pi)
    size = np.pi / (4 * strength**2) / (9 * np.pi / 8) ** (1 / 3)
    return size, (force - 1) / size


def factors(cut=1.0):
    """Return arrays of the simulated spheres: effective Tabor number, size, factors, and masks."""
    rows = kept("range_factor")["rows"]
    first = np.array([coefficient(row, cut) * row["size"] for row in rows])
    energy = np.array([row["energy"] for row in rows])
    k = np.array([row["k"] for row in rows])
    return {
        "effective": np.array([row["effective"] for row in rows]),
        "size": np.array([row["size"] for row in rows]),
        "simulated": np.array([row["simulated"] for row in rows]),
        "rule": np.array([row["package"] for row in rows]),
        "first": 1 + first,
        "geometry": 1 + np.array([trajectory(row) * row["T"] * row["size"] for row in rows]),
        "glassy": energy * k >= NOT_GLASSY,
        "fresh": np.array([row["i"] >= FRESH for row in rows]),
        "bounded": bounded(first),
        "inside": (energy > MOVING) & (energy * k < NOT_GLASSY),
        "energy": energy,
    }


def table(head, rows):
    """Return a table in Markdown from its head and rows, whose cells are apart by `|`."""
    lines = [f"| {head} |", "|---" * (head.count("|") + 1) + "|", *(f"| {row} |" for row in rows)]
    return "\n".join(lines) + "\n"


def measured():
    """Return the table of the measured series beside its predictions."""
    lines = []
    with (MEASURED / "comparison.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for name, word in (("pull_off", "pull-off"), ("jump_in", "jump-in")):
        for row in rows:
            of = {key: float(row[f"{name}_{key}"]) for key in _RATIOS}
            bands = (
                f"{of[f'{kind}_low']:.3f} to {of[f'{kind}_high']:.3f}"
                for kind in ("matched", "published")
            )
            lines.append(
                f"{row['solid']}, {row['protocol']}, {float(row['speed_nm_per_s']):.3g} nm/s "
                f"| {word} | {of['ratio']:.3f} ± {of['error']:.3f} | {' | '.join(bands)} "
                f"| {of['no_loss']:.3f}"
            )
    head = "silicone, speed | force | measured | matched spectra | published spectrum | no loss"
    return table(head, lines)


def _percent(x, digits=1):
    return f"{100 * x:.{digits}f} %"


def _signed(x, digits=1):
    return f"{100 * x:+.{digits}f} %".replace("-", "−")


def _span(x):
    return f"{_signed(x.min())} to {_signed(x.max())}"


def tables():
    """Return tables in Markdown by name."""
    found = {}
    lines = []
    for k, n in SOLIDS:
        name = f"standard solid, k = {k:g}" if n is None else f"power law n = {n:g}, k = {k:g}"
        for sign, word in ((1, "opening"), (-1, "closing")):
            values = np.asarray(crack(k, n).amplification(sign * np.array(OPENING)))
            lines.append(" | ".join([f"{name}, {word}", *(f"{x:.4g}" for x in values)]))
    found["energies"] = table(" | ".join(["V", *(f"{v:g}" for v in OPENING)]), lines)
    lines = []
    for k, n in SOLIDS:
        name = f"standard, k = {k:g}" if n is None else f"n = {n:g}, k = {k:g}"
        for form in closed_forms.FORMS:
            length = closed_forms.length_of_strength(form, crack(k, n).traction.reduced().strength)
            off = closed_forms.deviations(form, COMPARED, crack(k, n), length)
            best, left = closed_forms.best_length(form, COMPARED, crack(k, n))
            lines.append(f"{name} | {form} | {_span(off)} | {best / length:.2f} | {_percent(left)}")
    found["closed_forms"] = table(
        "solid | form | deviation with the length of the strength | best length over it "
        "| deviation left",
        lines,
    )
    lines = []
    for row in kept("agreement")["plane"]:
        n = row["exponent"]
        name = "standard" if n is None else f"n = {n:g}"
        lines.append(
            f"{name}, k = {row['modulus_ratio']:g} | {row['speed']:g} | {row['energy']:.5g} "
            f"| {row['package']:.5g} | {row['energy_off']:.0e} | {row['gap_off']:.0e} "
            f"| {row['traction_off']:.0e}".replace("-", "−")
        )
    head = "solid | V | second code | package | difference | gap | traction"
    found["plane"] = table(head, lines)
    lines = [
        f"{row['tabor']:g} | {row['force']:.6f} | {row['package']:.6f} | {row['off']:+.0e}"
        for row in kept("agreement")["elastic"]
    ]
    head = "Tabor number | second code | table of the package | difference"
    found["elastic"] = table(head, [line.replace("-", "−") for line in lines])
    lines = [
        f"{row['tabor']:g} | {row['speed']:g} | {row['energy']:.4g} | {row['effective']:.3g} "
        f"| {row['factor']:.5f} | {row['rule']:.5f} | {_signed(row['off'], 2)}"
        for row in kept("agreement")["moving"]
    ]
    head = "Tabor number | V | Γ | effective | second code | f(effective) | difference"
    found["moving"] = table(head, lines)
    data, lines = factors(), []
    groups = [(f"{low:g} to {high:g}", low, high, data["inside"]) for low, high in BINS]
    every = np.full(data["energy"].shape, True)
    groups += [("all of these", 0, 99, data["inside"]), ("the others", 0, 99, ~data["inside"])]
    groups += [("all cases", 0, 99, every)]
    if np.any(data["fresh"]):
        groups += [("drawn later", 0, 99, data["fresh"])]
    for name, low, high, mask in groups:
        here = mask & (data["effective"] >= low) & (data["effective"] < high)
        off = [data[name][here] / data["simulated"][here] - 1 for name in ("rule", "bounded")]
        parts = [f"{_percent(np.median(abs(x)), 2)}, {_percent(abs(x).max(), 2)}" for x in off]
        means = ", ".join(_signed(x.mean(), 2) for x in off)
        lines.append(f"{name} | {here.sum()} | {parts[0]} | {parts[1]} | {means}")
    found["factors"] = table(
        "effective Tabor number | cases | rule: median, worst | derived: median, worst "
        "| mean of rule, derived",
        lines,
    )
    lines = []
    for part in (0.5, 1.0, 2.0):
        here = factors(part)
        off = abs(here["bounded"] / here["simulated"] - 1)[here["inside"]]
        lines.append(f"{part * CUT:g} | {_percent(np.median(off), 2)} | {_percent(off.max(), 2)}")
    found["cuts"] = table("cut over a | median error | worst error", lines)
    lines = []
    rows, inside = kept("range_factor")["rows"], data["inside"]
    for name, terms in (
        ("geometry alone", ""),
        ("with the change of the energy", "g"),
        ("with the change of the speed", "n"),
        ("all three", "gn"),
    ):
        first = np.array([coefficient(row, terms=terms) * row["size"] for row in rows])
        off = (bounded(first) / data["simulated"] - 1)[inside]
        parts = _signed(off.mean(), 2), _percent(np.median(abs(off)), 2)
        lines.append(f"{name} | {parts[0]} | {parts[1]} | {_percent(abs(off).max(), 2)}")
    found["terms"] = table("coefficients | mean error | median | worst", lines)
    lines = [
        f"{row['rate']:g} | {row['energy']:.3g} | {row['finest']:.4f} | {row['order']:.2f} "
        f"| {row['force']:.4f} | {row['simulated']:.4f} | {_signed(row['off'], 2)} "
        f"| {_signed(row['contact_off'], 2)}"
        for row in kept("agreement")["marched"]
    ]
    head = "rate | Γ | finest mesh | order | extrapolated | simulated | difference | contact"
    return found | {"marched": table(head, lines), "measured": measured()}


def numbers():
    """Return the numbers of the text by name, as words."""
    agreement, data = kept("agreement"), factors()
    opening = [r for r in agreement["plane"] if r["speed"] > 0]
    closing = [r for r in agreement["plane"] if r["speed"] < 0]
    quasi = [r for r in kept("quasi_steady")["rows"] if r["speed"] > 1 and r["effective"] > 7]
    seen = np.array([(r["factor"] - 1) / r["size"] for r in quasi])
    derived = np.array([r["T"] for r in quasi])
    rule = np.array([(r["rule"] - 1) / r["size"] for r in quasi])
    inside = data["inside"]
    errors = {
        name: data[name] / data["simulated"] - 1
        for name in ("rule", "bounded", "geometry", "first")
    }
    off = {name: abs(errors[name])[inside] for name in ("rule", "bounded")}
    far = {name: error[inside & (data["effective"] > 5)].mean() for name, error in errors.items()}
    bound = kept("work-bound")["numbers"]
    elastic_T = kept("line_tension")["elastic"]
    slopes = np.diff([r["T"] for r in elastic_T]) / np.diff(
        np.log([r["radius"] for r in elastic_T])
    )
    form = {
        name: closed_forms.deviations(
            name,
            COMPARED,
            crack(0.1),
            closed_forms.length_of_strength(name, crack(0.1).traction.reduced().strength),
        )
        for name in closed_forms.FORMS
    }
    lens = vt.crack_contact(
        vt.Groups(tabor=1e4, material=reduced(0.1), start=vt.AtDepth(2e5), rate=1e5)
    )
    # the elastic coefficient within a radius grows as pi/12 per ln of the radius
    return {
        "energy_unit_speed": f"{float(crack(0.1).amplification(1.0)):.3f}",
        "energy_ten": f"{float(crack(0.1).amplification(10.0)):.3f}",
        "energy_closing_ten": f"{float(crack(0.1).amplification(-10.0)):.4f}",
        "slow": f"{crack(0.1).slow_coefficient / 0.9:.3f}",
        "zone": f"{crack(0.1).zone_length:.2f}",
        "plane_off": f"{max(abs(r['energy_off']) for r in opening):.0e}".replace("e-0", "e−"),
        "plane_off_percent": _percent(max(abs(r["energy_off"]) for r in opening), 3),
        "closing_off_percent": _percent(max(abs(r["energy_off"]) for r in closing), 3),
        "gap_off_percent": _percent(max(r["gap_off"] for r in opening), 2),
        "traction_off": f"{max(r['traction_off'] for r in opening):.4f}",
        "plane_cases": str(len(agreement["plane"])),
        "elastic_off_percent": _percent(max(abs(r["off"]) for r in agreement["elastic"]), 3),
        "quasi_cases": str(len(quasi)),
        "quasi_seen": f"{seen.min():.2f} to {seen.max():.2f}",
        "quasi_derived": f"{derived.min():.2f} to {derived.max():.2f}",
        "quasi_off_percent": _percent(np.max(np.abs(derived / seen - 1)), 0),
        "quasi_rule": f"{rule.min():.2f} to {rule.max():.2f}",
        "cases": str(inside.size),
        "cases_inside": str(int(inside.sum())),
        "rule_median": _percent(np.median(off["rule"]), 2),
        "rule_worst": _percent(off["rule"].max(), 2),
        "derived_median": _percent(np.median(off["bounded"]), 2),
        "derived_worst": _percent(off["bounded"].max(), 2),
        "rule_far": _signed(far["rule"], 2),
        "derived_far": _signed(far["bounded"], 2),
        "geometry_far": _signed(far["geometry"], 2),
        "fresh_words": (
            f", and {data['fresh'].sum()} cases were drawn after it" if any(data["fresh"]) else ""
        ),
        "marched_best": _percent(min(abs(r["off"]) for r in agreement["marched"]), 3),
        "marched_off": _percent(max(abs(r["off"]) for r in agreement["marched"]), 2),
        "marched_contact": " and ".join(_signed(r["contact_off"], 2) for r in agreement["marched"]),
        "near_glassy": str(int(data["glassy"].sum())),
        "glassy_rule": _percent(np.max(np.abs(errors["rule"][data["glassy"]])), 2),
        "dugdale_far": f"{dugdale(40.0)[1]:.5f}",
        "dugdale_size": f"{dugdale(40.0)[0]:.4f}",
        "dugdale_near": f"{dugdale(5.0)[1]:.4f}",
        "dugdale_large": f"{dugdale(5.0)[0]:.3f}",
        "log_slope": f"{min(slopes):.3f} to {max(slopes):.3f}",
        "first_far": _signed(far["first"], 2),
        "cut": f"{CUT:g}",
        "accuracy": f"{kept('range_cases')['accuracy']:g}",
        "schapery_off": _span(form["Schapery"]),
        "stress_off": _span(form["constant stress"]),
        "pb_off": _span(form["Persson-Brener"]),
        "bound_unit": f"{bound['unit']:.4f}",
        "bound_rows": f"{bound['short_rows']:,}",
        "bound_largest": f"{bound['largest_short']:.2f}",
        "bound_all_rows": f"{bound['rows']:,}",
        "bound_long": f"{bound['largest']:.1f}",
        "huge_force": f"{lens.pull_off_force:.2f}",
        "huge_band": _percent(lens.band),
        "checked": str(checked()),
        "version": vt.__version__,
    }
