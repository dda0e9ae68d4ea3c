"""Material passports: written and read back, refused when they lie."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from viscotack.model.materials.conversion import slowed
from viscotack.model.materials.passport import (
    Evidence,
    Origin,
    Passport,
    _moved,
    allowed,
    shift_error,
)
from viscotack.model.materials.passport_file import passport_text, read_passport, write_passport
from viscotack.model.materials.shift import WLF, Arrhenius, TabulatedShift
from viscotack.model.problem.case_file import passport_of
from viscotack.model.tables import Reading

LAW = dict(rubbery_modulus=1e6 / 3, glassy_modulus=1e9 / 7, tau0=0.1 / 3, poisson_ratio=0.4)
MATERIAL = {
    "sls": vt.StandardSolid(**LAW),
    "prony": vt.Prony(
        rubbery_modulus=1e6 / 3, branches=[(1e7 / 7, 1e-3 / 3), (2e6, 7.0)], poisson_ratio=0.5
    ),
    "power-law": vt.RetardationPowerLaw(**LAW, exponent=0.7 / 3),
}
SHIFT = {
    "none": None,
    "wlf": WLF(reference_temperature=300.1, c1=17.44 / 3, c2=51.6 / 0.7),
    "arrhenius": Arrhenius(293.15, 1e5 / 3),
    "table": TabulatedShift(293.15, (253.15, 273.15, 303.15), (5 / 3, 1.0, -1 / 7)),
}


def passport(material=MATERIAL["power-law"], shift=SHIFT["wlf"]):
    return Passport(
        name='a "rubber"\n with \\ and ü',
        material=material,
        temperature=293.15,
        shift=shift,
        temperatures=(143.15, 293.15),
        frequencies=(2 * np.pi, 1e7 / 3),
        measured="G",
        origin=Origin(reference="a lab", file="dma.csv", sha256="12ab", notes=("one", "two")),
        evidence=Evidence(
            numbers=32,
            constants=4,
            scatter=0.02 / 3,
            level=0.9,
            intervals=(("tau0", 1 / 30, float("inf")),),
            undetermined=("a plateau",),
        ),
    )


# of every solid: tests/test_testing.py
@pytest.mark.parametrize("shift", SHIFT.values(), ids=SHIFT)
def test_a_passport_comes_back_to_the_last_digit(shift, tmp_path):
    written = passport(shift=shift)
    write_passport(written, tmp_path / "x.toml")
    assert read_passport(tmp_path / "x.toml") == written


def test_solids_that_are_allowed_come_back_and_move_with_the_temperature(tmp_path):
    shift = TabulatedShift(
        293.15, (253.15, 273.15, 303.15), (5 / 3, 1.0, -1 / 7), uncertainty=(0.1, 0.05, 0.05)
    )
    arms = MATERIAL["prony"]
    more = tuple(replace(arms, rubbery_modulus=f * 1e6 / 3) for f in (0.9, 1.0, 1.1, 1.2))
    written = replace(passport(arms, shift), allowed=more)
    write_passport(written, tmp_path / "m.toml")
    assert read_passport(tmp_path / "m.toml") == written
    moved = written.moved_to(273.15)
    factors = [
        new.branches[0][1] / old.branches[0][1]
        for new, old in zip(moved.allowed, more, strict=True)
    ]
    # as far apart as log10 a_T is doubtful, around it
    assert 10 ** np.mean(np.log10(factors)) == pytest.approx(written.shift_factor(273.15))
    deviation = written.shift_deviation(273.15)
    assert np.std(np.log10(factors)) == pytest.approx(deviation) and deviation > 0
    assert [x.rubbery_modulus for x in moved.allowed] == [x.rubbery_modulus for x in more]


TEXT = passport_text(passport())


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("passport = 1\n", "", "is not a material passport"),
        ("exponent = ", 'colour = "red"\nexponent = ', "unknown key 'colour'"),
        ('modulus = "E"', 'modulus = "G"', "states Young's moduli"),
        ('Pa"\nexponent', '"\nexponent', "has no unit"),
        ("[origin]", "[origins]", r"unknown table \[origins\]"),
    ],
)
def test_a_passport_that_is_wrong_is_refused(old, new, words, tmp_path):
    assert old in TEXT
    (tmp_path / "x.toml").write_text(TEXT.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ValueError, match=words) as caught:
        read_passport(tmp_path / "x.toml")
    assert "x.toml" in str(caught.value)


def lens_with(passport, folder, **temperature):
    """Write a passport and a case that names it; return the case."""
    write_passport(passport, folder / "m.toml")
    extra = "".join(f'{key} = "{value}"\n' for key, value in temperature.items())
    case = folder / "lens.toml"
    case.write_text(
        f'[material]\npassport = "m.toml"\n{extra}'
        '[interface]\nlaw = "lennard-jones"\nwork_of_adhesion = "0.1 J/m^2"\n'
        'equilibrium_gap = "1 um"\n[sphere]\nradius = "1 mm"\n'
        '[protocol]\npreload_force = "1 mN"\nspeed = "10 um/s"\n'
    )
    return case


def uncertain():
    material = vt.RetardationPowerLaw(
        rubbery_modulus=1e6, glassy_modulus=1e7, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    )
    shift = TabulatedShift(293.15, (253.15, 273.15, 293.15), (3.0, 1.2, 0.0), (0.3, 0.15, 0.0))
    return Passport(
        name="m", material=material, temperature=293.15, shift=shift, temperatures=(253.15, 293.15)
    )


def test_a_case_has_its_material_at_a_temperature(tmp_path):
    case = lens_with(uncertain(), tmp_path, temperature="0 degC")
    moved = vt.read_case(case)
    assert moved.material.tau0 == pytest.approx(0.1 * 10**1.2, rel=1e-12)
    tables = tomllib.loads(case.read_text())
    reading = Reading("the case", beside=case.parent.joinpath)
    passport, deviation = passport_of(tables, reading)
    assert deviation == pytest.approx(0.15)
    assert passport.temperature == 273.15 and passport.material == moved.material
    case.write_text(case.read_text().replace("0 degC", "60 degC"))
    with pytest.raises(ValueError, match="not extrapolated"):
        vt.read_case(case)


def test_a_passport_is_scaled_to_another_rubbery_modulus(tmp_path):
    case = lens_with(uncertain(), tmp_path)
    own = vt.read_case(case).material
    case.write_text(case.read_text().replace("[material]", '[material]\nrubbery_modulus = "3 MPa"'))
    solid = vt.read_case(case).material
    assert solid == replace(own, rubbery_modulus=3e6, glassy_modulus=3 * own.glassy_modulus)
    tables = tomllib.loads(case.read_text())
    scaled, _ = passport_of(tables, Reading("the case", beside=case.parent.joinpath))
    assert (scaled.name, scaled.material) == ("m, scaled to 3 MPa", solid)
    case.write_text(case.read_text().replace('"3 MPa"', '"-3 MPa"'))
    with pytest.raises(ValueError, match="rubbery_modulus must be positive"):
        vt.read_case(case)


def test_uncertain_times_widen_a_prediction(tmp_path):
    problem = vt.read_case(lens_with(uncertain(), tmp_path, temperature="0 degC"))
    plain, wide = vt.predict(problem), vt.predict(problem, shift_deviation=0.15)
    assert wide.pull_off_force == plain.pull_off_force
    assert wide.interval[0] < plain.interval[0] and wide.interval[1] > plain.interval[1]
    assert np.ptp(wide.work_interval) > np.ptp(plain.work_interval)
    # as far as slower material is stuck more firmly
    slower = replace(problem, material=slowed(problem.material, 10 ** (1.6449 * 0.15)))
    up = np.log(vt.predict(slower).pull_off_force / plain.pull_off_force)
    own = np.log(plain.interval[1] / plain.pull_off_force)
    assert np.log(wide.interval[1] / wide.pull_off_force) == pytest.approx(
        np.hypot(up, own), rel=1e-3
    )
    assert "uncertainty of 0.15 decades" in wide.why
    case = tmp_path / "lens.toml"
    record = vt.ask(
        "uncertainty", problem=case, scatter=("sphere.radius 1 %",), samples=16
    ).record()
    (times,) = (row for row in record["inputs"] if row["input"] == "shift")
    assert times["deviation"] == pytest.approx(0.15 * np.log(10))


def of_intervals(*intervals, level=0.9):
    evidence = Evidence(numbers=9, constants=3, level=level, intervals=intervals)
    return replace(passport(MATERIAL["sls"], SHIFT["wlf"]), evidence=evidence)


@pytest.mark.parametrize(
    ("low", "high", "width"),
    [(0.8, 1.5, (np.log(1 / 0.8) + np.log(1.5)) / 2), (0.0, 1.5, np.log(1.5)), (0.8, np.inf, None)],
)
def test_solids_are_drawn_from_the_closed_sides_of_an_interval(low, high, width):
    tau0 = MATERIAL["sls"].tau0
    found = allowed(of_intervals(("tau0", low * tau0, high * tau0), ("of_the_fit", 1.0, 2.0)))
    deviation = (width or np.log(1 / 0.8)) / 1.6448536269514722
    drawn = np.random.default_rng(20).standard_normal(24)
    assert [x.tau0 for x in found] == pytest.approx(tau0 * np.exp(deviation * drawn), rel=1e-9)
    assert {replace(x, tau0=tau0) for x in found} == {MATERIAL["sls"]}


def test_the_error_of_times_by_temperature_is_the_slope_of_the_shift():
    # log10 a_T from -2 to 2 K around 300.1 K and around 320 K
    law, written = SHIFT["wlf"], passport(MATERIAL["sls"])
    written = replace(written, temperature=300.1)
    for given, middle in ((None, 300.1), (320.0, 320.0)):
        decades = law.log10_shift(middle - 2.0) - law.log10_shift(middle + 2.0)
        error = shift_error(written, 2.0, given)
        assert error == pytest.approx(decades / 2 * np.log(10), rel=1e-12)
    assert shift_error(written, 0.0) == 0.0
    assert shift_error(Passport(name="x", material=MATERIAL["sls"]), 2.0) == 0.0


def test_an_interval_moves_with_its_time_and_keeps_its_open_ends():
    # ln 2 and the error of the shift add as independent errors
    half = np.hypot(np.log(2), 0.5)
    name, low, high = _moved(("tau0", 0.05, 0.2), 0.1, 30.0, 0.5)
    assert (name, low, high) == (
        "tau0",
        pytest.approx(3 * np.exp(-half)),
        pytest.approx(3 * np.exp(half)),
    )
    assert _moved(("tau0", 0.0, 0.2), 0.1, 30.0, 0.0) == ("tau0", 0.0, pytest.approx(6.0))
    assert _moved(("tau0", 0.05, np.inf), 0.1, 30.0, 0.0) == ("tau0", pytest.approx(1.5), np.inf)
    assert _moved(("exponent", 0.1, 0.2), 0.1, 30.0, 0.5) == ("exponent", 0.1, 0.2)
    # an interval of 80 % by 1.2816 of the 0.15 decades by which the table is uncertain at 0 C
    told = Evidence(numbers=9, constants=4, level=0.8, intervals=(("tau0", 0.05, 0.2),))
    ((_, *ends),) = replace(uncertain(), evidence=told).moved_to(273.15).evidence.intervals
    half = np.hypot(np.log(2), 1.2816 * 0.15 * np.log(10))
    assert ends == pytest.approx(0.1 * 10**1.2 * np.exp([-half, half]), rel=1e-4)


def test_a_passport_is_used_up_to_a_kelvin_beside_its_temperatures():
    written = replace(passport(MATERIAL["sls"]), temperatures=(273.15, 293.15))
    for inside, outside in ((272.15, 272.14), (294.15, 294.16)):
        assert written.shift_factor(inside) > 0
        with pytest.raises(ValueError, match="was measured from 0 C"):
            written.shift_factor(outside)
    one = replace(written, temperatures=(293.15, 293.15), frequencies=(1.0, 1.0))
    assert one.temperatures == (293.15, 293.15)
    for wrong in ((0.0, 1.0), (2.0, 1.0)):
        with pytest.raises(ValueError, match="frequencies must be positive and ascend"):
            replace(written, frequencies=wrong)
