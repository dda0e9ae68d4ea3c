"""Problems, predictions and results in a notebook have the numbers that the command line has."""

import base64
import re
import sys
from html import unescape
from types import SimpleNamespace

import pytest

import viscotack as vt
from synthetic import SI, jkr_result
from viscotack.app.operations.parts.solid import FIRST
from viscotack.model.problem.case_file import case_of_tables
from viscotack.units import readable

PROBLEM = case_of_tables(FIRST)


def rows(text):
    return [
        [unescape(cell) for cell in re.findall("<td>(.*?)</td>", row)]
        for row in re.findall("<tr>(<td>.*?)</tr>", text)
    ]


def picture(text):
    return base64.b64decode(re.search('src="data:image/svg[+]xml;base64,([^"]+)"', text)[1])


def test_a_prediction_is_shown_with_its_interval_its_tier_and_its_curve():
    found = vt.predict(PROBLEM)
    text, force = found._repr_html_(), PROBLEM.scales().force
    words, value, band = rows(text)[0]
    assert (words, value) == ("pull-off force", readable(found.pull_off_force * force, "N"))
    low, high = (float(x) * 1e-3 / force for x in band.removesuffix(" mN").split(" to "))
    # to one unit of the last digit that is shown
    assert (low, high) == pytest.approx(found.interval, abs=1e-7 / force)
    assert "<th>90 % of cases</th>" in text
    assert f"by the {found.method}: {found.why}" in unescape(text)
    assert picture(text).lstrip().startswith(b"<?xml")
    words, value, _ = rows(vt.predict(PROBLEM.groups())._repr_html_())[0]
    assert value == f"{found.pull_off_force:.4g} x 1.5 pi R dg0"
    assert value.partition(" ")[0] in repr(vt.predict(PROBLEM.groups()))
    assert readable(found.pull_off_force * force, "N") in repr(found)


def test_a_result_is_shown_short_and_its_series_as_a_frame(monkeypatch):
    result = jkr_result(problem=SI)
    assert len(repr(result)) < 200 and result.status in repr(result)
    assert picture(result._repr_html_()).lstrip().startswith(b"<?xml")
    table = SimpleNamespace(DataFrame=dict)
    monkeypatch.setitem(sys.modules, "pandas", table)
    assert result.to_frame()["force_N"] == pytest.approx(result.force * result.scales.force)
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(vt.NotInstalled):
        result.to_frame()
