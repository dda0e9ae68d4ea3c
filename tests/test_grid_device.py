"""The grid with its fields in another library of arrays, as on a GPU."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy import fft

import viscotack as vt
from test_rough_checkpoint import problem as rough
from viscotack.simulate.grid import plane, run
from viscotack.simulate.rough import pull, pulling


class OnDevice(np.lib.mixins.NDArrayOperatorsMixin):
    """An array that, like one of CuPy, does not become one of NumPy and does not meet one."""

    def __init__(self, held):
        self.held = np.asarray(held)

    def __array__(self, *_, **__):
        raise TypeError("implicit copy to the host")

    def __array_ufunc__(self, ufunc, method, *inputs, out=(), **options):
        if out:
            options["out"] = tuple(map(bare, out))
        found = getattr(ufunc, method)(*map(bare, inputs), **options)
        return out[0] if out else OnDevice(found)

    def __array_function__(self, function, types, arguments, options):
        if function is np.asarray:
            return OnDevice(arguments[0])
        found = function(*bare(arguments), **{k: bare(x) for k, x in options.items()})
        return OnDevice(found)

    def __getattr__(self, name):
        found = getattr(self.held, name)
        if not callable(found):
            return OnDevice(found) if isinstance(found, np.ndarray) else found
        return lambda *given, **options: OnDevice(found(*bare(given), **options))

    def __getitem__(self, key):
        return OnDevice(self.held[bare(key)])

    def __setitem__(self, key, value):
        self.held[bare(key)] = bare(value)

    def __len__(self):
        return len(self.held)

    def __float__(self):
        return float(self.held)

    def __int__(self):
        return int(self.held)

    def __index__(self):
        return int(self.held)

    def __bool__(self):
        return bool(self.held)

    def get(self):
        return self.held


def bare(value):
    """Return what is on the device; an array of the host may not be there."""
    if isinstance(value, OnDevice):
        return value.held
    if isinstance(value, np.ndarray):
        raise TypeError("an array of the host meets one of the device")
    return type(value)(map(bare, value)) if isinstance(value, list | tuple) else value


@pytest.fixture
def device(monkeypatch):
    """Put the double in place of CuPy."""
    library = SimpleNamespace(
        asarray=OnDevice,
        zeros=lambda shape, kind: OnDevice(np.zeros(shape, kind)),
        cuda=SimpleNamespace(runtime=SimpleNamespace(memGetInfo=lambda: (0, 10**12))),
    )
    transforms = SimpleNamespace(
        rfft2=lambda x: OnDevice(fft.rfft2(x.held)),
        irfft2=lambda x, s, overwrite_x: OnDevice(fft.irfft2(x.held, s=s)),
    )
    monkeypatch.setattr(plane, "libraries", lambda device: (library, transforms))
    # a start is refined from larger pixels
    monkeypatch.setattr(run, "_COARSEST", 8)


def problem(periodic, start, body):
    return rough(16, 1.5e-6, apart=start, body=body, periodic=periodic)


@pytest.mark.parametrize(
    ("periodic", "start", "body"),
    [
        (True, True, vt.HalfSpace()),
        (False, False, vt.HalfSpace()),
        (True, False, vt.Layer(thickness=4e-5, base=vt.Frictionless())),
    ],
)
def test_a_device_gives_the_same_digits(tmp_path, device, periodic, start, body):
    stated = problem(periodic, start, body)
    how = {"maps": 3, "accuracy": 0.02}
    there = pull(stated, device="cuda", checkpoint=tmp_path / "run.npz", every=0.0, **how)
    again = pull(stated, device="cuda", checkpoint=tmp_path / "run.npz", **how)
    plane.libraries = lambda device: (np, fft)
    here = pull(problem(periodic, start, body), **how)
    assert there.rows() == here.rows() == again.rows()
    assert there.summary == here.summary
    assert np.array_equal(there.strongest.pressure, here.strongest.pressure)


def test_without_cupy_a_device_is_refused():
    with pytest.raises(vt.InputError) as refused:
        pull(problem(True, False, vt.HalfSpace()), device="cuda")
    assert refused.value.field == "device"


def test_a_map_that_memory_does_not_hold_is_refused(monkeypatch):
    monkeypatch.setattr(pulling, "memory", lambda device: 16 * 16 * 425.0)
    stated = problem(True, False, vt.HalfSpace())
    pulling.check_memory(stated.contact.plane, 1)
    with pytest.raises(vt.InputError):
        pulling.check_memory(stated.contact.plane, 2)
