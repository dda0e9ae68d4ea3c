"""Equations that are misprinted, and slips of the text: each measured by a number that must fit."""

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import dawsn, ellipk, gamma, spence

from viscotack import RelaxationPowerLaw
from viscotack.theory import greenwood, jkr, maugis, persson_brener, punch

from ..figures.cases import ALPHA, ALPHA_LJ, LENS, PDMS, PDMS_WORK, solid
from ..figures.elastic import ONE, UNIT, strength
from ..figures.lens import SHORT, TIP
from .claim import Measured, Of, listed

_SOLID = solid()
_IN_SI = {"radius": 5e-3, "contact_modulus": 2e6, "work_of_adhesion": 0.15}


def tabor_printed(of: Of) -> Measured:
    """Return Eq. 2.2 as printed in two systems of units, one over the other; it must be 1."""
    length, mass = 1e3, 1e2

    def printed(R: float, w: float, E: float, h: float, power: int) -> float:
        return (R * w**2 / (E**power * h**3)) ** (1 / 3)

    ratio = [
        printed(5e-3 * length, 0.15 * mass, 2e6 * mass / length, 1e-6 * length, power)
        / printed(5e-3, 0.15, 2e6, 1e-6, power)
        for power in (1, 2)
    ]
    return Measured(ratio[0], f"printed {ratio[0]:.3g}; with E*² {ratio[1]:.6g}")


def stress_intensity(of: Of) -> Measured:
    """Return the limit of Eq. 2.5 of the pressure of Eq. 2.9 over sqrt(2 E* dg0)."""
    a, x = 2e-4, 2e-4 * 1e-10
    tension = -float(jkr.pressure(a - x, contact_radius=a, **_IN_SI))
    expected = np.sqrt(2 * _IN_SI["contact_modulus"] * _IN_SI["work_of_adhesion"])
    found = tension * np.sqrt(2 * np.pi * x) / expected
    return Measured(float(found), f"{found:.5f} of sqrt(2E*Δγ0) for x → 0")


def jump_twice(of: Of) -> Measured:
    """Return the strain by Eq. 2.14 after a step of stress, as printed over the true one."""
    after = float(np.real(_SOLID.creep(1.0)))
    # the integral from before the step holds the jump already
    printed = after + after
    return Measured(printed / after, f"{printed:.5f} as printed, {after:.5f} true (t = τ)")


def greenwood_relaxation(of: Of) -> Measured:
    """Return Greenwood's energy with the two readings of tau, from his own zone integral."""
    energy, k = 2.0, 0.1
    speed = float(greenwood.speed(energy, material=_SOLID))
    alpha = energy / speed

    def zone(a: float) -> float:
        return 1 - 2 / a * quad(dawsn, 0, np.sqrt(a))[0]

    with_retardation = 1 / (k + (1 - k) * zone(alpha))
    with_relaxation = 1 / (k + (1 - k) * zone(k * alpha))
    return Measured(
        with_retardation / energy,
        f"Γ = {with_retardation:.4f} at the speed of 2 with d/Vτ_ret; {with_relaxation:.3f} if "
        "the k of Eq. 2.16 is kept with a retardation time",
    )


def sign(of: Of) -> Measured:
    """Return the amplification of Eq. 2.18 with both signs, SLS, k = 0.1, b = 3."""
    k, b = 0.1, 3.0
    part = (1 - k) * (np.sqrt(1 + b**-2) - 1 / b)
    right, printed = 1 / (1 - part), 1 / (1 + part)
    return Measured(printed, f"printed {printed:.4f}, with −Im(1/E) {right:.4f}")


def tip_length(of: Of) -> Measured:
    """Return the amplification at 2 pi v tau/l0 = 1 with the printed a0, over the right one."""
    v = np.array([1.0, 2.0]) / (2 * np.pi)
    right, printed = np.asarray(persson_brener.amplification(v, material=_SOLID))
    return Measured(printed / right, f"Γ = {printed:.4f} instead of {right:.4f}")


def strength_ratio(of: Of) -> Measured:
    """Return the ratio of critical and peak stress that the beta of appendix II means."""
    cohesion, speed, energy = 0.05, 3.0, 2.0
    beta = 64 * cohesion / (9 * np.sqrt(3))
    # x = 2 pi v tau0/l0 over the energy (Eq. 2.18) is beta V/energy (appendix II, Eq. 3)
    x = beta * speed / energy
    tip = 2 * np.pi * speed / (x * energy)
    # l0/h0 = E0* dg0/(pi (alpha sigma0)^2 h0) with dg0 = alpha_LJ sigma0 h0
    found = float(np.sqrt(ALPHA_LJ / (np.pi * cohesion * tip)))
    return Measured(found, f"{found:.4f} = √2/π by β = 64Σ0/(9√3); π/9 = {ALPHA:.3f} in chapter 4")


def process_zone(of: Of) -> Measured:
    """Return a0 of Eq. 3.3 over a0 of the nomenclature, E* = E0 for both."""
    modulus, work, strength = 1.3, 0.7, 2.1
    punch_length = float(
        punch.fracture_length(contact_modulus=modulus, work_of_adhesion=work, strength=strength)
    )
    listed = modulus * work / (2 * np.pi * strength**2)
    ratio = punch_length / listed
    return Measured(ratio, f"{ratio:.4f} = π² times the one of the nomenclature")


def reference_speed(of: Of) -> Measured:
    """Return the speed at which k (a v)^n = 1 over the printed v_ref."""
    k, a, n = 2.0, 3.0, 0.6
    right = brentq(lambda v: k * (a * v) ** n - 1, 1e-6, 1.0)
    printed = 1 / (k * a**n)
    return Measured(
        right / printed, f"for k = 2, a = 3, n = 0.6: {right:.4f}, printed {printed:.4f}"
    )


def separation(of: Of) -> Measured:
    """Return Eq. 3.36 as printed for a reversible rigid punch, where it must be 1."""
    strength = 16 / (9 * np.sqrt(3))

    def tension(h: float) -> float:
        return 8 / 3 * (h**-3 - h**-9) / strength

    found = quad(tension, 1, np.inf)[0]
    return Measured(found, f"{found:.6f} as printed, {found / ALPHA_LJ:.6f} with 1/α_LJ")


def hertz(of: Of) -> Measured:
    """Return Eq. 4.13 as printed for the pressure of Hertz at r = 0.3, over the true one."""
    r = 0.3

    def kernel(s: float) -> float:
        low, high = min(r, s), max(r, s)
        return 4 / (np.pi * high) * float(ellipk((low / high) ** 2))

    def integral(power: int) -> float:
        parts = [(0, r), (r, 1)]
        return sum(
            quad(lambda s: np.sqrt(1 - s * s) * kernel(s) * s**power, *part, limit=200)[0]
            for part in parts
        )

    exact = np.pi / 4 * (2 - r**2)
    printed, right = integral(0), integral(1)
    return Measured(
        printed / exact, f"{printed:.4f} printed, {right:.6f} with s ds, {exact:.6f} true"
    )


def rate_units(of: Of) -> Measured:
    """Return r/(tau0 h0) and r tau0/h0 in milliseconds over that in seconds; both must be 1."""
    in_s, in_ms = (1e-4, 0.02), (1e-4 * 1e-3, 0.02 * 1e3)
    printed, right = (
        (in_ms[0] * in_ms[1] ** power) / (in_s[0] * in_s[1] ** power) for power in (-1, 1)
    )
    return Measured(printed, f"{printed:.0e} as printed, {right:.3g} for rτ0/h0")


def hidden_group(of: Of) -> Measured:
    """Return R/h0 for which l0 = h0 at mu = 3.24, as chapter 5 takes it."""
    ratio = (np.pi * ALPHA**2 / ALPHA_LJ**2 * 3.24**1.5) ** 2
    return Measured(ratio, f"only if R = {ratio:.3f} h0")


def off_by_one(of: Of) -> Measured:
    """Return the largest error of Eq. 34 as printed for a ramp of stress in 20 steps."""
    material = solid(0.01, 0.6)
    errors = []
    for steps in (20, 40, 80):
        t = np.linspace(0, 1, steps + 1)
        creep = np.asarray(material.creep(t))
        fine = np.linspace(0, 1, 20_001)
        exact = np.trapezoid(np.asarray(material.creep(fine)), fine)
        # the sum to m = q asks for a step that is not there yet
        printed = np.sum(creep[::-1][:-1]) / steps
        errors.append(abs(printed - exact))
    order = np.log2(errors[0] / errors[2]) / 2
    return Measured(
        float(order), f"order {order:.2f}: {errors[0]:.2g} at 20 steps, {errors[2]:.2g} at 80"
    )


def contact_modulus(of: Of) -> Measured:
    """Return what Eq. 42 is off by with E0 in the place of E0*, for a Poisson ratio of 1/2."""
    off = (1 / (1 - 0.25)) ** (2 / 3)
    return Measured(off, f"a factor {off:.4f} at ν = 1/2")


def load_unit(of: Of) -> Measured:
    """Return the least force of Eq. 44 as printed; in its unit it must be -1."""
    a = np.linspace(0.5, 2, 30_001)
    printed = np.min(2 * a**3 - 1.5 * np.sqrt(8 * a**3))
    true = np.min(np.asarray(jkr.force(a, **UNIT))) / 1.5
    return Measured(float(printed), f"least {printed:.4f} as printed, {true:.4f} true")


def jkr_work(of: Of) -> Measured:
    found = float(jkr.work_to_pull_off(**UNIT)) / 1.5
    return Measured(found, f"{found:.6f} μπ^(2/3)")


def instability(of: Of) -> Measured:
    found = jkr.pull_off(**UNIT)
    return Measured(
        float(found.depth), f"{float(found.depth):.6f}, a = {float(found.contact_radius):.6f}"
    )


def modulus_ratio(of: Of) -> Measured:
    return Measured(PDMS.modulus_ratio, f"{PDMS.modulus_ratio:.5g} (1.458/3089)")


def total_time(of: Of) -> Measured:
    return Measured(
        8505 * 1.76e3, f"{8505 * 1.76e3:.3g} s; the mean would be {1.66e7 / 8505:.0f} s"
    )


def peak(of: Of) -> Measured:
    found = 9 * np.sqrt(3) / 16
    return Measured(found, f"{found:.6f}")


def tip_of_pdms(of: Of) -> Measured:
    return Measured(1e9 * TIP, f"{1e9 * TIP:.2f} nm with E0*; {1e9 * TIP * 0.75:.1f} nm with E0")


def quasi_static_range(of: Of) -> Measured:
    h0 = (LENS * PDMS_WORK**2 / PDMS.contact_modulus**2 / 2.05**3) ** (1 / 3)
    return Measured(1e6 * h0, f"{1e6 * h0:.3f} µm")


def short_tabor(of: Of) -> Measured:
    mu = (LENS * PDMS_WORK**2 / PDMS.contact_modulus**2 / SHORT**3) ** (1 / 3)
    return Measured(mu, f"μ = {mu:.1f} for 30.8 nm, where 3.24 was simulated")


def bonded(of: Of) -> Measured:
    """Return the depth of pull-off of a bonded layer over that of Eq. (1) of appendix I."""
    case = {"contact_modulus": 2e6, "work_of_adhesion": 0.1}
    depth = float(
        punch.thin_layer_depth_at_pull_off(1e-4, base=punch.Bonded(poisson_ratio=0.3), **case)
    )
    zeta = 0.7**2 / 0.4
    printed = np.sqrt(2 * 1e-4 * 0.1 / (zeta * 2e6))
    return Measured(depth / printed, f"{depth / printed:+.4f} of it: a depth of tension")


def two_materials(of: Of) -> Measured:
    """Return the largest |E_H C_L - 1| of the two power laws with the same n and tau0."""
    parts = {"rubbery_modulus": 1.0, "glassy_modulus": 10.0, "tau0": 1.0, "poisson_ratio": 0.0}
    w = np.geomspace(1e-8, 1e8, 321)
    found = []
    for n in (0.2, 0.6, 1.6):
        by_h = np.asarray(RelaxationPowerLaw(exponent=n, **parts).complex_modulus(w))
        by_l = np.asarray(solid(0.1, n).complex_compliance(w))
        found.append(float(np.max(np.abs(by_h * by_l - 1))))
    words = f"E_H C_L is off 1 by {listed('{:.1f}', found)} for n = 0.2, 0.6, 1.6"
    return Measured(found[0], words)


def kramers_kronig(of: Of) -> Measured:
    """Return the largest miss of Eq. 4.26 by the fitted modulus, over the loss modulus."""
    w = np.geomspace(1e-6, 1e22, 421)
    modulus: object = PDMS.complex_modulus(w)
    storage, loss = np.real(np.asarray(modulus)), np.imag(np.asarray(modulus))
    found = _loss_from_storage(w, storage)
    inside = (w > 1e-2) & (w < 1e12)
    off = float(np.max(np.abs(found[inside] / loss[inside] - 1)))
    return Measured(off, f"met within {100 * off:.2g} % over 14 decades")


def _loss_from_storage(omega: np.ndarray, storage: np.ndarray) -> np.ndarray:
    """Return the loss modulus by Eq. 4.26 integrated by parts, storage linear in ln omega.

    The integral of ln coth|t/2| from 0 to y is pi^2/4 less half the difference of two dilogarithms.
    """
    y = np.log(omega)
    apart = y[None, :] - y[:, None]
    z = np.exp(-np.abs(apart))
    integral = np.sign(apart) * (np.pi**2 / 4 - (spence(1 - z) - spence(1 + z)))
    return np.diff(integral, axis=1) @ (np.diff(storage) / np.diff(y)) / np.pi


def creep_forms(of: Of) -> Measured:
    """Return the largest difference of Eq. 4.9 from the integral of Eq. 4.8, n = 0.6."""
    material = solid(0.1, 0.6)
    off = 0.0
    for t in (1e-3, 0.1, 1.0, 30.0):
        parts = [
            quad(lambda y, t=t: np.exp(0.6 * y - np.exp(y)) * -np.expm1(-t / np.exp(y)), a, a + 4)[
                0
            ]
            for a in range(-60, 8, 4)
        ]
        exact = 0.1 + 0.9 * sum(parts) / gamma(0.6)
        off = max(off, abs(float(np.real(material.creep(t))) / exact - 1))
    return Measured(off, f"within {max(off, 1e-10):.0e} at four times")


def maugis_lj(of: Of) -> Measured:
    """Return the force of Maugis-Dugdale at mu = 5 over JKR, that of Fig. 2.2b."""
    force, low = (float(maugis.pull_off_force(strength=strength(mu), **ONE)) for mu in (5.0, 0.01))
    words = f"{force / 1.5 / np.pi:.4f} of JKR at μ = 5; {low / 2 / np.pi:.4f} of DMT at 0.01"
    return Measured(force / (1.5 * np.pi), words)
