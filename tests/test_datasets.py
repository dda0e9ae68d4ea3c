"""The open datasets: whole, as their card says, and what the solver gives again."""

from functools import lru_cache

import numpy as np
import pytest

import viscotack as vt

pytest.importorskip("pyarrow", reason="datasets are stored in Parquet")


from viscotack.model.problem.rows import KINDS  # noqa: E402

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
