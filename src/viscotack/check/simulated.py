"""Checks that simulate a problem, or evaluate predictions of it."""

import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.forecast import advise, predict
from viscotack.methods import solve
from viscotack.problem import Groups
from viscotack.protocol import AtForce, Retraction
from viscotack.result import Result, load, save
from viscotack.result.observables import pull_off_force
from viscotack.rough import RoughProblem, pull
from viscotack.surfaces import self_affine
from viscotack.theory import lennard_jones
from viscotack.traction import effective_range

from .findings import Finding, holds, refused, same

ACCURACY = 1e-2
# Tolerance of the force bounds, which differ between laws of equal work and strength.
_SLACK = 0.03
# Pixels of the side of a rough surface.
_PIXELS = 8


def run(problem: Any, *, accuracy: float = ACCURACY) -> Result:
    """Simulate a problem to pull-off, without an error estimate."""
    return solve(problem, until="pull-off", accuracy=accuracy, estimate_error=False)


def bounds(groups: Groups) -> tuple[float, float]:
    """Return the forces of the slowest and fastest pull-off [1.5 pi R dg0], with a tolerance."""
    mu, k = groups.effective_tabor, groups.modulus_ratio
    slow = float(np.asarray(lennard_jones.pull_off_ratio(mu)))
    fast = float(np.asarray(lennard_jones.pull_off_ratio(mu * k ** (1 / 3)))) / k
    return slow * (1 - _SLACK), fast * (1 + _SLACK)


def between_limits(groups: Groups) -> Iterator[Finding]:
    """Check that the simulated force lies between the slow and the fast limit."""
    result = run(groups)
    force, (low, high) = pull_off_force(result), bounds(groups)
    name = "simulation: pull-off between the slow and the fast limit"
    yield holds(name, low <= force <= high, f"{low:.4g} to {high:.4g}", f"{force:.4g}")
    residual = result.energy_residual
    if residual is not None:
        name = "simulation: the energy audit closes"
        yield holds(name, abs(residual) < 0.02, "a residual below 0.02", residual)


def in_si(groups: Groups, *, modulus: float, poisson_ratio: float) -> Iterator[Finding]:
    """Check that a problem in SI has the same dimensionless force."""
    problem = groups.in_si(
        radius=2e-3,
        contact_modulus=modulus / (1 - poisson_ratio**2),
        work_of_adhesion=0.03,
        time_unit=0.7,
        poisson_ratio=poisson_ratio,
    )
    found, expected = (pull_off_force(run(p)) for p in (problem, groups))
    yield same("simulation: the force is the same in SI", found, expected, rtol=1e-6)


def saved(problem: Any, also: Iterable[type]) -> Iterator[Finding]:
    """Check that a result is unchanged after saving and loading."""
    result, also = run(problem), tuple(also)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.npz"
        save(result, path)
        back = load(path, also=also)
    equal = bool(np.array_equal(back.force, result.force)) and back.problem == result.problem
    yield holds("result: saved and loaded", equal, "the same force and problem", back.problem)


def on_a_map(material: Any, law: Any) -> Iterator[Finding]:
    """Check that a small rough surface is pulled off within the limits of the law."""
    along = material.contact_modulus * law.equilibrium_gap**2 / law.work_of_adhesion
    pixel = along * effective_range(law) ** 2 / 4
    surface = self_affine(
        _PIXELS,
        pixel,
        hurst=0.8,
        rms_height=min(0.5 * law.equilibrium_gap, 0.2 * pixel),
        seed=1,
        shortest=6 * pixel,
    )
    start = AtForce(0.05 * law.strength * surface.area)
    speed = law.equilibrium_gap / material.time_unit if material.time_unit else 1e-6
    problem = RoughProblem(
        surface=surface,
        material=material,
        traction=law,
        protocol=Retraction(start=start, speed=speed),
    )
    found = pull(problem, accuracy=ACCURACY, estimate_error=False)
    stress, most = found.pull_off_stress, law.strength * (1 + _SLACK)
    name = "rough surface: pulled off with at most the strength of the law"
    yield holds(name, found.has_separated and 0 < stress <= most, f"up to {most:.4g} Pa", stress)
    name = "rough surface: the energy audit closes"
    yield holds(name, found.energy_residual < 0.02, "a residual below 0.02", found.energy_residual)


def answered(groups: Groups) -> Iterator[Finding]:
    """Check that predictions lie within their limits or return a reason."""
    low, high = bounds(groups)
    where = f"at a Tabor number of {groups.tabor:g}"
    try:
        found = predict(groups)
        force, (least, most) = found.pull_off_force, found.interval
        holds_it = least <= force <= most and least <= high and most >= low
        words = f"{force:.4g} in {least:.4g} to {most:.4g} by {found.method}"
    except Exception as error:
        holds_it, words = refused(error), f"{type(error).__name__}: {error}"
    yield holds(f"predict {where}", holds_it, f"{low:.4g} to {high:.4g}, or a reason", words)
    try:
        best = advise(groups).estimates
        forces = [e.pull_off_force for e in best if e.applies and e.pull_off_force is not None]
        wrong = [f for f in forces if not low * 0.9 <= f <= high * 1.1]
        holds_it, words = not wrong, f"{wrong}"
    except Exception as error:
        holds_it, words = refused(error), f"{type(error).__name__}: {error}"
    yield holds(f"advise {where}", holds_it, f"{low:.4g} to {high:.4g}, or a reason", words)
