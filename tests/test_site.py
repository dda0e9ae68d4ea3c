"""The built site in a real browser: `make docs`, then `make test MARK=outside`.

Figures are printed with ``-s``.
"""

from pathlib import Path

import pytest

from app_server import browsing, serving

pytestmark = pytest.mark.outside

SITE = Path(__file__).parents[1] / "out/site"
PAGES = (
    *("index", "first_hour", "choose", "predict", "elsewhere", "verification", "glossary"),
    *("operations", "theory", "examples/index", "examples/dead_load", "reference/theory"),
    "reference/made/viscotack.theory.elastic.maugis.curve",
)
# Of a page with all that it loads, without compression [MB].
MOST = 0.95
SIZES = {"wide": (1440, 1000), "narrow": (390, 844)}


@pytest.fixture(scope="module")
def link():
    if not (SITE / "docs/index.html").exists():
        pytest.fail("there is no site: make docs")
    with serving(SITE) as served:
        yield served


@pytest.fixture(scope="module")
def browser():
    with browsing() as found:
        yield found


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("size", SIZES)
def test_axe_finds_nothing_and_nothing_comes_from_elsewhere(browser, link, size, theme):
    from axe_playwright_python.sync_playwright import Axe

    width, height = SIZES[size]
    context = browser.new_context(viewport={"width": width, "height": height}, color_scheme=theme)
    asked, wrong, weight = [], [], {}
    context.on("request", lambda request: asked.append(request.url))
    for name in PAGES:
        page, answers = context.new_page(), []
        page.on("response", lambda got, answers=answers: answers.append(got))
        page.goto(f"{link}docs/{name}.html")
        page.wait_for_load_state("networkidle")
        weight[name] = sum(len(got.body()) for got in answers if got.ok) / 1e6
        wrong += [(name, got.url, got.status) for got in answers if not got.ok]
        for found in Axe().run(page).response["violations"]:
            wrong.append((name, found["id"], [x["html"][:160] for x in found["nodes"]][:3]))
        if page.locator("meta[name=description]").count() != 1:
            wrong.append((name, "no description"))
        if page.evaluate("document.documentElement.scrollWidth") > width:
            wrong.append((name, "wider than the window"))
        page.close()
    context.close()
    print(size, theme, {name: f"{size:.2f} MB" for name, size in weight.items()})
    assert [x for x in asked if not x.startswith((link, "data:", "blob:"))] == []
    assert wrong == []
    # sent as it is; servers that compress send a third. With the index of the search it was 1.3 MB.
    assert weight["index"] < MOST and weight["first_hour"] < MOST


def test_the_search_finds_a_page(browser, link):
    page = browser.new_page()
    page.goto(f"{link}search.html?q=tabor+number")
    page.wait_for_selector("#search-results li a")
    page.wait_for_function("document.querySelectorAll('#search-results li').length > 5")
    links = page.eval_on_selector_all("#search-results li a", "all => all.map(x => x.href)")
    assert any("docs/" in each for each in links)
    page.click("#search-results li a >> nth=0")
    page.wait_for_selector("h1")
    page.close()
