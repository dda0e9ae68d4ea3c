"""Tasks of the page that take milliseconds to seconds: states, predictions, advice, materials."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from viscotack.app.operations.parts.examples import EXAMPLES, FIRST
from viscotack.app.operations.parts.json_data import drawn, plain
from viscotack.app.operations.parts.library import library
from viscotack.errors import InputError
from viscotack.model.geometry import FlatPunch
from viscotack.model.problem import Problem
from viscotack.prediction import cautions_on, predict
from viscotack.prediction.advice import advice_on, estimates_without_advice
from viscotack.prediction.closed_forms import Estimate
from viscotack.prediction.tier import Question
from viscotack.prediction.tiers import SOON, best
from viscotack.simulate.crack_contact import crack_contact
from viscotack.simulate.crack_contact.by_crack import METHOD
from viscotack.version import __version__

from .forms import forms
from .overview import by_speed, numbers_of, pulled, quick
from .state import State, state_of_toml

Tell = Callable[[dict[str, Any]], None]
Asked = Mapping[str, Any]

# Speeds of the theories' picture, and how many decades around the present one.
_SPEEDS, _DECADES = 9, 3.0
# Frequencies of the picture of a material, and how many decades around 1/its time.
_FREQUENCIES, _WIDE = 81, 8.0


def warm() -> None:
    """Run slow initialisations once."""
    quick(State(FIRST))


def ask_forms(asked: Asked, *, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Return the input forms, the published materials and example cases."""
    return forms(also) | {"materials": library(), "examples": EXAMPLES, "version": __version__}


def ask_state(asked: Asked, *, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Return the tables of a case file; one that states no case is refused."""
    state = state_of_toml(asked["toml"], also)
    state.problem  # noqa: B018
    return {"tables": plain(dict(state.tables))}


def ask_quick(asked: Asked, *, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Return the fast overview of a state, and the state as file, command and Python."""
    state = State(asked["tables"], also)
    run = {"accuracy": asked["accuracy"], "until": asked["until"]}
    return quick(state, confidence=asked["confidence"]) | {
        "toml": state.toml,
        "command": state.command(**run),
        "python": state.python(**run),
    }


def ask_moduli(asked: Asked, *, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Return storage and loss modulus of a state's material over the frequencies that matter."""
    material = State(asked["tables"], also).problem.material
    frequency = np.logspace(-_WIDE, _WIDE, _FREQUENCIES) / material.time_unit
    modulus = np.asarray(material.complex_modulus(2 * np.pi * frequency))
    return {
        "frequency": drawn(frequency),
        "storage": drawn(np.real(modulus)),
        "loss": drawn(np.imag(modulus)),
    }


def ask_verdict(asked: Asked, *, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Return the prediction of :func:`viscotack.predict` for a state, and that of every tier.

    ``numbers`` are those of the prediction, or ``refused`` is the reason why there is none.
    ``words`` describe the regime, for the retraction of a relaxed contact of revolution;
    ``tiers`` are rows in SI.
    """
    state = State(asked["tables"], also)
    problem = state.problem
    # one question, so that the theories are evaluated once
    question, numbers, refused, words = Question(problem), [], "", ()
    try:
        numbers = numbers_of(best(question, SOON))
    except InputError as error:
        refused = f"{str(error)[:1].upper()}{str(error)[1:]}."
    try:
        advice = advice_on(question)
        words, estimates = advice.statements, advice.estimates
    except InputError:
        estimates = estimates_without_advice(question)
    warned = cautions_on(problem, passport=state.passport)
    revolution = not isinstance(problem.geometry, FlatPunch)
    return {
        "numbers": numbers,
        "refused": refused,
        "words": list(dict.fromkeys((*words, *warned))),
        "tiers": [_in_si(each, problem) for each in estimates],
        "crack": any(each.tier == METHOD and each.applies for each in estimates)
        or (revolution and not words),
    }


def _in_si(estimate: Estimate, problem: Problem) -> dict[str, Any]:
    value = estimate.pull_off_force
    scale = problem.outputs.observables[pulled(problem.outputs)].unit.scale
    return plain(
        {
            "tier": estimate.tier,
            "value": None if value is None else value * getattr(problem.scales(), scale),
            "error": estimate.error,
            "applies": estimate.applies,
            "why": estimate.why,
        }
    )


def ask_theory(asked: Asked, *, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Evaluate the slow theories for a state."""
    problem = State(asked["tables"], also).problem
    return {
        "crack": _crack(problem) if asked["crack"] else None,
        "speeds": _speeds(problem) if asked["speeds"] else None,
    }


def _crack(problem: Problem) -> dict[str, Any] | None:
    """Return the curve of the contact whose edge is a steady crack, where it holds."""
    try:
        found = crack_contact(problem)
    except (InputError, ArithmeticError):
        return None
    scales = problem.scales()
    return {
        "words": "edge a steady crack, bulk remembers",
        "depth": drawn(found.depth * scales.length),
        "force": drawn(found.force * scales.force),
        "radius": drawn(found.contact_radius * scales.radius),
        "applies": found.inside,
        "why": found.why,
        "band": found.band,
    }


def _speeds(problem: Problem) -> dict[str, Any] | None:
    """Return the pull-off force at other speeds by the theories, as far as one answers."""
    protocol, scales = problem.protocol, problem.scales()
    if protocol.speed is None:
        return None
    speeds = protocol.speed * np.logspace(-_DECADES, _DECADES, _SPEEDS)
    rows = []
    for speed in speeds.tolist():
        try:
            answer = predict(replace(problem, protocol=replace(protocol, speed=speed)))
        except (InputError, ArithmeticError):
            continue
        rows.append((speed, answer.pull_off_force, *answer.interval))
    if len(rows) < 2:
        return None
    speed, *forces = np.array(rows).T
    in_si = [each * scales.force for each in forces]
    return by_speed(speed, in_si, problem, "the best theory of each speed")
