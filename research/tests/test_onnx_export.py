"""The exported surrogate gives the same digits as NumPy, whoever runs it."""

import numpy as np
import pytest

pytest.importorskip("onnx", reason="pip install onnx")
runtime = pytest.importorskip("onnxruntime", reason="pip install onnxruntime")

from research.onnx_export.file import export, outputs  # noqa: E402
from viscotack.prediction.surrogate import physics  # noqa: E402
from viscotack.prediction.surrogate.store import shipped  # noqa: E402

LOW, HIGH = np.array(list(physics.LIMITS.values())).T
# Measured: 1e-13 at worst, of curves beyond the ranges.
DIGITS = 1e-12


def session(surrogate, folder):
    export(surrogate, folder / "tack.onnx")
    return runtime.InferenceSession(folder / "tack.onnx", providers=["CPUExecutionProvider"])


def drawn(count, beyond=0.0, seed=1):
    """Return rows at random, even in the logarithm, decades beyond the ranges if told."""
    low, high = np.log10(LOW) - beyond, np.log10(HIGH) + beyond
    return 10 ** np.random.default_rng(seed).uniform(low, high, (count, 5))


def assert_same_digits(exported, surrogate, groups):
    """Compare all outputs; curves relative to the largest number of their row."""
    names = [output.name for output in exported.get_outputs()]
    found = dict(zip(names, exported.run(None, {"groups": groups}), strict=True))
    wanted = outputs(surrogate, groups)
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
        # slopes are differences, which magnify rounding
        limit = 1e-8 if width or name.endswith("_slopes") else DIGITS
        assert np.max(np.abs(found[name] - value) / size) < limit, name


def test_same_digits_inside_the_ranges_at_their_ends_and_beyond(tmp_path):
    surrogate = shipped()
    exported = session(surrogate, tmp_path)
    assert (tmp_path / "tack.onnx").stat().st_size < 5e6
    corners = np.array(np.meshgrid(*zip(LOW, HIGH, strict=True))).reshape(5, -1).T
    # pressed starts and starts in tension, whose curves differ
    assert 0.02 < np.mean(surrogate.tests(drawn(1000)).start[0] > 0) < 0.98
    for groups in (drawn(1000), corners, drawn(500, beyond=0.5)):
        assert_same_digits(exported, surrogate, groups)
