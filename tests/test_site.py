"""The built site in a real browser: `make docs`, then `make test-outside`.

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
        page, sizes = context.new_page(), []
        page.on("response", lambda got, sizes=sizes: sizes.append(len(got.body())))
        page.goto(f"{link}docs/{name}.html")
        page.wait_for_load_state("networkidle")
        weight[name] = sum(sizes) / 1e6
        for found in Axe().run(page).response["violations"]:
            wrong.append((name, found["id"], [x["html"][:160] for x in found["nodes"]][:3]))
        if page.evaluate("document.documentElement.scrollWidth") > width:
            wrong.append((name, "wider than the window"))
        page.close()
    context.close()
    print(size, theme, {name: f"{size:.2f} MB" for name, size in weight.items()})
    assert [x for x in asked if not x.startswith((link, "data:", "blob:"))] == []
    assert wrong == []


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
