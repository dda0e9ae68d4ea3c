"""Columns of the datasets: names, units and descriptions."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from viscotack.errors import InputError
from viscotack.model.materials.random_solids import creep_spectrum
from viscotack.model.problem.outputs import PLANE, REVOLUTION, Kind
from viscotack.model.problem.rows import INPUTS, KINDS

# Lower bounds of stated relative errors, which hold in 95 % of the
# rows: for all spheres, for deeply pressed ones, and for those of large Tabor number and small
# modulus ratio, whose trajectories come close to jumps.
LEAST_ERRORS = {"force_error": 1e-3, "work_error": 5e-3}
DEEP, LEAST_DEEP = 80.0, {"force_error": 1.5e-3, "work_error": 5e-3}
LARGE_TABOR, SMALL_RATIO = 5.0, 1e-3
LEAST_STEEP = {"force_error": 1.5e-3, "work_error": 2e-2}


@dataclass(frozen=True)
class Column:
    """A column of a dataset."""

    name: str
    unit: str  # as in docs/symbols.md; "1" if dimensionless
    words: str
    source: str = ""  # name in a campaign
    # "exact" numbers keep all digits; a "number" is rounded to seven, far more than its accuracy;
    # a "curve" is a list of 24 numbers; a "spectrum" is a list of exact numbers, one per time of
    # the solid; "whole" numbers are integers.
    form: str = "number"
    less: str = ""  # name of a number to subtract
    error: bool = False  # bounded below by `least_errors`

    def __post_init__(self) -> None:
        object.__setattr__(self, "source", self.source or self.name)

    def type(self, pa: Any) -> Any:
        """Return the pyarrow type of the column."""
        if self.form == "curve":
            return pa.list_(pa.float32(), 24)
        if self.form == "spectrum":
            return pa.list_(pa.float64())
        return {"exact": pa.float64(), "number": pa.float32(), "whole": pa.int32()}[self.form]

    def value(self, row: Mapping[str, Any]) -> Any:
        """Return the value of the column from the row of a campaign."""
        if self.form == "spectrum":
            found = creep_spectrum(row["solid"], row["modulus_ratio"])
            return found[_SPECTRUM.index(self.name)].tolist()
        if self.source not in row:
            raise InputError(
                f"the campaign has no column {self.source!r}; run its plan again in a new folder"
            )
        value = row[self.source]
        if self.form in ("exact", "whole") or value is None:
            return value
        if isinstance(value, list):
            zero = row[self.less] if self.less else 0.0
            return [None if v is None else v - zero for v in value]
        return max(value, least_errors(row)[self.name]) if self.error else value


def least_errors(row: Mapping[str, Any]) -> dict[str, float]:
    """Return the smallest relative errors that a row may state, by column.

    Examples
    --------
    >>> least_errors({"tabor": 9.0, "modulus_ratio": 2e-4, "preload": 1.0})
    {'force_error': 0.0015, 'work_error': 0.02}
    """
    if row.get("tabor", 0.0) > LARGE_TABOR and row["modulus_ratio"] < SMALL_RATIO:
        return LEAST_STEEP
    return LEAST_DEEP if row["preload"] > DEEP else LEAST_ERRORS


_HOW = (
    Column(
        "force_error",
        "1",
        "relative error of the pull-off force or stress",
        "error_estimate",
        error=True,
    ),
    Column(
        "work_error",
        "1",
        "relative error of the work to pull-off",
        "error_estimate_work",
        error=True,
    ),
    Column("energy_residual", "1", "largest imbalance of the energies over their largest term"),
    Column("accuracy", "1", "what the solver was asked for", form="exact"),
    Column("steps", "1", "steps of the run to the pull-off", form="whole"),
    Column("jumps", "1", "times at which an equilibrium ended before the pull-off", form="whole"),
)


def _inputs(kind: str) -> tuple[Column, ...]:
    """Return the input columns of a kind of campaign, from their cards."""
    names = (*KINDS[kind].columns[:-1], "preload", "rate")
    return tuple(
        Column(
            name,
            INPUTS[name].unit,
            f"{INPUTS[name].card.words} ({INPUTS[name].card.symbol})",
            form="exact",
        )
        for name in names
    )


def _outputs(kind: Kind, words: Mapping[str, str]) -> tuple[Column, ...]:
    """Return the columns of numbers of a summary, in the units of the geometry."""
    return tuple(
        Column(name, kind.observables[name].unit.text.replace("time unit", "tau0"), text)
        for name, text in words.items()
    )


def _curve(kind: Kind, sense: str) -> tuple[Column, ...]:
    shares = {"25": "25", "50": "50", "75": "75", "87_5": "87.5"}
    force, radius = kind.name_of("force"), kind.name_of("contact_radius")
    unit = kind.of("force").unit.text
    words = f"{force} at 24 points of the retraction, {sense} positive"
    return (
        Column("travel_to_pull_off", "h0", "travel from the start to the pull-off"),
        *(
            Column(f"{force}_at_{key}", unit, f"{force} at {share} % of the travel")
            for key, share in shares.items()
        ),
        Column(
            "trajectory_travel_left",
            "h0",
            "travel from these points to the pull-off",
            "trajectory_depth",
            "curve",
            less="depth_at_pull_off",
        ),
        Column(f"trajectory_{force}", unit, words, form="curve"),
        Column(f"trajectory_{radius}", kind.of("contact_radius").unit.text, _EDGE, form="curve"),
    )


_EDGE = "contact edge at these points; null where there is none"
_SPHERE = (
    *_outputs(
        REVOLUTION,
        {
            "pull_off_force": "minus the least force",
            "work_to_pull_off": "work from zero force, or from the start",
            "depth_at_pull_off": "depth at the pull-off, positive into the solid",
            "contact_radius_at_pull_off": "contact edge there; null without one",
            "crack_speed_at_pull_off": "speed of the edge there",
        },
    ),
    *_curve(REVOLUTION, "compression"),
    *_HOW,
)
# Columns computed from the index of a solid, not by the campaign.
_SPECTRUM = ("retardation_weights", "retardation_times")
# Columns by kind of campaign.
KEPT = {
    "sphere": (*_inputs("sphere"), *_SPHERE),
    "solid": (
        *_inputs("solid"),
        Column(_SPECTRUM[0], "1", "parts of the creep from k to 1, of sum 1", form="spectrum"),
        Column(_SPECTRUM[1], "time unit", "retardation time of each, ascending", form="spectrum"),
        *_SPHERE,
    ),
    "punch": (
        *_inputs("punch"),
        *_outputs(
            PLANE,
            {
                "pull_off_stress": "largest mean tension",
                "work_to_pull_off": "work of unit area from zero stress",
                "depth_at_pull_off": "depth at the pull-off, positive into the layer",
                "ligament_at_pull_off": "half width still in contact there",
                "crack_speed_at_pull_off": "speed of the edge there; null at a jump",
            },
        ),
        *_curve(PLANE, "tension"),
        *_HOW,
    ),
}


def units(kind: str) -> dict[str, list[str]]:
    """Return unit and description of every column of a kind of campaign.

    Examples
    --------
    >>> units("sphere")["preload"]
    ['h0', 'depth of the relaxed start, positive into the solid (delta)']
    """
    return {column.name: [column.unit, column.words] for column in KEPT[kind]}
