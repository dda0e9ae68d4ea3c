r"""A map of heights on square pixels, its statistics, and maps from a few numbers.

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


def sphere(pixels: int, pixel: float, *, radius: float) -> HeightMap:
    """Return the cap of a sphere, as a paraboloid that continues beyond the map.

    Parameters
    ----------
    pixels : int
        Pixels of each side.
    pixel : float
        Side of a pixel [m].
    radius : float
        Radius of the sphere [m].

    Examples
    --------
    >>> cap = sphere(8, 1e-6, radius=1e-3)
    >>> f"{cap.heights.min():.3g}"
    '-1.22e-08'
    """
    _check(pixels)
    x = (np.arange(pixels) + 0.5 - pixels / 2) * positive("pixel", pixel, "m")
    R = positive("radius", radius, "m")
    return HeightMap(-np.add.outer(x**2, x**2) / (2 * R), pixel, beyond=R)


def self_affine(
    pixels: int,
    pixel: float,
    *,
    hurst: float,
    rms_height: float,
    seed: int,
    roll_off: float | None = None,
    shortest: float | None = None,
    periodic: bool = True,
) -> HeightMap:
    r"""Return a random self-affine map with a Gaussian distribution of heights.

    .. math:: C(q) \propto \max(q, q_r)^{-2 (1 + H)} \quad \text{for} \quad q \le q_s

    Source: Jacobs, Junge and Pastewka (2017), doi:10.1088/2051-672X/aa51f8.

    Parameters
    ----------
    pixels : int
        Pixels of each side.
    pixel : float
        Side of a pixel [m].
    hurst : float
        Hurst exponent H, from 0 to 1.
    rms_height : float
        Root mean square of the heights of this very map [m].
    seed : int
        Seed of the random phases and amplitudes.
    roll_off : float, optional
        Wave length 2 pi/q_r above which the spectrum is flat [m]; by default the side.
    shortest : float, optional
        Shortest wave length 2 pi/q_s [m]; by default two pixels.
    periodic : bool
        Whether the map repeats. If not, it is cut out of one twice as wide.

    Examples
    --------
    >>> rough = self_affine(64, 1e-6, hurst=0.8, rms_height=1e-7, seed=1, shortest=8e-6)
    >>> f"{rough.heights.std():.3g}"
    '1e-07'
    """
    if not 0 <= hurst <= 1:
        raise InputError(f"the Hurst exponent lies between 0 and 1, got {hurst}")
    _check(pixels)
    many = pixels if periodic else 2 * pixels
    side = many * pixel
    q = 2 * np.pi * np.fft.fftfreq(many, pixel)
    q = np.hypot(q[:, None], q)
    low = 2 * np.pi / (side if roll_off is None else positive("roll_off", roll_off, "m"))
    high = 2 * np.pi / (2 * pixel if shortest is None else positive("shortest", shortest, "m"))
    if low > high:
        raise InputError("the shortest wave length must be shorter than the roll-off")
    drawn = np.fft.fft2(np.random.default_rng(seed).normal(size=(many, many)))
    drawn *= np.maximum(q, low) ** (-1 - hurst) * ((q > 0) & (q <= high))
    h = np.fft.ifft2(drawn).real[:pixels, :pixels]
    h = h - h.mean()
    spread = h.std()
    if not spread > 0:
        raise InputError("no wave fits between the shortest wave length and the side of the map")
    return HeightMap(h * (positive("rms_height", rms_height, "m") / spread), pixel, periodic)


def bumps(
    pixels: int,
    pixel: float,
    *,
    radius: float,
    spacing: float,
    height: float,
    scatter: float = 0.0,
    seed: int = 0,
) -> HeightMap:
    """Return a periodic square array of spherical bumps on a plane.

    Parameters
    ----------
    pixels : int
        Pixels of each side.
    pixel : float
        Side of a pixel [m].
    radius, height : float
        Radius of the bumps and their height above the plane [m].
    spacing : float
        Distance of neighbouring bumps [m]; the side is a multiple of it.
    scatter : float
        Standard deviation of the heights of the bumps [m].
    seed : int
        Seed of their heights.
    """
    each, centre, x = _lattice(pixels, pixel, spacing)
    tops = height + scatter * np.random.default_rng(seed).normal(size=(each, each))
    rise = np.add.outer((x - centre) ** 2, (x - centre) ** 2) / (
        2 * positive("radius", radius, "m")
    )
    at = np.floor(x / spacing).astype(int).clip(0, each - 1)
    return HeightMap(np.maximum(tops[np.ix_(at, at)] - rise, 0.0), pixel, periodic=True)


def pillars(
    pixels: int, pixel: float, *, radius: float, spacing: float, height: float
) -> HeightMap:
    """Return a periodic square array of flat round pillars on a plane.

    The parameters are those of :func:`bumps`, with the radius of the top of a pillar.
    """
    _, centre, x = _lattice(pixels, pixel, spacing)
    away = np.sqrt(np.add.outer((x - centre) ** 2, (x - centre) ** 2))
    return HeightMap(np.where(away <= radius, positive("height", height, "m"), 0.0), pixel, True)


def _check(pixels: int) -> None:
    """Refuse a map of too many pixels before it takes memory."""
    if not FEWEST <= pixels <= MOST_GENERATED:
        raise InputError(f"pixels must lie between {FEWEST} and {MOST_GENERATED}, got {pixels}")


def _lattice(pixels: int, pixel: float, spacing: float) -> tuple[int, npt.NDArray, npt.NDArray]:
    """Return the number of cells of a side, and the centre of the cell of each pixel."""
    _check(pixels)
    side = pixels * positive("pixel", pixel, "m")
    each = round(side / positive("spacing", spacing, "m"))
    if not 1 <= each <= pixels or abs(each * spacing - side) > 1e-6 * side:
        raise InputError(
            f"the side, {side:g} m, must be a multiple of the spacing, got {spacing:g} m; the "
            f"spacing is at least a pixel"
        )
    x = (np.arange(pixels) + 0.5) * pixel
    return each, (np.floor(x / spacing) + 0.5) * spacing, x
