"""Records of measured files and fits, for ``--json`` and the API."""

from dataclasses import asdict
from math import isfinite
from typing import Any

from .json_data import plain

# name in Python -> name in tables, with the unit
_MEASURED = {
    "pull_off_force": "pull_off_force_N",
    "depth_at_pull_off": "depth_at_pull_off_m",
    "work_to_pull_off": "work_to_pull_off_J",
    "work_of_separation": "work_of_separation_J",
    "preload": "preload_N",
    "preload_depth": "preload_depth_m",
    "speed": "speed_m_s",
    "mean_speed": "mean_speed_m_s",
}
_PLAIN = {
    "pull_off_raw": "pull_off_raw_N",
    "dwell_time": "dwell_time_s",
    "approach_speed": "approach_speed_m_s",
    "noise": "noise_N",
}


def passport_record(passport: Any) -> dict[str, Any]:
    """Return a material passport; what has no bound, or is not known, is None."""
    return plain(
        asdict(passport)
        | {
            "material": _material_record(passport.material),
            "modulus_ratio": passport.material.modulus_ratio,
        }
    )


def fit_record(report: Any, passport: Any) -> dict[str, Any]:
    """Return a fitted material: its passport, or the law alone where it has none."""
    more = {"criterion": dict(report.compared), "median_error": report.median_error}
    if passport is not None:
        return passport_record(passport) | plain(more)
    evidence = {
        "level": report.level,
        "intervals": [(each.name, each.low, each.high) for each in report.intervals],
        "undetermined": report.undetermined,
        "cautions": report.cautions,
    }
    return plain({"material": _material_record(report.material), "evidence": evidence} | more)


def _material_record(material: Any) -> dict[str, Any]:
    from viscotack.materials.words import word_of

    return {"model": word_of(material)} | asdict(material)


def cycle_row(cycle: Any) -> dict[str, Any]:
    """Return the numbers of a cycle by their names with units."""
    row: dict[str, Any] = {"cycle": cycle.number}
    for name, column in _MEASURED.items():
        one = getattr(cycle, name)
        row[column], row[f"{column}_uncertainty"] = one.value, one.uncertainty
    return row | {column: getattr(cycle, name) for name, column in _PLAIN.items()}


def tests_record(found: Any) -> dict[str, Any]:
    """Return the cycles and rejections of a survey of tack tests."""
    tests = [
        {
            "file": one.record.source.path,
            "sha256": one.record.source.sha256,
            "format": one.record.source.format,
            "cycles": [
                cycle_row(cycle) | {"notes": list(cycle.source.notes)} for cycle in one.cycles
            ],
            "refused": [{"cycle": bad.number, "reason": bad.reason} for bad in one.refused],
        }
        for one in found.evaluations
    ]
    unread = [{"file": one.path, "reason": one.reason} for one in found.unread]
    return {"tests": tests, "unread": unread}


def slow_record(fit: Any) -> dict[str, Any]:
    """Return the interface parameters identified from a slow test."""
    fits = [
        {
            "model": one.model,
            "work_of_adhesion_J_m2": one.work_of_adhesion,
            "contact_modulus_Pa": one.contact_modulus,
            "tabor": one.tabor,
            "scatter_N": one.scatter,
            "criterion": one.criterion,
            "intervals": {name: asdict(interval) for name, interval in one.intervals.items()},
        }
        for one in fit.fits
    ]
    return {
        "against": fit.test.against,
        "points": int(fit.test.force.size),
        "level": fit.level,
        "evidence": fit.evidence,
        "fits": fits,
        "words": list(fit.words),
    }


def rates_record(fit: Any) -> dict[str, Any]:
    """Return the interface parameters identified from a rate series."""
    return {
        "work_of_adhesion_J_m2": fit.work_of_adhesion,
        "equilibrium_gap_m": fit.equilibrium_gap,
        "tabor": fit.tabor,
        "intervals": {name: asdict(interval) for name, interval in fit.intervals.items()},
        "scatter": fit.scatter,
        "scatter_between_speeds": fit.between_speeds,
        "solutions": [dict(one.values) for one in fit.solutions],
        "series": [
            {
                "speed_m_s": one.speed,
                "pull_off_force_N": one.force.value,
                "pull_off_force_N_uncertainty": one.force.uncertainty,
                "fitted_N": force,
            }
            for one, force in zip(fit.series, fit.forces, strict=True)
        ],
        "layer": _layer_record(fit.forward.body),
        "growth": None if fit.growth is None else _growth_record(fit.growth),
        "words": list(fit.words),
    }


def _layer_record(body: Any) -> dict[str, Any] | None:
    """Return thickness and base of a layer, None for a half-space."""
    if body.word != "layer":
        return None
    return {
        "thickness_m": body.thickness,
        "base": body.base.word,
        "poisson_ratio": body.poisson_ratio,
    }


def _growth_record(found: Any) -> dict[str, Any]:
    """Return the growth of the interface with speed."""
    grows = isfinite(found.reference_speed)
    return {
        "strengthening": found.strengthening,
        "opening_speed_m_s": found.opening_speed,
        "exponent": found.exponent,
        "reference_speed_m_s": found.reference_speed if grows else None,
        "better_by": found.better_by,
        "chance": found.chance,
        "shares": [
            {
                "speed_m_s": one.speed,
                "edge_speed_m_s": one.edge_speed,
                "energy": one.energy,
                "bulk": one.bulk,
                "interface": one.interface,
            }
            for one in found.shares
        ],
    }
