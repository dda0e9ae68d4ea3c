"""Figures of the thesis: each says what it is, its numbers are kept, and they are what is made."""

import numpy as np
import pytest

pytest.importorskip("sklearn", reason="comes with viscotack[replication]")
pytest.importorskip("xgboost", reason="comes with viscotack[replication]")
pytest.importorskip("pyarrow", reason="comes with viscotack[campaign]")

import viscotack as vt  # noqa: E402
from research.replication import kept as keeping  # noqa: E402
from research.replication.bench import Hands  # noqa: E402
from research.replication.figures import figure_4_3, figure_5_2  # noqa: E402
from research.replication.figures.cases import Work, detached, punch, sphere  # noqa: E402
from research.replication.figures.catalogue import BESIDE, THEORY, THESIS, Figure, figures  # noqa: E402
from research.replication.kept import difference, kept, path_of  # noqa: E402
from research.replication.making import Maker, picture  # noqa: E402

ALL = THESIS + BESIDE
# Some of each kind: curves, markers, a table, models.
DRAWN = ("2.1", "3.6", "4.7", "table-5.1")
MOST = 2e6


@pytest.fixture(scope="module")
def maker():
    with Hands(1) as hands:
        yield Maker(hands, afresh=True)


@pytest.mark.parametrize("name", ALL)
def test_a_figure_says_what_it_shows_claims_needs_and_costs(name):
    words = Figure(name).words()
    assert all(head in words for head in ("Claims:", "Needs:", "Costs:"))
    assert "no numbers are kept" not in words


def test_no_figure_of_the_list_is_left_out():
    wanted = (
        "2.1 2.2a 2.2b 3.3 3.4 3.5 3.6 3.7 3.8 3.9 3.10 4.2 4.3 4.4 4.5 4.6 4.7 4.8 4.9 4.10 5.2 "
        "5.5 5.6 5.7 5.8 5.9 5.10 5.12 5.13 A.1 A.3 A.4 A.5 A.6 A.7 A.8 A.9 table-3.1 table-5.1 "
        "table-5.2 table-5.3 table-5.4 table-A.1"
    )
    assert set(wanted.split()) == set(THESIS)


def test_kept_numbers_are_all_used_and_small():
    files = {path for path in keeping.FOLDER.glob("*.json")}
    assert files == {path_of(name) for name in ALL}
    assert sum(path.stat().st_size for path in files) < MOST


@pytest.mark.parametrize("name", THEORY)
def test_theory_is_what_it_was(name, maker):
    """Regression: the kept numbers have five digits."""
    assert difference(kept(name), maker.of(name)) < 2e-4


def test_a_wrong_number_is_seen():
    numbers = kept("3.3")
    wrong = numbers | {"slow": numbers["slow"] * np.where(np.arange(161) == 7, 1.01, 1.0)}
    assert difference(numbers, wrong) == pytest.approx(0.01, rel=1e-3)
    assert difference(numbers, numbers | {"new": 1.0}) == np.inf
    assert difference(numbers, numbers | {"slow": numbers["slow"][1:]}) == np.inf


def test_simulations_are_what_they_were():
    """Regression, within what each states as its own error."""
    case = figure_4_3.PANELS["start"][1]
    one = figure_4_3.unloaded(case)
    then = kept("4.3")["start"]["curves"][1]
    assert one["pull_off_force"] == pytest.approx(then["pull_off_force"], rel=then["error"])
    work = figure_5_2.unloaded(figure_5_2.PANELS["saturation"][0])
    then = kept("5.2")["saturation"]["curves"][0]
    assert work["work"] == pytest.approx(then["work"], rel=then["work_error"])
    numbers = kept("3.8")
    i, j = 1, 15
    found = detached(Work(punch(numbers["thickness"][i], numbers["rate"][j])))
    assert found["force"] == pytest.approx(numbers["force"][i, j], rel=2e-3)


@pytest.mark.parametrize("name", DRAWN)
def test_a_figure_is_drawn_from_its_kept_numbers(name, tmp_path):
    path = picture(name, kept(name), tmp_path, dpi=50)
    assert path.read_bytes()[:4] == b"\x89PNG" and path.stat().st_size > 2000


def test_what_is_not_there_is_refused(tmp_path, monkeypatch):
    with pytest.raises(vt.InputError, match=r"no figure '3.2'; there are 2.1"):
        Figure("3.2")
    monkeypatch.setattr(keeping, "FOLDER", tmp_path)
    with pytest.raises(vt.InputError, match="figure 2.1 --afresh --keep"):
        kept("2.1")


def test_numbers_come_back_as_they_were_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(keeping, "FOLDER", tmp_path)
    numbers = {"a": np.array([1.0, np.nan]), "b": {"c": [np.eye(2), "word"]}, "d": True, "e": 3}
    keeping.keep("2.1", numbers, seconds=1.5)
    assert difference(kept("2.1"), keeping.rounded(numbers)) == 0
    assert keeping.cost("2.1") == 1.5
    assert np.isnan(kept("2.1")["a"][1]) and kept("2.1")["b"]["c"][1] == "word"


@pytest.mark.slow
def test_helping_hands_give_what_one_hand_gives():
    cases = [Work(sphere(10.0, 3.0), estimate=False), Work(sphere(100.0, 3.0), estimate=False)]
    with Hands(2) as hands:
        began = hands.seconds
        two = list(hands.each(detached, cases))
        assert hands.seconds - began > 0.02
    assert difference(two, [detached(case) for case in cases]) < 1e-9


def test_figures_in_order_have_no_doubles():
    names = [figure.name for figure in figures()]
    assert len(names) == len(set(names)) == len(ALL)


def test_a_stopped_run_resumes_as_long_as_the_sources_are_the_same(tmp_path, monkeypatch):
    with Hands(1) as hands:

        def made():
            return Maker(hands, afresh=True, progress=tmp_path).of("2.1")

        numbers = made()
        monkeypatch.setattr(Figure("2.1").module, "numbers", None)
        assert difference(made(), numbers) == 0
        (tmp_path / "sources.sha256").write_text("others")
        with pytest.raises(TypeError, match="not callable"):
            made()
