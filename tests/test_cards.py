import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import pytest
from typer.testing import CliRunner

import viscotack as vt
from viscotack.app.cli import application
from viscotack.cards import Quantity, conform
from viscotack.problem.schema import schema, words

DOCS = Path(__file__).resolve().parents[1] / "docs"


def test_a_number_out_of_its_range_is_refused_with_unit_range_and_cure():
    @dataclass(frozen=True)
    class Wall:
        height: Annotated[
            float, Quantity("m", "h", "height", above=0, most=2, advice="build two walls")
        ]

        def __post_init__(self):
            conform(self)

    assert Wall(1).height == 1.0 and isinstance(Wall(1).height, float)
    with pytest.raises(ValueError, match=r"height must lie in .0, 2., got 3 m; build two walls"):
        Wall(3)
    with pytest.raises(ValueError, match=r"height must be a number in m, got '1 m'; .*parse"):
        Wall("1 m")
    with pytest.raises(ValueError, match="height must be finite"):
        Wall(float("nan"))


def test_the_table_of_the_symbols_is_read_from_the_cards():
    text = (DOCS / "symbols.md").read_text(encoding="utf-8")
    found = re.search(r"<!-- viscotack schema --words -->\n(.*?)\n<!-- end -->", text, re.S)
    assert found is not None
    assert found[1].strip() == words().strip(), "write it anew: viscotack schema --words"


def test_the_schema_holds_the_records_of_problems():
    jsonschema = schema()
    defs = jsonschema["$defs"]
    material = vt.StandardSolid(
        rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0
    )
    record = vt.to_dict(vt.Groups(3.0, material, vt.AtDepth(2.0), 1.0))
    for part in (record, record["material"], record["start"]):
        described = defs[part["type"]]
        assert part.keys() <= described["properties"].keys()
        assert set(described["required"]) <= part.keys()
    done = CliRunner().invoke(application(), ["schema"])
    assert json.loads(done.stdout) == jsonschema


@pytest.mark.parametrize(
    ("bounds", "wrong", "words"),
    [
        (dict(above=1), 0.5, "be above 1"),
        (dict(above=0), 0.0, "be positive"),
        (dict(most=5), 7.0, "be at most 5"),
        (dict(least=2), 1.0, "be at least 2"),
        (dict(least=2, most=3), 4.0, "lie between 2 and 3"),
        (dict(above=2, most=3), 2.0, r"lie in .2, 3."),
    ],
)
def test_every_kind_of_range_has_its_words(bounds, wrong, words):
    with pytest.raises(vt.InputError, match=f"x must {words}, got {wrong}"):
        Quantity("1", "x", "a number", **bounds).checked("x", wrong)


def test_a_lower_bound_is_open_or_closed():
    with pytest.raises(vt.InputError, match="either `above`"):
        Quantity("1", "x", "a number", above=0, least=1)
