"""The operations ``theory jkr``, ``disc``, ``maugis`` and ``crack-contact``: no simulation."""

from dataclasses import replace
from typing import Annotated, Any, ClassVar

import numpy as np

from viscotack.app.operations.parts.solid import OnLayer
from viscotack.errors import InputError
from viscotack.files.text import write_table

from .options import Number, contact, csv_file, number, picture, quoted
from .parts.closed_form import closed_form
from .parts.record_words import read
from .request import Answer, Caller, Request

_RADIUS = Number('Sphere radius R, "5.19 mm".', unit="m", above=0)
_MODULUS = Number('E* = E/(1 - nu^2), "1.94 MPa".', unit="Pa", above=0)
_WORK = Number('dg0, "0.1523 J/m^2".', unit="J/m^2", above=0)


class Jkr(OnLayer):
    """Detachment of an elastic sphere, forces of short range (JKR), from a half-space or a film.

    Example: viscotack theory jkr --radius "1 mm" --contact-modulus "1 MPa" --work-of-adhesion
    "50 mJ/m^2" --thickness "60 um" --bonded 0.49
    """

    word: ClassVar = "theory jkr"
    outputs: ClassVar = (picture(),)

    radius: Annotated[float, _RADIUS]
    contact_modulus: Annotated[float, _MODULUS]
    work_of_adhesion: Annotated[float, _WORK]

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.model.geometry import HalfSpace, Layer, Sphere
        from viscotack.model.protocol import AtForce
        from viscotack.theory import film
        from viscotack.theory.elastic import relaxed

        body = self.body
        solid: Any = {"shape": Sphere(self.radius)}
        solid |= self.values("contact_modulus", "work_of_adhesion")
        end, fold = film.pull_off(body=body, **solid), film.instability(body=body, **solid)
        free = relaxed.contact(AtForce(0.0), body=body, **solid)
        assert free is not None, "every JKR contact has a state without load"
        record = {
            "pull_off_force_N": -end.force,
            "contact_radius_at_pull_off_m": end.contact_radius,
            "depth_at_pull_off_m": end.depth,
            "work_to_pull_off_J": film.work_to_pull_off(body=body, **solid),
            "contact_radius_without_load_m": free.contact_radius,
            "instability_depth_m": fold.depth,
        }
        if isinstance(body, Layer):
            limit = self.values("radius", "work_of_adhesion")
            record |= {
                "over_half_space": end.force / film.pull_off(body=HalfSpace(), **solid).force,
                "thin_limit_N": film.thin_limit(base=body.base, **limit),
                "half_space_thickness_m": film.half_space_thickness(base=body.base, **solid),
            }
        a = np.linspace(0.0, 1.5 * float(free.contact_radius), 201)[1:]
        depth, force = relaxed.curve(body=body, **solid)
        return closed_form(end, record, (depth(a), force(a)), ("depth [m]", "force [N]"))


class OfDisc(OnLayer):
    """Detachment of a disc, the flat end of a cylinder, from a half-space or a film (Kendall).

    Example: viscotack theory disc --radius "1 mm" --contact-modulus "1 MPa" --work-of-adhesion
    "50 mJ/m^2" --strength "50 kPa" --thickness "200 um" --bonded 0.49
    """

    word: ClassVar = "theory disc"
    outputs: ClassVar = (picture("Draw the force against the radius of the disc."),)

    radius: float = number('Radius of the disc a, "1 mm".', "m", above=0, default=...)
    contact_modulus: Annotated[float, _MODULUS]
    work_of_adhesion: Annotated[float, _WORK]
    strength: float | None = number(
        'Of the interface, "50 kPa"; its force limits that of Kendall.', "Pa", above=0
    )

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.theory import disc, indenter
        from viscotack.theory.elastic.on_layer import LARGEST as WIDEST

        a, E, body = self.radius, self.contact_modulus, self.body
        solid: Any = {"contact_modulus": E, "work_of_adhesion": self.work_of_adhesion}
        limits: Any = {**solid, "strength": self.strength, "body": body}
        force = disc.pull_off_force(contact_radius=a, **limits)
        stiffness = indenter.stiffness(a, contact_modulus=E, body=body)
        record = {
            "pull_off_force_N": force,
            "depth_at_pull_off_m": -np.asarray(force) / stiffness,
            "stiffness_N_per_m": stiffness,
            "kendall_force_N": disc.pull_off_force(contact_radius=a, body=body, **solid),
        }
        if self.strength is not None:
            uniform = disc.strength_limit(contact_radius=a, strength=self.strength)
            record["strength_force_N"] = uniform
            if self.thickness is None:
                crossover = disc.crossover_radius(strength=self.strength, **solid)
                record["crossover_radius_m"] = crossover
        if self.thickness is not None:
            whole = disc.pull_off_force(contact_radius=a, strength=self.strength, **solid)
            record["over_half_space"] = force / whole
        # the theory of a layer ends at a hundred thicknesses
        most = 10.0 if self.thickness is None else min(10.0, WIDEST * self.thickness / a)
        radii = a * np.geomspace(0.1, most, 61)
        curve = radii, np.asarray(disc.pull_off_force(contact_radius=radii, **limits))
        labels = ("radius of the disc [m]", "pull-off force [N]")
        return closed_form(force, record, curve, labels, logarithmic=True)


class Maugis(Request):
    """Detachment of an elastic sphere, forces of any range (Maugis-Dugdale).

    Example: viscotack theory maugis --radius "1 um" --contact-modulus "1 GPa" --work-of-adhesion
    "50 mJ/m^2" --strength "20 MPa", or: viscotack theory maugis --tabor 1
    """

    word: ClassVar = "theory maugis"
    outputs: ClassVar = (picture(),)

    radius: Annotated[float | None, _RADIUS] = None
    contact_modulus: Annotated[float | None, _MODULUS] = None
    work_of_adhesion: Annotated[float | None, _WORK] = None
    strength: float | None = number('Tension in the ring, "5 MPa".', "Pa", above=0)
    tabor: float | None = number(
        "Instead of all of them, for dimensionless answers: the Tabor number of a "
        "Lennard-Jones contact of the same work and peak tension.",
        above=0,
    )

    def check(self) -> None:
        """Refuse options that exclude each other."""
        given = [name for name, value in self._sphere.items() if value is not None]
        missing = [name for name, value in self._sphere.items() if value is None]
        if self.tabor is not None and given:
            raise InputError(
                f"tabor states the whole problem; leave out {quoted(given)}", field="tabor"
            )
        if self.tabor is None and missing:
            raise InputError(f"{quoted(missing)} missing; or give tabor alone")

    @property
    def _sphere(self) -> dict[str, Any]:
        return self.values("radius", "contact_modulus", "work_of_adhesion", "strength")

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


class OfCrack(Request):
    """Compute a contact history with the steady-crack contact model.

    The problem is given as for simulate sphere, by options or by a file in SI. The model has no
    fitted constant and holds for Tabor numbers above a few. It takes about 0.1 s.

    Example: viscotack theory crack-contact --tabor 10000 --material sls --modulus-ratio 0.1
    --preload 200000 --rate 10000
    """

    word: ClassVar = "theory crack-contact"
    outputs: ClassVar = (csv_file("Write the history as CSV, dimensionless.", "curve"), picture())
    takes_own: ClassVar = True

    problem: Any = contact("The contact, of revolution.", default=...)

    def answer(self, caller: Caller) -> Answer:
        """Compute the history."""
        from viscotack.model.problem import Groups, Problem
        from viscotack.simulate.crack_contact.by_crack import crack_contact, summary

        stated = self.stated(caller)
        problem = stated.problem
        assert isinstance(problem, Problem | Groups), "of no map of heights"
        found = crack_contact(problem)
        record = summary(found)
        labels = ("depth / h0", "force / (1.5 pi R dg0)")
        answer = closed_form(found, record, (found.depth, found.force), labels)
        files = {"curve": lambda target: write_table(read(found, *_HISTORY), target)}
        return replace(answer, files=files, notes=stated.notes)


# Columns of the history.
_HISTORY = ("time", "depth", "force", "contact_radius", "edge_speed", "amplification", "move")
