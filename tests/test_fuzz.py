"""The fuzzer: relations hold of a few cases, and a planted defect is found, shrunk and repeated."""

import json
import shlex
import signal
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from fuzz import __main__ as fuzz
from fuzz import answers
from fuzz.answers import by_simulation, differences
from fuzz.cases import Luck, contact, of_text
from fuzz.shrinking import shrunk
from viscotack import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    Dugdale,
    Groups,
    LennardJones,
    MoveTo,
    Retract,
    Sphere,
    StandardSolid,
)
from viscotack.result import Result

QUICK = ("passive", "split-material", "one-arm-material", "law", "case-file", "nesting")
SOLID = StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
CASE = Groups(tabor=0.5, material=SOLID, start=AtForce(0.0), rate=10.0)


@pytest.mark.parametrize("name", QUICK)
def test_relations_of_materials_laws_and_doors_hold(name, capsys):
    assert fuzz.main(["--seed", "3", "--checks", "4", "--only", name]) == 0
    assert "4 checks" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["si-scale", "split-retraction", "rest", "energy", "until"])
def test_relations_of_a_simulation_hold(name):
    assert fuzz.judge(fuzz.RELATIONS[name], CASE, draw=5) == []


def test_cases_are_those_of_their_seed_and_their_text():
    cases = [contact(Luck(4, number)) for number in range(20)]
    assert cases == [contact(Luck(4, number)) for number in range(20)]
    assert [of_text(repr(case)) for case in cases] == cases


def test_a_planted_defect_is_found_shrunk_logged_and_repeated(monkeypatch, tmp_path, capsys):
    right = StandardSolid.creep

    def wrong(self, time):
        return right(self, np.asarray(time) * (1.1 if self.glassy_modulus > 100 else 1.0))

    monkeypatch.setattr(StandardSolid, "creep", wrong)
    log = tmp_path / "log.jsonl"
    given = ["--seed", "1", "--checks", "20", "--only", "one-arm-material", "--log", str(log)]
    assert fuzz.main(given) == 1
    found = [json.loads(line) for line in log.read_text().splitlines()]
    findings, (end,) = [f for f in found if "command" in f], [f for f in found if "next" in f]
    assert end["next"] == 20 and findings and findings[0]["wrong"][0].startswith("creep apart by")
    modulus = of_text(shlex.split(findings[0]["command"])[-1]).glassy_modulus
    assert modulus > 100 and float(f"{modulus:.0e}") == modulus
    # the command stands alone: it repeats the finding, and holds where the defect is mended
    words = shlex.split(findings[0]["command"])[3:]
    assert fuzz.main(words) == 1
    monkeypatch.undo()
    assert fuzz.main(words) == 0
    # a log that is complete is not run again, and still says that something was found
    capsys.readouterr()
    assert fuzz.main(given) == 1
    assert "20 checks" in capsys.readouterr().out


def test_a_wrong_scale_of_a_series_is_found(monkeypatch):
    plain = fuzz.RELATIONS["stiff-spring"]
    assert fuzz.judge(plain, CASE, draw=0) == []
    checked = Result.__post_init__

    def scaled(self):
        if self.problem.groups().stiffness is not None:
            object.__setattr__(self, "contact_radius", 1.3 * np.asarray(self.contact_radius))
        checked(self)

    monkeypatch.setattr(Result, "__post_init__", scaled)
    assert any("contact_radius" in words for words in fuzz.judge(plain, CASE, draw=0))


def test_words_of_loops_are_compared_except_where_a_tolerance_decides_them():
    moves = (Approach(10.0, AtDepth(1.0)), Retract(10.0, AtDepth(0.0)))
    back = replace(CASE, rate=None, moves=moves)
    closed, opened = by_simulation(replace(back, start=AtDepth(0.0))), by_simulation(back)
    name = "cycle 1 loop"
    assert closed.words[name] <= {"closed", "closed in depth only"}
    assert opened.words[name] == {"open"}
    assert f"{name} closed in depth only and open" in differences(closed, opened)
    at_threshold = replace(
        closed,
        numbers=closed.numbers | {"cycle 1 hysteresis": None},
        words={name: frozenset({"open", "closed in depth only"})},
    )
    assert differences(closed, at_threshold) == []


def test_a_partner_that_takes_too_long_is_not_judged(monkeypatch):
    slow = replace(CASE, tabor=4.0)
    monkeypatch.setattr(answers, "TIME_LIMIT", 1e-6)
    with pytest.raises(answers.TooLong):
        answers._partner(slow)


@pytest.mark.skipif(not hasattr(signal, "SIGALRM"), reason="a system without an alarm")
def test_a_check_without_an_end_is_not_judged(monkeypatch):
    def endless(case, luck):
        while True:
            pass

    monkeypatch.setattr(fuzz, "_PATIENCE", 0.05)
    with pytest.raises(answers.TooLong, match="of a check"):
        fuzz.judge(replace(fuzz.RELATIONS["rest"], check=endless), CASE, draw=0)


def test_a_dent_gives_back_what_an_earlier_cycle_left_in_it():
    moves = (MoveTo(11.0, 0.154), MoveTo(12.8, 0.063), MoveTo(-2.1, 87.0))
    solid = replace(SOLID, glassy_modulus=90.0)
    case = Groups(tabor=2.0, material=solid, start=AtDepth(20.0), rate=40.0, moves=moves)
    assert by_simulation(case).numbers["cycle 2 hysteresis"] < 0
    assert fuzz.judge(fuzz.RELATIONS["hysteresis"], case, draw=0) == []


def test_a_contact_that_is_pushed_throughout_is_an_answer():
    pushed = replace(CASE, rate=None, start=AtForce(1.0), moves=(Approach(10.0, AtDepth(2.0)),))
    answer = by_simulation(pushed)
    assert float(np.min(answer.series["force"])) > 0 and differences(answer, answer) == []


def test_long_series_are_compared_in_bounded_memory():
    time = np.linspace(0, 1, 20_000)
    line = np.column_stack([time, time**2])
    tracemalloc.start()
    apart = answers._distance(line + [0.0, 0.1], line)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 20e6 and np.max(apart) == pytest.approx(0.1, rel=0.01)


def test_the_round_off_of_a_force_between_surfaces_apart_is_not_compared():
    law = Dugdale(1.0, 1.0, rise=0.29, fall=0.6)
    case = Groups(tabor=4.0, material=SOLID, start=Apart(36.6), rate=70.0, traction=law)
    assert fuzz.judge(fuzz.RELATIONS["stiff-spring"], case, draw=0) == []


def test_a_case_is_shrunk_to_what_makes_it_fail():
    case = next(
        case
        for case in (contact(Luck(9, number)) for number in range(99))
        if case.stiffness is not None and len(case.moves) > 1 and not case.in_plane_strain
    )
    small = shrunk(case, lambda simpler: simpler.stiffness is not None and simpler.tabor > 0.01)
    assert small.moves == () or small.rate is None
    assert small.traction == LennardJones(1.0, 1.0) and small.geometry == Sphere(1.0)
    assert small.start == AtForce(0.0) and not small.in_plane_strain
    assert float(f"{small.stiffness:.0e}") == small.stiffness
