"""The open datasets: whole, as their card says, and what the solver gives again."""

import re
import tomllib
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pyarrow", reason="datasets are stored in Parquet")

from viscotack import datasets, solve  # noqa: E402
from viscotack.campaign import read_plan  # noqa: E402
from viscotack.campaign.columns import KINDS  # noqa: E402
from viscotack.campaign.listed import read_words  # noqa: E402
from viscotack.datasets import files  # noqa: E402
from viscotack.datasets.columns import KEPT  # noqa: E402
from viscotack.datasets.making import Targets, how, make  # noqa: E402
from viscotack.result.observables import (
    pull_off,
    work_to_pull_off,  # noqa: E402
)

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
    "solid": ("tabor", "modulus_ratio", "solid", "preload", "rate"),
    "punch": ("size", "thickness", "cohesion", "modulus_ratio", "preload", "rate"),
}


# Tests of one set follow each other; all sets at once are half a gigabyte.
loaded = lru_cache(maxsize=2)(datasets.load)


@pytest.fixture(scope="module", params=datasets.NAMES)
def named(request):
    return request.param, loaded(request.param)


def kind_of(name):
    solids = dict.fromkeys(("solids", "rough", "sharp"), "solid")
    return "punch" if name.startswith("punch") else solids.get(name, "sphere")


def planned(name):
    """Return the inputs of the cases of a plan, in their order."""
    inputs = INPUTS[kind_of(name)]
    if kind_of(name) != "solid":
        return [tuple(case.inputs[i] for i in inputs) for case in read_plan(plan(name)).cases]
    # names by content would be asked of some thousand solids
    found = []
    for block in tomllib.loads(plan(name).read_text(encoding="utf-8"))["list"]:
        names, rows = read_words(plan(name).with_name(block["file"]))
        found += [tuple(float(row[names.index(i)]) for i in inputs) for _, row in rows]
    return found


def plan(name):
    return datasets.plan_path(name)


def numbers(table, column):
    return table.column(column).to_numpy()


def rows_of(table, column):
    """Return a column of lists of equal length as a matrix."""
    flat = table.column(column).combine_chunks().flatten().to_numpy()
    return flat.reshape(table.num_rows, -1).astype(float)


def test_a_set_has_the_columns_of_its_card(named):
    name, table = named
    assert table.column_names == [column.name for column in KEPT[kind_of(name)]]
    assert list(datasets.metadata(name)["columns"]) == table.column_names
    card = CARD.read_text(encoding="utf-8")
    assert [column for column in table.column_names if f"`{column}`" not in card] == []
    (line,) = [
        line for line in card.splitlines() if line.startswith(f"| `{name}` |") and "MB" in line
    ]
    assert re.search(rf"\| {table.num_rows:,}(<!--[^|]*-->)? \|", line)


def test_a_set_is_the_beginning_of_its_plan(named):
    name, table = named
    facts = datasets.metadata(name)
    inputs = INPUTS[kind_of(name)]
    failed = {tuple(row[i] for i in inputs) for row in facts["failures"]}
    stored = list(zip(*(table.column(i).to_pylist() for i in inputs), strict=True))
    assert stored == [case for case in planned(name)[: facts["cases"]] if case not in failed]
    assert facts["plan"] == plan(name).read_text(encoding="utf-8")


def test_fewer_than_one_case_in_a_thousand_fails(named):
    name, table = named
    facts = datasets.metadata(name)
    assert table.num_rows + len(facts["failures"]) == facts["cases"]
    # these are drawn on faces and edges too, where two in a thousand are not resolved, and four of
    # those drawn where errors are large
    most = dict.fromkeys(("fresh", "unseen", "hard", "punch_faces"), 3e-3) | {"steep": 5e-3}
    assert len(facts["failures"]) < most.get(name, 1e-3) * facts["cases"]


def gathered(count):
    """Return shares of a part of the trajectory that is kept at so many points."""
    return 1 - (1 - np.arange(count) / (count - 1)) ** 2


def test_a_trajectory_has_eight_points_to_zero_force_and_sixteen_from_there(named):
    name, table = named
    sign, force = (-1, "stress") if kind_of(name) == "punch" else (1, "force")
    line = sign * rows_of(table, f"trajectory_{force}")
    left = rows_of(table, "trajectory_travel_left")
    assert np.all(np.diff(left) < 0)
    np.testing.assert_allclose(left[:, 0], numbers(table, "travel_to_pull_off"), rtol=1e-6)
    peak = -line[:, -1]
    assert np.all(line >= -peak[:, None]), "the pull-off is the largest tension"
    assert np.all(np.abs(left[:, -1]) <= 1e-7 * left[:, 0])
    pressed = line[:, 0] > 0
    line, left = line / peak[:, None], left / left[:, :1]
    assert np.all(np.abs(line[pressed, 8]) <= 1e-9)
    # where a start is all but free of force the nodes are felt
    tense = np.any(line[pressed, :8] <= -2e-3, axis=1)
    # the smaller, first peak of one row is in tension, and the force returns to compression
    assert tense.sum() == (1 if name == "sharp" else 0)
    assert np.all(line[pressed, 9:] < 0)
    assert np.all(line[~pressed] <= 0)
    zero = left[pressed, 8:9]
    expected = np.hstack([1 - (1 - zero) * gathered(9), zero * (1 - gathered(16)[1:])])
    np.testing.assert_allclose(left[pressed], expected, rtol=1e-6, atol=1e-9)
    even = np.broadcast_to(1 - gathered(24), left[~pressed].shape)
    np.testing.assert_allclose(left[~pressed], even, rtol=1e-6, atol=1e-7)


def test_stated_errors_are_no_less_than_what_was_found_and_seldom_above_the_targets(named):
    name, table = named
    deep = numbers(table, "preload") > 80
    steep = np.zeros_like(deep)
    if kind_of(name) != "punch":
        steep = (numbers(table, "tabor") > 5) & (numbers(table, "modulus_ratio") < 1e-3)
    force, work = (numbers(table, f"{what}_error") for what in ("force", "work"))
    least_work = np.where(steep, np.float32(2e-2), np.float32(5e-3))
    assert np.all(force >= np.where(deep | steep, np.float32(1.5e-3), np.float32(1e-3)))
    assert np.all(work >= least_work)
    _, targets = how(name)
    assert np.mean(force > targets.force) < 0.01
    # those that measure and judge are run once more only, `solids` and `rough` not at all
    few = dict.fromkeys(("fresh", "unseen", "hard", "steep", "punch_faces", "rough"), 0.03)
    most = (few | {"unseen": 0.04, "solids": 0.08}).get(name, 0.01)
    assert np.mean(work > np.maximum(targets.work, least_work)) < most


@pytest.mark.parametrize("column", TABLE_A1)
def test_the_inputs_of_thesis_have_the_statistics_of_table_a1(column):
    x = numbers(loaded("thesis"), column)
    assert len(x) == 8505
    x = np.log10(x) if column in LOGARITHMIC else x
    mean, median, spread, low, high = TABLE_A1[column]
    assert np.mean(x) == pytest.approx(mean, abs=0.05 * spread)
    assert np.median(x) == pytest.approx(median, abs=0.05 * spread)
    assert np.std(x, ddof=1) == pytest.approx(spread, rel=0.05, abs=0)
    assert (x.min(), x.max()) == pytest.approx((low, high), abs=2e-3)


def test_the_limits_of_punches_are_elastic_layers_and_fast_ones():
    table = loaded("punch_limits")
    elastic = numbers(table, "modulus_ratio") == 1
    assert elastic.sum() == 256
    assert set(numbers(table, "rate")[~elastic]) == {1e16}
    # a layer that does not relax is one of the glassy modulus: fast ones of k are elastic ones
    # whose lengths are k times as large in their own a0, but for what the start has pressed
    pressed = rows_of(table, "trajectory_stress")[:, 0]
    lightest = np.argmax(np.where(elastic, -np.inf, pressed))
    (row,) = table.slice(lightest, 1).to_pylist()
    other = {name: row[name] for name in INPUTS["punch"]}
    ratio = other["modulus_ratio"]
    other |= {"modulus_ratio": 1.0, "rate": 1.0}
    other |= {name: ratio * row[name] for name in ("size", "thickness")}
    result = solve(KINDS["punch"].problem(other), until="pull-off", accuracy=row["accuracy"])
    assert pull_off(result).force == pytest.approx(row["pull_off_stress"], rel=2e-3)


@pytest.mark.parametrize("name", datasets.NAMES)
def test_rows_are_what_the_solver_gives(name):
    table = loaded(name)
    quick = np.flatnonzero(numbers(table, "steps") < 300)
    for place in np.random.default_rng(5).choice(quick, 3, replace=False):
        (row,) = table.slice(place, 1).to_pylist()
        kind = KINDS[kind_of(name)]
        problem = kind.problem({column: row[column] for column in INPUTS[kind.name]})
        result = solve(problem, until="pull-off", accuracy=row["accuracy"], estimate_error=False)
        force = row["pull_off_stress" if kind.name == "punch" else "pull_off_force"]
        assert pull_off(result).force == pytest.approx(force, rel=row["force_error"], abs=0)
        work = row["work_to_pull_off"]
        assert work_to_pull_off(result) == pytest.approx(work, rel=row["work_error"], abs=0)


def test_a_damaged_file_is_refused(tmp_path, monkeypatch):
    content = bytearray(datasets.path("punch").read_bytes())
    content[len(content) // 2] ^= 1
    damaged = tmp_path / "punch.parquet"
    damaged.write_bytes(content)
    monkeypatch.setattr(files, "path", lambda name: damaged)
    with pytest.raises(ValueError, match="is damaged or of another version: its SHA-256 is"):
        datasets.load("punch")


@pytest.mark.slow
def test_a_set_can_be_made_again_and_misses_are_run_finer(tmp_path):
    import pyarrow.parquet as pq

    whole = datasets.load("punch").slice(0, 4).to_pylist()
    made = pq.read_table(make("punch", tmp_path / "a", cases=4)).to_pylist()
    for row, stored in zip(made, whole, strict=True):
        # how often a case was run again depends on what the solver of the day says of its errors
        finest = row["accuracy"] == 2e-3 / 16
        assert finest or row["force_error"] <= Targets().force
        assert row["pull_off_stress"] == pytest.approx(stored["pull_off_stress"], rel=1e-3, abs=0)
    strict = Targets(force=1e-5, work=1e-5)
    made = pq.read_table(make("punch", tmp_path / "b", cases=2, targets=strict)).to_pylist()
    assert [row["accuracy"] for row in made] == pytest.approx([2e-3 / 16] * 2)
