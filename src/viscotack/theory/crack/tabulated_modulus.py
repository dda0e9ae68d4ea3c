r"""Crack theories evaluated directly from a measured complex modulus, without a fitted spectrum.

**Persson and Brener.** With the loss compliance
:math:`C'' = -\mathrm{Im}(1/E) = E''/(E'^2 + E''^2)` and the cut-off
:math:`\omega_c = 2\pi v / (l_0 \Gamma)`

.. math:: \frac1\Gamma = 1 - \frac{2 E_0}{\pi} \int_0^{\omega_c} C''(\omega)
          \sqrt{1 - (\omega/\omega_c)^2} \, \frac{d\omega}{\omega}
          = 1 - \frac{2 E_0}{\pi} \int_0^{\pi/2} I(\omega_c \sin\theta) \sin\theta \, d\theta,
          \quad I(\omega) = \int_0^\omega C'' \, d\ln\omega

(Eq. 2.18), the same law as :mod:`viscotack.theory.crack.persson_brener`. The modulus
above the cut-off has no effect, so the table need not reach the glassy range. The modulus below the
table has an effect, which the first row bounds: in any linear solid C''/omega decreases, and with
:math:`x/(1+x^2) \le \arctan x \le x/(1+x^2) + \frac\pi2 x^2/(1+x^2)`, mode by mode,

.. math:: C''_1 \le I(\omega_1) \le C''_1 + \frac\pi2 \left( \frac1{E_0} - C'_1 \right).

**Greenwood.** The creep under the zone, :math:`E_0 C(t) = 1 - \frac{2 E_0}{\pi} \int C'' \cos
\omega t \, d\ln\omega`, in Eq. 3.32 gives the same law with another kernel,

.. math:: \frac1\Gamma = 1 - \frac{2 E_0}{\pi} \int_0^\infty C''(\omega) \,
          Q\!\left(\frac{\omega l \Gamma}{v}\right) \frac{d\omega}{\omega}, \quad
          Q(y) = \mathrm{Re} \, {}_2F_2(1, 1; \tfrac32, 2; -i y)

which decays from 1 as :math:`\pi/(4 y)`: there is no sharp cut-off, so the modulus above the table
contributes as well. The last row bounds it correspondingly:
:math:`\int_{\omega_N}^\infty C'' \, d\ln\omega \le C''_N + \frac\pi2 C'_N`. A table that ends far
below the glassy range is sufficient only for much slower cracks.

Source: Persson & Brener (2005), doi:10.1103/PhysRevE.71.036123; Maghami, PhD thesis (2025),
Eq. 2.18 and 3.32, published as doi:10.1016/j.jmps.2024.105844 and
doi:10.1016/j.engfracmech.2024.109898; Greenwood (2004), J. Phys. D 37, 2557 (no DOI known to this
package). The second kernel and the bounds are this package's.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, ascending, plain, positive
from viscotack.theory.crack import greenwood as zone
from viscotack.theory.crack import persson_brener as integral

_FEWEST = 4


class Interval(NamedTuple):
    """Lower bound ``low`` and upper bound ``high`` of the amplification, dimensionless.

    Returned by :func:`amplification` and :func:`greenwood_amplification`.
    """

    low: Number
    high: Number


@dataclass(frozen=True)
class TabulatedModulus:
    r"""A complex modulus :math:`E' + i E''` as a table, such as a DMA master curve.

    Parameters
    ----------
    rubbery_modulus : float
        Rubbery plateau E0 [Pa], not above the first storage modulus.
    frequencies : sequence of float
        Angular frequencies omega [rad/s], ascending, at most a decade apart: 2 pi times those
        in Hz.
    storage, loss : sequence of float
        E' and E'' [Pa], positive. C'' is a power law between two rows.

    Raises
    ------
    InputError
        If frequencies do not ascend or leave a gap, or the moduli are invalid.

    Examples
    --------
    >>> rubber = TabulatedModulus(
    ...     rubbery_modulus=1e6,
    ...     frequencies=(0.1, 1.0, 10.0, 100.0),
    ...     storage=(1.01e6, 1.1e6, 2e6, 4e6),
    ...     loss=(3e4, 2e5, 9e5, 3e6),
    ... )
    >>> low, high = amplification(1.0, modulus=rubber)
    >>> f"{low:.3f} to {high:.3f}"
    '1.357 to 1.374'
    """

    rubbery_modulus: float
    frequencies: tuple[float, ...]
    storage: tuple[float, ...]
    loss: tuple[float, ...]

    def __post_init__(self) -> None:
        E = float(np.asarray(positive(rubbery_modulus=self.rubbery_modulus)))
        columns = {
            name: np.asarray(getattr(self, name), dtype=float)
            for name in ("frequencies", "storage", "loss")
        }
        w, stored, lost = columns.values()
        if w.ndim != 1 or w.size < _FEWEST or not w.shape == stored.shape == lost.shape:
            raise InputError(
                f"a modulus needs {_FEWEST} or more rows of frequency, storage and loss, got "
                f"{w.size}, {stored.size} and {lost.size}"
            )
        for name, column in columns.items():
            if not np.all(np.isfinite(column) & (column > 0)):
                unit = "rad/s" if name == "frequencies" else "Pa"
                raise InputError(
                    f"{name} must be positive and finite [{unit}], got a minimum of "
                    f"{np.min(column):g}; remove rows without measurements"
                )
        remedy = "sort the table and merge overlapping sweeps into one master curve"
        ascending(w, "frequencies", "rad/s", remedy)
        if E > stored[0] * (1 + 1e-12):
            raise InputError(
                f"rubbery_modulus {E:g} Pa must not exceed the first storage modulus "
                f"{stored[0]:g} Pa; give the plateau of the modulus at low frequency"
            )
        object.__setattr__(self, "rubbery_modulus", E)
        for name, column in columns.items():
            object.__setattr__(self, name, tuple(column.tolist()))
        low, _ = _tables(self)
        if not integral.rest(w[-1:], low)[0] > 0:
            raise InputError(
                "the integral of the loss exceeds the rubbery compliance, which is impossible for "
                "a linear solid; check rubbery_modulus and the units of storage and loss"
            )


def amplification(speed: Values, *, modulus: TabulatedModulus) -> Interval:
    """Return bounds of effective over rubbery surface energy at speeds v/l0 [1/s].

    The bounds cover the unknown modulus below the table, but not the scatter of the measurement
    nor the error of the power laws between rows, which decreases with the square of the row
    spacing: for n = 0.6 and k = 0.1, near the glassy range, 3 % at 4 rows per decade, 0.8 % at 8
    and 0.2 % at 16.

    Parameters
    ----------
    speed : array_like
        v/l0 [1/s] with ``l0`` of
        :func:`viscotack.theory.crack.persson_brener.crack_tip_length`, in :func:`speed_range`.
    modulus : TabulatedModulus
        Table of the complex modulus.

    Raises
    ------
    InputError
        If a speed is outside its range, because the table is too narrow.

    Examples
    --------
    >>> rubber = TabulatedModulus(
    ...     rubbery_modulus=1e6,
    ...     frequencies=(0.1, 1.0, 10.0, 100.0),
    ...     storage=(1.01e6, 1.1e6, 2e6, 4e6),
    ...     loss=(3e4, 2e5, 9e5, 3e6),
    ... )
    >>> low, high = amplification(1.0, modulus=rubber)
    >>> f"{low:.3f} to {high:.3f}"
    '1.357 to 1.374'
    """
    v = np.asarray(positive(speed=speed))
    _refuse_outside(v, speed_range(modulus=modulus), "tip")
    low, high = (integral.solved(v, table) for table in _tables(modulus))
    return Interval(plain(low), plain(high))


def speed_range(*, modulus: TabulatedModulus) -> tuple[float, float]:
    """Return the slowest and the fastest speed v/l0 [1/s] whose cut-off lies in the table.

    Parameters
    ----------
    modulus : TabulatedModulus
        Table of the complex modulus.

    Examples
    --------
    >>> rubber = TabulatedModulus(
    ...     rubbery_modulus=1e6,
    ...     frequencies=(0.1, 1.0, 10.0, 100.0),
    ...     storage=(1.01e6, 1.1e6, 2e6, 4e6),
    ...     loss=(3e4, 2e5, 9e5, 3e6),
    ... )
    >>> slowest, fastest = speed_range(modulus=rubber)
    >>> f"{slowest:.4f} {fastest:.1f}"
    '0.0164 38.0'
    """
    ends = np.array([modulus.frequencies[0], modulus.frequencies[-1]])
    low, high = _tables(modulus)
    # both bounds must have their cut-off in the table
    first = ends[0] / integral.rest(ends[:1], high)[0]
    last = ends[1] / integral.rest(ends[1:], low)[0]
    return float(first / (2 * np.pi)), float(last / (2 * np.pi))


def greenwood_amplification(speed: Values, *, modulus: TabulatedModulus) -> Interval:
    """Return bounds of effective over rubbery surface energy by Greenwood, at speeds v/l [1/s].

    The bounds cover the unknown modulus below and above the table, but not the scatter of the
    measurement nor the error of the power laws between rows: for n = 0.6 and k = 0.1, near
    the glassy range, 4 % at 4 rows per decade, 1 % at 8 and 0.2 % at 16. Two decades below the
    fastest speed of a table the bounds differ by some per cent, at its end by a factor of two.

    Parameters
    ----------
    speed : array_like
        v/l [1/s] with ``l`` of :func:`viscotack.theory.crack.greenwood.cohesive_zone_length`,
        in :func:`greenwood_speed_range`.
    modulus : TabulatedModulus
        Table of the complex modulus.

    Raises
    ------
    InputError
        If a speed is outside its range, because the table is too narrow.

    Examples
    --------
    >>> rubber = TabulatedModulus(
    ...     rubbery_modulus=1e6,
    ...     frequencies=(0.1, 1.0, 10.0, 100.0),
    ...     storage=(1.01e6, 1.1e6, 2e6, 4e6),
    ...     loss=(3e4, 2e5, 9e5, 3e6),
    ... )
    >>> low, high = greenwood_amplification(1.0, modulus=rubber)
    >>> f"{low:.3f} to {high:.3f}"
    '1.278 to 1.296'
    """
    v = np.asarray(positive(speed=speed))
    curves = _zone_curves(modulus)
    _refuse_outside(v, zone.ends(curves), "zone")
    low = zone.solved(v, curves.passage, curves.most)
    return Interval(plain(low), plain(zone.solved(v, curves.passage, curves.least)))


def greenwood_speed_range(*, modulus: TabulatedModulus) -> tuple[float, float]:
    r"""Return the slowest and the fastest v/l [1/s] whose zone passage is covered by the table.

    There :math:`v/(l \Gamma)` lies between the first and the last frequency, for both bounds.

    Parameters
    ----------
    modulus : TabulatedModulus
        Table of the complex modulus.

    Examples
    --------
    >>> rubber = TabulatedModulus(
    ...     rubbery_modulus=1e6,
    ...     frequencies=(0.1, 1.0, 10.0, 100.0),
    ...     storage=(1.01e6, 1.1e6, 2e6, 4e6),
    ...     loss=(3e4, 2e5, 9e5, 3e6),
    ... )
    >>> slowest, fastest = greenwood_speed_range(modulus=rubber)
    >>> f"{slowest:.4f} {fastest:.1f}"
    '0.1078 252.1'
    """
    return zone.ends(_zone_curves(modulus))


def _refuse_outside(v: npt.NDArray, ends: tuple[float, float], length: str) -> None:
    if np.any(v < ends[0]) or np.any(v > ends[1]):
        raise InputError(
            f"the table covers cracks of {ends[0]:.4g} to {ends[1]:.4g} {length} lengths per "
            f"second, got {np.min(v):.4g} to {np.max(v):.4g}; measure a wider range of "
            "frequencies for others"
        )


def _zone_curves(modulus: TabulatedModulus) -> zone.Bounds:
    low, high = _tables(modulus)
    last = modulus.storage[-1] - 1j * modulus.loss[-1]
    compliance = modulus.rubbery_modulus * last / abs(last) ** 2
    return zone.bounds(
        low.frequencies,
        low.loss,
        below=(low.start, high.start),
        above=float(-compliance.imag + np.pi / 2 * compliance.real),
    )


def _tables(modulus: TabulatedModulus) -> tuple[integral.Table, integral.Table]:
    """Return the loss compliance in 1/E0 with the bounds of its integral below the table."""
    E, stored, lost = modulus.rubbery_modulus, np.array(modulus.storage), np.array(modulus.loss)
    size = stored**2 + lost**2
    loss = E * lost / size
    least = loss[0]
    most = least + np.pi / 2 * (1 - E * stored[0] / size[0])
    w = np.array(modulus.frequencies)
    return (
        integral.Table(w, loss, least, linear_below=True),
        integral.Table(w, loss, most, linear_below=False),
    )
