"""Tables of detachments: read, brought to our units, refused."""

import numpy as np
import pytest

from research.replication.table import read_detachments

from .rows import made_rows, write_rows


def test_rows_come_back_from_a_file(tmp_path):
    rows = made_rows(20, points=True)
    found = read_detachments(write_rows(tmp_path / "rows.csv", rows))
    for name in ("tabor", "rate", "work_to_pull_off", "key_points"):
        np.testing.assert_array_equal(getattr(found, name), getattr(rows, name))
    assert found.work_known.all()


def test_parquet_and_csv_give_the_same_rows(tmp_path):
    arrow = pytest.importorskip("pyarrow")
    from pyarrow import csv as arrow_csv
    from pyarrow import parquet

    source = write_rows(tmp_path / "rows.csv", made_rows(20))
    assert arrow
    parquet.write_table(arrow_csv.read_csv(source), tmp_path / "rows.parquet")
    found = read_detachments(tmp_path / "rows.parquet")
    np.testing.assert_array_equal(found.rate, read_detachments(source).rate)
    assert found.key_points is None


def test_the_published_columns_are_brought_to_ours(tmp_path):
    path = tmp_path / "rows.csv"
    path.write_text(
        "runload,alphaload,mu,k,n,outputAmplification,workofSepration\n"
        "-100,73,3.24,0.1,0.6,5,30\n-10,73,3.24,0.1,0.6,4,0.01\n"
    )
    rows = read_detachments(path)
    assert rows.rate.tolist() == [100, 10] and rows.preload[0] == 73
    assert rows.work_to_pull_off[0] == pytest.approx(20, rel=1e-15)
    assert rows.work_known.tolist() == [True, False]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("tabor,rate\n1,2\n", "has no column modulus_ratio, exponent, preload"),
        ("tabor,modulus_ratio,exponent,preload,rate,pull_off_force,work_to_pull_off\n", "no rows"),
        (
            "tabor,modulus_ratio,exponent,preload,rate,pull_off_force,work_to_pull_off\n"
            "1,0.1,0.6,-2,10,2,3\n",
            "preload must be positive and finite.*row 1 with '-2'",
        ),
        (
            "tabor,modulus_ratio,exponent,preload,rate,pull_off_force,work_to_pull_off\n"
            "1,0.1,0.6,,10,2,3\n",
            "row 1: preload is '', not a number",
        ),
        ("tabor,rate\n1\n", "line 2: 1 values, expected 2"),
    ],
)
def test_a_wrong_file_is_refused_with_its_fault(tmp_path, text, words):
    path = tmp_path / "rows.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=words):
        read_detachments(path)
