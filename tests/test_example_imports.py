"""The import lines that the reference shows in front of an example."""

import pytest

from docs.example_imports import imports

JKR = "viscotack.theory.elastic.jkr"


@pytest.mark.parametrize(
    ("example", "module", "lines"),
    [
        (">>> predict", "viscotack.forecast.answer", ["from viscotack import predict"]),
        (">>> from viscotack import a as np\n>>> np", JKR, []),
        (">>> [print(np) for np in [1]]", JKR, []),
        (">>> np.ones(3)", JKR, ["import numpy as np"]),
        (">>> pull_off_force(1.0)", JKR, [f"from {JKR} import pull_off_force"]),
    ],
)
def test_an_example_has_the_imports_of_the_names_that_it_does_not_define(example, module, lines):
    assert imports(example, module) == lines
