r"""Names and units of the outputs of each kind of problem, and units of its inputs.

A :class:`viscotack.Result` is the same for every indenter: force, depth, contact edge. Summaries,
tables and figures use the specific quantities: the pull-off force of a sphere [1.5 pi R
Delta-gamma_0] or the pull-off stress of a punch [sigma_0]. A :class:`Kind` defines them.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from viscotack.errors import InputError
from viscotack.model.materials import Elastic
from viscotack.model.traction import has_rest


@dataclass(frozen=True)
class Unit:
    """The unit of a dimensionless number.

    Attributes
    ----------
    text, drawn : str
        Unit in text, and in figures.
    scale : str
        Attribute of ``problem.scales()`` that converts the number to SI.
    si : str
        SI unit.
    """

    text: str
    drawn: str
    scale: str
    si: str

    @property
    def tail(self) -> str:
        """Return the unit suffix of a name in SI, such as ``m_per_s``."""
        return self.si.replace("/", "_per_").replace("^", "")


# Factor on a number of a `Result`, from the dimensionless groups.
Factor = Callable[[Any], float]


@dataclass(frozen=True)
class Series:
    """A column of a table: a series of a `Result`, its unit and a factor."""

    source: str
    words: str
    unit: Unit
    factor: Factor = lambda groups: 1.0


@dataclass(frozen=True)
class Output:
    """A number of a summary, computed by the function of that name in the observables.

    A `noted` one has an additional note: a warning of the function, or the reason why it is
    undefined.
    """

    words: str
    unit: Unit
    noted: bool = False


@dataclass(frozen=True)
class Kind:
    """Outputs of a kind of problem.

    Attributes
    ----------
    series : mapping
        Columns of its table, by name.
    observables : mapping
        Numbers of its summary, by name.
    cycles : mapping
        Columns of the table of its cycles, by name.
    energy : Unit
        Unit of energies and works.
    energy_factor : callable
        Factor of that unit.
    """

    series: Mapping[str, Series]
    observables: Mapping[str, Output]
    cycles: Mapping[str, Series]
    energy: Unit
    energy_factor: Factor = lambda groups: 1.0

    @property
    def units(self) -> Mapping[str, Unit]:
        """Units of force, depth, radius, speed, work, time and pure numbers."""
        sources = {"radius": "contact_radius", "speed": "edge_speed"}
        names = ("force", "depth", "time", *sources)
        units = {name: self.of(sources.get(name, name)).unit for name in names}
        return units | {"work": self.energy, "1": _PURE}

    def of(self, source: str) -> Series:
        """Return the column of a series of a `Result`."""
        return self.series[self.name_of(source)]

    def check_has(self, observable: str) -> None:
        """Raise an error for a number that summaries of this kind do not contain."""
        if observable not in self.observables:
            pulled = f"pull_off_{self.name_of('force')}"
            raise InputError(f"this kind of problem has no {observable}; use {pulled}")

    def name_of(self, source: str) -> str:
        """Return the name of the column of a series of a `Result`."""
        return next(name for name, column in self.series.items() if column.source == source)


_PURE = Unit("", "", "", "")
_TIME = Unit("time unit", "time unit", "time", "s")
_LENGTH = Unit("h0", "$h_0$", "length", "m")
_FORCE = Unit("1.5 pi R dg0", r"$1.5\,\pi R\,\Delta\gamma_0$", "force", "N")
_RADIUS = Unit("(pi R^2 dg0/E0*)^(1/3)", r"$(\pi R^2 \Delta\gamma_0/E_0^*)^{1/3}$", "radius", "m")
_SPEED = Unit(
    "(R^2 dg0/E0*)^(1/3)/time unit",
    r"$(R^2 \Delta\gamma_0/E_0^*)^{1/3}$ per time unit",
    "edge_speed",
    "m/s",
)
_WORK = Unit("1.5 pi R dg0 h0", r"$1.5\,\pi R\,\Delta\gamma_0 h_0$", "work", "J")


def _cycles(force: str, unit: Unit, work: Unit) -> dict[str, Series]:
    """Return the columns of a table of cycles, see :class:`viscotack.result.cycles.Cycle`."""
    return {
        "begin": Series("begin", "begin", _TIME),
        "end": Series("end", "end", _TIME),
        "snap_in_depth": Series("snap_in_depth", "snap-in at", _LENGTH),
        f"snap_in_{force}": Series("snap_in_force", "snap-in", unit),
        f"peak_{force}": Series("peak_force", "peak", unit),
        f"pull_off_{force}": Series("pull_off_force", "pull-off", unit),
        "depth_at_pull_off": Series("depth_at_pull_off", "at depth", _LENGTH),
        "work_to_pull_off": Series("work_to_pull_off", "work", work),
        "hysteresis": Series("hysteresis", "hysteresis", work),
        "hysteresis_error": Series("hysteresis_error", "its error", _PURE),
        "time_to_detachment": Series("time_to_detachment", "time to detachment", _TIME),
    }


REVOLUTION = Kind(
    series={
        "time": Series("time", "time", _TIME),
        "depth": Series("depth", "depth", _LENGTH),
        "force": Series("force", "force", _FORCE),
        "contact_radius": Series("contact_radius", "contact radius", _RADIUS),
        "edge_speed": Series("edge_speed", "crack speed", _SPEED),
    },
    observables={
        "pull_off_force": Output("pull-off force", _FORCE),
        "work_to_pull_off": Output("work to pull-off", _WORK, noted=True),
        "work_of_separation": Output("work of separation", _WORK),
        "depth_at_pull_off": Output("depth at pull-off", _LENGTH),
        "contact_radius_at_pull_off": Output("contact radius there", _RADIUS),
        "crack_speed_at_pull_off": Output("crack speed there", _SPEED),
        "other_peak_force": Output("other peak of force", _FORCE),
        "depth_at_other_peak": Output("depth there", _LENGTH),
        "work_to_other_peak": Output("work to other peak", _WORK),
        "time_to_detachment": Output("time to detachment", _TIME),
    },
    cycles=_cycles("force", _FORCE, _WORK),
    energy=_WORK,
)


# Of a shape whose contact may have several edges.
DETAILED = replace(
    REVOLUTION,
    series={
        **REVOLUTION.series,
        "inner_radius": Series("inner_radius", "inner radius", _RADIUS),
        "rings": Series("rings", "rings", _PURE),
    },
)


_STRESS = Unit("sigma0", r"$\sigma_0$", "stress", "Pa")
_WIDTH = Unit("a", "$a$", "half_width", "m")
_CRACK = Unit("h0/time unit", "$h_0$ per time unit", "crack_speed", "m/s")
_ENERGY = Unit("dg0", r"$\Delta\gamma_0$", "work", "J/m^2")

PLANE = Kind(
    series={
        "time": Series("time", "time", _TIME),
        "depth": Series("depth", "depth", _LENGTH),
        "stress": Series("force", "mean tension", _STRESS, lambda groups: -1.0),
        "ligament": Series(
            "contact_radius", "ligament", _WIDTH, lambda groups: 1 / groups.geometry.half_width
        ),
        # lengths of a Result are in a0
        "crack_speed": Series(
            "edge_speed", "crack speed", _CRACK, lambda groups: groups.fracture_length
        ),
    },
    observables={
        "pull_off_stress": Output("pull-off stress", _STRESS),
        "work_to_pull_off": Output("work to pull-off", _ENERGY, noted=True),
        "work_of_separation": Output("work of separation", _ENERGY),
        "depth_at_pull_off": Output("depth at pull-off", _LENGTH),
        "ligament_at_pull_off": Output("ligament there", _WIDTH),
        "crack_speed_at_pull_off": Output("crack speed there", _CRACK),
        "effective_surface_energy": Output("surface energy there", _ENERGY, noted=True),
        "other_peak_stress": Output("other peak of stress", _STRESS),
        "depth_at_other_peak": Output("depth there", _LENGTH),
        "work_to_other_peak": Output("work to other peak", _ENERGY),
        "time_to_detachment": Output("time to detachment", _TIME),
    },
    cycles=_cycles("stress", _STRESS, _ENERGY),
    energy=_ENERGY,
    # sigma_0 h_0 over Delta-gamma_0
    energy_factor=lambda groups: groups.traction.strength,
)


@dataclass(frozen=True)
class InSI:
    """SI values of the units of dimensionless groups.

    Attributes
    ----------
    length : float
        Unit of gaps and depths, h_0 [m].
    work : float
        Unit of work per area, Delta-gamma_0 [J/m^2].
    force : float
        Unit of the forces [N] of a protocol; for a punch, unit of its stresses [Pa].
    contact_radius : float
        Unit of the contact radii of a protocol [m].
    along, height : float
        Units of distances along the surface, and of heights of a shape [m].
    """

    length: float
    work: float
    force: float
    contact_radius: float
    along: float
    height: float


def time_unit(material: Any, traction: Any) -> float:
    """Return the unit of dimensionless times [s]: the material's.

    An elastic solid has none; where the traction law grows or ages, its own time is the only one
    there is: that in which a gap opens by h_0 at its reference speed, or its reference time.
    """
    if isinstance(material, Elastic) and has_rest(traction):
        return traction.own_time
    return material.time_unit
