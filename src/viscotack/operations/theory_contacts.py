"""The operations ``theory jkr``, ``maugis`` and ``crack-contact``: contacts without simulation."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np

from viscotack.errors import InputError

from .declare.answer import Answer, Caller, csv_file, picture
from .declare.cards import Number
from .declare.options import Operation
from .declare.statement import Stated, Statement
from .declare.wording import flag
from .parts.closed_form import closed_form
from .parts.record_words import record_words
from .parts.tables import as_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from viscotack.methods.by_crack import CrackContact

_RADIUS = Number('Sphere radius R, "5.19 mm".', unit="m", above=0, metavar="LENGTH")
_MODULUS = Number('E* = E/(1 - nu^2), "1.94 MPa".', unit="Pa", above=0, metavar="PRESSURE")
_WORK = Number('dg0, "0.1523 J/m^2".', unit="J/m^2", above=0, metavar="ENERGY")


@dataclass(frozen=True, kw_only=True)
class Jkr(Operation):
    """Detachment of an elastic sphere, forces of short range (JKR).

    Example: viscotack theory jkr --radius "1 mm" --contact-modulus "1 MPa" --work-of-adhesion
    "50 mJ/m^2"
    """

    word: ClassVar = "theory jkr"
    outputs: ClassVar = (picture(),)

    radius: Annotated[float, _RADIUS]
    contact_modulus: Annotated[float, _MODULUS]
    work_of_adhesion: Annotated[float, _WORK]

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.theory import jkr

        case = {
            "radius": self.radius,
            "contact_modulus": self.contact_modulus,
            "work_of_adhesion": self.work_of_adhesion,
        }
        end, fold = jkr.pull_off(**case), jkr.instability(**case)
        free = jkr.contact_radius_at_force(0.0, **case)
        a = np.linspace(0.0, 1.5 * float(free), 400)
        record = {
            "pull_off_force_N": -end.force,
            "contact_radius_at_pull_off_m": end.contact_radius,
            "depth_at_pull_off_m": end.depth,
            "work_to_pull_off_J": jkr.work_to_pull_off(**case),
            "contact_radius_without_load_m": free,
            "instability_depth_m": fold.depth,
        }
        curve = jkr.depth(a, **case), jkr.force(a, **case)
        return closed_form(end, record, curve, ("depth [m]", "force [N]"))


@dataclass(frozen=True, kw_only=True)
class Maugis(Operation):
    """Detachment of an elastic sphere, forces of any range (Maugis-Dugdale).

    Example: viscotack theory maugis --radius "1 um" --contact-modulus "1 GPa" --work-of-adhesion
    "50 mJ/m^2" --strength "20 MPa", or: viscotack theory maugis --tabor 1
    """

    word: ClassVar = "theory maugis"
    outputs: ClassVar = (picture(),)

    radius: Annotated[float | None, _RADIUS] = None
    contact_modulus: Annotated[float | None, _MODULUS] = None
    work_of_adhesion: Annotated[float | None, _WORK] = None
    strength: Annotated[
        float | None,
        Number('Tension in the ring, "5 MPa".', unit="Pa", above=0, metavar="PRESSURE"),
    ] = None
    tabor: Annotated[
        float | None,
        Number(
            "Instead of all of them, for dimensionless answers: the Tabor number of a "
            "Lennard-Jones contact of the same work and peak tension.",
            above=0,
            metavar="MU",
        ),
    ] = None

    def __post_init__(self) -> None:
        flags = {flag(name): value for name, value in self._sphere.items()}
        given = [flag for flag, value in flags.items() if value is not None]
        missing = [flag for flag, value in flags.items() if value is None]
        if self.tabor is not None and given:
            raise InputError(f"--tabor states the whole problem; leave out {', '.join(given)}")
        if self.tabor is None and missing:
            raise InputError(f"{' and '.join(missing)} missing; or give --tabor alone")

    @property
    def _sphere(self) -> dict[str, Any]:
        names = ("radius", "contact_modulus", "work_of_adhesion", "strength")
        return {name: getattr(self, name) for name in names}

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.theory import maugis

        if self.tabor is None:
            case = self._sphere
            units, tails = (1.0, 1.0, 1.0), ("_N", "_m", "_m", "_J")
            labels = ("depth [m]", "force [N]")
        else:
            # R = E* = dg0 = 1: h0 is 1/mu, and the strength what makes the Maugis parameter
            case = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
            wanted = maugis.parameter_from_tabor(self.tabor)
            of_one = maugis.maugis_parameter(**case, strength=1.0)
            case["strength"] = float(np.asarray(wanted) / of_one)
            units, tails = (1.5 * np.pi, np.cbrt(np.pi), 1 / self.tabor), ("", "", "", "")
            labels = ("depth / h0", "force / (1.5 pi R dg0)")
        load, length, height = units
        end = maugis.pull_off(**case)
        excess = float(end.cohesive_radius) / float(end.contact_radius) - 1
        states = maugis.curve(1 + excess * np.geomspace(1e-3, 1e3, 400), **case)
        record = {
            "maugis_parameter": maugis.maugis_parameter(**case),
            f"pull_off_force{tails[0]}": -end.force / load,
            f"contact_radius_at_pull_off{tails[1]}": end.contact_radius / length,
            f"cohesive_radius_at_pull_off{tails[1]}": end.cohesive_radius / length,
            f"depth_at_pull_off{tails[2]}": end.depth / height,
            f"work_to_pull_off{tails[3]}": maugis.work_to_pull_off(**case) / (load * height),
        }
        return closed_form(end, record, (states.depth / height, states.force / load), labels)


@dataclass(frozen=True, kw_only=True)
class OfCrack(Operation):
    """Compute a contact history with the steady-crack contact model.

    The problem is given as for simulate sphere, by options or by a file in SI. The model has no
    fitted constant and holds for Tabor numbers above a few. It takes about 0.1 s.

    Example: viscotack theory crack-contact --tabor 10000 --material sls --modulus-ratio 0.1
    --preload 200000 --rate 10000
    """

    word: ClassVar = "theory crack-contact"
    outputs: ClassVar = (csv_file("Write the history as CSV, dimensionless.", "curve"), picture())
    takes_own: ClassVar = True

    problem: Annotated[Statement, Stated("The contact, of a sphere.", whole=False)]

    def answer(self, caller: Caller) -> Answer:
        """Compute the history."""
        from viscotack.methods.by_crack import crack_contact, summary
        from viscotack.problem import Groups, Problem

        problem = self.problem.problem
        assert isinstance(problem, Problem | Groups), "stated as that of a sphere"
        found = crack_contact(problem)
        record = summary(found)
        return Answer(
            found,
            record=lambda: record,
            words=lambda: record_words(record),
            files={"curve": as_text(lambda: _table(found))},
            pictures={"plot": lambda: _drawn(found)},
            notes=self.problem.notes,
        )


def _table(found: "CrackContact") -> str:
    names = ("time", "depth", "force", "contact_radius", "edge_speed", "amplification", "move")
    rows = zip(*(getattr(found, name).tolist() for name in names), strict=True)
    lines = [",".join(map(repr, row)) for row in rows]
    return "\n".join([",".join(names), *lines]) + "\n"


def _drawn(found: "CrackContact") -> "Figure":
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained")
    axes = figure.subplots()
    axes.plot(found.depth, found.force)
    if found.depth_at_pull_off is not None and found.pull_off_force is not None:
        band = found.band * found.pull_off_force
        axes.errorbar(found.depth_at_pull_off, -found.pull_off_force, yerr=band, fmt="o", capsize=3)
    axes.set_xlabel("depth / h0")
    axes.set_ylabel("force / (1.5 pi R dg0)")
    axes.axhline(0.0, color="0.7", linewidth=0.8)
    return figure
