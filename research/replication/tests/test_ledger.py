"""The ledger: every claim is measured, and the page says what was measured."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("sklearn", reason="comes with viscotack[replication]")
pytest.importorskip("xgboost", reason="comes with viscotack[replication]")
pytest.importorskip("pyarrow", reason="comes with viscotack[campaign]")

from typer.testing import CliRunner  # noqa: E402

import viscotack as vt  # noqa: E402
from research.replication.__main__ import app  # noqa: E402
from research.replication.figures.catalogue import THESIS  # noqa: E402
from research.replication.gallery import GALLERY, PICTURES, SEEN, text  # noqa: E402
from research.replication.kept import kept  # noqa: E402
from research.replication.ledger.claim import Measured, Standing, Verdict  # noqa: E402
from research.replication.ledger.contents import every, named  # noqa: E402
from research.replication.ledger.page import PAGE, page  # noqa: E402
from viscotack.theory import jkr, persson_brener  # noqa: E402

FEWEST, LARGEST_PICTURE = 60, 60e3
CLAIMS = every()


@pytest.fixture(scope="module")
def measured():
    """Return the page as it is measured now: theory afresh, simulations as they are kept."""
    return page(kept)


def test_the_page_is_what_is_measured(measured):
    assert PAGE.read_text(encoding="utf-8") == measured


def test_a_wrong_number_in_the_ledger_is_seen(measured):
    written = PAGE.read_text(encoding="utf-8")
    for number, wrong in (("88.9 ± 0.5 %", "78.9 ± 0.5 %"), ("4.5037 printed", "4.5073 printed")):
        assert number in written
        assert written.replace(number, wrong) != measured


def test_a_verdict_falls_with_the_number_it_rests_on():
    """A third of the simulated works, and Eq. 43 would be a bound at all rates."""

    def less(name):
        numbers = kept(name)
        return numbers | {"simulated": numbers["simulated"] / 3} if name == "A.7" else numbers

    assert named("upper-bound-between").measured(kept).value > 2
    with pytest.raises(vt.InputError, match="upper-bound-between.*'holds' stands between"):
        named("upper-bound-between").measured(less)
    with pytest.raises(vt.InputError, match="jkr-work: measured 0.80182"):
        replace(named("jkr-work"), stands=(1.8, 1.9)).measured(kept)
    with pytest.raises(vt.InputError, match="measured nan"):
        replace(named("b1"), measure=lambda of: Measured(np.nan)).measured(kept)


def test_claims_are_many_and_each_says_how_it_is_remeasured():
    assert len(CLAIMS) >= FEWEST
    assert len({claim.name for claim in CLAIMS}) == len(CLAIMS)
    assert {claim.verdict for claim in CLAIMS} == set(Verdict)
    # an equation, a simulation, something unpublished, and a wrong statement
    standings = {x: named(x).judged(kept)[1] for x in ("tabor", "alpha", "arms", "tabor-of-pdms")}
    assert list(standings.values()) == list(Standing)
    written = PAGE.read_text(encoding="utf-8")
    for claim in CLAIMS:
        assert f"`claim {claim.name}` |" in written
        # a verdict that any number would bear could not fall
        assert np.all(np.isfinite(claim.stands)) and claim.stands[0] <= claim.stands[1]


def test_an_unknown_claim_is_refused():
    with pytest.raises(vt.InputError, match="no claim 'alfa'; there are tabor"):
        named("alfa")


def test_the_bound_on_the_work_is_that_of_jkr_with_the_largest_energy():
    """Identity: the work of JKR goes as its energy to 5/3."""
    unit = {"radius": 1.0, "contact_modulus": 1.0}
    plain, gained = (float(jkr.work_to_instability(work_of_adhesion=w, **unit)) for w in (1, 10))
    assert gained / plain == pytest.approx(10 ** (5 / 3), rel=1e-12)
    assert plain / (1.5 * np.pi ** (5 / 3)) == pytest.approx(1.156939, rel=1e-6)
    assert kept("work-bound")["unit"] == pytest.approx(1.156939, rel=1e-4)


def test_the_slow_coefficient_is_that_of_the_theory():
    """Limit: a tiny modulus ratio, at which the fit of the thesis is right."""
    solid = vt.RetardationPowerLaw(
        rubbery_modulus=1.0, glassy_modulus=1e6, exponent=0.6, tau0=1.0, poisson_ratio=0.0
    )
    gain = float(persson_brener.amplification(1e-6, material=solid)) - 1
    assert gain / 1e-6 == pytest.approx(np.pi * 0.6, rel=1e-3)
    assert gain / 1e-6 == pytest.approx(-0.0125 + 3.136 * 0.6, rel=0.01)
    assert named("slow-coefficient").measured(kept).value == pytest.approx(10.6, abs=0.2)


def test_the_gallery_has_a_picture_and_a_paragraph_of_each_figure():
    assert GALLERY.read_text(encoding="utf-8") == text()
    assert set(THESIS) <= set(SEEN)
    pictures = list(PICTURES.glob("*.png"))
    assert {path.name for path in pictures} == {f"{n.replace('.', '_')}.png" for n in SEEN}
    assert all(path.stat().st_size < LARGEST_PICTURE for path in pictures)


def asked(*words):
    """Return exit status and output of ``python -m research.replication``."""
    answer = CliRunner().invoke(app, [*map(str, words)])
    return answer.exit_code, answer.output


def test_a_figure_made_afresh_says_how_far_it_is_from_the_kept_one(tmp_path):
    code, said = asked("figure", "2.1", "--afresh", "--workers", 1, "--svg", "--out", tmp_path)
    assert code == 0 and (tmp_path / "2_1.svg").exists()
    assert "Claims: adhesion makes the contact larger" in said
    assert "they differ by 0.0e+00 at most" in said


def test_what_is_taken_as_it_is_kept_though_asked_for_afresh_is_said():
    code, said = asked("claim", "random-rows", "--afresh", "--workers", 1)
    assert code == 0 and "published-rows needs the authors' archive (--archive)" in said


def test_commands_refuse_in_words():
    for words in (("figure", "9.9"), ("claim", "alfa")):
        code, said = asked(*words)
        assert code == 2 and "there are" in said


def test_a_claim_is_measured_by_its_command(measured):
    code, said = asked("claim", "upper-bound-between")
    assert code == 0 and "holds" in said and "88.9 ± 0.5 %" in said
    code, said = asked("ledger")
    assert code == 0 and said.strip() == measured.strip()


@pytest.mark.slow
def test_everything_is_drawn_and_measured_from_kept_numbers(tmp_path):
    code, said = asked("--all", "--workers", 1, "--out", tmp_path)
    assert code == 0 and "every verdict stands" in said
    drawn = {path.stem: path.stat().st_size for path in tmp_path.glob("*.png")}
    assert set(drawn) == {n.replace(".", "_") for n in SEEN} and min(drawn.values()) > 2000
