"""The page without Python beside `viscotack.predict`: digits, refusals; `make test MARK=outside`.

Chromium without a window reads the page from a web server that has nothing but its files.
"""

import json
import re
from urllib.parse import urlencode

import numpy as np
import pytest

import viscotack as vt
from app_server import browsing, serving, until
from release import static_page
from viscotack.errors import InputError
from viscotack.forecast.tiers import AT_ONCE
from viscotack.problem.case_file import case_of_tables
from viscotack.surrogate.store import shipped

WIDE, NARROW = {"width": 1440, "height": 1000}, {"width": 390, "height": 844}
# Largest relative difference of a number; measured 5e-12.
DIGITS = 1e-6
# What a refusal of the package is about: a field, or a contact that is too large.
ABOUT = re.compile(r"small strain|too long for|\[(?:material|interface|sphere|protocol)\] \w+")


def test_its_example_is_a_case_that_the_surrogate_answers():
    found = vt.predict(case_of_tables(static_page.EXAMPLE), budget=AT_ONCE)
    assert found.inside and found.curve is not None
    fields = static_page.facts()["fields"]
    named = {table: {field["key"] for field in fields[table]} for table in fields}
    chosen = {"material": {"model"}, "interface": {"law"}}
    assert named == {t: set(keys) - chosen.get(t, set()) for t, keys in static_page.EXAMPLE.items()}


@pytest.mark.parametrize("name", ["predict.js", "index.html"])
def test_it_uses_only_what_is_copied(name):
    text = (static_page.HERE / name).read_text()
    used = {word for word in text.replace('"', " ").replace("./", " ").split() if "." in word}
    files = {word for word in used if word.endswith((".js", ".css", ".svg", ".mjs", ".onnx"))}
    made = {"facts.json", "tack.onnx", "predict.js", "ort.wasm.bundle.min.mjs"}
    assert files and files <= {*static_page.SHARED, *made}
    assert "http" not in text.replace("http-equiv", "")


@pytest.fixture(scope="module")
def link(tmp_path_factory):
    folder = tmp_path_factory.mktemp("static")
    static_page.write(folder)
    with serving(folder) as served:
        yield served


@pytest.fixture(scope="module")
def browser():
    with browsing() as found:
        yield found


@pytest.fixture(scope="module")
def page(browser, link):
    context = browser.new_context(viewport=WIDE)
    asked, wrong = [], []
    context.on("request", lambda request: asked.append(request.url))
    found = context.new_page()
    found.on("pageerror", lambda error: wrong.append(str(error)))
    found.on("console", lambda said: wrong.append(said.text) if said.type == "error" else None)
    opened(found, link)
    yield found
    assert [url for url in asked if not url.startswith((link, "data:", "blob:"))] == []
    assert len(asked) > 10 and wrong == []
    context.close()


def opened(page, link):
    page.goto(link)
    page.wait_for_selector("body[data-drawn]", timeout=120_000)
    return page


def answer(page, tables):
    """State a case; return its numbers, why there are none, and its refusal."""
    version = page.evaluate("(tables) => (viscotack.take(tables), viscotack.version)", tables)
    page.wait_for_selector(f"body[data-drawn='{version}']")
    return page.evaluate(
        "({ refused: viscotack.refused, ...(viscotack.refused ? {} : viscotack.found) })"
    )


def drawn(count, seed, beyond=0.0):
    """Draw groups even in their logarithms, some decades beyond the ranges if told."""
    low, high = np.log10(list(shipped().limits.values())).T
    return 10 ** np.random.default_rng(seed).uniform(low - beyond, high + beyond, (count, len(low)))


def stated(groups, random):
    """State groups in SI; radius, range and modulus are drawn, so that most strains are small."""
    tabor, ratio, exponent, preload, rate = groups
    modulus, nu, gap = (
        10 ** random.uniform(4, 7),
        random.uniform(0.2, 0.5),
        10 ** random.uniform(-8, -6),
    )
    radius = gap * 10 ** random.uniform(4, 6)
    work = np.sqrt(tabor**3 * (modulus / (1 - nu**2)) ** 2 * gap**3 / radius)
    tau = 10 ** random.uniform(-3, 0)
    return {
        "sphere": {"radius": f"{radius!r} m"},
        "protocol": {"preload_depth": f"{preload * gap!r} m", "speed": f"{rate * gap / tau!r} m/s"},
        "material": {
            "model": "power-law",
            "rubbery_modulus": f"{modulus!r} Pa",
            "glassy_modulus": f"{modulus / ratio!r} Pa",
            "exponent": float(exponent),
            "tau0": f"{tau!r} s",
            "poisson_ratio": nu,
        },
        "interface": {
            "law": "lennard-jones",
            "work_of_adhesion": f"{float(work)!r} J/m^2",
            "equilibrium_gap": f"{gap!r} m",
        },
    }


def cases():
    """Cases in range, out of range, doubtful in force, and doubtful in work alone."""
    surrogate, many = shipped(), drawn(20_000, seed=11)
    force, work = surrogate.doubtful(many, surrogate.evaluate(many)).T
    out = drawn(60, seed=12, beyond=0.5)
    rows = [
        *many[~force & ~work][:60],
        *many[force][:15],
        *many[work & ~force][:10],
        *out[~surrogate.inside(out).all(axis=1)][:30],
    ]
    random = np.random.default_rng(13)
    return [stated([float(x) for x in row], random) for row in rows]


@pytest.mark.outside
def test_it_answers_and_refuses_as_predict_does(page):
    counts, worst = {}, 0.0
    for tables in cases():
        told = answer(page, tables)
        try:
            problem = case_of_tables(tables)
        except InputError as error:
            kind = ABOUT.search(str(error))[0]
            assert kind in told["refused"]
            counts[kind] = counts.get(kind, 0) + 1
            continue
        assert told["refused"] == ""
        inside = shipped().inside([list(told["groups"].values())])[0]
        try:
            found = vt.predict(problem, budget=AT_ONCE)
        except vt.OutOfRange as error:
            found, reason = None, str(error)
        if found is None or not found.inside or found.method != "surrogate":
            assert told["numbers"] == [] and told.get("curve") is None
            kind = "out of range" if not inside.all() else "doubtful"
            names = [n for n, there in zip(shipped().limits, inside, strict=True) if not there]
            assert all(name.replace("_", " ") in told["why"] for name in names)
            assert (kind == "out of range") == told["why"].startswith("Outside the training range")
            assert kind == "out of range" or "not certain" in reason
            counts[kind] = counts.get(kind, 0) + 1
            continue
        scales, numbers = problem.scales(), {x["name"]: x for x in told["numbers"]}
        pairs = [
            (numbers["pull_off_force"]["value"], found.pull_off_force * scales.force),
            *zip(
                numbers["pull_off_force"]["interval"],
                (x * scales.force for x in found.interval),
                strict=True,
            ),
        ]
        kind = "force and work"
        if found.work_to_pull_off is None:
            kind = "force alone"
            assert "work_to_pull_off" not in numbers and told.get("curve") is None
            assert "No work and no curve" in told["why"]
        else:
            work, curve = numbers["work_to_pull_off"], told["curve"]
            pairs += [
                (work["value"], found.work_to_pull_off * scales.work),
                *zip(work["interval"], (x * scales.work for x in found.work_interval), strict=True),
                (curve["band"], found.curve_band * scales.force),
            ]
            for name, scale in (("depth", scales.length), ("force", scales.force)):
                expected = getattr(found.curve, name) * scale
                far = np.abs(np.array(curve[name]) - expected).max() / np.abs(expected).max()
                pairs.append((1 + far, 1.0))
            expected = found.curve.contact_radius * scales.radius
            np.testing.assert_allclose(curve["radius"], expected, rtol=DIGITS)
        worst = max(worst, *(abs(a / b - 1) for a, b in pairs))
        counts[kind] = counts.get(kind, 0) + 1
    print(counts, f"largest relative difference {worst:.1e}")
    assert worst < DIGITS
    assert counts["force and work"] >= 50
    assert min(counts[k] for k in ("out of range", "doubtful", "force alone")) >= 5


@pytest.mark.outside
@pytest.mark.parametrize(
    ("table", "key", "value", "words"),
    [
        ("sphere", "radius", "-5 mm", "must be positive, got '-5 mm'"),
        ("sphere", "radius", "5 kg", "must be a number with the unit m"),
        ("material", "poisson_ratio", "0.7", "must"),
        ("material", "glassy_modulus", "1 Pa", "must not be below rubbery_modulus"),
        ("interface", "equilibrium_gap", "10 mm", "too long for this sphere"),
        ("protocol", "preload_depth", "2 mm", "exceeds small strain"),
        ("protocol", "speed", "fast", "must be a number with the unit m/s"),
    ],
)
def test_it_refuses_at_the_field_what_the_package_refuses(page, table, key, value, words):
    tables = static_page.EXAMPLE | {table: static_page.EXAMPLE[table] | {key: value}}
    with pytest.raises(InputError):
        case_of_tables(tables | {"material": tables["material"]})
    assert words in answer(page, tables)["refused"]
    assert page.get_attribute(f"#{table}-{key}", "aria-invalid") == "true"
    assert words in page.inner_text(f"#{table}-{key}-problem")
    assert answer(page, static_page.EXAMPLE)["refused"] == ""
    assert page.locator(".problem").count() == 0


@pytest.mark.outside
def test_a_stranger_sees_the_answer_its_interval_and_its_curve(page):
    told = answer(page, static_page.EXAMPLE)
    said = page.inner_text("#best")
    assert "4.665 mN" in said and "in 90 % of cases" in said and "by the surrogate" in said
    assert "power laws by retardation" in page.inner_text("#content")
    until(page, "viscotack.found.speeds !== null")
    assert page.locator("#curve path[stroke-width='7']").count() == 1
    assert page.locator("#speeds path").count() > 10
    # the link has the case
    values = [(f"{t}.{k}", v) for t, keys in static_page.EXAMPLE.items() for k, v in keys.items()]
    assert page.url.endswith(f"?{urlencode(values)}")
    page.fill("#protocol-speed", "1 mm/s")
    page.press("#protocol-speed", "Tab")
    until(page, "viscotack.tables.protocol.speed === '1 mm/s' && viscotack.best")
    faster = page.evaluate("viscotack.best[0].value")
    assert faster > 1.2 * told["numbers"][0]["value"]
    opened(page, page.url)
    assert page.evaluate("viscotack.best[0].value") == faster
    case = page.evaluate("viscotack.toml")
    assert 'speed = "1 mm/s"' in case and "exponent = 0.2207" in case


@pytest.mark.outside
@pytest.mark.parametrize("size", [WIDE, NARROW], ids=["wide", "narrow"])
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing(browser, link, size, theme):
    from axe_playwright_python.sync_playwright import Axe

    context = browser.new_context(viewport=size, color_scheme=theme)
    found = opened(context.new_page(), link)
    assert found.evaluate("document.documentElement.dataset.theme") == theme
    violations = Axe().run(found).response["violations"]
    assert json.dumps([x["id"] for x in violations]) == "[]"
    assert found.evaluate("document.documentElement.scrollWidth") == size["width"]
    context.close()
