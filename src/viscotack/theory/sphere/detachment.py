r"""State at pull-off from the retraction rate, slow, fast or intermediate.

Three conditions at the moment of the largest tension, without fitted constants:

- the edge is a Persson-Brener crack with the amplification
  :math:`\Gamma = \Gamma_{PB}(v)`, in a JKR contact of that energy: the largest tension is

  .. math:: P = \tfrac32 \pi R \, \Gamma \Delta\gamma_0, \quad
            a = \left(\frac{9 \pi R^2 \Gamma \Delta\gamma_0}{8 E_0^*}\right)^{1/3};

- the bulk responds to the retraction during the time t since the start with its compliance at that
  time, :math:`\kappa = E_0 C(t)`, from 1 (relaxed) to k (glassy):

  .. math:: r \, t = \kappa \left[ \delta_l + \frac{3^{1/3}}{4} \, h \, \Gamma^{2/3} \right],
            \quad h = (\pi^2 \Delta\gamma_0^2 R/E_0^{*2})^{1/3};

- so the edge recedes at

  .. math:: v = \frac{r}{d\delta/da} = \frac{3^{1/3}}{2} \frac{l}{h} \frac{r}{\kappa \Gamma^{1/3}},
            \quad l = (\pi R^2 \Delta\gamma_0/E_0^*)^{1/3}.

Slow retraction leads to JKR; fast retraction to :math:`\Gamma = \kappa^{-1} = 1/k`, the fast limit
of :mod:`viscotack.theory.sphere.bounds`. It is exact if the bulk is relaxed or glassy and the
forces have a short range; otherwise the compliance at one time approximates the history.

Range: Tabor number of at least 1, and a start larger than a by at least a fifth. For 275
simulations (power laws and standard solids, k 1e-3 to 0.3, n 0.3 to 1.6, rates 0.1 to 1e8 h0/tau0,
mu to 8; alpha = pi/9 in the tip length, as fitted in the thesis) nine of ten speeds agree within 17
%, and nine of ten forces within 8 % after multiplication by the elastic
:func:`viscotack.theory.elastic.lennard_jones.pull_off_ratio`. The worst differ by a factor of 2: in
speed if the bulk is halfway between rubber and glass, in force if mu is near 1 and the start light.
Below mu = 1 nine of ten speeds agree within a third; forces do not.

Source: this package. No DOI: the parts are
Persson & Brener (2005), doi:10.1103/PhysRevE.71.036123, and Johnson, Kendall & Roberts (1971),
doi:10.1098/rspa.1971.0141.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, contact_scales, plain, positive
from viscotack.theory._roots import regula_falsi
from viscotack.theory.crack import CrackLaw
from viscotack.theory.elastic import jkr

# Depth at the largest tension, -3^(1/3)/4, and da/d(depth) there, 3^(1/3)/2, of JKR.
_DEPTH, _SLOPE = np.cbrt(3) / 4, np.cbrt(3) / 2
# Tolerance of the root of ln t, and number of iterations of the law.
_ROUND_OFF, _SETTLED = 1e-14, 5
_TOLERANCE = 1e-12


class State(NamedTuple):
    """State at pull-off, returned by :func:`at_pull_off`, SI; floats or arrays of the speeds.

    Attributes
    ----------
    force : float or ndarray
        Pull-off force [N] for forces of short range, a positive number.
    contact_radius : float or ndarray
        Contact radius [m].
    crack_speed : float or ndarray
        Speed at which the edge recedes [m/s], positive.
    amplification : float or ndarray
        Effective over rubbery surface energy.
    time : float or ndarray
        Time since the start of retraction [s].
    compliance : float or ndarray
        Compliance of the bulk over that of the relaxed solid, k to 1.
    """

    force: Number
    contact_radius: Number
    crack_speed: Number
    amplification: Number
    time: Number
    compliance: Number


def at_pull_off(
    speed: Values,
    law: CrackLaw,
    *,
    depth: float,
    radius: float,
    contact_modulus: float,
    work_of_adhesion: float,
) -> State:
    r"""Compute the state at pull-off of a sphere retracted at speeds r [m/s], positive.

    Parameters
    ----------
    speed : array_like
        Retraction speed [m/s].
    law : CrackLaw
        Crack law of the edge; the bulk creeps as its material. The accuracy above holds for Persson
        and Brener with the length of
        :func:`viscotack.theory.crack.persson_brener.crack_tip_length`.
    depth : float
        Depth of the relaxed start [m].
    radius, contact_modulus, work_of_adhesion : float
        Relaxed contact, as in :mod:`viscotack.theory.elastic.jkr` [m, Pa, J/m^2].

    Raises
    ------
    InputError
        If the start has no contact, or one smaller than the state at pull-off, because then the
        force depends on the preload.

    Notes
    -----
    One equation for t. Creep is concave, so t/kappa and Gamma increase with t; kappa
    increases, so v and Gamma(v) of the law decrease. Therefore there is one root,
    between known bounds.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> law = CrackLaw(theory="persson-brener", material=solid, tip_length=1e-6)
    >>> state = at_pull_off(
    ...     1e-4, law, depth=5e-4, radius=5e-3, contact_modulus=2e6, work_of_adhesion=0.15
    ... )
    >>> f"{state.force * 1e3:.1f} mN at {state.crack_speed * 1e3:.2f} mm/s"
    '31.3 mN at 0.97 mm/s'
    """
    state = unlimited(
        speed,
        law,
        depth=depth,
        radius=radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
    )
    case = dict(radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion)
    start = float(np.asarray(jkr.contact_radius_at_depth(depth, **case)))
    a = np.ravel(state.contact_radius)
    if np.any(a > start):
        i = int(np.argmax(a))
        raise InputError(
            f"the relaxed contact radius of {start:.3g} m at the start is below the {a[i]:.3g} m "
            f"needed for detachment at {np.ravel(speed)[i]:.3g} m/s to be independent of the "
            "preload; press deeper, or retract more slowly"
        )
    return state


def unlimited(
    speed: Values,
    law: CrackLaw,
    *,
    depth: Values,
    radius: float,
    contact_modulus: float,
    work_of_adhesion: float,
) -> State:
    r"""Compute the state of :func:`at_pull_off`, also for a start smaller than the state.

    It then describes the relaxation of the bulk during the retraction from this depth, not the
    force. Speeds and depths are broadcast.

    Parameters
    ----------
    speed : array_like
        Retraction speed [m/s], positive.
    law : CrackLaw
        Crack law of the edge; the bulk creeps as its material.
    depth : array_like
        Depth of the relaxed start [m], above that of the pull-off of the relaxed contact.
    radius, contact_modulus, work_of_adhesion : float
        R of the sphere [m], rubbery :math:`E_0^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2];
        positive.

    Returns
    -------
    State
        Force [N], contact radius [m], crack speed [m/s] and more.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    A deeper start takes longer, so the bulk creeps further and the force is smaller:

    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> law = CrackLaw(theory="persson-brener", material=solid, tip_length=1e-6)
    >>> state = unlimited(
    ...     1e-3, law, depth=[1e-4, 5e-4], radius=5e-3, contact_modulus=2e6, work_of_adhesion=0.15
    ... )
    >>> [f"{force * 1e3:.1f} mN" for force in state.force]
    ['35.1 mN', '34.8 mN']
    """
    r, d = np.broadcast_arrays(positive(speed=speed), np.asarray(depth, dtype=float))
    length, height, load = (
        float(x)
        for x in contact_scales(
            radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
        )
    )
    k, unit = law.material.modulus_ratio, law.material.time_unit
    least = d + _DEPTH * height
    if not np.all(least > 0):
        raise InputError(
            f"depth must be above {-_DEPTH * height:.6g} m, that of the pull-off of the relaxed "
            f"contact, got {np.min(d)} m"
        )
    low = np.log(k * least / r)
    high = np.log((d + _DEPTH * height * k ** (-2 / 3)) / r)
    modes = law.material.retardation_modes(
        shortest=float(np.exp(np.min(low))),
        longest=float(np.exp(np.max(high))),
        tolerance=_TOLERANCE * k,
    )

    def edge(log_time: Any) -> tuple[Any, Any, Any]:
        """Return Gamma^(2/3) required by the travel, the edge speed and kappa."""
        time = np.exp(log_time)
        compliance = np.asarray(modes.creep(time))
        asked = (r * time / compliance - d) / (_DEPTH * height)
        root = np.sqrt(np.clip(asked, 1.0, k ** (-2 / 3)))
        return asked, _SLOPE * length / height * r / (compliance * root), compliance

    # the compliance increases with time, and the speed decreases with it and with the energy
    fastest, slowest = (
        _SLOPE * length / height * np.asarray(r / modes.creep(np.exp(end))) for end in (low, high)
    )
    amplification = law.amplification_of_passage(
        float(np.log(law.tip_length / (unit * np.max(fastest)))),
        float(np.log(law.tip_length / (unit * np.min(slowest) * k ** (4 / 3)))),
    )

    def crack(gamma: Any, v: Any) -> Any:
        """Return the amplification of a tip enlarged by gamma, at a speed."""
        y = np.log(np.clip(gamma, 1.0, 1 / k) * law.tip_length / (unit * v))
        return amplification(np.atleast_1d(y)).reshape(np.shape(y))

    def excess(log_time: Any) -> Any:
        asked, v, _ = edge(log_time)
        return asked - np.cbrt(crack(np.maximum(asked, 0.0) ** 1.5, v)) ** 2

    best = regula_falsi(excess, low, high, noise=_ROUND_OFF * (k ** (-2 / 3) + np.abs(d) / height))
    asked, v, compliance = edge(best)
    gamma = asked**1.5
    for _ in range(_SETTLED):
        # the speed is accurate to round-off; iterate the law for its energy
        gamma = crack(gamma, v)
    a = length * np.cbrt(9 / 8 * gamma)
    return State(*(plain(x) for x in (1.5 * load * gamma, a, v, gamma, np.exp(best), compliance)))
