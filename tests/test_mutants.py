"""The mutants of `benchmarks/mutants.py`: which tests judge a module, and how a mutant is found."""

import sys
from dataclasses import asdict
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
sys.path.append(str(ROOT / "benchmarks"))

from judges import Judges  # noqa: E402
from mutants import NEAREST, ROOMS, Mutant, outcome  # noqa: E402


@pytest.fixture(scope="module")
def judges():
    return Judges(ROOT)


@pytest.mark.parametrize("room", ROOMS)
def test_every_module_of_a_judged_room_is_reached_by_tests(judges, room):
    modules = [path for path in sorted((ROOT / "src/viscotack" / room).rglob("*.py"))]
    assert modules, f"no room {room}: change ROOMS of benchmarks/mutants.py"
    # an __init__ only exports
    without = [path for path in modules if path.stem != "__init__" and not judges.of(path)]
    assert without == [], "no test file imports what leads to these modules"


@pytest.mark.parametrize(
    ("module", "test"),
    [
        ("theory/elastic/jkr.py", "ladder/test_elastic_theory.py"),
        ("bem/march.py", "test_solve.py"),
        ("problem/case_file.py", "test_case_file.py"),
        ("result/observables.py", "test_observables.py"),
    ],
)
def test_the_tests_of_a_module_are_among_its_judges(judges, module, test):
    nearest = judges.of(ROOT / "src/viscotack" / module)[:NEAREST]
    assert Path("tests", test) in nearest


def test_judges_follow_a_module_that_moves_behind_the_names_of_a_package(tmp_path):
    package = tmp_path / "src/viscotack"
    for room in ("old", "new"):
        (package / room).mkdir(parents=True)
        (package / room / "__init__.py").write_text("")
    (package / "__init__.py").write_text("from .old import f\nfrom .other import g\n")
    (package / "other.py").write_text("from viscotack.old import f\ndef g(): return f()\n")
    (package / "old/__init__.py").write_text("from .law import f\n")
    (package / "old/law.py").write_text("def f(): return 1\n")
    (tmp_path / "tests/ladder").mkdir(parents=True)
    (tmp_path / "tests/test_far.py").write_text("from viscotack import g\n")
    (tmp_path / "tests/ladder/test_near.py").write_text("import viscotack as v\nv.f()\n")
    (tmp_path / "tests/test_none.py").write_text("import viscotack\nimport numpy\n")
    expected = [Path("tests/ladder/test_near.py"), Path("tests/test_far.py")]
    assert Judges(tmp_path).of(package / "old/law.py") == expected
    (package / "old/law.py").rename(package / "new/law.py")
    (package / "old/__init__.py").write_text("from ..new.law import f\n")
    assert Judges(tmp_path).of(package / "new/law.py") == expected


SOURCE = """\
def f(x):
    return x + 1


class A:
    def g(self, x):
        y = x + 1
        if y:
            return x + 1
        return x + 1
"""


def test_a_mutant_is_found_in_its_function_after_its_module_has_moved_and_grown(tmp_path):
    lines = SOURCE.splitlines()
    lines[8] = "            return x - 1"
    mutant = Mutant.between("bem/law.py", "Add_Sub", SOURCE, "\n".join(lines) + "\n")
    assert (mutant.scope, mutant.before) == ("A.g", ("            return x + 1",))
    (tmp_path / "theory").mkdir()
    path = tmp_path / "theory/law.py"
    path.write_text("import numpy\n\n" + SOURCE)
    assert mutant.found(tmp_path) == (path, 10)
    assert mutant.applied(path.read_text(), 10) == "\n".join(["import numpy", "", *lines]) + "\n"
    assert Mutant.of(asdict(mutant) | {"verdict": "killed"}) == mutant
    path.write_text(SOURCE.replace("x + 1", "1 + x"))
    assert mutant.found(tmp_path) is None


def test_a_mutant_of_a_repeated_line_is_the_occurrence_it_was(tmp_path):
    twice = "def f(x):\n    x += 1\n    x += 1\n"
    mutant = Mutant.between("law.py", "N", twice, "def f(x):\n    x += 1\n    x += 2\n")
    (tmp_path / "law.py").write_text(twice)
    assert mutant.found(tmp_path) == (tmp_path / "law.py", 2)


def test_a_line_may_go_without_another_in_its_place():
    mutant = Mutant.between("law.py", "RemoveDecorator", "@cache\n" + SOURCE, SOURCE)
    assert (mutant.before, mutant.after) == (("@cache",), ())
    assert mutant.applied("@cache\n" + SOURCE, 0) == SOURCE


PASSED = "tests/test_a.py::test_b PASSED   [ 50%]\n"
FAILED = "tests/test_a.py::test_c[x - y] FAILED  [100%]\n"


@pytest.mark.parametrize(
    ("output", "code", "failed"),
    [
        (PASSED + "=== 1 passed in 0.1s ===", 0, ""),
        (PASSED + FAILED + "FAILED tests/test_a.py::test_c[x - y] - assert 1 == 2\n", 1, "[x - y]"),
        ("ERROR tests/test_a.py - ImportError\n", 2, "tests/test_a.py"),
        (PASSED + "tests/test_a.py::test_d[1-2] ", -27, "test_d[1-2]"),
    ],
    ids=["passed", "failed", "import", "hung"],
)
def test_a_run_names_the_test_that_failed_or_hung(output, code, failed):
    assert outcome(output, code)[0].endswith(failed)
    assert bool(outcome(output, code)[0]) == (code != 0)
