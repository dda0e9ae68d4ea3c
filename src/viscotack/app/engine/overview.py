"""Fast overview of a case: closed-form theories and surrogates, in milliseconds.

Every part takes milliseconds, so that the page can update while numbers are dragged: no simulation
and no slow theory is run. Curves are in SI, force (for a punch the mean stress) positive in
compression, depth positive into the solid.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from viscotack.app.engine.state import State
from viscotack.app.operations.parts.json_data import drawn, plain
from viscotack.app.operations.theory_punch import pad_of
from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.model.geometry import Disc, FlatPunch, Layer
from viscotack.model.materials import RetardationPowerLaw
from viscotack.model.problem import Groups, Problem
from viscotack.model.problem.outputs import PLANE, REVOLUTION, Kind
from viscotack.model.protocol import AtDepth, AtForce, AtRadius, Start, states
from viscotack.prediction import predict
from viscotack.prediction.advice import estimate_by
from viscotack.prediction.power_laws import SURROGATE
from viscotack.prediction.prediction import Prediction
from viscotack.prediction.punches import inputs_of
from viscotack.prediction.surrogate import store
from viscotack.prediction.surrogate.punch_physics import HIGH, LOW, RATE
from viscotack.prediction.table import predict_table
from viscotack.prediction.theories import forms_of
from viscotack.prediction.tier import Question
from viscotack.prediction.tiers import AT_ONCE, TIERS
from viscotack.theory.elastic.relaxed import contact, curve, ends
from viscotack.theory.punch import unloading
from viscotack.units import readable_interval

# Speeds of the picture of force against speed, in one table or one by one at a millisecond each,
# and how many decades around the present one.
_SPEEDS, _FEW, _DECADES = 41, 17, 4.0
_POINTS = 80
# A contact of an indenter of revolution is looked for up to this multiple of the radius (pi R^2
# dg0/E0*)^(1/3), and a curve without a start is drawn to this one.
_LARGEST, _USUAL = 300.0, 2.0
UNLOADING = next(tier for tier in TIERS if tier.name == "unloading")
_WORK = "work_to_pull_off"
_INPUTS = {AtDepth: "preload", AtForce: "preload_force", AtRadius: "preload_radius"}


def quick(state: State, *, confidence: float = 0.9) -> dict[str, Any]:
    """Evaluate fast theories and surrogates for a case; returns plain data.

    Parameters
    ----------
    state : State
        The case.
    confidence : float
        Of the intervals of what was learned.

    Returns
    -------
    dict
        ``axes``: names and units; ``groups``: the dimensionless numbers; ``curves``: name ->
        ``depth`` and ``force``, what it is in ``words``, whether it ``applies`` and ``why``;
        ``numbers``: pull-off and work with their intervals; ``speeds``: pull-off against retraction
        speed; ``start``: depth, force and radius of the relaxed start; ``notes``: what has no
        answer, and why.

    Raises
    ------
    ValueError
        If the state states no case, or an impossible one.
    """
    problem = state.problem
    found = {
        "axes": _axes(problem),
        "groups": plain(problem.groups().inputs),
        "curves": {},
        "numbers": [],
        "speeds": None,
        "start": None,
        "notes": [],
    }
    if isinstance(problem.geometry, FlatPunch):
        _pad(problem, found)
    else:
        _elastic(problem, found)
        _edge(problem, found)
    _learned(problem, found, confidence)
    return found


def _axes(problem: Problem) -> dict[str, Any]:
    kind = PLANE if isinstance(problem.geometry, FlatPunch) else REVOLUTION
    scales = problem.scales()
    force, depth, edge = (kind.of(name) for name in ("force", "depth", "contact_radius"))
    named = {"force": force, "depth": depth, "radius": edge, "time": kind.of("time")}
    axes = {name: {"words": x.words, "unit": x.unit.si} for name, x in named.items()}
    # a punch's tension is drawn as every force is, compression upwards
    axes["force"]["words"] = "mean stress" if kind is PLANE else "force"
    numbers = {name: kind.observables[name] for name in (pulled(kind), _WORK)}
    axes |= {name: {"words": x.words, "unit": x.unit.si} for name, x in numbers.items()}
    return axes | {
        "pulled": axes[pulled(kind)] | {"name": pulled(kind)},
        "speed": {"words": "retraction speed", "unit": "m/s"},
        "pressure": {"words": "pressure", "unit": "Pa"},
        "gap": {"words": "gap", "unit": "m"},
        "along": {"words": "radius" if kind is REVOLUTION else "from the middle", "unit": "m"},
        "length": float(scales.length),
    }


def pulled(kind: Kind) -> str:
    """Return the name of the pull-off quantity of a kind of problem: force or stress."""
    return f"pull_off_{kind.name_of('force')}"


def _curve(words: str, depth: Any, force: Any, **more: Any) -> dict[str, Any]:
    return {"words": words, "depth": drawn(depth), "force": drawn(force), "applies": True} | more


def _elastic(problem: Problem, found: dict[str, Any]) -> None:
    """Add the curve of the relaxed solid, from the start to detachment on a rigid drive."""
    if isinstance(problem.geometry, Disc):
        found["notes"].append("the JKR curve of a disc, which detaches as a whole, is not drawn")
        return
    solid: Any = {
        "body": problem.body,
        "contact_modulus": problem.material.contact_modulus,
        "work_of_adhesion": problem.traction.work_of_adhesion,
    }
    shape: Any = problem.geometry
    unit = problem.scales().radius
    depth, force = curve(shape, **solid)
    last = ends(shape, **solid)[0].contact_radius
    contacts = (contact(state, shape=shape, **solid) for state in states(problem.protocol))
    held = [x for x in contacts if x is not None and x.contact_radius < _LARGEST * unit]
    start = max(held, key=lambda x: x.contact_radius, default=None)
    if start is None:
        found["notes"].append("JKR has no contact at the start depth or force")
    radii = np.linspace(_USUAL * unit if start is None else start.contact_radius, last, _POINTS)
    found["curves"]["elastic"] = _curve(
        "infinitely slow, short range (JKR)",
        depth(radii),
        force(radii),
        radius=drawn(radii),
    )
    if start is not None and isinstance(problem.protocol.start, Start):
        found["start"] = {
            "depth": start.depth,
            "force": start.force,
            "radius": start.contact_radius,
        }


def _edge(problem: Problem, found: dict[str, Any]) -> None:
    """Add the curve of a moving edge on a relaxed bulk, and whether it applies."""
    question = Question(problem)
    try:
        curve = question.once(forms_of).curve
    except InputError:  # of another test or shape; the advisor gives the reason
        return
    if curve is None:
        return
    estimate = estimate_by(UNLOADING, question)
    scales = problem.scales()
    keep = np.unique(np.linspace(0, len(curve.depth) - 1, 2 * _POINTS).astype(int))
    found["curves"]["edge"] = _curve(
        "relaxed bulk, edge a viscoelastic crack",
        curve.depth[keep] * scales.length,
        curve.force[keep] * scales.force,
        radius=drawn(curve.contact_radius[keep] * scales.radius),
        applies=estimate.applies,
        why=estimate.why,
    )


def _learned(problem: Problem, found: dict[str, Any], confidence: float) -> None:
    """Add the surrogate, if the case is in its range."""
    try:
        answer = predict(problem, confidence=confidence, budget=AT_ONCE)
    except OutOfRange as error:
        found["notes"].append(f"surrogate: {error}")
        return
    scales, curve, punch = problem.scales(), answer.curve, isinstance(problem.geometry, FlatPunch)
    load, edge = (scales.stress, scales.width) if punch else (scales.force, scales.radius)
    if curve is not None:
        found["curves"]["surrogate"] = _curve(
            f"learned from {'6,000' if punch else '30,000'} simulations",
            curve.depth * scales.length,
            curve.force * load,
            radius=drawn(curve.contact_radius * edge),
            interval=[x * load for x in answer.interval],
            confidence=confidence,
        )
    found["numbers"] = numbers_of(answer)
    if curve is None:
        found["notes"].append(f"surrogate: {answer.why}")
    # a surrogate may withhold work and curve at this speed, and state the force at all of them
    if curve is not None or answer.method.startswith("surrogate"):
        found["speeds"] = _speeds(answer)


def numbers_of(answer: Prediction) -> list[dict[str, Any]]:
    """Return force and work of a prediction in SI, each with its interval."""
    kind, scales = answer.problem.outputs, answer.problem.scales()
    given = (
        (pulled(kind), answer.pull_off_force, answer.interval),
        (_WORK, answer.work_to_pull_off, answer.work_interval),
    )
    units = {name: getattr(scales, kind.observables[name].unit.scale) for name, *_ in given}
    return [
        {
            "name": name,
            "value": value * units[name],
            "interval": [x * units[name] for x in interval],
            "band": _band(interval, units[name], kind.observables[name].unit.si, answer.confidence),
            "method": answer.method,
            "confidence": answer.confidence,
            "why": answer.why,
        }
        for name, value, interval in given
        if value is not None and interval is not None
    ]


def _band(interval: tuple[float, float], scale: float, unit: str, confidence: float | None) -> str:
    """Return an interval in words."""
    words = readable_interval(interval[0] * scale, interval[1] * scale, unit)
    return words if confidence is None else f"{words} in {100 * confidence:.3g} % of cases"


def by_speed(speed: Any, forces: Any, problem: Problem, words: str) -> dict[str, Any]:
    """Return the curve of force by speed: forces, and the ends of their intervals, in SI."""
    force, low, high = map(drawn, forces)
    return {
        "speed": drawn(speed),
        "force": force,
        "low": low,
        "high": high,
        "here": problem.protocol.speed,
        "words": words,
    }


def _speeds(answer: Prediction) -> dict[str, Any]:
    """Return the pull-off at other speeds, within the range of the surrogate."""
    problem, confidence = answer.problem, answer.confidence
    assert isinstance(problem, Problem) and confidence is not None
    groups, scales = problem.groups(), problem.scales()
    punch = isinstance(problem.geometry, FlatPunch)
    assert groups.rate is not None
    least, most = groups.rate * 10**-_DECADES, groups.rate * 10**_DECADES
    if punch or answer.inside and answer.method == SURROGATE:
        inputs = inputs_of(groups) if punch else _inputs(groups)
        low, high = (LOW[RATE], HIGH[RATE]) if punch else store.shipped().limits["rate"]
        rates = np.geomspace(max(low * 1.0001, least), min(high / 1.0001, most), _SPEEDS)
        columns = {name: np.full(_SPEEDS, value) for name, value in inputs.items()}
        found = predict_table(columns | {"rate": rates}, confidence=confidence)
        name = pulled(problem.outputs)
        forces = [found[f"{name}{end}"] for end in ("", "_low", "_high")]
    else:
        rates, forces = _one_by_one(groups, np.geomspace(least, most, _FEW), confidence)
    load = scales.stress if punch else scales.force
    speeds = rates * scales.length / scales.time
    return by_speed(speeds, [each * load for each in forces], problem, "surrogate")


def _inputs(groups: Groups) -> dict[str, float]:
    """Return the inputs of the surrogate of power laws."""
    assert isinstance(groups.material, RetardationPowerLaw)
    return {
        "tabor": groups.tabor,
        "modulus_ratio": groups.modulus_ratio,
        "exponent": groups.material.exponent,
        _INPUTS[type(groups.start)]: groups.start.value,  # type: ignore[index]
    }


def _one_by_one(groups: Groups, rates: Array, confidence: float) -> tuple[Array, Array]:
    """Return the rates at which other surrogates answer, and the forces with their intervals."""
    found = []
    for rate in rates.tolist():
        try:
            one = predict(replace(groups, rate=rate), confidence=confidence, budget=AT_ONCE)
        except OutOfRange:
            continue
        found.append((rate, one.pull_off_force, *one.interval))
    columns = np.array(found).T
    return columns[0], columns[1:]


def _pad(problem: Problem, found: dict[str, Any]) -> None:
    """Add the elastic pad, and the pull-off stress of viscoelastic edges against the speed."""
    geometry, body, speed = problem.geometry, problem.body, problem.protocol.speed
    assert isinstance(geometry, FlatPunch) and isinstance(body, Layer)
    pad = pad_of(problem)
    stress = float(np.asarray(pad.elastic_stress(body.thickness)))
    stiffness = -stress / float(np.asarray(pad.elastic_depth(body.thickness)))
    # the stress is limited by the strength of the interface
    stress = min(stress, pad.strength)
    pressed = _pressed(problem, stiffness)
    ways = np.array([pressed, -stress / stiffness])
    found["curves"]["elastic"] = _curve("infinitely slow, short range", ways, ways * stiffness)
    found["start"] = {"depth": pressed, "force": pressed * stiffness, "radius": None}
    if body.thickness > 5 * geometry.half_width:
        found["notes"].append(
            "moving edges: the theory holds for layers thinner than 5 half widths"
        )
        return
    if speed is None or problem.material.modulus_ratio >= 1:
        return
    speeds = np.geomspace(speed * 10**-_DECADES, speed * 10**_DECADES, 17)
    law = pad.crack_law("persson-brener", material=problem.material)
    forces = np.asarray(unloading.pull_off(speeds, pad, law, thickness=body.thickness).stress)
    # 1 % low to 19 % high of 35 simulations (viscotack.theory.punch.unloading)
    band = forces, forces / 1.19, forces / 0.99
    found["speeds"] = by_speed(speeds, band, problem, "edges that are viscoelastic cracks")


def _pressed(problem: Problem, stiffness: float) -> float:
    """Return the depth of the relaxed start of a punch in full contact."""
    match problem.protocol.start:
        case AtDepth(depth=value):
            return value
        case AtForce(force=value):
            return value / stiffness
    return 0.0
