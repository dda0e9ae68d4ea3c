"""The same quantity has the same word in Python, JSON, tables, HTTP and on the page."""

import json
import re
from dataclasses import fields, is_dataclass
from pathlib import Path

import pytest

import viscotack as vt
from front_ends import Http
from stated import PUNCH, SPHERE
from viscotack.app.engine.overview import quick
from viscotack.app.engine.page_tasks import ask_verdict
from viscotack.campaign import CaseSettings, measure
from viscotack.datasets.columns import KEPT
from viscotack.forecast.prediction_table import FORCE, WORK
from viscotack.lab.tack import Cycle as TackCycle
from viscotack.operations import ask
from viscotack.operations.declare.state import State
from viscotack.operations.parts.examples import EXAMPLES, FIRST
from viscotack.result import observables

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "src/viscotack/app/page"
PAD = EXAMPLES["A flat punch on a soft layer"]
# The word of a quantity, and with what unit it ends in SI.
WORDS = {
    "pull_off_force": "N",
    "pull_off_stress": "Pa",
    "work_to_pull_off": "J|J_per_m2",
    "work_of_separation": "J|J_per_m2",
    "depth_at_pull_off": "m",
    "time_at_pull_off": "s",
    "contact_radius_at_pull_off": "m",
    "cohesive_radius_at_pull_off": "m",
    "inner_radius_at_pull_off": "m",
    "rings_at_pull_off": "1",
    "ligament_at_pull_off": "m",
    "crack_speed_at_pull_off": "m_per_s",
    "amplification_at_pull_off": "1",
    "travel_to_pull_off": "m",
    "other_peak_force": "N",
    "other_peak_stress": "Pa",
    "depth_at_other_peak": "m",
    "work_to_other_peak": "J|J_per_m2",
}
# A name that speaks of one of them, and what may stand before and behind the word.
SPEAKS = re.compile(r"pull_?off|peak|crack_?speed|detach|^work")
MORE = "note|low|high|uncertainty|mean|weighted_mean|standard_deviation"
ALLOWED = re.compile(
    "|".join(
        rf"(?:slowest_|fastest_)?{word}(?:_(?:{unit}))?(?:_(?:{MORE}))?"
        for word, unit in WORDS.items()
    )
)
# Names of something else: intervals, scales, compression, series of a punch, points of a record.
OTHERS = {
    "work_interval",
    "work_interval_J",
    "work_interval_J_per_m2",
    "work_error",
    "peak_force",
    "peak_force_N",
    "peak_stress",
    "peak_stress_Pa",
    "time_to_detachment",
    "time_to_detachment_s",
    "crack_speed",
    "pull_off_at",
    "pull_off_raw",
    "pull_off_raw_N",
    "work_of_adhesion",
    "work_of_adhesion_J_m2",
    "detachment",
}
# Values are compared between functions, summaries and records.
LENS, PADS = {"problem": FIRST}, {"problem": PAD}
COARSE = {"until": "pull-off", "accuracy": 0.02}
CRACK = {"problem": SPHERE | {"tabor": 1e4, "preload": 2e5, "rate": 1e3}}
JKR = {"radius": "1 mm", "contact_modulus": "1 MPa", "work_of_adhesion": "50 mJ/m^2"}
DEPTH, WORK_DONE = "depth_at_pull_off", "work_to_pull_off"
FORCE_OF_SPHERE, FORCE_OF_PUNCH = {"pull_off_force"}, {"pull_off_stress"}


def names_in(value):
    """Return all names of a record: keys, and what an entry says that its name is."""
    if isinstance(value, dict):
        found = set(value) | ({value["name"]} if isinstance(value.get("name"), str) else set())
        return found.union(*map(names_in, value.values()))
    return set().union(*map(names_in, value)) if isinstance(value, list | tuple) else set()


def names_of(noun):
    """Return the names of a class: fields and properties, without those kept for a release."""
    kept = {name for name in vars(noun) if isinstance(vars(noun)[name], property)}
    return {field.name for field in fields(noun)} | kept if is_dataclass(noun) else kept


def strange(names):
    """Return the names that speak of a quantity in other words."""
    return sorted(
        name
        for name in names
        if SPEAKS.search(name) and not ALLOWED.fullmatch(name) and name not in OTHERS
    )


@pytest.mark.parametrize(
    ("noun", "has"),
    [
        (vt.Result, {"pull_off_force", "pull_off_stress", WORK_DONE, DEPTH}),
        (vt.Prediction, {"pull_off_force", "pull_off_stress", WORK_DONE, DEPTH}),
        (vt.CrackContact, {"pull_off_force", WORK_DONE, DEPTH, "crack_speed_at_pull_off"}),
        (vt.Cycle, {"pull_off_force", WORK_DONE, DEPTH}),
        (TackCycle, {"pull_off_force", WORK_DONE, DEPTH}),
        (vt.Advice, {"pull_off_force", "crack_speed_at_pull_off_m_per_s"}),
        (vt.Estimate, {"pull_off_force"}),
    ],
)
def test_classes_have_the_words(noun, has):
    assert has <= names_of(noun)
    assert strange(names_of(noun)) == []


@pytest.mark.parametrize("problem", [SPHERE, PUNCH], ids=["sphere", "punch"])
def test_a_result_has_the_numbers_of_the_functions_and_of_its_summary(problem):
    result = ask("simulate", problem=problem, **COARSE).found
    told = vt.summary(result)
    for name in ("pull_off_force", "pull_off_stress", WORK_DONE, DEPTH):
        if name in told:
            assert getattr(result, name) == getattr(vt, name)(result) == told[name]
    # the largest tension, whatever the unit
    assert result.pull_off_force == told.get("pull_off_stress", told.get("pull_off_force"))


@pytest.mark.parametrize("word", ["simulate", "predict"])
def test_a_sphere_has_a_force_and_no_stress(word):
    given = COARSE if word == "simulate" else {}
    found = ask(word, problem=SPHERE, **given).found
    words = "this kind of problem has no pull_off_stress; use pull_off_force"
    with pytest.raises(vt.InputError, match=words):
        found.pull_off_stress  # noqa: B018


def test_a_prediction_has_the_numbers_of_its_summary():
    for problem, force in ((SPHERE, "pull_off_force"), (PUNCH, "pull_off_stress")):
        found = ask("predict", problem=problem).found
        told = vt.prediction_summary(found)
        for name in (force, WORK_DONE, DEPTH):
            assert getattr(found, name) == told[name]


def test_advice_has_its_force_in_newtons():
    told, predicted = (ask(word, problem=FIRST).record() for word in ("advise", "predict"))
    for name in ("pull_off_force_N", "interval_N"):
        assert told[name] == pytest.approx(predicted[name], rel=1e-12, abs=0)


def test_functions_have_the_words():
    public = {name for name in vt.__all__ if SPEAKS.search(name)}
    assert {"pull_off_force", "pull_off_stress", WORK_DONE, DEPTH} <= public
    found = {*vars(observables), *public} - {"pull_off", "pull_offs", "other_peak", "equal_peak"}
    taken = {"pull_off_in", "peaks", "peaks_in", "work_to", "work_lost", "detachment"}
    assert strange(found - taken) == []


@pytest.mark.parametrize(
    ("word", "given", "has"),
    [
        ("simulate", {"problem": SPHERE, **COARSE}, {"pull_off_force", WORK_DONE, DEPTH}),
        ("simulate", LENS | COARSE, {"pull_off_force_N", f"{WORK_DONE}_J", f"{DEPTH}_m"}),
        ("simulate", {"problem": PUNCH, **COARSE}, {"pull_off_stress", WORK_DONE, DEPTH}),
        ("predict", {"problem": SPHERE}, {"pull_off_force", WORK_DONE, DEPTH}),
        ("predict", LENS, {"pull_off_force_N", f"{WORK_DONE}_J", f"{DEPTH}_m"}),
        ("predict", {"problem": PUNCH}, {"pull_off_stress", WORK_DONE, DEPTH}),
        ("predict", PADS, {"pull_off_stress_Pa", f"{WORK_DONE}_J_per_m2", f"{DEPTH}_m"}),
        ("advise", {"problem": SPHERE}, {"pull_off_force"}),
        ("advise", LENS, {"pull_off_force", "pull_off_force_N", "crack_speed_at_pull_off_m_per_s"}),
        ("theory jkr", JKR, {"pull_off_force_N", f"{WORK_DONE}_J", f"{DEPTH}_m"}),
        ("theory maugis", {"tabor": 1.0}, {"pull_off_force", WORK_DONE, DEPTH}),
        ("theory crack-contact", CRACK, {"pull_off_force", WORK_DONE, DEPTH}),
        ("theory punch", {"case": "pad.toml"}, {"pull_off_stress_Pa", f"{DEPTH}_m"}),
        ("test read", {"files": ["lens.csv"]}, {"pull_off_force_N", f"{DEPTH}_m"}),
    ],
)
def test_records_have_the_words(word, given, has, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pad.toml").write_text((ROOT / "examples/from_toml/pad.toml").read_text())
    (tmp_path / "lens.csv").write_text((ROOT / "examples/from_rig/lens_30_um_s.csv").read_text())
    record = json.loads(json.dumps(ask(word, **given).record(), default=float))
    for key in ("problem", "error_estimate"):
        record.pop(key, None)
    assert has <= names_in(record)
    assert strange(names_in(record)) == []


def test_http_answers_in_the_same_words():
    http = Http()
    try:
        answer = http("/api/predict", json=LENS).json()
    finally:
        http.close()
    answer.pop("problem")
    assert {"pull_off_force_N", f"{WORK_DONE}_J", f"{DEPTH}_m"} <= answer.keys()
    assert strange(names_in(answer)) == []


@pytest.mark.parametrize(
    ("tables", "force"), [(FIRST, FORCE_OF_SPHERE), (PAD, FORCE_OF_PUNCH)], ids=["sphere", "punch"]
)
def test_the_page_is_told_in_the_same_words(tables, force):
    told = [quick(State(tables)), ask_verdict({"tables": tables}, lambda told: None, ())]
    for one in told:
        assert {number["name"] for number in one["numbers"]} == force | {WORK_DONE}
        assert strange(names_in(one)) == []
    assert force | {WORK_DONE} <= told[0]["axes"].keys()


def test_the_program_of_the_page_has_the_same_words():
    names = {name for file in PAGE.glob("*.js") for name in re.findall(r"\w+", file.read_text())}
    assert {"pull_off_force", "pull_off_stress", WORK_DONE} <= names
    assert strange(name for name in names if "_" in name) == []


@pytest.mark.parametrize(("problem", "force"), [(SPHERE, FORCE_OF_SPHERE), (PUNCH, FORCE_OF_PUNCH)])
def test_rows_of_campaigns_have_the_same_words(problem, force):
    posed = ask("simulate", problem=problem, **COARSE).found.problem
    row = measure(posed, CaseSettings(accuracy=0.02))
    assert force | {WORK_DONE, DEPTH} <= row.keys()
    assert strange(row) == []


def test_tables_have_the_same_words():
    columns = {column.name for kept in KEPT.values() for column in kept}
    columns |= {name for names in (*FORCE.values(), WORK) for name in names}
    assert {"pull_off_force", "pull_off_stress", WORK_DONE, DEPTH} <= columns
    assert strange(columns) == []
