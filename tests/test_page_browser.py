"""The page in a real browser: what a newcomer does, and what it costs. docs/app.md has the figures.

Chromium without a window, `make test MARK=outside`; figures are printed with ``-s``.
"""

import time
from pathlib import Path

import pytest

from app_server import browsing, running, until

pytestmark = pytest.mark.outside

ROOT = Path(__file__).parents[1]
TABS = (
    *("contact", "material", "rig", "compare", "record", "design", "window", "array", "rough"),
    *("report", "operations"),
)
WIDE, NARROW = {"width": 1440, "height": 1000}, {"width": 390, "height": 844}
RIG = [ROOT / f"examples/from_rig/lens_{speed}_um_s.csv" for speed in (1, 30, 1000)]


@pytest.fixture(scope="module")
def server():
    with running() as (link, process):
        yield link, process


@pytest.fixture(scope="module")
def browser():
    with browsing() as found:
        yield found


@pytest.fixture
def page(browser, server):
    found = browser.new_page(viewport=WIDE)
    wrong = []
    found.on("pageerror", lambda error: wrong.append(str(error)))
    yield found
    found.close()
    assert wrong == []


def opened(page, link):
    page.goto(link)
    page.wait_for_selector("body[data-run=done]", timeout=60_000)
    return page


def at_rest(page):
    """Wait until what was changed has been simulated."""
    until(page, "viscotack.run.version === viscotack.version && viscotack.run.state === 'done'")


def test_a_newcomer_sees_a_finished_moving_example_without_a_click(page, server):
    began = time.perf_counter()
    opened(page, server[0])
    print(f"finished simulation {time.perf_counter() - began:.1f} s after the link, 0 clicks")
    legend = page.inner_text("#view-contact .legend >> nth=0")
    for what in ("simulation", "learned from", "theory", "infinitely slow"):
        assert what in legend
    assert "4.665 mN" in page.inner_text("#best")
    assert "4.668 mN" in page.inner_text(".numbers")
    places = set()
    for _ in range(5):
        places.add(page.input_value("[aria-label='Point along the simulated curve']"))
        page.wait_for_timeout(300)
    assert len(places) > 2


def test_a_dma_file_becomes_the_material_and_a_rig_file_stands_beside_the_forecast(page, server):
    opened(page, server[0])
    # one click chooses the file, one takes the material; what the file does not say becomes fields
    page.set_input_files("#material-file", ROOT / "examples/from_dma/pdms_dma.csv")
    for option, value in {"reference_temperature": "20", "glass_transition": "-115"}.items():
        until(page, f"document.activeElement.id === 'fit-{option}'")
        said = page.inner_text("#view-material p.refused")
        assert option.replace("_", " ") in said and "--" not in said and option not in said
        page.keyboard.type(f"{value} degC")
        page.keyboard.press("Tab")
    page.wait_for_selector("#use-material", timeout=60_000)
    assert "power-law: 4 constants on 32 numbers" in page.inner_text("#view-material pre")
    page.click("#use-material")
    at_rest(page)
    assert page.input_value("#material-exponent").startswith("0.2202")
    page.click("#tab-rig")
    page.set_input_files("#view-rig input[type=file]", RIG)
    page.wait_for_selector("#view-rig table tbody tr >> nth=2", timeout=60_000)
    legend = page.inner_text("#view-rig .legend >> nth=0")
    assert "lens_1000_um_s.csv" in legend and "simulation of the case" in legend


def test_a_number_that_is_impossible_is_refused_where_it_stands(page, server):
    opened(page, server[0])
    page.fill("#sphere-radius", "-5 mm")
    page.press("#sphere-radius", "Tab")
    page.wait_for_selector("#refused:not([hidden])")
    assert "radius must be positive, got -5 mm" in page.inner_text("#refused")
    assert page.get_attribute("#sphere-radius", "aria-invalid") == "true"
    assert page.inner_text("#sphere-radius-problem") == "radius must be positive, got -5 mm"
    assert page.get_attribute("#sphere-radius", "aria-describedby") == "sphere-radius-problem"
    page.fill("#sphere-radius", "5 mm")
    page.press("#sphere-radius", "Tab")
    page.wait_for_selector("#refused", state="hidden")
    assert page.locator(".problem").count() == 0
    # a group that is closed opens, and a move that cannot be read is marked where it stands
    page.click("summary:text('Test')")
    page.evaluate("viscotack.set('protocol', 'moves', ['approach fast'])")
    page.wait_for_selector(".problem:text('approach fast')")


def test_other_shapes_starts_and_alternatives_of_a_number_are_answered(page, server):
    opened(page, server[0])
    page.click("text=state the modulus ratio instead")
    page.select_option("#choice-material", "sls")
    at_rest(page)
    assert page.input_value("#material-modulus_ratio") == "0.1"
    page.select_option("#choice-shape", "punch")
    at_rest(page)
    page.select_option("#choice-start", "start")  # moves of a punch go to a stress, not to a force
    at_rest(page)
    page.select_option("#layer-base", "bonded")
    page.wait_for_selector(".problem:text('poisson_ratio of a bonded layer')")
    assert page.get_attribute("#material-poisson_ratio", "aria-invalid") == "true"


def test_a_case_that_is_not_simulated_shows_no_number_of_the_case_before(page, server):
    opened(page, server[0])
    page.uncheck("text=simulate when the numbers rest")
    page.select_option("#example", index=3)  # a cone, of which no theory answers
    page.wait_for_selector("#best .large:text('no answer')")
    assert "stale" not in page.get_attribute("#best", "class")


def test_reload_and_link_restore_the_state(page, browser, server):
    opened(page, server[0])
    page.select_option("#example", index=4)
    at_rest(page)
    page.fill("#layer-thickness", "80 um")
    page.press("#layer-thickness", "Tab")
    at_rest(page)
    page.click("#tab-compare")
    page.click("#keep-here")
    until(page, "location.search.includes('80+um')")  # a file and its link have what was typed
    stress = page.evaluate("viscotack.run.answer.summary.pull_off_stress_Pa")
    page.click("#tab-record")
    link = page.inner_text("#record-link")
    page.reload()
    other = browser.new_page(viewport=NARROW)
    other.goto(link)
    for each in (page, other):
        each.wait_for_selector("body[data-run=done]", timeout=60_000)
        assert each.input_value("#layer-thickness") == "80 µm"
        assert each.evaluate("viscotack.run.answer.summary.pull_off_stress_Pa") == stress
        until(each, "viscotack.kept.length === 1")
    assert page.get_attribute("#tab-record", "aria-selected") == "true"
    other.close()


@pytest.mark.parametrize("size", [WIDE, NARROW], ids=["wide", "narrow"])
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing_serious(browser, server, size, theme):
    try:
        from axe_playwright_python.sync_playwright import Axe
    except ImportError:
        pytest.fail("no accessibility checks: pip install viscotack[outside]")
    context = browser.new_context(viewport=size, color_scheme=theme)
    page = opened(context.new_page(), server[0])
    found = {}
    for tab in TABS:
        page.click(f"#tab-{tab}")
        if tab == "rig":
            page.set_input_files("#view-rig input[type=file]", RIG[:1])
            page.wait_for_selector("#view-rig table tbody tr", timeout=60_000)
        if tab == "compare":
            page.click("#keep-here")
        page.wait_for_timeout(300)
        page.evaluate("document.querySelectorAll('details').forEach((x) => { x.open = true; })")
        for one in Axe().run(page).response["violations"]:
            found.setdefault(one["impact"], []).append(
                (tab, one["id"], [node["html"][:120] for node in one["nodes"][:3]])
            )
    context.close()
    print({impact: len(rows) for impact, rows in found.items()}, found)
    assert found == {}
