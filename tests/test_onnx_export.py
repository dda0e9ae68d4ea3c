"""The exported surrogate gives the same digits as NumPy, whoever runs it."""

from dataclasses import replace

import numpy as np
import pytest

onnx = pytest.importorskip("onnx", reason="comes with viscotack[onnx]")
runtime = pytest.importorskip("onnxruntime", reason="comes with viscotack[dev]")

from viscotack.surrogate import line, physics  # noqa: E402
from viscotack.surrogate.model import Surrogate  # noqa: E402
from viscotack.surrogate.network import Networks  # noqa: E402
from viscotack.surrogate.onnx import export  # noqa: E402
from viscotack.surrogate.onnx.graph import Graph  # noqa: E402
from viscotack.surrogate.store import SHIPPED, shipped  # noqa: E402
from viscotack.surrogate.trust import CONFIDENCES, OF, Trust  # noqa: E402
from viscotack.surrogate.trust import INPUTS as TOLD  # noqa: E402

LOW, HIGH = np.array(list(physics.LIMITS.values())).T
# Measured: 1e-13 at worst, of curves beyond the ranges.
DIGITS = 1e-12


def networks(random, members, *sizes, centre=None, spread=None):
    layers = list(zip(sizes[:-1], sizes[1:], strict=True))
    return Networks(
        tuple(random.normal(size=(members, a, b)) / np.sqrt(a) for a, b in layers),
        tuple(random.normal(size=(members, 1, b)) / 3 for _, b in layers),
        centre,
        spread,
    )


@pytest.fixture(scope="module")
def surrogate():
    """Return one that has learned nothing: its numbers reach every branch, and mean none."""
    random = np.random.default_rng(7)
    shapes = networks(random, 1, 10, 12, line.OUTPUTS)
    centre, spread = random.uniform(0.0, 1.0, line.OUTPUTS), np.full(line.OUTPUTS, 0.5)
    return Surrogate(
        physics.SphereContact,
        {
            "start": networks(
                random, 2, 2, 8, 2, centre=np.array([0.0, 0.1]), spread=np.array([2.0, 0.3])
            ),
            "fast": networks(random, 3, 3, 8, 1),
            "force": networks(random, 3, 5, 12, 12, 1),
            "work": networks(random, 2, 9, 12, 1, centre=np.array([0.3]), spread=np.array([0.5])),
            "give": networks(random, 2, 10, 12, 1, centre=np.array([0.1]), spread=np.array([0.3])),
            "line": replace(shapes, centre=centre, spread=spread),
            "second": networks(random, 1, 7, 6, 2),
        },
        Trust(
            networks(random, 2, TOLD, 6, len(OF)),
            0.01 * random.uniform(1, 3, (len(OF), len(CONFIDENCES))),
            np.ones(len(CONFIDENCES)),
        ),
    )


def session(surrogate, folder):
    export(surrogate, folder / "tack.onnx")
    return runtime.InferenceSession(folder / "tack.onnx", providers=["CPUExecutionProvider"])


@pytest.fixture(scope="module")
def exported(surrogate, tmp_path_factory):
    return session(surrogate, tmp_path_factory.mktemp("onnx"))


def drawn(count, beyond=0.0, seed=1):
    """Return rows at random, even in the logarithm, decades beyond the ranges if told."""
    low, high = np.log10(LOW) - beyond, np.log10(HIGH) + beyond
    return 10 ** np.random.default_rng(seed).uniform(low, high, (count, 5))


def assert_same_digits(exported, surrogate, groups):
    """Compare all outputs; curves relative to the largest number of their row."""
    names = [output.name for output in exported.get_outputs()]
    found = dict(zip(names, exported.run(None, {"groups": groups}), strict=True))
    answers = surrogate.evaluate(groups)
    intervals = surrogate.intervals(groups, answers, confidence=0.9)
    curves = surrogate.curves(groups, answers)
    wanted = {
        "pull_off_force": answers.pull_off_force,
        "work_to_pull_off": answers.work_to_pull_off,
        "force_interval": intervals.pull_off_force,
        "work_interval": intervals.work_to_pull_off,
        "inside": surrogate.inside(groups),
        "doubtful": surrogate.doubtful(groups, answers),
        "force_slopes": surrogate.slopes(groups)[0],
        "work_slopes": surrogate.slopes(groups)[1],
        "curve_depth": curves.depth,
        "curve_force": curves.force,
        "curve_contact_radius": curves.contact_radius,
        "curve_band": intervals.curve,
        "travel_interval": intervals.travel,
    }
    assert names == list(wanted)
    for name, value in wanted.items():
        assert found[name].shape == value.shape and found[name].dtype == value.dtype, name
        if name in ("inside", "doubtful"):
            np.testing.assert_array_equal(found[name], value)
            continue
        assert np.isfinite(value).all()
        size = np.abs(value) if value.ndim == 1 else np.abs(value).max(axis=1, keepdims=True)
        # widths are told by small differences of networks, and by parts of ways of 1e-4
        width = name.endswith(("_band", "_interval"))
        limit = 1e-8 if width else DIGITS
        assert np.max(np.abs(found[name] - value) / size) < limit, name


def test_same_digits_as_numpy_over_the_ranges(exported, surrogate):
    groups = drawn(3000)
    starts = surrogate.tests(groups).start[0]
    # pressed starts and starts in tension, whose curves differ
    assert 0.02 < np.mean(starts > 0) < 0.98
    assert_same_digits(exported, surrogate, groups)


def test_same_digits_at_the_ends_of_the_ranges(exported, surrogate):
    corners = np.array(np.meshgrid(*zip(LOW, HIGH, strict=True))).reshape(5, -1).T
    assert corners.shape == (32, 5)
    assert surrogate.inside(corners).all()
    assert_same_digits(exported, surrogate, corners)


def test_same_digits_outside_where_the_elastic_limit_has_other_branches(exported, surrogate):
    groups = drawn(2000, beyond=1.5, seed=2)
    tabor = groups[:, physics.TABOR]
    glassy = tabor * np.cbrt(groups[:, physics.MODULUS_RATIO])
    for numbers in (tabor, glassy):
        assert np.any(numbers < 0.01) and np.any(numbers > 10)
    inside = surrogate.inside(groups)
    assert inside.any(axis=0).all() and not inside.all(axis=0).any()
    assert_same_digits(exported, surrogate, groups)


def test_what_onnx_cannot_express_is_refused(surrogate):
    graph = Graph()
    x = graph.input("x", np.ones((1, 3)))
    with pytest.raises(TypeError, match=r"np\.sinh .* no ONNX counterpart"):
        np.sinh(x)
    with pytest.raises(TypeError, match=r"np\.cumsum has no ONNX counterpart"):
        np.cumsum(x)
    with pytest.raises(TypeError, match=r"np\.add \(accumulate\) has no ONNX counterpart"):
        np.add.accumulate(x, axis=1)


@pytest.mark.skipif(not SHIPPED.exists(), reason="the package comes without a surrogate yet")
def test_the_surrogate_of_the_package_has_the_same_digits_in_a_small_file(tmp_path):
    surrogate = shipped()
    exported = session(surrogate, tmp_path)
    assert (tmp_path / "tack.onnx").stat().st_size < 5e6
    assert_same_digits(exported, surrogate, drawn(1000))
    assert_same_digits(exported, surrogate, drawn(500, beyond=0.5))
