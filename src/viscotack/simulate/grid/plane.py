r"""Elastic response of a body on a rectangular grid of pixels, by fast Fourier transforms.

The traction is constant on each pixel. A periodic body with the transfer function
:math:`\hat G(q)` moves by :math:`\hat u = \hat G \hat p`; of the half-space with E* = 1 it is
:math:`2/q`, and a uniform pressure moves only the reference, so the mean displacement is zero. A
surface without neighbours lies in a domain twice as wide in both directions. There the half-space
has the compliance of pressed squares (Love, 1929) up to the width of the surface, and a layer its
transfer function, because a load on it is not felt far away. Outside the surface no tractions act.

Fields are arrays of NumPy, or of CuPy on a GPU: NumPy's functions accept both.

Tractions that vary over a pixel move its centre less than their mean does. The factor
:math:`\exp(q^2 \Delta x^2/48)` on :math:`\hat G` corrects most of this error in free space.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from scipy import fft

from viscotack.errors import InputError
from viscotack.model.geometry import Body, HalfSpace, Layer

Device = Literal["cpu", "cuda"]
# Without types, which SciPy states for several libraries of arrays.
_fft: Any = fft

# Correction of tractions that vary over a pixel, fitted to spheres of revolution.
_WITHIN_PIXEL = 48.0


@dataclass(frozen=True, eq=False)
class Plane:
    """The surface of a body, in any unit of length, with displacements for E* = 1.

    Parameters
    ----------
    shape : tuple of int
        Rows and columns of pixels.
    pixel : float
        Side of a pixel, a square.
    body : HalfSpace or Layer
        The body below, in the same unit.
    periodic : bool
        Whether the surface repeats in both directions.
    device : "cpu" or "cuda"
        Where its fields are.
    """

    shape: tuple[int, int]
    pixel: float
    body: Body = HalfSpace()
    periodic: bool = False
    device: Device = "cpu"

    @cached_property
    def library(self) -> tuple[Any, Any]:
        """Library of the arrays, and its Fourier transforms."""
        return libraries(self.device)

    def field(self, values: Any) -> Any:
        """Return values as a field on the device."""
        return self.library[0].asarray(values)

    def zeros(self, kind: Any = float) -> Any:
        """Return a field of the domain that is zero."""
        return self.library[0].zeros(self.domain, kind)

    @cached_property
    def domain(self) -> tuple[int, int]:
        """Rows and columns of the domain of the transforms."""
        if self.periodic:
            return self.shape
        rows, columns = (_fft.next_fast_len(2 * side, real=True) for side in self.shape)
        return rows, columns

    @cached_property
    def wave_number(self) -> npt.NDArray:
        """Wave numbers q of the transform, one over the unit of length."""
        rows, columns = self.domain
        along = 2 * np.pi * np.fft.fftfreq(rows, self.pixel)
        across = 2 * np.pi * np.fft.rfftfreq(columns, self.pixel)
        return np.hypot(along[:, None], across)

    @cached_property
    def compliance(self) -> npt.NDArray:
        """Transform of the displacement per traction; 0 for a mean that the body does not have."""
        q = self.wave_number
        if self.periodic or isinstance(self.body, Layer):
            with np.errstate(divide="ignore"):
                found = 2 / q
            found[0, 0] = 0.0
            if isinstance(self.body, Layer):
                b, base = self.body.thickness, self.body.base
                found *= base.transfer(np.where(q > 0, q * b, 1.0))
                found[0, 0] = base.foundation * b
                if not (self.periodic or found[0, 0]):
                    # Glued and incompressible: G rises like q^2; its mean near q = 0
                    found[0, 0] = found[0, 1] / (2 * np.pi)
            return self.field(found)
        found = _fft.rfft2(_love(self.domain, self.pixel)).real
        return self.field(found * np.exp((q * self.pixel) ** 2 / _WITHIN_PIXEL))

    @cached_property
    def stiffness(self) -> npt.NDArray:
        """Transform of the traction per displacement; 0 where the compliance is."""
        G = self.compliance
        with np.errstate(divide="ignore"):
            return np.where(G > 0, 1 / G, 0.0)

    @cached_property
    def usual_stiffness(self) -> float:
        """Median of the stiffness over the wave numbers, of a preconditioner."""
        return float(np.median(self.stiffness))

    @cached_property
    def mean_is_zero(self) -> bool:
        """Whether the mean displacement is zero, so that the depth is that of the mean plane."""
        return float(self.compliance[0, 0]) == 0

    def moved(self, traction: npt.NDArray) -> npt.NDArray:
        """Return the displacements of the domain under tractions on the surface."""
        return self.applied(self.compliance, self.widened(traction))

    def held(self, displacement: npt.NDArray) -> npt.NDArray:
        """Return the tractions on the domain that hold displacements of the domain."""
        return self.applied(self.stiffness, displacement)

    def applied(self, transfer: npt.NDArray, field: npt.NDArray) -> npt.NDArray:
        """Return a field of the domain, multiplied by a transfer function."""
        transform = self.library[1]
        found = transform.rfft2(field)
        found *= transfer
        return transform.irfft2(found, s=self.domain, overwrite_x=True)

    def widened(self, field: npt.NDArray) -> npt.NDArray:
        """Return a field of the surface on the domain, zero outside."""
        field = field.reshape(self.shape)
        if self.periodic:
            return field
        wide = self.zeros(field.dtype)
        wide[: self.shape[0], : self.shape[1]] = field
        return wide

    def within(self, field: npt.NDArray) -> npt.NDArray:
        """Return the part of a field of the domain that lies on the surface, as a flat array."""
        return field[: self.shape[0], : self.shape[1]].ravel()


def libraries(device: Device) -> tuple[Any, Any]:
    """Return the library of arrays of a device, and its Fourier transforms.

    Raises
    ------
    InputError
        If CuPy or a GPU is missing.
    """
    if device == "cpu":
        return np, fft
    try:
        cupy: Any = import_module("cupy")
        transforms = import_module("cupyx.scipy.fft")
    except ImportError:
        raise InputError(
            'device "cuda" needs CuPy: pip install "viscotack[gpu]"', field="device"
        ) from None
    try:
        cupy.cuda.runtime.getDeviceCount()
    except cupy.cuda.runtime.CUDARuntimeError as error:
        raise InputError(f'device "cuda" has no GPU: {error}', field="device") from None
    return cupy, transforms


def memory(device: Device) -> float:
    """Return the bytes of memory of a device; infinity where the system does not tell."""
    if device == "cuda":
        return float(libraries(device)[0].cuda.runtime.memGetInfo()[1])
    # Windows has no sysconf
    value: Callable[[str], int] | None = getattr(os, "sysconf", None)
    if value is None:
        return float("inf")
    return float(value("SC_PAGE_SIZE") * value("SC_PHYS_PAGES"))


def on_host(field: Any) -> npt.NDArray:
    """Return a field as an array of NumPy."""
    return field if isinstance(field, np.ndarray) else field.get()


def _love(domain: tuple[int, int], pixel: float) -> npt.NDArray:
    r"""Return the displacement around a pixel under unit traction, wrapped, for E* = 1.

    Of a rectangle with corners at x and y from the place, after Love (1929),
    doi:10.1098/rsta.1929.0009,

    .. math:: \pi u = \sum \pm [x \operatorname{asinh}(y/|x|) + y \operatorname{asinh}(x/|y|)] .
    """

    def corner(x: npt.NDArray, y: npt.NDArray) -> npt.NDArray:
        return x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))

    def edges(many: int) -> npt.NDArray:
        distance = np.minimum(np.arange(many), many - np.arange(many))
        return distance - 0.5

    x, y = edges(domain[0])[:, None], edges(domain[1])
    u = corner(x + 1, y + 1) - corner(x, y + 1) - corner(x + 1, y) + corner(x, y)
    return pixel / np.pi * u
