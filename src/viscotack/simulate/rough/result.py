"""Result of a pull on a rough surface, in SI, and its file."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.whole import Target, write_whole
from viscotack.result import Event, Outcome


@dataclass(frozen=True, eq=False)
class FieldMap:
    """Gap and pressure over the map at one instant.

    Attributes
    ----------
    time, depth, force : float
        Time [s], depth [m] and force [N] of the instant.
    gap, pressure : ndarray, shape (rows, columns)
        Gap [m], and pressure [Pa], positive in compression.
    """

    time: float
    depth: float
    force: float
    gap: npt.NDArray
    pressure: npt.NDArray


@dataclass(frozen=True, eq=False)
class RoughResult:
    """A simulated pull on a rough surface; series in SI with one entry per step.

    Attributes
    ----------
    time, depth, force : ndarray
        Time [s], depth [m], positive into the solid, and force [N], positive in compression.
    drive : ndarray
        Depth of the drive, which a spring joins to the surface [m].
    area : ndarray
        Area where the gap is smaller than that of the largest tension [m^2].
    patches : ndarray of int
        Number of connected parts of this area.
    work, elastic, interface, heat, jumps : ndarray
        Energies [J]: work of the drive since the start, with the spring of the machine; elastic
        and interface energy; heat in the solid and loss in jumps since the start.
    last_leg : int
        Number of the step where the last part of the test begins.
    status : str
        Ending of the run, as of :class:`viscotack.Result`.
    events : tuple of Event
        Jumps, with time [s], depth [m], force [N] and energy [J].
    energy_residual : float
        Largest imbalance of the energies over the largest cumulative term.
    error_estimate : dict or None
        Relative errors of ``force`` (largest tension), ``work`` (of separation) and ``area`` (the
        largest of the contact); None if they are not estimated.
    warnings : tuple of str
        What makes the answer less certain than stated.
    strongest : FieldMap
        Maps at the largest tension.
    maps : tuple of FieldMap
        Maps at other instants, in order of time, on request.
    nominal_area, pixel : float
        Area of the map [m^2], and side of a pixel [m].
    statistics : dict
        Cost: steps, newton_iterations, rejected_steps, pixels, modes, wall_time_s.
    """

    time: npt.NDArray
    depth: npt.NDArray
    drive: npt.NDArray
    force: npt.NDArray
    area: npt.NDArray
    patches: npt.NDArray
    work: npt.NDArray
    elastic: npt.NDArray
    interface: npt.NDArray
    heat: npt.NDArray
    jumps: npt.NDArray
    last_leg: int
    status: str
    events: tuple[Event, ...]
    energy_residual: float
    strongest: FieldMap
    nominal_area: float
    pixel: float
    error_estimate: Mapping[str, float] | None = None
    warnings: tuple[str, ...] = ()
    maps: tuple[FieldMap, ...] = ()
    statistics: Mapping[str, float] = field(default_factory=dict)

    @property
    def outcome(self) -> Outcome:
        """Outcome at the beginning of the status sentence."""
        return Outcome.of(self.status)

    @property
    def has_separated(self) -> bool:
        """Whether the surfaces are apart at the end, or never touched."""
        return self.outcome not in (Outcome.STOPPED, Outcome.IN_CONTACT)

    @property
    def pull_off_force(self) -> float:
        """Largest tension of the last part of the test [N], 0 if there is none."""
        return max(-float(self.force[self.last_leg :].min()), 0.0)

    @property
    def pull_off_stress(self) -> float:
        """Pull-off force over the area of the map [Pa]."""
        return self.pull_off_force / self.nominal_area

    @property
    def at_pull_off(self) -> int:
        """Number of the step of the largest tension."""
        return self.last_leg + int(np.argmin(self.force[self.last_leg :]))

    @property
    def work_of_separation(self) -> float:
        """Work at the surface from zero force to separation in the last part of the test [J].

        As of a sphere (:func:`viscotack.work_of_separation`) it is the area below the curve of
        force and depth, without jumps. 0 if the surfaces never pull on each other.

        Raises
        ------
        ValueError
            If the run did not end in separation.
        """
        if not self.has_separated:
            raise InputError(f"the surfaces have not separated: {self.status}")
        first, at = self.last_leg, self.at_pull_off
        pressed = np.flatnonzero(self.force[first:at] >= 0)
        i = first + int(pressed[-1]) if pressed.size else first
        force, depth = self.force[i:].copy(), self.depth[i:].copy()
        if len(force) < 2 or not self.pull_off_force:
            return 0.0
        if pressed.size:  # from zero force; it is linear in a step
            depth[0] += force[0] / (force[0] - force[1]) * (depth[1] - depth[0])
            force[0] = 0.0
        done = (force[1:] + force[:-1]) / 2 * np.diff(depth)
        jumped = np.isin(self.time[i + 1 :], [event.time for event in self.events])
        return float(done[~jumped].sum() - self.interface[-1])

    @property
    def hysteresis(self) -> float:
        """Work of the drive that the whole test has lost, heat and jumps [J]."""
        return float(self.heat[-1] + self.jumps[-1])

    @property
    def summary(self) -> dict[str, Any]:
        """Numbers of the answer in SI."""
        at = self.at_pull_off
        separated = self.has_separated
        errors = self.error_estimate or {}
        return {
            "pull_off_force_N": self.pull_off_force,
            "pull_off_force_error": errors.get("force"),
            "pull_off_stress_Pa": self.pull_off_stress,
            "depth_at_pull_off_m": float(self.depth[at]),
            "contact_share_at_pull_off": float(self.area[at]) / self.nominal_area,
            "patches_at_pull_off": int(self.patches[at]),
            "largest_contact_share": float(self.area.max()) / self.nominal_area,
            "largest_contact_share_error": errors.get("area"),
            "work_of_separation_J": self.work_of_separation if separated else None,
            "work_of_separation_error": errors.get("work") if separated else None,
            "hysteresis_J": self.hysteresis,
            "lost_in_jumps_J": float(self.jumps[-1]),
            "jumps": len(self.events),
            "energy_residual": self.energy_residual,
            "status": self.status,
            "warnings": list(self.warnings),
        }

    def rows(self) -> list[dict[str, float]]:
        """Return the series as rows of a table."""
        columns = {
            "time_s": self.time,
            "depth_m": self.depth,
            "drive_m": self.drive,
            "force_N": self.force,
            "contact_area_m2": self.area,
            "patches": self.patches,
            "work_J": self.work,
            "elastic_J": self.elastic,
            "interface_J": self.interface,
            "heat_J": self.heat,
            "jumps_J": self.jumps,
        }
        return [
            dict(zip(columns, (value.item() for value in row), strict=True))
            for row in zip(*columns.values(), strict=True)
        ]

    def save_maps(self, target: Target) -> None:
        """Write series and maps to a NumPy archive (.npz), whole or not at all.

        It has the arrays of :meth:`rows` by name, ``pixel_m``, and of the maps ``map_time_s``,
        ``map_depth_m``, ``map_force_N``, ``map_gap_m`` and ``map_pressure_Pa``.
        """
        held = io.BytesIO()
        maps = self.maps or (self.strongest,)
        rows = self.rows()
        series: dict[str, Any] = {name: np.array([row[name] for row in rows]) for name in rows[0]}
        arrays: dict[str, Any] = {
            "pixel_m": self.pixel,
            "map_time_s": [m.time for m in maps],
            "map_depth_m": [m.depth for m in maps],
            "map_force_N": [m.force for m in maps],
            "map_gap_m": np.array([m.gap for m in maps], dtype=np.float32),
            "map_pressure_Pa": np.array([m.pressure for m in maps], dtype=np.float32),
            "summary": json.dumps(self.summary),
        }
        np.savez_compressed(held, **series, **arrays)
        write_whole(target, held.getvalue())
