"""Requests of the page: the schema of its case, and fast theories and surrogates for it.

Curves are in SI, force (for a punch the mean stress) positive in compression, depth positive into
the solid. No simulation is run.
"""

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from viscotack.app.operations.options import contact, option
from viscotack.app.operations.parts.record_words import read
from viscotack.app.operations.parts.solid import EXAMPLES, FIRST, library
from viscotack.app.operations.parts.tables import drawn
from viscotack.app.operations.request import Answer, Caller, Request
from viscotack.app.operations.theory import pad_of
from viscotack.errors import InputError, OutOfRange
from viscotack.files.toml import parse_toml
from viscotack.model import geometry
from viscotack.model.problem import Problem
from viscotack.model.problem.outputs import PLANE, REVOLUTION
from viscotack.model.problem.schema import schema
from viscotack.model.protocol import AtDepth, AtForce, states
from viscotack.prediction.advice import advice_on, estimate_by, estimates_without_advice
from viscotack.prediction.cautions import cautions_on
from viscotack.prediction.predict import predict
from viscotack.prediction.prediction import Prediction
from viscotack.prediction.theories import crack_of, forms_of
from viscotack.prediction.tier import Question
from viscotack.prediction.tiers import AT_ONCE, CLOSED_FORMS, CRACK, SIMULATE, SOON, best
from viscotack.simulate.crack_contact.by_crack import CrackContact
from viscotack.theory.elastic import relaxed
from viscotack.units import readable_interval
from viscotack.version import __version__

if TYPE_CHECKING:
    from viscotack.app.operations.statement import Statement

# Ways to begin a test, the usual one first, by the key of the table [protocol] that states them.
_STARTS = {
    "preload_force": "pressed by a load",
    "preload_stress": "pressed by a load",
    "preload_depth": "pressed to a depth",
    "preload_radius": "pressed to a contact radius",
    "start": "apart",
}
_POINTS = 80
# A contact of an indenter of revolution is looked for up to this multiple of the radius (pi R^2
# dg0/E0*)^(1/3), and a curve without a start is drawn to this one.
_LARGEST, _USUAL = 300.0, 2.0
# Speeds at which surrogates and theories are asked, and how many decades around the present one.
_AT_ONCE, _SOON = (17, 4.0), (9, 3.0)
# Frequencies of the picture of a material, and how many decades around 1/its time.
_FREQUENCIES, _WIDE = 81, 8.0
_WORK = "work_to_pull_off"


class Forms(Request):
    """Return the input forms, the published materials and example cases."""

    word: ClassVar = "forms"

    def answer(self, caller: Caller) -> Answer:
        """Return what the page makes its fields from."""
        found = {"schema": schema(caller.also), "starts": _STARTS, "materials": library()}
        return Answer(None, data=found | {"examples": EXAMPLES, "version": __version__})


class CaseFile(Request):
    """Return the tables of the text of a case file, as the page states them."""

    word: ClassVar = "tables"

    toml: Annotated[str, Field(max_length=200_000)] = option("The text.", default=...)

    def answer(self, caller: Caller) -> Answer:
        """Parse the text, and check that it is a case."""
        tables: dict[str, Any] = parse_toml(self.toml, "the file")
        Quick(problem=tables).case(caller)
        return Answer(tables, data={"tables": tables})


class OfCase(Request):
    """A request about the case of the page."""

    problem: Any = contact("The case, in SI.", default=...)

    def case(self, caller: Caller) -> "Statement":
        """Return the problem, in SI."""
        stated = self.stated(caller)
        if not isinstance(stated.problem, Problem):
            raise InputError("the page shows a shape and a test in SI, [protocol]")
        return stated


class Quick(OfCase):
    """Evaluate fast theories and surrogates for a case.

    ``axes``: names and units; ``groups``: the dimensionless numbers; ``curves``: name -> ``depth``
    and ``force``, what it is in ``words``, whether it ``applies`` and ``why``; ``numbers``:
    pull-off and work with their intervals; ``moduli`` of the material; ``notes``: what has no
    answer, and why.
    """

    word: ClassVar = "quick"

    def answer(self, caller: Caller) -> Answer:
        """Evaluate what takes milliseconds, so that the page follows a number that is dragged."""
        problem: Any = self.case(caller).problem
        found: dict[str, Any] = {
            "axes": _axes(problem),
            "groups": problem.groups().inputs,
            "curves": {},
            "numbers": [],
            "moduli": _moduli(problem.material),
            "notes": [],
        }
        if isinstance(problem.geometry, geometry.FlatPunch):
            found["curves"]["elastic"] = _pad(problem)
        else:
            _elastic(problem, found)
            _edge(problem, found)
        _learned(problem, found)
        return Answer(found, data=found)


class Verdict(OfCase):
    """Return the prediction of :func:`viscotack.predict` for a case, and that of every tier.

    ``numbers`` are those of the prediction, or ``refused`` is the reason why there is none.
    ``words`` describe the regime, for the retraction of a relaxed contact of revolution;
    ``tiers`` are rows in SI.
    """

    word: ClassVar = "verdict"

    def answer(self, caller: Caller) -> Answer:
        """Ask all tiers one question, so that the theories are evaluated once."""
        stated = self.case(caller)
        problem: Any = stated.problem
        question, numbers, refused, words = Question(problem), [], "", ()
        try:
            numbers = _numbers(best(question, SOON))
        except InputError as error:
            refused = str(error).removesuffix(f"; {SIMULATE}")
        try:
            advice = advice_on(question)
            words, estimates = advice.statements, advice.estimates
        except InputError:
            estimates = estimates_without_advice(question)
        warned = cautions_on(problem, passport=stated.passport)
        unit = _scale(problem, _pulled(problem))
        tiers = [read(each, "tier", "error", "applies", "why") for each in estimates]
        for row, each in zip(tiers, estimates, strict=True):
            row["value"] = each.pull_off_force and each.pull_off_force * unit
        words = list(dict.fromkeys((*words, *warned)))
        found = {"numbers": numbers, "refused": refused, "words": words, "tiers": tiers}
        return Answer(found, data=found)


class Theory(OfCase):
    """Evaluate what takes seconds: the steady-crack contact, and the pull-off at other speeds."""

    word: ClassVar = "theory"

    def answer(self, caller: Caller) -> Answer:
        """Compute both, as far as they hold."""
        problem: Any = self.case(caller).problem
        # surrogates where there are some, because theories take seconds
        speeds = _by_speed(problem, AT_ONCE, *_AT_ONCE) or _by_speed(problem, SOON, *_SOON)
        found = {"crack": _crack(problem), "speeds": speeds}
        return Answer(found, data=found)


REQUESTS = (CaseFile, Quick, Verdict, Theory)


def warm() -> None:
    """Run slow initialisations once."""
    Quick(problem=FIRST).answer(Caller())


def _axes(problem: Any) -> dict[str, Any]:
    """Return words and units of what is drawn."""
    kind = PLANE if isinstance(problem.geometry, geometry.FlatPunch) else REVOLUTION
    pulled = _pulled(problem)
    named = {name: kind.of(name) for name in ("force", "depth")}
    named |= {name: kind.observables[name] for name in (pulled, _WORK)}
    axes: dict[str, Any] = {n: {"words": x.words, "unit": x.unit.si} for n, x in named.items()}
    # a punch's tension is drawn as every force is, compression upwards
    axes["force"]["words"] = "mean stress" if kind is PLANE else "force"
    return axes | {
        "pulled": axes[pulled] | {"name": pulled},
        "speed": {"words": "retraction speed", "unit": "m/s"},
        "along": {"words": "radius" if kind is REVOLUTION else "from the middle", "unit": "m"},
        "length": float(problem.scales().length),
    }


def _pulled(problem: Any) -> str:
    """Return the name of the pull-off quantity of a problem: force or stress."""
    return f"pull_off_{problem.outputs.name_of('force')}"


def _scale(problem: Any, name: str) -> float:
    """Return the unit of a number of a prediction."""
    return getattr(problem.scales(), problem.outputs.observables[name].unit.scale)


def _curve(words: str, depth: Any, force: Any, **more: Any) -> dict[str, Any]:
    return {"words": words, "depth": drawn(depth), "force": drawn(force)} | more


def _moduli(material: Any) -> dict[str, Any]:
    """Return storage and loss modulus of a material over the frequencies that matter."""
    frequency = np.logspace(-_WIDE, _WIDE, _FREQUENCIES) / material.time_unit
    modulus = np.asarray(material.complex_modulus(2 * np.pi * frequency))
    parts = {"frequency": frequency, "storage": np.real(modulus), "loss": np.imag(modulus)}
    return {name: drawn(values) for name, values in parts.items()}


def _elastic(problem: Any, found: dict[str, Any]) -> None:
    """Add the curve of the relaxed solid, from the start to detachment on a rigid drive."""
    if isinstance(problem.geometry, geometry.Disc):
        found["notes"].append("The JKR curve of a disc, which detaches as a whole, is not drawn.")
        return
    solid: Any = {
        "body": problem.body,
        "contact_modulus": problem.material.contact_modulus,
        "work_of_adhesion": problem.traction.work_of_adhesion,
    }
    shape, unit = problem.geometry, problem.scales().radius
    depth, force = relaxed.curve(shape, **solid)
    last = relaxed.ends(shape, **solid)[0].contact_radius
    contacts = (relaxed.contact(x, shape=shape, **solid) for x in states(problem.protocol))
    radii = [x.contact_radius for x in contacts if x is not None]
    start = max((a for a in radii if a < _LARGEST * unit), default=None)
    if start is None:
        found["notes"].append("JKR has no contact at the start depth or force.")
    radii = np.linspace(_USUAL * unit if start is None else start, last, _POINTS)
    found["curves"]["elastic"] = _curve(
        "infinitely slow, short range (JKR)", depth(radii), force(radii)
    )


def _pad(problem: Any) -> dict[str, Any]:
    """Return the curve of an elastic pad, from its start in full contact."""
    pad, thickness = pad_of(problem), problem.body.thickness
    stress = float(np.asarray(pad.elastic_stress(thickness)))
    stiffness = -stress / float(np.asarray(pad.elastic_depth(thickness)))
    start = problem.protocol.start
    pressed = {AtDepth: 1.0, AtForce: 1 / stiffness}.get(type(start), 0.0) * start.value
    # the stress is limited by the strength of the interface
    ways = np.array([pressed, -min(stress, pad.strength) / stiffness])
    return _curve("infinitely slow, short range", ways, ways * stiffness)


def _edge(problem: Any, found: dict[str, Any]) -> None:
    """Add the curve of a moving edge on a relaxed bulk, and whether it applies."""
    question = Question(problem)
    try:
        curve = question.once(forms_of).curve
    except InputError:  # of another test or shape; the advisor gives the reason
        return
    if curve is None:
        return
    estimate, scales = estimate_by(CLOSED_FORMS["unloading"], question), problem.scales()
    keep = np.unique(np.linspace(0, len(curve.depth) - 1, 2 * _POINTS).astype(int))
    found["curves"]["edge"] = _curve(
        "relaxed bulk, edge a viscoelastic crack",
        curve.depth[keep] * scales.length,
        curve.force[keep] * scales.force,
        applies=estimate.applies,
        why=estimate.why,
    )


def _crack(problem: Any) -> dict[str, Any] | None:
    """Return the curve of the contact whose edge is a steady crack, where it holds."""
    question = Question(problem)
    try:
        CRACK.ask(question)
    except (InputError, ArithmeticError):
        return None
    found, scales = question.once(crack_of), problem.scales()
    assert isinstance(found, CrackContact), "the tier has answered"
    depth, force = found.depth * scales.length, found.force * scales.force
    return _curve("edge a steady crack, bulk remembers", depth, force)


def _learned(problem: Any, found: dict[str, Any]) -> None:
    """Add the surrogate, if the case is in its range."""
    try:
        answer = predict(problem, budget=AT_ONCE)
    except OutOfRange:  # the tiers give the reason
        return
    load, curve = _scale(problem, _pulled(problem)), answer.curve
    found["numbers"] = _numbers(answer)
    if curve is not None:
        count = "6,000" if isinstance(problem.geometry, geometry.FlatPunch) else "30,000"
        found["curves"]["surrogate"] = _curve(
            f"learned from {count} simulations",
            curve.depth * problem.scales().length,
            curve.force * load,
            interval=[x * load for x in answer.interval],
            confidence=answer.confidence,
        )


def _by_speed(problem: Any, budget: float, count: int, decades: float) -> dict[str, Any] | None:
    """Return the pull-off at other speeds, as far as the best tier within a budget answers."""
    protocol, rows = problem.protocol, []
    if protocol.speed is None:
        return None
    for speed in (protocol.speed * np.logspace(-decades, decades, count)).tolist():
        other = replace(problem, protocol=replace(protocol, speed=speed))
        try:
            answer = predict(other, budget=budget)
        except (InputError, ArithmeticError):
            continue
        rows.append((speed, answer.pull_off_force, *answer.interval))
    if len(rows) < 2:
        return None
    speeds, *forces = np.array(rows).T
    load = _scale(problem, _pulled(problem))
    curves = zip(("force", "low", "high"), forces, strict=True)
    words = "surrogate" if budget == AT_ONCE else "the best theory of each speed"
    found = {"speed": drawn(speeds)} | {name: drawn(x * load) for name, x in curves}
    return found | {"here": protocol.speed, "words": words}


def _numbers(answer: Prediction) -> list[dict[str, Any]]:
    """Return force and work of a prediction in SI, each with its interval."""
    problem: Any = answer.problem
    given = (
        (_pulled(problem), answer.pull_off_force, answer.interval),
        (_WORK, answer.work_to_pull_off, answer.work_interval),
    )
    found = []
    for name, value, interval in given:
        if value is None or interval is None:
            continue
        scale, unit = _scale(problem, name), problem.outputs.observables[name].unit.si
        low, high = (x * scale for x in interval)
        band = readable_interval(low, high, unit)
        if answer.confidence is not None:
            band += f" in {100 * answer.confidence:.3g} % of cases"
        row = {"name": name, "value": value * scale, "interval": [low, high], "band": band}
        found.append(row | {"method": answer.method, "why": answer.why})
    return found
