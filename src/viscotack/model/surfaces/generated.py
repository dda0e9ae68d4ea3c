"""Maps of heights from a few numbers: sphere, self-affine roughness, bumps and pillars."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.units import positive

from .heights import FEWEST, MOST_GENERATED, HeightMap


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
    x = _centred(pixels, pixel)
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


def _centred(pixels: int, pixel: float) -> npt.NDArray:
    _check(pixels)
    return (np.arange(pixels) + 0.5 - pixels / 2) * positive("pixel", pixel, "m")


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
