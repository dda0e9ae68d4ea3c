"""Records of measured files and fits, for ``--json`` and the API."""

from dataclasses import asdict
from itertools import zip_longest
from pathlib import Path
from typing import Any

from viscotack.model.materials.material import word_of
from viscotack.units import readable

from .record_words import estimates, read, rows_of

_MEASURED = ("pull_off_force_N", "depth_at_pull_off_m", "work_to_pull_off_J")
_MEASURED += ("work_of_separation_J", "preload_N", "preload_depth_m", "speed_m_s", "mean_speed_m_s")
_PLAIN = ("pull_off_raw_N", "dwell_time_s", "approach_speed_m_s", "noise_N", "temperature_K")


def passport_record(passport: Any) -> dict[str, Any]:
    """Return a material passport; unbounded and unknown values are None."""
    material = {"model": word_of(passport.material)} | asdict(passport.material)
    ratio = passport.material.modulus_ratio
    return asdict(passport) | {"material": material, "modulus_ratio": ratio}


def fit_record(report: Any, passport: Any) -> dict[str, Any]:
    """Return a fitted material: its passport, and how well it fits."""
    more = {"criterion": dict(report.compared), "median_error": report.median_error}
    return passport_record(passport) | more


def cycle_row(cycle: Any, radius: float | None = None, law: Any = None) -> dict[str, Any]:
    """Return the numbers of a cycle by their names with units.

    With a radius JKR's work is among them, and with a shift law the speed a_T v.
    """
    row: dict[str, Any] = {"cycle": cycle.number}
    row |= estimates(cycle, *_MEASURED) | read(cycle, *_PLAIN)
    if law is not None and cycle.temperature is not None:
        factor = 10.0 ** float(law.log10_shift(cycle.temperature))
        row["shifted_speed_m_s"] = factor * cycle.speed.value
    return row | _jkr(cycle.pull_off_force.value, radius)


def _jkr(force: float, radius: float | None) -> dict[str, float]:
    """Return the work of adhesion of an elastic JKR sphere; empty without a radius."""
    from viscotack.lab.tack.repeats import jkr_work

    return {} if radius is None else {"jkr_work_of_adhesion_J_m2": jkr_work(force, radius)}


def repeat_rows(table: Any, radius: float | None = None) -> list[dict[str, Any]]:
    """Return a row for each temperature and speed of a table of repeated tests."""
    return [
        {
            "speed_m_s": one.speed,
            "tests": len(one.cycles),
            "pull_off_force_N_mean": one.force,
            "pull_off_force_N_standard_deviation": one.force_deviation,
            "pull_off_force_N_weighted_mean": one.weighted_mean,
            "work_of_separation_J_mean": one.work,
            "work_of_separation_J_standard_deviation": one.work_deviation,
            **_jkr(one.force, radius),
            "temperature_K": one.temperature,
            **({} if one.shift is None else {"shifted_speed_m_s": one.shifted_speed}),
            "far": "; ".join(f"{cycle.source.path} cycle {cycle.number}" for cycle in one.far),
        }
        for one in table.speeds
    ]


def curve_rows(cycles: Any) -> list[dict[str, Any]]:
    """Return the retractions side by side: depth and force of each, coldest and slowest first."""
    from viscotack.lab.tack.repeats import same_temperatures

    columns = {}
    groups = same_temperatures(cycles)
    rows = [x for same in groups for x in sorted(same, key=lambda one: one.speed.value)]
    for number, one in enumerate(rows, start=1):
        at = conditions(one.temperature if len(groups) > 1 else None, one.speed.value)
        name = f"{number}: {Path(one.source.path).name} cycle {one.number}, {at}"
        columns[f"depth [m] {name}"] = one.depth[one.retraction].tolist()
        columns[f"force [N] {name}"] = one.force[one.retraction].tolist()
    return [dict(zip(columns, row, strict=True)) for row in zip_longest(*columns.values())]


def conditions(temperature: float | None, speed: float) -> str:
    """Return temperature and speed of a test, as "25 C, 1 um/s", or the speed alone."""
    where = "" if temperature is None else f"{temperature - 273.15:.3g} C, "
    return where + readable(speed, "m/s", digits=3)


def series_record(table: Any) -> dict[str, Any]:
    """Return the scatter of single tests, and the exponents of force by speed.

    "exponent" is that of a series at one temperature, or of the master curve.
    """
    exponent = table.exponent if table.master is None else table.master
    paths = {"exponent": "value", "exponent_standard_error": "uncertainty"}
    return {
        **read(table, "scatter", scatter_degrees_of_freedom="freedom"),
        **read(exponent, **paths),
        "exponents": [{"temperature_K": T} | read(one, **paths) for T, one in table.exponents],
    }


def tests_record(found: Any, table: Any, radius: float | None, law: Any = None) -> dict[str, Any]:
    """Return cycles and rejections of a survey of tack tests, and its table of repeats."""
    tests = [
        {
            "file": one.record.source.path,
            "sha256": one.record.source.sha256,
            "format": one.record.source.format,
            "cycles": [
                cycle_row(cycle, radius, law)
                | {"notes": cycle.source.notes, "cautions": cycle.cautions}
                for cycle in one.cycles
            ],
            "refused": [{"cycle": bad.number, "reason": bad.reason} for bad in one.refused],
        }
        for one in found.evaluations
    ]
    unread = [{"file": one.path, "reason": one.reason} for one in found.unread]
    return {
        "tests": tests,
        "unread": unread,
        "repeats": repeat_rows(table, radius),
        **series_record(table),
    }


def slow_record(fit: Any) -> dict[str, Any]:
    """Return the interface parameters identified from a slow test.

    The work is None where it is an upper bound, or undetermined between the models in "alike".
    """
    names = ("model", "work_of_adhesion_J_m2", "contact_modulus_Pa", "tabor", "scatter_N")
    names += ("criterion", "intervals")
    return {
        "work_of_adhesion_J_m2": (
            None if fit.upper_bound or fit.undetermined else fit.best.work_of_adhesion
        ),
        "alike": [one.model for one in fit.alike],
        "interval": fit.work_of_adhesion,
        "against": fit.test.against,
        "points": fit.test.force.size,
        "fits": [read(one, *names) for one in fit.fits],
        **read(fit, "undetermined", "upper_bound", "level"),
        "evidence": "Bayesian information criterion, chi2 + k ln n, scatter of the best model",
        **read(fit, "words"),
    }


def rates_record(fit: Any) -> dict[str, Any]:
    """Return the interface parameters identified from a rate series."""
    body, layer, growth = fit.forward.body, None, None
    if body.word == "layer":
        layer = read(body, "thickness_m", "poisson_ratio") | {"base": body.base.word}
    if fit.growth is not None:
        found, pulled, values = fit.growth, fit.growth.pulled, fit.best.values
        shares = {
            "speed_m_s": fit.given.speed,
            "edge_speed_m_s": pulled.crack_speed,
            "energy": pulled.energy,
            "bulk": pulled.energy / pulled.interface,
            "interface": pulled.interface,
        }
        growth = {
            "strengthening": values["strengthening"],
            **read(found, "opening_speed_m_s"),
            "exponent": values["exponent"],
            **read(found, "reference_speed_m_s", "better_by", "chance"),
            "shares": rows_of(shares),
        }
    return {
        **interface_record(fit),
        "range_bound_m": fit.given.range_bound,
        **_series_record(fit),
        "criterion_of_edge_law": None if fit.edge is None else fit.edge.criterion,
        "layer": layer,
        "growth": growth,
        **read(fit, "tabor", "words"),
    }


def edge_record(fit: Any) -> dict[str, Any]:
    """Return the edge law identified from a rate series."""
    return {**interface_record(fit), **_series_record(fit), **read(fit, "words")}


def interface_record(fit: Any) -> dict[str, float]:
    """Return the most likely interface: range of attraction, or speed and exponent of a law."""
    units = {"equilibrium_gap": "equilibrium_gap_m", "reference_speed": "reference_speed_m_s"}
    found = {units[name]: value for name, value in fit.best.values.items() if name in units}
    if "reference_speed" in fit.best.values:
        found["exponent"] = fit.best.values["exponent"]
    return {"work_of_adhesion_J_m2": fit.work_of_adhesion} | found


def _series_record(fit: Any) -> dict[str, Any]:
    """Return intervals, scatter, forces and growth with the contact time of any rate series."""
    ageing: dict[str, Any] | None = {"separate": False} if fit.given.confounded else None
    if (found := fit.ageing) is not None:
        ageing = {"growth_per_decade": fit.best.values["growth_per_decade"]}
        ageing |= read(fit.given, "middle_time_s")
        ageing |= read(found, "better_by", "chance", "correlation")
        ageing |= {"separate": not found.together, "unexplained": fit.unexplained}
    paths = {"temperature_K": "temperature", "speed_m_s": "true_speed"}
    paths |= {"shifted_speed_m_s": "speed", "pull_off_force_N": "force.value"}
    paths |= {"pull_off_force_N_uncertainty": "force.uncertainty"}
    timed = () if found is None else ("contact_time_s",)
    return {
        **read(fit, "intervals", "scatter", "trend", "criterion", "describes_tests"),
        "scatter_between_speeds": fit.between_speeds,
        "ageing": ageing,
        "solutions": [one.values for one in fit.solutions],
        "series": [
            read(one, **paths) | {"fitted_N": force} | read(one, *timed)
            for one, force in zip(fit.series, fit.forces, strict=True)
        ],
    }


def forecast_rows(forecast: Any) -> list[dict[str, float]]:
    """Return a row for each speed of a forecast."""
    columns = read(
        forecast, speed_m_s="speed", pull_off_force_N="force", low_N="low", high_N="high"
    )
    columns |= read(forecast, low_of_one_test_N="low_of_one", high_of_one_test_N="high_of_one")
    columns |= read(forecast, "contact_time_s")
    return rows_of({name: x for name, x in columns.items() if x is not None})
