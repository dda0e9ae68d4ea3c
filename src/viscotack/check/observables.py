"""Conformance checks for observables of a result: independence of units and mesh."""

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.materials.branched_solids import StandardSolid
from viscotack.problem import Groups
from viscotack.problem.nouns import known
from viscotack.protocol import AtForce
from viscotack.result import load, save
from viscotack.result.observables import summary

from . import simulated
from .findings import Finding, Report, holds, refused, report, same

_MEASURES = {"force", "depth", "radius", "speed", "work", "time", "1"}


def check_observable(observable: Any, *, refinement: float = 0.05) -> Report:
    """Check an observable of a result: independence of units, refinement and saving.

    Parameters
    ----------
    observable : Observable
        User-defined, or from the package: name, description, measure and function.
    refinement : float
        Largest relative change allowed when the accuracy of steps and mesh is five times better.

    Returns
    -------
    Report
        The findings.

    Notes
    -----
    Runs four simulations of a standard solid at a Tabor number of 1, which takes some seconds.

    Examples
    --------
    >>> from viscotack import Observable, pull_off_force
    >>> pull = Observable("pull", "pull-off force", "force", pull_off_force)
    >>> check_observable(pull).passed
    True
    """
    return report(observable, (_labels, _answers), refinement)


def _labels(observable: Any, refinement: float) -> Iterator[Finding]:
    """Check name, description and measure."""
    yield holds("name is an identifier", observable.name.isidentifier(), "a name", observable.name)
    described = bool(observable.words.strip())
    yield holds("description is not empty", described, "words", observable.words)
    known_measure = observable.measure in _MEASURES
    yield holds("measure is a known one", known_measure, sorted(_MEASURES), observable.measure)


def _case() -> Groups:
    solid = StandardSolid(rubbery_modulus=1.0, glassy_modulus=5.0, tau0=1.0, poisson_ratio=0.0)
    return Groups(1.0, solid, AtForce(2.0), 1.0)


def _answers(observable: Any, refinement: float) -> Iterator[Finding]:
    """Check the value for a simulation."""
    groups = _case()
    problem = groups.in_si(
        radius=2e-3, contact_modulus=3e6, work_of_adhesion=0.03, time_unit=0.7, poisson_ratio=0.4
    )
    coarse = simulated.run(groups)
    try:
        value = float(observable.function(coarse))
    except ValueError as error:
        yield holds(
            "a missing value raises an error with a reason", refused(error), "a reason", error
        )
        return
    yield holds("the number is finite", np.isfinite(value), "a number", value)
    value_in_si = float(observable.function(simulated.run(problem)))
    name = "the dimensionless value is the same in SI"
    yield same(name, value_in_si, value, rtol=1e-6, atol=1e-9)
    fine = float(observable.function(simulated.run(groups, accuracy=simulated.ACCURACY / 5)))
    yield same("refinement of steps and nodes", value, fine, rtol=refinement, atol=1e-6)
    with tempfile.TemporaryDirectory() as folder:
        save(coarse, Path(folder) / "run.npz")
        again = float(observable.function(load(Path(folder) / "run.npz")))
    yield same("a saved result has the same value", again, value, rtol=1e-12)
    if known((observable,)).observables:
        told = summary(coarse, also=(observable,))
        yield same("the summary contains it", told[observable.name], value, rtol=1e-12)
