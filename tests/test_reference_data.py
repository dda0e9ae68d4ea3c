"""The values that tests compare with: all in the repository, and what their README says of them."""

import argparse
import csv
import hashlib
import importlib.util
from pathlib import Path

import pytest

from reference_data import DATA, DETACHMENTS, VALUES, reference

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


def table_option():
    """Return a parser with the option by which benchmarks find the published table."""
    spec = importlib.util.spec_from_file_location("benchmark_cases", BENCHMARKS / "cases.py")
    cases = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(cases)
    parser = argparse.ArgumentParser()
    cases.add_table(parser)
    return parser


def test_an_equation_without_values_is_refused_and_not_skipped():
    assert len(reference("4.25")) == sum(row["equation"] == "4.25" for row in VALUES)
    with pytest.raises(AssertionError, match=r"no value of 4\.26"):
        reference("4.25", "4.26")


def test_published_detachments_were_drawn_by_their_inputs_alone():
    with DETACHMENTS.open(newline="") as file:
        rows = list(csv.DictReader(file))
    names = ("runload", "alphaload", "mu", "k", "n")
    inputs = [",".join(f"{float(row[name]):.6g}" for name in names) for row in rows]
    assert all(hashlib.sha256(each.encode()).hexdigest()[0] in "012" for each in inputs)
    assert (len(rows), len(set(inputs))) == (1200, 1095)


def test_data_of_others_lie_beside_their_licence():
    holders = {
        "dma_published": "Copyright (c) 2022 Alliance for Sustainable Energy, LLC",
        "sphere_bem_published": "Copyright (c) 2025 Ali Maghami",
    }
    assert {path.name for path in DATA.iterdir() if path.is_dir()} == set(holders)
    for folder, holder in holders.items():
        assert holder in (DATA / folder / "LICENSE").read_text()


def test_every_file_of_data_is_described():
    text = (DATA / "README.md").read_text()
    files = {path.name for path in DATA.rglob("*") if path.is_file()}
    assert [name for name in files - {"README.md", "LICENSE"} if f"{name}`" not in text] == []


def test_benchmarks_read_the_same_sample_unless_told_otherwise(tmp_path):
    assert table_option().parse_args([]).table == DETACHMENTS.resolve()
    other = tmp_path / "rows.csv"
    other.touch()
    assert table_option().parse_args(["--table", str(other)]).table == other


def test_a_published_table_that_is_not_there_is_an_error_that_says_where_to_get_it(capsys):
    with pytest.raises(SystemExit) as stop:
        table_option().parse_args(["--table", "nowhere.csv"])
    assert stop.value.code == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "there is no file nowhere.csv" in said
    assert "github.com/alimaghamii/ML4Adh" in said and "tests/data" in said
