"""The answer at once: what it agrees with, where it says no, and how fast it is."""

from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from viscotack.prediction.surrogate import physics, store
from viscotack.result.curve import curve

CASE = {"tabor": 3.24, "modulus_ratio": 0.1, "exponent": 0.8, "preload": 73.0, "rate": 316.23}
UNIT = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0}


def sphere(start=None, material=None, **changed):
    """Return the groups of a case, some of its numbers changed."""
    case = CASE | changed
    material = material or vt.RetardationPowerLaw(
        **UNIT, glassy_modulus=1 / case["modulus_ratio"], exponent=case["exponent"], tau0=1.0
    )
    return vt.Groups(case["tabor"], material, start or vt.AtDepth(case["preload"]), case["rate"])


def in_si(groups):
    return groups.in_si(
        radius=5e-3, contact_modulus=2e6, work_of_adhesion=0.1, time_unit=0.02, poisson_ratio=0.5
    )


def series(**columns):
    """Return a table of cases, columns that are not given held as in CASE."""
    count = max(len(values) for values in columns.values())
    held = (
        CASE
        if "preload" in columns or not {"preload_force"} & set(columns)
        else {name: value for name, value in CASE.items() if name != "preload"}
    )
    return {name: np.full(count, value) for name, value in held.items()} | columns


# With the solver and the limits --------------------------------------------------------------
@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"tabor": 2.0, "modulus_ratio": 0.01, "exponent": 0.4, "preload": 20.0, "rate": 1.0},
        {"tabor": 1.0, "exponent": 1.5, "preload": 10.0, "rate": 1e5},
        {"tabor": 0.3, "exponent": 0.6, "preload": 5.0, "rate": 1e4},
        {"tabor": 0.02, "modulus_ratio": 0.01, "exponent": 1.5, "preload": 50.0, "rate": 10.0},
    ],
)
def test_prediction_and_simulation_agree(changed):
    groups = sphere(**changed)
    answer = vt.predict(groups)
    result = vt.solve(groups, until="pull-off", estimate_error=False)
    force = vt.pull_off_force(result)
    # several times the error of the surrogate, and far below what a wrong unit would make
    assert answer.pull_off_force == pytest.approx(force, rel=0.01, abs=0)
    assert answer.work_to_pull_off == pytest.approx(vt.work_to_pull_off(result), rel=0.03, abs=0)
    row = curve(result, vt.pull_off(result))
    off = np.abs(np.array(row["trajectory_force"]) - answer.curve.force)
    assert np.median(off) < 0.03 * force
    off = np.abs(np.array(row["trajectory_depth"]) - answer.curve.depth)
    assert np.median(off) < 0.03 * row["travel_to_pull_off"]


# Units and starts ----------------------------------------------------------------------------
@pytest.mark.parametrize("start", [vt.AtForce(5.0), vt.AtRadius(2.0)])
def test_a_start_by_force_or_radius_is_one_by_depth(start):
    depth = store.shipped().start_depth(CASE["tabor"], **vars(start))
    a, b = vt.predict(sphere(start=start)), vt.predict(sphere(preload=depth))
    assert a.inside and a.pull_off_force == b.pull_off_force
    # the doubt of the depth is in it too
    low, high = b.work_interval
    assert 0.98 * low < a.work_interval[0] <= low * (1 + 1e-12)
    assert high * (1 - 1e-12) <= a.work_interval[1] < 1.02 * high
    assert a.curve.depth[0] == pytest.approx(depth, rel=1e-9, abs=0)


# Outside -------------------------------------------------------------------------------------
@pytest.mark.parametrize("name", physics.INPUTS)
@pytest.mark.parametrize("end", [0, 1])
def test_outside_the_range_the_surrogate_claims_nothing(name, end):
    bound = store.shipped().limits[name][end]
    assert vt.predict(sphere(**{name: bound})).inside
    try:
        answer = vt.predict(sphere(**{name: bound * (0.99, 1.01)[end]}))
    except vt.OutOfRange as error:
        assert str(error).startswith(f"{name} is ")
    else:
        assert not (answer.inside and answer.method == "surrogate")


def test_below_the_least_tabor_number_the_start_is_not_forgotten():
    # a simulation gives 1.803 at either; that the start is relaxed and slow it is not
    for mu in (0.00999, 0.001):
        case = sphere(tabor=mu, modulus_ratio=0.019, exponent=0.48, preload=49.4, rate=5.58)
        answer = vt.predict(case)
        assert answer.work_to_pull_off is None and answer.work_interval is None
        assert answer.interval[0] < 1.803 < answer.interval[1] and answer.band == "measured"
    assert "tabor is 0.0005, verified from 0.3 to 8" in refused(replace(case, tabor=5e-4))


@pytest.mark.parametrize(
    "end", [("rate", 1e10, 1), ("tabor", 0.01, -1), ("modulus_ratio", 1e-4, -1), ("tabor", 10.0, 1)]
)
def test_predictions_are_continuous_where_the_surrogate_ends(end):
    name, limit, outward = end
    case = dict(exponent=0.3, modulus_ratio=0.02, preload=20.0, rate=100.0, tabor=2.0)
    inner, outer = (
        vt.predict(sphere(**case | {name: limit * (1 + side * outward * 1e-7)}), budget=0.01)
        for side in (-1, 1)
    )
    assert inner.why != outer.why and inner.inside
    assert outer.pull_off_force == pytest.approx(inner.pull_off_force, rel=1e-5)
    if limit != 0.01:  # no work is given below
        assert outer.work_to_pull_off == pytest.approx(inner.work_to_pull_off, rel=1e-5)


def test_beyond_the_largest_rate_the_interval_widens_towards_the_fast_limit():
    case = dict(exponent=0.2, modulus_ratio=1e-3)
    rates = (1e10, 1.001e10, 1e11, 1e13, 1e16)
    found = [vt.predict(sphere(rate=rate, **case)) for rate in rates]
    forces, widths = np.array(
        [[x.pull_off_force, x.interval[1] / x.interval[0] - 1] for x in found]
    ).T
    fast = vt.predict(sphere(rate=1e10, exponent=2.0, modulus_ratio=1e-3)).pull_off_force
    assert np.all(np.diff(forces) > 0) and 0.97 * fast < forces[-1] < fast
    assert np.all(np.diff(widths) >= 0) and widths[1] == pytest.approx(widths[0], rel=0.02)
    assert widths[-1] > 2 * widths[0]
    assert all(x.interval[0] < x.pull_off_force < x.interval[1] for x in found)


def test_below_the_least_modulus_ratio_force_rises_until_the_glass_is_not_felt():
    for rate, exponent in ((10.0, 0.3), (1e6, 0.8), (1e9, 2.0)):
        case = dict(rate=rate, exponent=exponent, preload=300.0)
        said = [vt.predict(sphere(modulus_ratio=k, **case)) for k in (1e-4, 9.99e-5, 1e-5, 1e-6)]
        force = [each.pull_off_force for each in said]
        assert said[0].inside and not said[1].inside and said[1].band == "measured"
        assert force[1] == pytest.approx(force[0], rel=1e-3)
        assert force[0] <= force[1] <= force[2] <= force[3] <= 100 * force[0]
        # most of what is left is in the first decade
        assert force[3] - force[2] <= force[2] - force[0] + 1e-12
    # the surrogate is not certain at the limit, and is not extrapolated from there
    doubtful = dict(rate=1e4, exponent=0.8, preload=300.0)
    assert vt.predict(sphere(modulus_ratio=1e-4, **doubtful)).method == "simulation"
    assert "slope" not in refused(sphere(modulus_ratio=1e-5, **doubtful))
    assert "modulus_ratio is 9e-07, verified from 0.001 to 0.3" in refused(
        sphere(modulus_ratio=9e-7)
    )
    with pytest.raises(vt.OutOfRange, match="modulus_ratio is 1e-05, .*; rate is 1e[+]12"):
        vt.predict(sphere(modulus_ratio=1e-5, rate=1e12))


def test_the_depths_of_zero_force_and_pull_off_have_intervals():
    answer, wider = vt.predict(sphere()), vt.predict(sphere(), confidence=0.98)
    times, further = vt.predict(sphere(), shift_deviation=0.5), vt.predict(sphere(rate=1e12))
    assert answer.curve.force[8] == 0 and answer.zero_force_depth == answer.curve.depth[8]
    for name, depth in (("zero_force", answer.zero_force_depth), ("depth", answer.curve.depth[-1])):
        low, high = getattr(answer, f"{name}_interval")
        assert low < depth < high < answer.curve.depth[0]
        least, most = getattr(wider, f"{name}_interval")
        assert least < low and high < most
        assert getattr(further, f"{name}_interval") is None
        assert np.ptp(getattr(times, f"{name}_interval")) > 2 * (high - low)
    # at least what the error of the work moves the end of the tensile part by
    assert np.ptp(answer.depth_interval) > np.ptp(answer.work_interval) / answer.pull_off_force
    assert vt.predict(sphere(preload=0.01)).zero_force_depth is None
    assert times.curve_band > answer.curve_band


def test_zero_force_is_where_the_simulation_has_it():
    problem = sphere(preload=20.0)
    answer = vt.predict(problem)
    found = vt.solve(problem, until="pull-off", accuracy=1e-3, estimate_error=False)
    crossing = int(np.flatnonzero(found.force > 0)[-1])
    ends = slice(crossing, crossing + 2)
    zero = np.interp(0.0, found.force[ends][::-1], found.depth[ends][::-1])
    low, high = answer.zero_force_interval
    assert low < zero < high


def test_the_band_of_a_theory_is_not_scaled_to_another_confidence():
    solid = vt.StandardSolid(**UNIT, glassy_modulus=10.0, tau0=1.0)
    deep = sphere(material=solid, rate=1.0, preload=600.0)
    a, b = (vt.predict(deep, confidence=c) for c in (0.9, 0.5))
    assert a.interval == b.interval and b.confidence == 0.9


def test_a_theory_without_a_measured_band_is_refused():
    solid = vt.StandardSolid(**UNIT, glassy_modulus=10.0, tau0=1.0)
    known = vt.predict(sphere(material=solid, rate=1.0, preload=600.0))
    assert (known.band, known.confidence) == ("measured", 0.9)
    series = vt.Prony(rubbery_modulus=1.0, branches=((3.0, 1.0), (6.0, 9.0)), poisson_ratio=0.0)
    for groups, where in (
        (sphere(rate=1e17), "rate"),
        (sphere(material=replace(solid, tau0=1e17), rate=1.0, preload=600.0), "rate"),
        (sphere(tabor=4.0, exponent=0.25, rate=1e17), "exponent"),
        (sphere(material=series, rate=1.0, preload=600.0), "solid is prony"),
    ):
        assert where in refused(groups)


def refused(problem, **options):
    with pytest.raises(ValueError) as caught:
        vt.predict(problem, **options)
    return str(caught.value)


@pytest.mark.parametrize(
    ("changed", "name"),
    [
        ({"moves": (vt.Dwell(3.0),)}, "Dwell"),
        ({"stiffness": 2.0}, "stiffness of 2"),
        ({"start": vt.Apart(9.0)}, "start is apart"),
        # the intervals of tiers of other laws are those of tests/test_tiers.py
        ({"tabor": 2.0, "traction": vt.Dugdale(1.0, 1.0, fall=0.1)}, "steepest fall is 19.96"),
    ],
)
def test_other_tests_and_steep_laws_are_refused(changed, name):
    assert name in refused(replace(sphere(), **changed))


def test_impossible_questions_are_refused():
    assert "no relaxed one exists at depth -50" in refused(sphere(preload=-50.0))
    assert "evaluated up to 300" in refused(sphere(start=vt.AtForce(1e9)))
    for rate in (1.0, 1e17):
        for confidence in (0.85, 90, np.nan):
            assert "confidence" in refused(sphere(rate=rate), confidence=confidence)
            with pytest.raises(ValueError, match="confidence"):
                vt.predict_table(series(rate=[rate]), confidence=confidence)
    with pytest.raises(TypeError, match="read_case"):
        vt.predict("lens.toml")


# Tables --------------------------------------------------------------------------------------
def test_rows_of_a_table_are_those_of_single_predictions_in_their_order():
    rates = np.array([1e3, 1e12, 1.0, -1.0, np.nan, 1e-2, 1e17])
    table = vt.predict_table(series(rate=rates))
    assert table["inside"].tolist() == [True, False, True, False, False, True, False]
    assert str(table["why"][6]) == refused(sphere(rate=1e17))
    for i in (0, 1, 2, 5):
        one = vt.predict(sphere(rate=rates[i]))
        assert table["method"][i] == one.method
        assert table["why"][i] == ("" if one.inside else one.why)
        found = [table[f"pull_off_force{end}"][i] for end in ("", "_low", "_high")]
        assert found == pytest.approx([one.pull_off_force, *one.interval], rel=1e-9, abs=0)
        work = [table[f"work_to_pull_off{end}"][i] for end in ("", "_low", "_high")]
        expected = [one.work_to_pull_off, *one.work_interval]
        assert work == pytest.approx(expected, rel=1e-9, abs=0)
    for i, words in ((3, "rate must be positive, got -1.0"), (4, "rate must be finite")):
        assert words in table["why"][i] and table["method"][i] == ""
        assert np.isnan(table["pull_off_force"][i])


# Pictures ------------------------------------------------------------------------------------
def test_a_picture_has_the_curve_its_interval_and_the_simulation(tmp_path):
    problem = in_si(sphere())
    answer, result = (
        vt.predict(problem),
        vt.solve(problem, until="pull-off", accuracy=1e-2, estimate_error=False),
    )
    figure = vt.draw_prediction(answer, result)
    (axes,) = figure.axes
    drawn = axes.lines[1].get_ydata()[::8]
    assert drawn == pytest.approx(answer.curve.force * problem.scales().force, rel=1e-12)
    vt.save_figure(figure, tmp_path / "curve.png")
    assert (tmp_path / "curve.png").stat().st_size > 1000
    with pytest.raises(ValueError, match="has no force curve to draw"):
        vt.draw_prediction(vt.predict(sphere(rate=1e13)))
