r"""Conformance checks for traction laws.

With the energy :math:`\varphi` per unit area at a gap h: :math:`\sigma = d\varphi/dh`, tension
positive; :math:`\varphi(h_0) = -\Delta\gamma_0`, :math:`\varphi(\infty) = 0`; the stiffness is
:math:`d\sigma/dh`. Derivatives are checked as integrals between neighbouring gaps, because the
traction may have kinks and the stiffness discontinuities.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.cards import check_carded
from viscotack.materials.branched_solids import Elastic
from viscotack.problem import Groups
from viscotack.protocol import AtForce
from viscotack.result.observables import pull_off_force
from viscotack.traction import Tabulated, at_rest, effective_range, has_rest, softening

from . import round_trips, simulated
from .findings import Finding, Report, holds, report, same

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
# Tabor numbers for the effective range: a contact near JKR, and one near Bradley's rigid sphere.
_JKR, _BRADLEY = 5.0, 0.05
# Modulus of a solid for a rough surface [work of adhesion over equilibrium gap].
_SOFT = 100.0


def check_law(law: Any, *, thorough: bool = True) -> Report:
    """Check the identities, limits and bounds of a traction law on which the package relies.

    Parameters
    ----------
    law : Traction
        A law in SI, from the package or user-defined. For a law that grows or ages the
        law at rest is checked.
    thorough : bool
        Whether also to simulate contacts near the JKR and Bradley limits, which takes seconds.

    Returns
    -------
    Report
        The findings.

    Examples
    --------
    >>> from viscotack.traction import LennardJones
    >>> check_law(LennardJones(0.05, 1e-9), thorough=False).passed
    True
    """
    checks = (
        _constants,
        _identities,
        _far,
        _peak,
        _units,
        _case_file,
        _flag,
    )
    return report(law, checks + ((_campaign, _contacts) if thorough else ()), room="laws")


def _gaps(law: Any) -> npt.NDArray[np.float64]:
    """Gaps from compressed to far apart, finer where the law may be discontinuous."""
    reach = effective_range(law)
    beyond = np.concatenate([np.linspace(0, 4, 1600), np.geomspace(4, 1e3, 300)[1:]])
    return law.equilibrium_gap * np.concatenate([np.linspace(0.6, 0.999, 200), 1 + reach * beyond])


def _integrals(function: Callable[[Any], Any], h: npt.NDArray[np.float64]) -> Any:
    half, middle = np.diff(h) / 2, (h[1:] + h[:-1]) / 2
    values = np.asarray(function(middle[:, None] + half[:, None] * _NODES))
    return half * (values @ _WEIGHTS)


def _constants(law: Any) -> Iterator[Finding]:
    """Check the constants of the law."""
    work, gap, reach = law.work_of_adhesion, law.equilibrium_gap, effective_range(at_rest(law))
    for name, value in (("work_of_adhesion", work), ("equilibrium_gap", gap), ("range", reach)):
        yield holds(f"{name} is positive", 0 < value < np.inf, "> 0", value)
    fall = softening(at_rest(law))
    yield holds("the tension falls beyond its peak", 0 < fall < np.inf, "a fall", fall)
    if not isinstance(at_rest(law), Tabulated):  # a tabulated law has points, no cards
        check_carded(type(at_rest(law)))


def _identities(law: Any) -> Iterator[Finding]:
    """Check that energy, traction and stiffness are derivatives of each other."""
    law = at_rest(law)
    h, w, s = _gaps(law), law.work_of_adhesion, law.strength
    change = np.diff(np.asarray(law.energy(h)))
    reach = float(np.max(np.abs(law.energy(h))))
    yield same(
        "traction is the derivative of the energy by the gap",
        _integrals(law.traction, h),
        change,
        rtol=1e-3,
        atol=2e-5 * reach,
    )
    total = np.sum(_integrals(law.traction, h[h >= law.equilibrium_gap]))
    name = "the traction does the work of adhesion from h0 to infinity"
    yield same(name, total - float(law.energy(h[-1])), w, rtol=2e-3)
    change, slopes = np.diff(np.asarray(law.traction(h))), _integrals(law.stiffness, h)
    largest = float(np.max(np.abs(law.traction(h))))
    name = "stiffness is the derivative of the traction by the gap"
    yield same(name, slopes, change, rtol=2e-2, atol=max(2e-2 * s, 1e-4 * largest))
    change = -np.diff(np.asarray(law.energy_beyond(h)))
    largest = float(np.max(np.abs(law.energy_beyond(h))))
    name = "energy_beyond is the integral of the energy to infinity"
    yield same(name, _integrals(law.energy, h), change, rtol=1e-3, atol=2e-5 * largest)


def _far(law: Any) -> Iterator[Finding]:
    """Check the law at the equilibrium gap and far apart."""
    law = at_rest(law)
    h0, w, s = law.equilibrium_gap, law.work_of_adhesion, law.strength
    yield same(
        "energy at the equilibrium gap is minus the work of adhesion", law.energy(h0), -w, rtol=1e-6
    )
    yield same("traction at the equilibrium gap is 0", law.traction(h0), 0.0, rtol=0, atol=1e-6 * s)
    far = 1e4 * h0 * max(1.0, effective_range(law))
    yield same("energy far apart is 0", law.energy(far), 0.0, rtol=0, atol=1e-6 * w)
    beyond = law.energy_beyond(far)
    yield same("energy_beyond far apart is 0", beyond, 0.0, rtol=0, atol=1e-3 * w * h0)
    below = np.asarray(law.traction(h0 * np.linspace(0.7, 0.999, 100)))
    found = float(np.max(below))
    yield holds("surfaces repel below the equilibrium gap", found < 0, "traction < 0", found)


def _peak(law: Any) -> Iterator[Finding]:
    """Check the strength and the edge gap."""
    law = at_rest(law)
    largest = float(np.max(law.traction(_gaps(law))))
    fits = law.strength * (1 - 1e-2) <= largest <= law.strength * (1 + 1e-9)
    yield holds("strength is the largest traction", fits, f"{law.strength:.8g}", f"{largest:.8g}")
    at_edge = law.traction(law.edge_gap)
    yield same("traction at edge_gap is the strength", at_edge, law.strength, rtol=1e-6)


def _units(law: Any) -> Iterator[Finding]:
    """Check the reduced law, and other units."""
    law = at_rest(law)
    r, w, h0 = law.reduced(), law.work_of_adhesion, law.equilibrium_gap
    numbers = (r.work_of_adhesion, r.equilibrium_gap)
    yield same("reduced: work 1 and gap 1", numbers, (1.0, 1.0), rtol=1e-12)
    x = np.array([0.8, 1.0, 1.1, 1.5, 3.0, 10.0])
    for name, unit in (
        ("traction", w / h0), ("energy", w), ("energy_beyond", w * h0), ("stiffness", w / h0**2)
    ):  # fmt: skip
        found, expected = unit * np.asarray(getattr(r, name)(x)), getattr(law, name)(x * h0)
        atol = 1e-9 * float(np.max(np.abs(expected)))
        yield same(f"units: {name} of the reduced law", found, expected, rtol=1e-9, atol=atol)
    found = np.shape(law.traction(np.full((2, 3), 1.2 * h0)))
    yield holds("traction: shape of the returned array", found == (2, 3), (2, 3), found)


def _tables(law: Any) -> dict[str, Any]:
    if not has_rest(law):
        return {"interface": {"law": law.word} | round_trips.numbers_of(law)}
    # the base case is reduced: only dimensionless numbers of the law are kept
    pure = {
        name: x for name, x in round_trips.numbers_of(law.base).items() if not isinstance(x, str)
    }
    words = {"law": law.word, "base": law.base.word}
    return {"interface": pure | round_trips.numbers_of(law) | words}


def _case_file(law: Any) -> Iterator[Finding]:
    """Check the round trip through a case file."""
    if not isinstance(at_rest(law), Tabulated):  # a table of points is a file of its own
        yield from round_trips.through_case_file(law, "traction", _tables(law))


def _campaign(law: Any) -> Iterator[Finding]:
    """Check a plan of a campaign."""
    if not isinstance(at_rest(law), Tabulated):
        yield from round_trips.through_campaign(law, _tables(law))


def _flag(law: Any) -> Iterator[Finding]:
    """Check the flag."""
    if has_rest(law) or isinstance(law, Tabulated):
        return
    r = law.reduced()
    scales = {"work_of_adhesion", "equilibrium_gap"}
    rest = [repr(x) for name, x in round_trips.numbers_of(r).items() if name not in scales]
    words = f"{law.word}:{','.join(rest)}" if rest else law.word
    yield round_trips.through_flags(r, "traction", {"law": words})


def _contacts(law: Any) -> Iterator[Finding]:
    """Check simulated contacts near the limits."""
    law = at_rest(law)
    modulus = _SOFT * law.work_of_adhesion / law.equilibrium_gap
    yield from simulated.on_a_map(Elastic(rubbery_modulus=modulus, poisson_ratio=0.0), law)
    law = law.reduced()
    solid = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    reach = effective_range(law)
    groups = Groups(_JKR * reach, solid, AtForce(0.0), 1.0, law)
    force = pull_off_force(simulated.run(groups))
    yield holds(
        "simulation: pull-off at short range is near JKR", 0.97 <= force <= 1.06, "1 to 1.06", force
    )
    groups = replace(groups, tabor=_BRADLEY * reach, start=AtForce(-0.5))
    force = pull_off_force(simulated.run(groups))
    name = "simulation: pull-off at long range is near Bradley"
    yield holds(name, 1.27 <= force <= 1.35, "4/3", force)
    yield from simulated.saved(groups, round_trips.classes_of(law))
