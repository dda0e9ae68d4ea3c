r"""A map of heights on square pixels.

**Statistics of a map of heights: rms height, slope and curvature, and the power spectrum.** The
power spectrum is that of Jacobs, Junge and Pastewka (2017), doi:10.1088/2051-672X/aa51f8:
:math:`C(q) = A^{-1} |\tilde h(q)|^2` with :math:`\tilde h` the Fourier integral over the area A. Of
a map that is not periodic it is taken after removing the tilt, through a Hann window, so that the
ends do not add a :math:`q^{-2}`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.units import positive

# Smallest and largest number of pixels of a side, and the largest of a generated map.
FEWEST, MOST, MOST_GENERATED = 8, 8192, 4096


@dataclass(frozen=True, eq=False)
class HeightMap:
    """Heights of a rigid surface above a reference plane, positive towards the solid.

    Parameters
    ----------
    heights : ndarray, shape (rows, columns)
        Heights at the centres of the pixels [m].
    pixel : float
        Side of a pixel [m].
    periodic : bool
        Whether the map repeats in both directions; otherwise nothing lies around it.
    beyond : float or None
        Radius [m] of the paraboloid, centred in the middle of the map, in which it continues.
    notes : tuple of str
        Decisions and doubts of the reader of a file.

    Raises
    ------
    ValueError
        If the heights are not finite, a side has less than 8 or more than 4096 pixels, or a
        periodic map continues as a paraboloid.

    Examples
    --------
    >>> import numpy as np
    >>> ramp = HeightMap(1e-9 * np.add.outer(np.arange(8.0), np.zeros(8)), pixel=1e-6)
    >>> bool(np.ptp(ramp.levelled().heights) < 1e-22)
    True
    """

    heights: npt.NDArray
    pixel: float
    periodic: bool = False
    beyond: float | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        h = np.array(self.heights, dtype=float)
        if h.ndim != 2 or not all(FEWEST <= side <= MOST for side in h.shape):
            raise InputError(
                f"a map of heights has {FEWEST} to {MOST} pixels in each direction, got an array "
                f"of shape {h.shape}"
            )
        if not np.all(np.isfinite(h)):
            missing = int(np.count_nonzero(~np.isfinite(h)))
            raise InputError(
                f"{missing} heights of the map are not numbers; fill the gaps of a measurement "
                "before"
            )
        h.setflags(write=False)
        object.__setattr__(self, "heights", h)
        object.__setattr__(self, "pixel", positive("pixel", self.pixel, "m"))
        if self.beyond is not None:
            object.__setattr__(self, "beyond", positive("beyond", self.beyond, "m"))
            if self.periodic:
                raise InputError("a periodic map repeats and does not continue as a paraboloid")

    @property
    def size(self) -> tuple[float, float]:
        """Lengths of the sides [m]."""
        rows, columns = self.heights.shape
        return rows * self.pixel, columns * self.pixel

    @property
    def area(self) -> float:
        """Area of the map [m^2]."""
        return self.heights.size * self.pixel**2

    def __add__(self, other: HeightMap) -> HeightMap:
        """Return the sum of two maps, such as a sphere and a roughness."""
        same = self.heights.shape == other.heights.shape and self.pixel == other.pixel
        if not (same and self.periodic == other.periodic):
            raise InputError("maps that are added must have the same pixels and be alike periodic")
        return replace(
            self, heights=self.heights + other.heights, beyond=self.beyond or other.beyond
        )

    def scaled(self, factor: float) -> HeightMap:
        """Return the map with all heights multiplied by a factor."""
        return replace(self, heights=factor * self.heights)

    def levelled(self, *, curvature: bool = False) -> HeightMap:
        """Return the map without its mean and tilt, with `curvature` without a paraboloid too.

        They are those of the least squares over all pixels. Not for a periodic map, which has none.
        """
        if self.periodic:
            raise InputError("a periodic map has neither tilt nor curvature to remove")
        rows, columns = self.heights.shape
        x = np.linspace(-1, 1, rows)[:, None] + np.zeros(columns)
        y = np.zeros(rows)[:, None] + np.linspace(-1, 1, columns)
        parts = [np.ones_like(x), x, y, *((x * x, x * y, y * y) if curvature else ())]
        matrix = np.array([part.ravel() for part in parts]).T
        found, *_ = np.linalg.lstsq(matrix, self.heights.ravel(), rcond=None)
        return replace(self, heights=self.heights - (matrix @ found).reshape(rows, columns))

    def coarser(self) -> HeightMap:
        """Return the map on pixels twice as large, each the mean of four."""
        rows, columns = (side - side % 2 for side in self.heights.shape)
        h = self.heights[:rows, :columns]
        mean = (h[::2, ::2] + h[1::2, ::2] + h[::2, 1::2] + h[1::2, 1::2]) / 4
        return replace(self, heights=mean, pixel=2 * self.pixel)


@dataclass(frozen=True, eq=False)
class Roughness:
    """Statistics of a map.

    Attributes
    ----------
    rms_height : float
        Root mean square of the heights about their mean [m].
    rms_slope : float
        Root mean square of the gradient.
    rms_curvature : float
        Root mean square of half the Laplacian, the mean curvature [1/m].
    peak : float
        Highest point above the mean [m].
    wave_number, spectrum : ndarray
        Wave numbers [1/m], and radial mean of the power spectrum [m^4].
    """

    rms_height: float
    rms_slope: float
    rms_curvature: float
    peak: float
    wave_number: npt.NDArray
    spectrum: npt.NDArray


def roughness(surface: HeightMap) -> Roughness:
    """Return the statistics of a map; one that is not periodic is freed of its tilt first.

    Derivatives are differences between neighbouring pixels.

    Examples
    --------
    A wave of amplitude 10 nm and length 8 um:

    >>> import numpy as np
    >>> x = (np.arange(64) + 0.5) * 1e-6
    >>> wave = HeightMap(1e-8 * np.add.outer(np.cos(2e6 * np.pi / 8 * x), 0 * x), 1e-6, True)
    >>> f"{roughness(wave).rms_height:.3g} {roughness(wave).rms_slope:.3g}"
    '7.07e-09 0.00541'
    """
    if not surface.periodic:
        surface = surface.levelled()
    h, dx = surface.heights - surface.heights.mean(), surface.pixel
    wide = np.pad(h, (0, 1), mode="wrap") if surface.periodic else h
    along = np.diff(wide, axis=0)[:, : h.shape[1]] / dx
    across = np.diff(wide, axis=1)[: h.shape[0]] / dx
    q, spectrum = _spectrum(h, dx, surface.periodic)
    return Roughness(
        rms_height=float(h.std()),
        rms_slope=float(np.sqrt(np.mean(along**2) + np.mean(across**2))),
        rms_curvature=rms_curvature(h, dx, surface.periodic),
        peak=float(h.max()),
        wave_number=q,
        spectrum=spectrum,
    )


def rms_curvature(heights: npt.NDArray, pixel: float, periodic: bool) -> float:
    """Return the root mean square of the mean curvature, half the Laplacian by differences.

    Parameters
    ----------
    heights : ndarray, shape (rows, columns)
        Heights, in any unit.
    pixel : float
        Side of a pixel, in any unit.
    periodic : bool
        Whether the map repeats; otherwise only pixels with four neighbours count.

    Returns
    -------
    float
        Unit of the heights over that of the pixel squared.
    """
    h = np.pad(heights, 1, mode="wrap") if periodic else heights
    bent = h[2:, 1:-1] + h[:-2, 1:-1] + h[1:-1, 2:] + h[1:-1, :-2] - 4 * h[1:-1, 1:-1]
    return float(np.sqrt(np.mean(bent**2))) / (2 * pixel**2)


def _spectrum(h: npt.NDArray, dx: float, periodic: bool) -> tuple[npt.NDArray, npt.NDArray]:
    """Return the radial mean of the power spectrum, in rings one smallest wave number wide."""
    rows, columns = h.shape
    if not periodic:
        window = np.outer(np.hanning(rows), np.hanning(columns))
        h = h * window / np.sqrt(np.mean(window**2))
    power = np.abs(np.fft.fft2(h)) ** 2 * dx**2 / h.size
    qx, qy = 2 * np.pi * np.fft.fftfreq(rows, dx), 2 * np.pi * np.fft.fftfreq(columns, dx)
    q = np.hypot(qx[:, None], qy)
    ring = 2 * np.pi / (dx * min(rows, columns))
    place = np.rint(q / ring).astype(int).ravel()
    count = np.bincount(place)
    mean_q = np.bincount(place, q.ravel()) / np.maximum(count, 1)
    mean = np.bincount(place, power.ravel()) / np.maximum(count, 1)
    kept = (np.arange(len(count)) > 0) & (count > 0) & (mean_q <= np.pi / dx)
    return mean_q[kept], mean[kept]
