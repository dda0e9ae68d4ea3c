"""The open datasets: whole, as their card says, and what the solver gives again."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pyarrow", reason="datasets are stored in Parquet")

from viscotack import datasets, solve  # noqa: E402
from viscotack.campaign import read_plan  # noqa: E402
from viscotack.campaign.columns import KINDS  # noqa: E402
from viscotack.datasets import files  # noqa: E402
from viscotack.datasets.columns import KEPT, LEAST_ERRORS  # noqa: E402
from viscotack.datasets.making import Targets, make  # noqa: E402
from viscotack.observables import pull_off, work_to_pull_off  # noqa: E402

CARD = Path(__file__).parents[1] / "docs" / "datasets.md"
# Table A.1 of Maghami, PhD thesis (2025): mean, median, standard deviation, least and largest.
TABLE_A1 = {
    "preload": (0.5718, 0.684, 0.9359, -2.255, 2.738),
    "tabor": (0.7181, 0.3, 0.9501, 0.04, 3.24),
    "rate": (4.467, 4.4, 2.75, -1.5, 10),
    "modulus_ratio": (-0.9189, -1, 0.219, -4, -0.301),
    "exponent": (0.8471, 0.6, 0.5635, 0.2, 2),
}
LOGARITHMIC = ("preload", "rate", "modulus_ratio")
INPUTS = {
    "sphere": ("tabor", "modulus_ratio", "exponent", "preload", "rate"),
    "punch": ("size", "thickness", "cohesion", "modulus_ratio", "preload", "rate"),
}


@pytest.fixture(scope="module", params=datasets.NAMES)
def named(request):
    return request.param, datasets.load(request.param)


def kind_of(name):
    return "punch" if name == "punch" else "sphere"


def numbers(table, column):
    return table.column(column).to_numpy()


def test_a_set_has_the_columns_of_its_card(named):
    name, table = named
    assert table.column_names == [column.name for column in KEPT[kind_of(name)]]
    assert list(datasets.metadata(name)["columns"]) == table.column_names
    card = CARD.read_text(encoding="utf-8")
    assert [column for column in table.column_names if f"`{column}`" not in card] == []


def test_a_set_is_the_beginning_of_its_plan(named):
    name, table = named
    plan = read_plan(datasets.plan_path(name))
    facts = datasets.metadata(name)
    inputs = INPUTS[kind_of(name)]
    failed = {tuple(row[i] for i in inputs) for row in facts["failures"]}
    planned = [tuple(case.inputs[i] for i in inputs) for case in plan.cases[: facts["cases"]]]
    stored = list(zip(*(table.column(i).to_pylist() for i in inputs), strict=True))
    assert stored == [case for case in planned if case not in failed]
    assert facts["plan"] == datasets.plan_path(name).read_text(encoding="utf-8")


def test_fewer_than_one_case_in_a_thousand_fails(named):
    name, table = named
    facts = datasets.metadata(name)
    assert table.num_rows + len(facts["failures"]) == facts["cases"]
    assert len(facts["failures"]) < 1e-3 * facts["cases"]


def test_what_a_set_says_is_consistent(named):
    name, table = named
    force = "stress" if name == "punch" else "force"
    peak = numbers(table, f"pull_off_{force}")
    assert np.all(np.isfinite(peak) & (peak > 0))
    line = np.array(table.column(f"trajectory_{force}").to_pylist())
    assert line.shape == (table.num_rows, 24)
    # pull-off is the end of the trajectory, in the sign of the column
    assert line[:, -1] == pytest.approx(peak if name == "punch" else -peak, rel=1e-6)
    # depth at the pull-off is the start less the travel; both keep seven digits
    start, travel = numbers(table, "preload"), numbers(table, "travel_to_pull_off")
    off = np.abs(start - travel - numbers(table, "pull_off_depth"))
    assert np.all(off <= 1e-6 * (np.abs(start) + travel))
    assert np.all(numbers(table, "energy_residual") < 1e-2)
    for what in ("force", "work"):
        assert np.all(numbers(table, f"{what}_error") >= np.float32(LEAST_ERRORS[f"{what}_error"]))


def test_errors_are_within_their_targets_but_for_a_few(named):
    _, table = named
    targets = Targets()
    assert np.mean(numbers(table, "force_error") > targets.force) < 0.01
    assert np.mean(numbers(table, "work_error") > targets.work) < 0.02


@pytest.mark.parametrize("column", TABLE_A1)
def test_the_inputs_of_thesis_have_the_statistics_of_table_a1(column):
    x = numbers(datasets.load("thesis"), column)
    assert len(x) == 8505
    x = np.log10(x) if column in LOGARITHMIC else x
    mean, median, spread, low, high = TABLE_A1[column]
    assert np.mean(x) == pytest.approx(mean, abs=0.05 * spread)
    assert np.median(x) == pytest.approx(median, abs=0.05 * spread)
    assert np.std(x, ddof=1) == pytest.approx(spread, rel=0.05, abs=0)
    assert (x.min(), x.max()) == pytest.approx((low, high), abs=2e-3)


@pytest.mark.parametrize("name", ["broad", "punch"])
def test_a_filled_set_is_spread_evenly(name):
    table = datasets.load(name)
    fill = {"broad": INPUTS["sphere"], "punch": INPUTS["punch"]}[name]
    for column in fill:
        x = np.log(numbers(table, column))
        if np.ptp(x):
            shares = np.histogram(x, bins=4, range=(x.min(), x.max()))[0] / len(x)
            assert shares == pytest.approx(0.25, abs=0.02)


@pytest.mark.parametrize("name", datasets.NAMES)
def test_rows_are_what_the_solver_gives(name):
    table = datasets.load(name)
    quick = np.flatnonzero(numbers(table, "steps") < 300)
    for place in np.random.default_rng(5).choice(quick, 3, replace=False):
        (row,) = table.slice(place, 1).to_pylist()
        kind = KINDS[kind_of(name)]
        problem = kind.problem({column: row[column] for column in INPUTS[kind.name]})
        result = solve(problem, until="pull-off", accuracy=row["accuracy"], estimate_error=False)
        force = row["pull_off_stress" if name == "punch" else "pull_off_force"]
        assert pull_off(result).force == pytest.approx(force, rel=row["force_error"], abs=0)
        work = row["work_to_pull_off"]
        assert work_to_pull_off(result) == pytest.approx(work, rel=row["work_error"], abs=0)


def test_the_files_are_small():
    assert sum(datasets.path(name).stat().st_size for name in datasets.NAMES) < 50e6


def test_a_damaged_file_is_refused(tmp_path, monkeypatch):
    content = bytearray(datasets.path("punch").read_bytes())
    content[len(content) // 2] ^= 1
    damaged = tmp_path / "punch.parquet"
    damaged.write_bytes(content)
    monkeypatch.setattr(files, "path", lambda name: damaged)
    with pytest.raises(ValueError, match="is damaged: its SHA-256 is"):
        datasets.load("punch")


def test_an_unknown_set_is_refused():
    with pytest.raises(ValueError, match="no dataset 'thesys'; there are thesis, broad, punch"):
        datasets.load("thesys")


@pytest.mark.slow
def test_a_set_can_be_made_again_and_misses_are_run_finer(tmp_path):
    import pyarrow.parquet as pq

    whole = datasets.load("punch").slice(0, 4).to_pylist()
    made = pq.read_table(make("punch", tmp_path / "a", cases=4)).to_pylist()
    for row, stored in zip(made, whole, strict=True):
        assert row["accuracy"] == stored["accuracy"]
        assert row["pull_off_stress"] == pytest.approx(stored["pull_off_stress"], rel=1e-3, abs=0)
    strict = Targets(force=1e-5, work=1e-5)
    made = pq.read_table(make("punch", tmp_path / "b", cases=2, targets=strict)).to_pylist()
    assert [row["accuracy"] for row in made] == pytest.approx([2e-3 / 16] * 2)
