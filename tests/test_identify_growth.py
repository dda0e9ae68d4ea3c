"""An interface that grows with speed, from a rate series: found, told from none, forecast."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import viscotack as vt
from rate_tests import LENS, holds, measured, of_other, of_single_cracks
from viscotack.app.operations.parts.report import page
from viscotack.identify import RateSeries, forecast_rates, identify_rates, search
from viscotack.identify import forward as growing
from viscotack.identify.computed import Computed
from viscotack.identify.forward import Forward, FoundGrowth, Growth, Opening
from viscotack.lab.tack import survey
from viscotack.model.materials.shift import WLF

SOLID = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=5e6, tau0=1e-2, poisson_ratio=0.5)
RADIUS, WORK, GAP, PRELOAD = 5e-3, 0.1, 50e-9, 4e-3
LAW = Growth(1e-4, 0.5)
SPEEDS = np.geomspace(1e-6, 1e-3, 4)
CASE = {"material": SOLID, "radius": RADIUS, "preload": PRELOAD, "growth": True}


def forces(law, speeds=SPEEDS):
    return of_single_cracks(Forward(SOLID, RADIUS), (WORK, GAP, PRELOAD), speeds, law)


def fitted(values, **more):
    return identify_rates(RateSeries(measured(values, 0.01, SPEEDS), theory=0.005, **CASE, **more))


@pytest.fixture
def small(monkeypatch):
    """Look for little, on a lattice as small as splines allow."""
    monkeypatch.setattr(growing, "_LATTICE", (0.35, 0.42, 0.5, 0.6))
    monkeypatch.setattr(growing, "LARGEST", 6.0)
    unknowns = [replace(growing.UNKNOWNS[0], high=6.0)]
    unknowns.append(replace(growing.UNKNOWNS[1], low=0.35, high=0.6))
    monkeypatch.setattr(search, "UNKNOWNS", unknowns)
    monkeypatch.setattr(search, "_COARSE", (0.77, 0.77, 0.6, 0.2))
    monkeypatch.setattr(search, "_FINE", (0.38, 0.57, 0.5, 0.2))
    return {"gaps": (20e-9, 120e-9), "work_of_adhesion": (WORK, 0.01 * WORK)}


@pytest.mark.slow
def test_growth_of_adhesion_is_detected_identified_and_forecast(small):
    fit = fitted(forces(LAW), **small)
    truth = {"work_of_adhesion": WORK, "equilibrium_gap": GAP, "exponent": 0.5}
    opening = float(fit.search.opening.speed(GAP))
    truth["strengthening"] = 1 + (opening / LAW.reference_speed) ** 0.5
    for name, value in truth.items():
        assert fit.intervals[name].low < value < fit.intervals[name].high
    assert fit.objective.best(truth).misfit < 1
    assert fit.growth.chance < 1e-3
    # the split is that of the crack itself
    by_interface = fit.growth.pulled.interface
    assert by_interface[-1] > max(by_interface[0], 1.5)
    forecast = forecast_rates(fit, [3e-5, 2e-3])
    assert holds(forecast, forces(LAW, [3e-5, 2e-3]))
    asked = SimpleNamespace(title="", notes="", material="")
    assert "growth exponent" in page(
        SimpleNamespace(fit=fit, survey=survey(LENS), asked=asked), forecast
    )
    shifting = replace(
        fit.passport, temperature=293.15, shift=WLF(reference_temperature=293.15, c1=5.0, c2=150.0)
    )
    with pytest.raises(vt.InputError, match="temperature"):
        forecast_rates(of_other(fit, material=shifting), [3e-5], temperature=310.0)


@pytest.mark.slow
def test_a_series_without_growth_needs_none(small):
    fit = fitted(forces(None), **small)
    assert fit.growth.chance > 0.1
    assert not fit.intervals["exponent"].told
    assert fit.intervals["strengthening"].low == 1.0


def unknowns(gap, strengthening):
    return {"equilibrium_gap": gap, "strengthening": strengthening, "exponent": 0.5}


def test_strengthening_is_read_where_an_edge_opens_the_gap_whatever_the_range():
    opening = Opening(1e-12)
    law = opening.growth(unknowns([1e-8, 1e-7], 3.0))
    assert opening.speed([1e-8, 1e-7]) == pytest.approx([1e-4, 1e-5])
    assert np.sqrt(opening.speed([1e-8, 1e-7]) / law.reference_speed) == pytest.approx(2.0)
    assert np.all(np.isinf(opening.growth(unknowns(1e-8, 1.0)).reference_speed))


@pytest.mark.parametrize("better_by", [0.0, 4.6, 9.2])
def test_chance_is_that_of_two_parameters_more(better_by):
    found = FoundGrowth(1e-4, 1e-4, better_by, None)
    assert found.chance == pytest.approx(np.exp(-better_by / 2))


@pytest.mark.slow
def test_cracks_of_an_interface_that_grows_are_kept_for_the_forecast(monkeypatch, tmp_path):
    monkeypatch.setattr(growing, "_LATTICE", (0.35, 0.42, 0.5, 0.6))
    monkeypatch.setattr(growing, "LARGEST", 2.0)
    opening, file = Opening(1e-12), tmp_path / "kept.npz"

    def pulled(speed):
        kept = Computed.read(file)
        forward = growing.growing(Forward(SOLID, RADIUS, computed=kept), opening, (4e-8, 6e-8))
        law = opening.growth(unknowns(GAP, 1.5))
        found = forward.pulled(WORK, GAP, speed, PRELOAD, 40, law).force
        kept.write(file)
        return float(found)

    first = pulled(1e-5)
    monkeypatch.delattr("viscotack.theory.crack.contact.growing._table")
    assert pulled(1e-5) == first
    # at a speed that was not computed, from the same cracks
    assert pulled(1e-4) > 1.1 * first
