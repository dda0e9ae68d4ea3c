"""The values that tests compare with: all in the repository, and what their README says of them."""

import pytest

from reference_data import VALUES, reference


def test_an_equation_without_values_is_refused_and_not_skipped():
    assert len(reference("4.25")) == sum(row["equation"] == "4.25" for row in VALUES)
    with pytest.raises(AssertionError, match=r"no value of 4\.26"):
        reference("4.25", "4.26")
