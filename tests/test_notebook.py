"""Problems, predictions and results in a notebook have the numbers that the command line has."""

import base64
import re
from html import unescape
from types import SimpleNamespace

import pytest

import viscotack as vt
from viscotack.app.notebook import load_ipython_extension
from viscotack.operations.parts.examples import FIRST
from viscotack.problem.case_file import case_of_tables
from viscotack.units import readable

PROBLEM = case_of_tables(FIRST)


@pytest.fixture
def shown():
    """Return what a shell of IPython shows; it asks the formatter of the type."""
    known = {}
    html = SimpleNamespace(for_type=known.__setitem__)
    load_ipython_extension(
        SimpleNamespace(display_formatter=SimpleNamespace(formatters={"text/html": html}))
    )
    return lambda thing: known[type(thing)](thing)


def rows(text):
    return [
        [unescape(cell) for cell in re.findall("<td>(.*?)</td>", row)]
        for row in re.findall("<tr>(<td>.*?)</tr>", text)
    ]


def picture(text):
    return base64.b64decode(re.search('src="data:image/svg[+]xml;base64,([^"]+)"', text)[1])


def test_a_prediction_is_shown_with_its_interval_its_tier_and_its_curve(shown):
    found = vt.predict(PROBLEM)
    text, force = shown(found), PROBLEM.scales().force
    words, value, band = rows(text)[0]
    assert (words, value) == ("pull-off force", readable(found.pull_off_force * force, "N"))
    low, high = (float(x) * 1e-3 / force for x in band.removesuffix(" mN").split(" to "))
    # to one unit of the last digit that is shown
    assert (low, high) == pytest.approx(found.interval, abs=1e-7 / force)
    assert "<th>90 % of cases</th>" in text
    assert f"by the {found.method}: {found.why}" in unescape(text)
    assert picture(text).lstrip().startswith(b"<?xml")
    words, value, _ = rows(shown(vt.predict(PROBLEM.groups())))[0]
    assert value == f"{found.pull_off_force:.4g} x 1.5 pi R dg0"
