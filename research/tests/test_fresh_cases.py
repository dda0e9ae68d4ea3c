"""Fresh cases of the surrogates: their draw, their labels and how curves are compared."""

import json

import numpy as np
import pytest

from research.training import fresh_cases
from research.training.calibration import Apart, levelled, untested
from research.training.fresh_cases import DESIGNS, TWO_PEAKS, counts_of, drawn, labelled
from research.training.scores import curve_error
from viscotack.prediction.surrogate import physics
from viscotack.prediction.surrogate.line import Curves
from viscotack.prediction.surrogate.network import Networks
from viscotack.prediction.surrogate.trust import CONFIDENCES, INPUTS, OF
from viscotack.result.curve import POINTS


def test_a_larger_draw_of_a_seed_contains_the_smaller_one():
    fewer = dict.fromkeys(DESIGNS, 2)
    few, many = drawn(3, fewer), drawn(3, fewer | {"power laws": 8, "punches": 5, "grippers": 3})
    assert {case.key for case in few} < {case.key for case in many}
    assert len(few) == 2 * len(DESIGNS) and {case.key for case in few}.isdisjoint(
        case.key for case in drawn(4, fewer)
    )


def test_each_design_draws_problems_in_its_range():
    cases = drawn(5, counts_of(["power laws=20", "two peaks=20", "large Tabor numbers=5"]))
    cases += drawn(5, dict.fromkeys(DESIGNS, 5))
    for case in cases:
        assert case.inputs.get("rate", case.inputs.get("speed")) > 0 and case.problem is not None
        if case.design == "power laws":
            row = np.array([case.inputs[name] for name in physics.INPUTS])
            assert np.all((physics.LOW <= row) & (row <= physics.HIGH))
        if case.design == "two peaks":
            values = [case.inputs[name] for name in ("tabor", "modulus_ratio", "preload")]
            for value, (low, high) in zip(values, TWO_PEAKS[:3], strict=True):
                assert low <= value <= high


def test_a_label_is_simulated_once(tmp_path, monkeypatch):
    asked = []
    monkeypatch.setattr(fresh_cases, "label", lambda case, _: asked.append(case) or {"force": 1.0})
    cases = drawn(6, {"power laws": 2})
    once, again = (list(labelled(cases, tmp_path)) for _ in range(2))
    assert once == again and asked == cases
    (path,) = tmp_path.iterdir()
    assert [json.loads(line)["key"] for line in path.read_text().splitlines()] == [
        case.key for case in cases
    ]


def test_a_curve_is_compared_between_its_points_too():
    travel = np.linspace(0.0, 4.0, POINTS)
    curve = Curves(10.0 - travel, -travel / 4, np.ones(POINTS))
    label = {"travel": travel.tolist(), "tension": (travel / 4).tolist()}
    assert curve_error(curve, label) < 1e-12
    middle = float(travel[3] + travel[4]) / 2
    dip = {"travel": [*label["travel"], middle], "tension": [*label["tension"], middle / 4 + 0.3]}
    assert curve_error(curve, dip) == pytest.approx(0.3)
    # beyond the end of the curve its last force counts
    assert curve_error(curve, {"travel": [5.0], "tension": [1.2]}) == pytest.approx(0.2)


def test_levels_hold_the_wanted_shares_alone_and_together():
    random = np.random.default_rng(7)
    reach = Networks((np.zeros((1, INPUTS, len(OF))),), (np.full((1, 1, len(OF)), -2.0),))
    trust = untested(reach)
    told = np.zeros((40_000, INPUTS))
    told[:, -2:] = np.log10(1e-3) + 2
    error = 5e-3 * random.normal(size=(40_000, len(OF)))
    found = levelled(trust, [[(trust, Apart(told[::2], error[::2]))]])
    for i, confidence in enumerate(CONFIDENCES):
        held = np.abs(error[1::2]) <= 1e-2 * found.levels[:, i]
        assert held.mean(axis=0) == pytest.approx(confidence, abs=0.015)
        together = np.abs(error[1::2, :3]) <= 1e-2 * found.levels[:3, i] * found.joint[i]
        assert together.all(axis=1).mean() == pytest.approx(confidence, abs=0.015)
