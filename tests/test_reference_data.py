"""The values that tests compare with: all in the repository, and what their README says of them."""

import csv
import hashlib

import pytest

from reference_data import DETACHMENTS, VALUES, reference


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
