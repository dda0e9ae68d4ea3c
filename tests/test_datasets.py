"""The open datasets: whole, as their card says, and what the solver gives again."""

from functools import lru_cache

import numpy as np
import pytest

import viscotack as vt

pytest.importorskip("pyarrow", reason="datasets are stored in Parquet")


from viscotack.model.problem.kinds import KINDS  # noqa: E402

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
loaded = lru_cache(maxsize=2)(vt.datasets.load)


def kind_of(name):
    solids = dict.fromkeys(("solids", "rough", "sharp"), "solid")
    return "punch" if name.startswith("punch") else solids.get(name, "sphere")


def numbers(table, column):
    return table.column(column).to_numpy()


def rows_of(table, column):
    """Return a column of lists of equal length as a matrix."""
    flat = table.column(column).combine_chunks().flatten().to_numpy()
    return flat.reshape(table.num_rows, -1).astype(float)


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
    result = vt.solve(KINDS["punch"].problem(other), until="pull-off", accuracy=row["accuracy"])
    assert vt.pull_off(result).force == pytest.approx(row["pull_off_stress"], rel=2e-3)


@pytest.mark.parametrize("name", vt.datasets.NAMES)
def test_rows_are_what_the_solver_gives(name):
    table = loaded(name)
    quick = np.flatnonzero(numbers(table, "steps") < 300)
    for place in np.random.default_rng(5).choice(quick, 1):
        (row,) = table.slice(place, 1).to_pylist()
        kind = KINDS[kind_of(name)]
        problem = kind.problem({column: row[column] for column in INPUTS[kind.name]})
        result = vt.solve(problem, until="pull-off", accuracy=row["accuracy"], estimate_error=False)
        force = row["pull_off_stress" if kind.name == "punch" else "pull_off_force"]
        assert vt.pull_off(result).force == pytest.approx(force, rel=row["force_error"], abs=0)
        work = row["work_to_pull_off"]
        assert vt.work_to_pull_off(result) == pytest.approx(work, rel=row["work_error"], abs=0)
