import re
import tomllib
from pathlib import Path

import pytest

import viscotack as vt
from stated import LENS, case_text, lens
from viscotack.files.quantities import read_quantities
from viscotack.model.problem.case_file import case_of_tables


def written(folder, text):
    path = folder / "case.toml"
    path.write_text(text)
    return path


def edited(old, new):
    """Return the case with a text replaced, after seeing that it is there."""
    assert old in LENS
    return LENS.replace(old, new)


def with_material(lines):
    return re.sub(r"\[material\].*?(?=\[interface\])", f"[material]\n{lines}\n\n", LENS, flags=re.S)


BASE = 'rubbery_modulus = "1 MPa"\npoisson_ratio = 0.4\n'
SOLID = dict(rubbery_modulus=1e6, poisson_ratio=0.4)


@pytest.mark.parametrize(
    ("lines", "material"),
    [
        (
            f'model = "sls"\n{BASE}glassy_modulus = "1 GPa"\ntau0 = "2 min"',
            vt.StandardSolid(**SOLID, glassy_modulus=1e9, tau0=120),
        ),
        (
            f'model = "prony"\n{BASE}file = "series.csv"',
            vt.Prony(**SOLID, branches=((5e6, 120.0), (4e6, 3600.0))),
        ),
    ],
)
def test_a_model_can_be_written_with_units_or_a_file(lines, material, tmp_path):
    (tmp_path / "series.csv").write_text("modulus_ratio,relaxation_time_min\n5,2\n4,60\n")
    assert vt.read_case(written(tmp_path, with_material(lines))).material == material


@pytest.mark.parametrize(
    ("line", "start"),
    [
        ('preload_depth = "2 um"', vt.AtDepth(2e-6)),
        ('preload_force = "-1 mN"', vt.AtForce(-1e-3)),
        ('preload_radius = "0.25 mm"', vt.AtRadius(2.5e-4)),
    ],
)
def test_every_start_can_be_written(line, start, tmp_path):
    text = edited('preload_force = "1.5 mN"', line)
    assert vt.read_case(written(tmp_path, text)).protocol.start == start


@pytest.mark.parametrize(
    ("text", "field"),
    [
        (edited("[sphere]", "[ball]"), "ball"),
        (edited('[sphere]\nradius = "5.19 mm"', ""), "sphere"),
        (edited('"5.19 mm"', "5.19"), "sphere.radius"),
        (edited('"5.19 mm"', '"5.19 Pa"'), "sphere.radius"),
        (edited('"5.19 mm"', "true"), "sphere.radius"),
        (edited('"5.19 mm"', '"1 km"'), "sphere.radius"),
        (edited("radius", "radiuss"), "sphere.radiuss"),
        (edited('"power-law"', '"rubber"'), "material.model"),
        (edited('"3089 MPa"', '"3089 Pa"'), "material"),
        (with_material(f'model = "elastic"\n{BASE}exponent = 0.5'), "material.exponent"),
        (edited('preload_force = "1.5 mN"', ""), "protocol"),
        (edited('speed = "100 um/s"', ""), "protocol.speed"),
        (edited('"100 um/s"', '"1 um/s"\nmoves = "dwell 1 s"'), "protocol.moves"),
        (edited('"100 um/s"', '"1 um/s"\nmoves = ["dwell -1 s"]'), "protocol"),
        (edited('"100 um/s"', '"1 um/s"\ncycles = true'), "protocol.cycles"),
        (edited("[protocol]", '[layer]\nthickness = "1 mm"\n[protocol]'), "layer.base"),
        (edited('equilibrium_gap = "1.55 um"', 'strength = "-1 MPa"'), "interface.strength"),
        (edited("[interface]", '[interface]\nstrength = "1 MPa"'), "interface.strength"),
        (edited("exponent =", "modulus_ratio = 0.1\nexponent ="), "material.modulus_ratio"),
    ],
)
def test_a_wrong_case_is_refused_with_its_field(text, field, tmp_path):
    with pytest.raises(vt.InputError, match=re.escape("case.toml")) as caught:
        vt.read_case(written(tmp_path, text))
    assert caught.value.field == field
    assert all(part in str(caught.value) for part in field.split("."))


def test_a_file_that_is_no_toml_is_refused(tmp_path):
    with pytest.raises(vt.InputError, match=r"case\.toml.*TOML"):
        vt.read_case(written(tmp_path, "[material"))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("E,tau\n5,2\n", "no column modulus_ratio .* first row is 'E,tau'"),
        ("modulus_ratio,relaxation_time\n5,2\n", "no column relaxation_time with its unit"),
        ("modulus_ratio,relaxation_time_kg\n5,2\n", "expected a quantity in s"),
        ("# x\nmodulus_ratio,relaxation_time_s\n5,2\n5,-2\n", "time of branches must be positive"),
        ("modulus_ratio,relaxation_time_s\n5,2,3\n", "line 2"),
    ],
)
def test_a_wrong_prony_series_is_refused_with_its_file(text, words, tmp_path):
    (tmp_path / "series.csv").write_text(text)
    case = written(tmp_path, with_material(f'model = "prony"\n{BASE}file = "series.csv"'))
    with pytest.raises(ValueError, match=f"series.csv.*{words}"):
        vt.read_case(case)


def test_the_documented_case_is_the_lens(tmp_path):
    text = (Path(__file__).parents[1] / "docs/input.md").read_text(encoding="utf-8")
    example = re.search(r"```toml\n(.*?)```", text, flags=re.S)
    assert example
    assert vt.read_case(written(tmp_path, example[1])) == lens()
    series = re.search(r"```text\n(.*?)```", text, flags=re.S)
    assert series
    (tmp_path / "series.csv").write_text(series[1])
    columns = read_quantities(
        tmp_path / "series.csv", {"modulus_ratio": "1", "relaxation_time": "s"}
    )
    assert tuple(columns.values()) == ((5.0, 4.0), (1e-3, 1.0))


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
    tables = tomllib.loads(LENS) | {table: replaced}
    with pytest.raises(vt.InputError, match=r"the case, \[.*which is not allowed in a request"):
        case_of_tables(tables)


@pytest.mark.parametrize(
    ("more", "name"),
    [
        ({"protocol": 'preload_depth = "1 um"\nspeed = "1e30 m/s"'}, r"\[protocol\] speed"),
        (
            {"protocol": 'start = "force 1e20 N"\nmoves = ["retract 1 um/s to depth 0 um"]'},
            "force must lie between",
        ),
    ],
)
def test_absurd_quantities_are_refused(more, name, tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(case_text(**more))
    with pytest.raises(vt.InputError, match=name):
        vt.read_case(file)


def test_tips_of_microscopes_and_creep_are_no_absurd_quantities(tmp_path):
    file = tmp_path / "case.toml"
    slow = 'preload_depth = "0.1 pm"\nspeed = "1e-3 pm/s"'
    text = case_text(radius="5 nm", protocol=slow).replace('gap = "1 um"', 'gap = "0.2 nm"')
    file.write_text(text.replace("50 mJ", "0.1 uJ"))
    assert vt.read_case(file).geometry.radius == 5e-9
