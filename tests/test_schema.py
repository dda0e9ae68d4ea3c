"""The JSON schema of a problem against the reader: both accept, or refuse, the same tables."""

import tomllib
from pathlib import Path

import jsonschema
import pytest

import viscotack as vt
from stated import LENS
from viscotack.model.problem.case_file import problem_of
from viscotack.model.problem.nouns import known
from viscotack.model.problem.schema import schema
from viscotack.model.tables import Reading

FOLDER = Path(__file__).parents[1] / "examples"
CASES = [*(FOLDER / "from_toml").glob("*.toml"), *(FOLDER / "rough").glob("*.toml")]
SCHEMA = schema()
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)


def stated(tables, *, bare=False):
    """Whether a problem is read, after seeing that the schema says the same."""
    try:
        problem_of(tables, Reading("the case", known(), (FOLDER / "from_toml").joinpath, bare=bare))
    except vt.InputError as error:
        refused = str(error)
    else:
        refused = ""
    assert VALIDATOR.is_valid(tables) == (not refused), (
        refused,
        [x.message for x in VALIDATOR.iter_errors(tables)],
    )
    return not refused


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_files_of_problems_and_their_json_are_valid(path):
    VALIDATOR.check_schema(SCHEMA)
    tables = tomllib.loads(path.read_text())
    assert stated(tables)
    problem = problem_of(tables, Reading("the case", known(), path.parent.joinpath))
    assert stated(vt.to_dict(problem), bare=True)


SPHERE = tomllib.loads(LENS)
PAD = tomllib.loads((FOLDER / "from_toml/pad.toml").read_text())
PURE = {
    "groups": {"tabor": 3.24, "preload": 73, "rate": 316.23},
    "material": {"model": "power-law", "modulus_ratio": 0.1, "exponent": 0.8},
}


@pytest.mark.parametrize("tables", [SPHERE, PAD, PURE], ids=["sphere", "punch", "groups"])
def test_a_table_or_key_that_is_left_out_or_unknown_is_refused_by_both(tables):
    assert stated(tables)
    assert not stated(tables | {"ball": {"radius": "1 mm"}})
    for name, table in tables.items():
        assert not stated({x: y for x, y in tables.items() if x != name})
        assert not stated(tables | {name: table | {"unknown": "1 mm"}})
        for key in table:
            less = {x: y for x, y in table.items() if x != key}
            assert not stated(tables | {name: less}), (name, key)


@pytest.mark.parametrize(
    ("of", "table", "change"),
    [
        (SPHERE, "material", {"model": "rubber"}),
        (SPHERE, "interface", {"law": "glue"}),
        (PAD, "layer", {"base": "glued"}),
        (SPHERE, "sphere", {"radius": "-5 mm"}),
        (SPHERE, "sphere", {"radius": "0 mm"}),
        (SPHERE, "material", {"poisson_ratio": 0.51}),
        (SPHERE, "material", {"poisson_ratio": -0.1}),
        (SPHERE, "material", {"modulus_ratio": 0.1}),
        (SPHERE, "interface", {"strength": "1 MPa"}),
        (SPHERE, "interface", {"law": "exponential"}),
        (SPHERE, "protocol", {"preload_depth": "1 um"}),
        (SPHERE, "protocol", {"preload_stress": "1 kPa"}),
        (PAD, "protocol", {"preload_force": "1 mN"}),
        (SPHERE, "protocol", {"cycles": 0}),
        (SPHERE, "protocol", {"moves": "dwell 1 s"}),
        (SPHERE, "cone", {"slope": 0.1}),
        (PURE, "groups", {"cohesion": 0.1}),
        (PURE, "material", {"modulus_ratio": 2}),
        (PURE, "protocol", {"speed": "1 um/s"}),
        (PURE, "layer", {"thickness": 2}),
        (SPHERE, "interface", {"law": "table", "file": "law.csv"}),
        (SPHERE | {"protocol": {"history": "h.csv"}}, "protocol", {"moves": ["dwell 1 s"]}),
        (PAD | {"protocol": {"speed": "1 um/s"}}, "protocol", {"start": "radius 1 mm"}),
    ],
)
def test_a_wrong_word_or_number_is_refused_by_both(of, table, change):
    assert not stated(of | {table: of.get(table, {}) | change})


LAW, EXPONENTIAL = SPHERE["interface"], {"base": "exponential", "decay": 0.3}
GROWS = LAW | {"law": "gent-schultz", "reference_speed": "1 um/s", "exponent": 0.4}
AGES = LAW | {"law": "saturating-ageing", "reference_time": "1 s", "largest_growth": 3}
PRONY = {x: SPHERE["material"][x] for x in ("rubbery_modulus", "poisson_ratio")}
PRONY |= {"model": "prony", "branches": [["5 MPa", "1 ms"]]}


@pytest.mark.parametrize(
    ("table", "keys", "valid"),
    [
        ("interface", GROWS, True),
        ("interface", AGES | EXPONENTIAL, True),
        ("interface", LAW | EXPONENTIAL | {"law": "eyring", "base": "dugdale"}, False),
        ("material", PRONY, True),
        ("material", {"passport": "pdms-10-1", "temperature": "-20 degC"}, True),
    ],
)
def test_other_laws_and_materials(table, keys, valid):
    assert stated(SPHERE | {table: keys}) == valid


def test_a_number_without_unit_may_be_text():
    assert stated(PURE | {"groups": PURE["groups"] | {"tabor": "3.24", "moves": ["dwell 1"]}})
    assert not stated(PURE | {"groups": PURE["groups"] | {"tabor": "0"}})
    assert stated(SPHERE | {"material": SPHERE["material"] | {"poisson_ratio": "50 %"}})
