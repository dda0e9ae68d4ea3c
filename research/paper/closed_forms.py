r"""Closed forms for the energy of an opening crack, each with its length over the strength.

All have the form :math:`1/\Gamma = c + \sum_j w_j \psi(t/\tau_j)`, with t the time in which a
zone of length :math:`l \Gamma` passes, :math:`V = l \Gamma/t`; they differ in the response psi of a
mode and in l. Units as in :mod:`viscotack.theory.crack.steady`.
"""

import numpy as np
import scipy

from viscotack.theory import greenwood

# Range of ln t over the retardation times, and its points.
_RANGE, _POINTS = 14.0, 1500


def schapery(q):
    """Creep at one time, a third of the passage: Schapery (1975), doi:10.1007/BF00033526."""
    return -np.expm1(-q / 3)


def constant_stress(q):
    """Mean creep in a zone of constant stress, without approximation (Greenwood 2004)."""
    return np.asarray(greenwood.zone_response(q))


def persson_brener(q):
    """Loss outside a blunt tip: Persson & Brener (2005), doi:10.1103/PhysRevE.71.036123."""
    x = q / (2 * np.pi)
    root = np.sqrt(1 + x**2)
    return 2 * x / (1 + x + root)


FORMS = {
    "Schapery": schapery,
    "constant stress": constant_stress,
    "Persson-Brener": persson_brener,
}


def length_of_strength(form, strength):
    """Return the length l that the strength of a law gives [E0* h0^2/dg]."""
    if form == "Persson-Brener":
        return 1 / (np.pi * (np.pi / 9 * strength) ** 2)
    return np.pi / (4 * strength**2)


def energies(form, speed, crack, length):
    """Return energies at speeds, for a length l."""
    modes = crack.modes
    tau, weights = np.array(modes.times), np.array(modes.weights)
    ends = np.log(tau.min()) - _RANGE, np.log(tau.max()) + _RANGE
    t = np.exp(np.linspace(*ends, _POINTS))
    gamma = 1 / (modes.instantaneous + FORMS[form](t[:, None] / tau) @ weights)
    v = length * gamma / t
    return np.exp(np.interp(np.log(speed), np.log(v[::-1]), np.log(gamma[::-1])))


def deviations(form, speed, crack, length):
    """Return relative deviations from the steady crack."""
    return energies(form, speed, crack, length) / np.asarray(crack.amplification(speed)) - 1


def best_length(form, speed, crack):
    """Return the length with the least largest deviation, and that deviation."""

    def largest(log_length):
        return float(np.max(np.abs(deviations(form, speed, crack, np.exp(log_length)))))

    found = scipy.optimize.minimize_scalar(largest, bounds=(-4.0, 4.0), method="bounded")
    return float(np.exp(found.x)), float(found.fun)
