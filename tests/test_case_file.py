import re
import tomllib
from pathlib import Path

import pytest

from stated import case_text
from viscotack.errors import InputError
from viscotack.geometry import Sphere
from viscotack.materials import (
    Elastic,
    Prony,
    RelaxationPowerLaw,
    RetardationPowerLaw,
    StandardSolid,
    published,
)
from viscotack.problem import Problem
from viscotack.problem.case_file import case_of_tables, read_case
from viscotack.problem.prony_file import read_prony
from viscotack.protocol import AtDepth, AtForce, AtRadius, Retraction
from viscotack.traction import LennardJones

POWER_LAW = """
[material]
model = "power-law"
rubbery_modulus = "1.458 MPa"
glassy_modulus = "3089 MPa"
exponent = 0.2207
tau0 = "18.76 ms"
poisson_ratio = 0.5

[interface]
law = "lennard-jones"
work_of_adhesion = "0.1523 J/m^2"
equilibrium_gap = "1.55 um"

[sphere]
radius = "5.19 mm"

[protocol]
preload_force = "1.5 mN"
speed = "100 um/s"
"""
LENS = Problem(
    material=RetardationPowerLaw(
        rubbery_modulus=1.458e6,
        glassy_modulus=3.089e9,
        exponent=0.2207,
        tau0=0.01876,
        poisson_ratio=0.5,
    ),
    traction=LennardJones(work_of_adhesion=0.1523, equilibrium_gap=1.55e-6),
    geometry=Sphere(radius=5.19e-3),
    protocol=Retraction(start=AtForce(force=1.5e-3), speed=100e-6),
)


def written(folder, text):
    path = folder / "case.toml"
    path.write_text(text)
    return path


def edited(old, new):
    """Return the case with a text replaced, after seeing that it is there."""
    assert old in POWER_LAW
    return POWER_LAW.replace(old, new)


def with_material(lines):
    return re.sub(
        r"\[material\].*?(?=\[interface\])", f"[material]\n{lines}\n\n", POWER_LAW, flags=re.S
    )


def test_a_case_in_words_is_the_problem_in_numbers(tmp_path):
    assert read_case(written(tmp_path, POWER_LAW)) == LENS


BASE = 'rubbery_modulus = "1 MPa"\npoisson_ratio = 0.4\n'
SOLID = dict(rubbery_modulus=1e6, poisson_ratio=0.4)
LAW = 'glassy_modulus = "1 GPa"\ntau0 = "2 min"\nexponent = 0.5'


@pytest.mark.parametrize(
    ("lines", "material"),
    [
        (f'model = "elastic"\n{BASE}', Elastic(**SOLID)),
        (
            f'model = "sls"\n{BASE}glassy_modulus = "1 GPa"\ntau0 = "2 min"',
            StandardSolid(**SOLID, glassy_modulus=1e9, tau0=120),
        ),
        (
            f'model = "power-law"\n{BASE}{LAW}',
            RetardationPowerLaw(**SOLID, glassy_modulus=1e9, tau0=120, exponent=0.5),
        ),
        (
            f'model = "relaxation-power-law"\n{BASE}{LAW}',
            RelaxationPowerLaw(**SOLID, glassy_modulus=1e9, tau0=120, exponent=0.5),
        ),
        (
            f'model = "prony"\n{BASE}branches = [["5 MPa", "2 s"], ["4 kPa", "1 h"]]',
            Prony(**SOLID, branches=((5e6, 2.0), (4e3, 3600.0))),
        ),
        (
            f'model = "prony"\n{BASE}file = "series.csv"',
            Prony(**SOLID, branches=((5e6, 120.0), (4e6, 3600.0))),
        ),
    ],
)
def test_every_model_can_be_written(lines, material, tmp_path):
    (tmp_path / "series.csv").write_text("modulus_ratio,relaxation_time_min\n5,2\n4,60\n")
    assert read_case(written(tmp_path, with_material(lines))).material == material


@pytest.mark.parametrize(
    ("line", "start"),
    [
        ('preload_depth = "2 um"', AtDepth(2e-6)),
        ('preload_force = "-1 mN"', AtForce(-1e-3)),
        ('preload_radius = "0.25 mm"', AtRadius(2.5e-4)),
    ],
)
def test_every_start_can_be_written(line, start, tmp_path):
    text = edited('preload_force = "1.5 mN"', line)
    assert read_case(written(tmp_path, text)).protocol.start == start


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[material", "is not a TOML file"),
        (edited("[sphere]", "[ball]"), r"unknown table 'ball'; expected interface, material"),
        (edited("[sphere]", "[spere]"), "unknown table 'spere'; did you mean sphere"),
        (edited('[sphere]\nradius = "5.19 mm"\n', ""), r"the table \[sphere\] is missing"),
        (edited('radius = "5.19 mm"', ""), r'\[sphere\] radius is missing; .* radius = "5.19 mm"'),
        (
            edited("radius = ", "raduis = "),
            r"\[sphere\] radius is missing \(is raduis meant\?\)",
        ),
        (
            edited('radius = "5.19 mm"', 'radius = "5.19 mm"\nmass = "1 kg"'),
            r"\[sphere\]: unknown key 'mass'; expected radius",
        ),
        (
            edited('"5.19 mm"', "5.19"),
            r"\[sphere\] radius has no unit, got 5.19; write .* in quotes, radius = \"5.19 mm\"",
        ),
        (edited('"5.19 mm"', '"5.19"'), r"\[sphere\] radius: '5.19' has no unit"),
        (
            edited('"5.19 mm"', '"5.19 Pa"'),
            r"\[sphere\] radius: '5.19 Pa' .* a quantity in m; for example radius = \"5.19 mm\"",
        ),
        (edited('"5.19 mm"', '"-5.19 mm"'), r"\[sphere\] radius must be positive"),
        (
            edited("exponent = 0.2207", "exponent = -0.2"),
            r"\[material\] exponent must lie in \(0, 3\], got -0.2",
        ),
        (edited("exponent = 0.2207", "exponent = true"), r"\[material\] exponent: expected"),
        (
            edited('"3089 MPa"', '"3089 Pa"'),
            r"\[material\] glassy_modulus \(short times\) must not be below",
        ),
        (
            edited('model = "power-law"', 'model = "rubber"'),
            r"\[material\] model must be one of elastic, sls, prony, power-law, .* got 'rubber'",
        ),
        (
            edited('law = "lennard-jones"', 'law = "glue"'),
            r"\[interface\] law must be one of lennard-jones, dugdale, .*, got 'glue'",
        ),
        (
            edited('preload_force = "1.5 mN"', ""),
            r"\[protocol\] needs exactly one of preload_depth, .* got none",
        ),
        (
            edited('preload_force = "1.5 mN"', 'preload_force = "1 mN"\npreload_depth = "1 um"'),
            "got preload_depth and preload_force",
        ),
        (
            edited('"100 um/s"', '"0 um/s"'),
            r"\[protocol\] speed must be positive",
        ),
        (edited('"1.5 mN"', '"15 N"'), r"case\.toml: the start exceeds small strain"),
        (
            with_material('model = "prony"\nrubbery_modulus = "1 MPa"\npoisson_ratio = 0.5'),
            r"\[material\] branches is missing; write for example branches = \[\[",
        ),
        (
            with_material(f'model = "prony"\n{BASE}branches = [["5 MPa", 2.0]]'),
            r"\[material\] branches: .*'2.0' has no unit",
        ),
        (
            with_material(f'model = "prony"\n{BASE}branches = ["5 MPa"]'),
            r"\[material\] branches: .*write for example branches = \[\[",
        ),
        (
            with_material(f'model = "prony"\n{BASE}branches = [["5 MPa", "2 s"], ["4 MPa"]]'),
            r"branches: .*relaxation time of each branch, got \['4 MPa'\]; write",
        ),
        (
            with_material(f'model = "prony"\n{BASE}branches = ["ab"]'),
            r"branches: .*relaxation time of each branch, got 'ab'; write",
        ),
        (
            with_material(f'model = "elastic"\n{BASE}exponent = 0.5'),
            r"\[material\]: unknown key 'exponent'",
        ),
    ],
)
def test_a_wrong_case_is_refused_with_table_and_key(text, words, tmp_path):
    with pytest.raises(ValueError, match=words) as caught:
        read_case(written(tmp_path, text))
    assert "case.toml" in str(caught.value)


def test_prony_times_without_a_unit_are_refused_in_si(tmp_path):
    (tmp_path / "series.csv").write_text("modulus_ratio,relaxation_time\n5,2\n")
    with pytest.raises(ValueError, match="times have no unit; name the column relaxation_time_s"):
        read_case(written(tmp_path, with_material(f'model = "prony"\n{BASE}file = "series.csv"')))


@pytest.mark.parametrize(
    ("text", "branches", "unit"),
    [
        ("modulus_ratio,relaxation_time_s\n5,0.001\n4, 1\n", ((5, 1e-3), (4, 1)), "s"),
        ("# soft\n\nmodulus_ratio, relaxation_time_h\n5,2\n", ((5, 2),), "h"),
        ("\ufeffmodulus_ratio,relaxation_time\n5,2\n", ((5, 2),), "1"),
    ],
)
def test_a_prony_series_is_read_in_its_own_unit_of_time(text, branches, unit, tmp_path):
    path = tmp_path / "series.csv"
    path.write_text(text, encoding="utf-8")
    assert read_prony(path) == (branches, unit)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "first row must be"),
        ("E,tau\n5,2\n", "first row must be .* got 'E,tau'"),
        ("modulus_ratio,relaxation_time_kg\n5,2\n", "expected a quantity in s"),
        ("modulus_ratio,relaxation_time_s\n", "no branch below the header"),
        ("# x\nmodulus_ratio,relaxation_time_s\n5,2\n5,-2\n", "line 4: time must be positive"),
        ("modulus_ratio,relaxation_time_s\n5,two\n", "line 2: time must be a number in s"),
        ("modulus_ratio,relaxation_time_s\n5,2,3\n", "line 2: a row must be .*, got '5,2,3'"),
    ],
)
def test_a_wrong_prony_series_is_refused_with_its_line(text, words, tmp_path):
    path = tmp_path / "series.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=words) as caught:
        read_prony(path)
    assert "series.csv" in str(caught.value)


def test_the_documented_case_is_the_lens(tmp_path):
    text = (Path(__file__).parents[1] / "docs/input.md").read_text(encoding="utf-8")
    example = re.search(r"```toml\n(.*?)```", text, flags=re.S)
    assert example
    assert read_case(written(tmp_path, example[1])) == LENS
    series = re.search(r"```text\n(.*?)```", text, flags=re.S)
    assert series
    (tmp_path / "series.csv").write_text(series[1])
    assert read_prony(tmp_path / "series.csv") == (((5.0, 1e-3), (4.0, 1.0)), "s")


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (
            lambda text: text.replace("glassy_", "glasy_").replace("tau0 =", "# tau0 ="),
            r"\[material\] glassy_modulus \(is glasy_modulus meant\?\) and tau0 are missing; "
            r'write for example glassy_modulus = "[^"]+", tau0 = "[^"]+"$',
        ),
        (
            lambda text: text.partition("[sphere]")[0],
            r"the tables \[protocol\] and \[sphere\] are missing; see docs/input.md",
        ),
        (
            lambda text: text.replace("work_of", "# ").replace("equilibrium_gap", "gap"),
            r"\[interface\] work_of_adhesion and equilibrium_gap are missing; write for",
        ),
    ],
    ids=["keys", "tables", "law"],
)
def test_all_that_is_missing_is_named_at_once(edit, said, tmp_path):
    with pytest.raises(ValueError, match=said):
        read_case(written(tmp_path, edit(POWER_LAW)))


def test_tables_that_were_sent_state_what_the_file_states():
    assert case_of_tables(tomllib.loads(POWER_LAW)) == LENS


def test_a_published_material_is_named_without_a_file():
    tables = tomllib.loads(POWER_LAW) | {"material": {"passport": "pdms-10-1"}}
    passport = published("pdms-10-1")
    assert case_of_tables(tables).material == passport.material
    tables["material"]["temperature"] = "0 degC"
    assert case_of_tables(tables).material == passport.at_temperature(273.15)


@pytest.mark.parametrize(
    ("table", "replaced"),
    [
        ("material", {"passport": "pdms.toml"}),
        ("material", {"model": "prony", "rubbery_modulus": "1 MPa", "file": "/etc/passwd"}),
        ("interface", {"law": "table", "file": "law.csv"}),
        ("protocol", {"history": "drive.csv"}),
    ],
)
def test_tables_that_were_sent_name_no_file(table, replaced):
    tables = tomllib.loads(POWER_LAW) | {table: replaced}
    with pytest.raises(InputError, match=r"the case, \[.*which is not allowed in a request"):
        case_of_tables(tables)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"radius": "1 km"}, r"\[sphere\] radius must lie between 1e-15 and 100 m, got 1000 m"),
        (
            {"protocol": 'preload_depth = "1 um"\nspeed = "1e30 m/s"'},
            r"\[protocol\] speed must lie between 1e-21 and 100000 m/s, got 1e\+30 m/s",
        ),
        (
            {"protocol": 'start = "force 1e20 N"\nmoves = ["retract 1 um/s to depth 0 um"]'},
            r"force must lie between 1e-21 and 1e\+09 N, got 1e\+20 N; check its unit",
        ),
        (
            {"protocol": 'start = "depth 0 um"\nmoves = ["retract 1e9 m/s to depth -1 mm"]'},
            r"speed must lie between .* got 1e\+09 m/s",
        ),
    ],
)
def test_absurd_quantities_are_refused(more, words, tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(case_text(**more))
    with pytest.raises(InputError, match=words):
        read_case(file)


def test_tips_of_microscopes_and_creep_are_no_absurd_quantities(tmp_path):
    file = tmp_path / "case.toml"
    slow = 'preload_depth = "0.1 pm"\nspeed = "1e-3 pm/s"'
    text = case_text(radius="5 nm", protocol=slow).replace('gap = "1 um"', 'gap = "0.2 nm"')
    file.write_text(text.replace("50 mJ", "0.1 uJ"))
    assert read_case(file).geometry.radius == 5e-9
