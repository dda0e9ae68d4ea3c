"""Equations that are misprinted, and slips of the text: each measured by a number that must fit."""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import dawsn, ellipk

from viscotack import RetardationPowerLaw, StandardSolid
from viscotack.theory import greenwood, jkr, maugis, persson_brener, punch

from ..figures.cases import ALPHA, ALPHA_LJ, LENS, PDMS, PDMS_WORK, solid
from ..figures.figure_2_1 import UNIT
from ..figures.figure_2_2b import UNIT as ONE
from ..figures.figure_2_2b import strength
from ..figures.figure_4_10 import SHORT, TIP
from .claim import Claim, Measured, Of, Verdict

_SOLID = StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
_IN_SI = {"radius": 5e-3, "contact_modulus": 2e6, "work_of_adhesion": 0.15}


def _tabor_printed(of: Of) -> Measured:
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


def _stress_intensity(of: Of) -> Measured:
    """Return the limit of Eq. 2.5 of the pressure of Eq. 2.9 over sqrt(2 E* dg0)."""
    a, x = 2e-4, 2e-4 * 1e-10
    tension = -float(jkr.pressure(a - x, contact_radius=a, **_IN_SI))
    expected = np.sqrt(2 * _IN_SI["contact_modulus"] * _IN_SI["work_of_adhesion"])
    found = tension * np.sqrt(2 * np.pi * x) / expected
    return Measured(float(found), f"{found:.5f} of sqrt(2E*Δγ0) for x → 0")


def _jump_twice(of: Of) -> Measured:
    """Return the strain by Eq. 2.14 after a step of stress, as printed over the true one."""
    after = float(np.real(_SOLID.creep(1.0)))
    # the integral from before the step holds the jump already
    printed = after + after
    return Measured(printed / after, f"{printed:.5f} as printed, {after:.5f} true (t = τ)")


def _greenwood(of: Of) -> Measured:
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


def _sign(of: Of) -> Measured:
    """Return the amplification of Eq. 2.18 with both signs, SLS, k = 0.1, b = 3."""
    k, b = 0.1, 3.0
    part = (1 - k) * (np.sqrt(1 + b**-2) - 1 / b)
    right, printed = 1 / (1 - part), 1 / (1 + part)
    return Measured(printed, f"printed {printed:.4f}, with −Im(1/E) {right:.4f}")


def _tip_length(of: Of) -> Measured:
    """Return the amplification at 2 pi v tau/l0 = 1 with the printed a0, over the right one."""
    v = np.array([1.0, 2.0]) / (2 * np.pi)
    right, printed = np.asarray(persson_brener.amplification(v, material=_SOLID))
    return Measured(printed / right, f"Γ = {printed:.4f} instead of {right:.4f}")


def _strength_ratio(of: Of) -> Measured:
    """Return the ratio of critical and peak stress that the beta of appendix II means."""
    cohesion, speed, energy = 0.05, 3.0, 2.0
    beta = 64 * cohesion / (9 * np.sqrt(3))
    # x = 2 pi v tau0/l0 over the energy (Eq. 2.18) is beta V/energy (appendix II, Eq. 3)
    x = beta * speed / energy
    tip = 2 * np.pi * speed / (x * energy)
    # l0/h0 = E0* dg0/(pi (alpha sigma0)^2 h0) with dg0 = alpha_LJ sigma0 h0
    found = float(np.sqrt(ALPHA_LJ / (np.pi * cohesion * tip)))
    return Measured(found, f"{found:.4f} = √2/π by β = 64Σ0/(9√3); π/9 = {ALPHA:.3f} in chapter 4")


def _process_zone(of: Of) -> Measured:
    """Return a0 of Eq. 3.3 over a0 of the nomenclature, E* = E0 for both."""
    modulus, work, strength = 1.3, 0.7, 2.1
    punch_length = float(
        punch.fracture_length(contact_modulus=modulus, work_of_adhesion=work, strength=strength)
    )
    listed = modulus * work / (2 * np.pi * strength**2)
    ratio = punch_length / listed
    return Measured(ratio, f"{ratio:.4f} = π² times the one of the nomenclature")


def _reference_speed(of: Of) -> Measured:
    """Return the speed at which k (a v)^n = 1 over the printed v_ref."""
    k, a, n = 2.0, 3.0, 0.6
    right = brentq(lambda v: k * (a * v) ** n - 1, 1e-6, 1.0)
    printed = 1 / (k * a**n)
    return Measured(
        right / printed, f"for k = 2, a = 3, n = 0.6: {right:.4f}, printed {printed:.4f}"
    )


def _separation(of: Of) -> Measured:
    """Return Eq. 3.36 as printed for a reversible rigid punch, where it must be 1."""
    strength = 16 / (9 * np.sqrt(3))

    def tension(h: float) -> float:
        return 8 / 3 * (h**-3 - h**-9) / strength

    found = quad(tension, 1, np.inf)[0]
    return Measured(found, f"{found:.6f} as printed, {found / ALPHA_LJ:.6f} with 1/α_LJ")


def _hertz(of: Of) -> Measured:
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


def _rate_units(of: Of) -> Measured:
    """Return r/(tau0 h0) and r tau0/h0 in milliseconds over that in seconds; both must be 1."""
    in_s, in_ms = (1e-4, 0.02), (1e-4 * 1e-3, 0.02 * 1e3)
    printed, right = (
        (in_ms[0] * in_ms[1] ** power) / (in_s[0] * in_s[1] ** power) for power in (-1, 1)
    )
    return Measured(printed, f"{printed:.0e} as printed, {right:.3g} for rτ0/h0")


def _hidden_group(of: Of) -> Measured:
    """Return R/h0 for which l0 = h0 at mu = 3.24, as chapter 5 takes it."""
    ratio = (np.pi * ALPHA**2 / ALPHA_LJ**2 * 3.24**1.5) ** 2
    return Measured(ratio, f"only if R = {ratio:.3f} h0")


def _off_by_one(of: Of) -> Measured:
    """Return the largest error of Eq. 34 as printed for a ramp of stress in 20 steps."""
    material = RetardationPowerLaw(
        rubbery_modulus=1.0, glassy_modulus=100.0, exponent=0.6, tau0=1.0, poisson_ratio=0.0
    )
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


def _contact_modulus(of: Of) -> Measured:
    """Return what Eq. 42 is off by with E0 in the place of E0*, for a Poisson ratio of 1/2."""
    off = (1 / (1 - 0.25)) ** (2 / 3)
    return Measured(off, f"a factor {off:.4f} at ν = 1/2")


def _load_unit(of: Of) -> Measured:
    """Return the least force of Eq. 44 as printed; in its unit it must be -1."""
    a = np.linspace(0.5, 2, 30_001)
    printed = np.min(2 * a**3 - 1.5 * np.sqrt(8 * a**3))
    true = np.min(np.asarray(jkr.force(a, **UNIT))) / 1.5
    return Measured(float(printed), f"least {printed:.4f} as printed, {true:.4f} true")


def _jkr_work(of: Of) -> Measured:
    found = float(jkr.work_to_pull_off(**UNIT)) / 1.5
    return Measured(found, f"{found:.6f} μπ^(2/3)")


def _instability(of: Of) -> Measured:
    found = jkr.pull_off(**UNIT)
    return Measured(
        float(found.depth), f"{float(found.depth):.6f}, a = {float(found.contact_radius):.6f}"
    )


def _modulus_ratio(of: Of) -> Measured:
    return Measured(PDMS.modulus_ratio, f"{PDMS.modulus_ratio:.5g} (1.458/3089)")


def _total_time(of: Of) -> Measured:
    return Measured(
        8505 * 1.76e3, f"{8505 * 1.76e3:.3g} s; the mean would be {1.66e7 / 8505:.0f} s"
    )


def _peak(of: Of) -> Measured:
    found = 9 * np.sqrt(3) / 16
    return Measured(found, f"{found:.6f}")


def _tip(of: Of) -> Measured:
    return Measured(1e9 * TIP, f"{1e9 * TIP:.2f} nm with E0*; {1e9 * TIP * 0.75:.1f} nm with E0")


def _quasi_static_range(of: Of) -> Measured:
    h0 = (LENS * PDMS_WORK**2 / PDMS.contact_modulus**2 / 2.05**3) ** (1 / 3)
    return Measured(1e6 * h0, f"{1e6 * h0:.3f} µm")


def _short_tabor(of: Of) -> Measured:
    mu = (LENS * PDMS_WORK**2 / PDMS.contact_modulus**2 / SHORT**3) ** (1 / 3)
    return Measured(mu, f"μ = {mu:.1f} for 30.8 nm, where 3.24 was simulated")


def _bonded(of: Of) -> Measured:
    """Return the depth of pull-off of a bonded layer over that of Eq. (1) of appendix I."""
    case = {"contact_modulus": 2e6, "work_of_adhesion": 0.1}
    depth = float(
        punch.thin_layer_depth_at_pull_off(1e-4, base=punch.Bonded(poisson_ratio=0.3), **case)
    )
    zeta = 0.7**2 / 0.4
    printed = np.sqrt(2 * 1e-4 * 0.1 / (zeta * 2e6))
    return Measured(depth / printed, f"{depth / printed:+.4f} of it: a depth of tension")


def _two_materials(of: Of) -> Measured:
    """Return the largest |E_H C_L - 1| of the two power laws with the same n and tau0."""
    from viscotack import RelaxationPowerLaw

    parts = {"rubbery_modulus": 1.0, "glassy_modulus": 10.0, "tau0": 1.0, "poisson_ratio": 0.0}
    w = np.geomspace(1e-8, 1e8, 321)
    found = []
    for n in (0.2, 0.6, 1.6):
        by_h = np.asarray(RelaxationPowerLaw(exponent=n, **parts).complex_modulus(w))
        by_l = np.asarray(RetardationPowerLaw(exponent=n, **parts).complex_compliance(w))
        found.append(float(np.max(np.abs(by_h * by_l - 1))))
    words = ", ".join(f"{x:.1f}" for x in found)
    return Measured(found[0], f"E_H C_L is off 1 by {words} for n = 0.2, 0.6, 1.6")


def _kramers_kronig(of: Of) -> Measured:
    """Return the largest miss of Eq. 4.26 by the fitted modulus, over the loss modulus."""
    from viscotack.lab import loss_from_storage

    w = np.geomspace(1e-6, 1e22, 421)
    modulus: object = PDMS.complex_modulus(w)
    storage, loss = np.real(np.asarray(modulus)), np.imag(np.asarray(modulus))
    found = np.asarray(loss_from_storage(w, storage))
    inside = (w > 1e-2) & (w < 1e12)
    off = float(np.max(np.abs(found[inside] / loss[inside] - 1)))
    return Measured(off, f"met within {100 * off:.2g} % over 14 decades")


def _creep_forms(of: Of) -> Measured:
    """Return the largest difference of Eq. 4.9 from the integral of Eq. 4.8, n = 0.6."""
    from scipy.special import gamma

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


def _maugis_lj(of: Of) -> Measured:
    """Return the force of Maugis-Dugdale at mu = 5 over JKR, that of Fig. 2.2b."""
    force, low = (float(maugis.pull_off_force(strength=strength(mu), **ONE)) for mu in (5.0, 0.01))
    words = f"{force / 1.5 / np.pi:.4f} of JKR at μ = 5; {low / 2 / np.pi:.4f} of DMT at 0.01"
    return Measured(force / (1.5 * np.pi), words)


CLAIMS = (
    Claim(
        "tabor",
        "Eq. 2.2",
        "The Tabor number is (RΔγ0²/(E*h0³))^(1/3)",
        1.0,
        _tabor_printed,
        (0.46, 0.47),
        Verdict.CORRECTED,
        "with one E* it changes with the units; Eq. 31 has E*²",
    ),
    Claim(
        "stress-intensity",
        "Eq. 2.5",
        "K_I is the limit of σ√(2πx) for ρ → 0",
        1.0,
        _stress_intensity,
        (0.9999, 1.0001),
        Verdict.CORRECTED,
        "the limit is x → 0: so Eq. 2.9 has K_I = √(2E*Δγ0)",
    ),
    Claim(
        "maugis",
        "Sec. 2.3, Fig. 2.2b",
        "Maugis-Dugdale passes from DMT to JKR",
        "1 at large μ",
        _maugis_lj,
        (1.0, 1.01),
        Verdict.HOLDS,
        "closed form, checked to 12 digits",
    ),
    Claim(
        "jkr-pull-off",
        "Sec. 2.2",
        "The pull-off is at δ = −3^(1/3)/4 (π²Δγ0²R/E*²)^(1/3)",
        -(3 ** (1 / 3)) / 4,
        _instability,
        (-0.36057, -0.36056),
        Verdict.HOLDS,
        "closed form",
    ),
    Claim(
        "history-integral",
        "Eq. 2.14, 2.15",
        "ε = σ(0)C + ∫ from −∞ of C dσ",
        1.0,
        _jump_twice,
        (1.99, 2.01),
        Verdict.CORRECTED,
        "a step is counted twice: begin the integral at 0⁺, or leave σ(0) out",
    ),
    Claim(
        "greenwood-time",
        "Eq. 2.16",
        "α = kd/(Vτ), with τ of the material",
        1.0,
        _greenwood,
        (0.9999, 1.0001),
        Verdict.CORRECTED,
        "there τ is the relaxation time; with the retardation time of Eq. 3.26 the k falls away, "
        "as in Eq. 3.34; d is l0 Δγ_eff/Δγ0",
    ),
    Claim(
        "persson-sign",
        "Eq. 2.18",
        "Γ = [1 − E0 (2/π) ∫ Im(1/E) …]⁻¹",
        2.8464,
        _sign,
        (0.6, 0.61),
        Verdict.CORRECTED,
        "with E = E′ + iE″ the sign of Im(1/E) is the other one: else Γ < 1",
    ),
    Claim(
        "persson-length",
        "Eq. 2.18, footnote",
        "a0 = E0Δγ0/(2πσc²) against a rigid body",
        1.0,
        _tip_length,
        (1.2, 1.24),
        Verdict.CORRECTED,
        "with G = K²/2E* it is E0*Δγ0/(πσc²), Eq. 4.23; the printed one is of two equal bodies",
    ),
    Claim(
        "strength-ratio",
        "Nomenclature, App. II",
        "α = σc/σ0 ≈ π/9",
        float(np.pi / 9),
        _strength_ratio,
        (0.4501, 0.4502),
        Verdict.CORRECTED,
        "in chapter 4, where it is fitted; the curves of Fig. A.1 have √2/π, which is a crack 1.66 "
        "times as fast at one energy",
    ),
    Claim(
        "process-zone",
        "Nomenclature, Eq. 3.3, 2.18",
        "a0 = E0Δγ0/(2πσ0²) is the process-zone size",
        1.0,
        _process_zone,
        (9.869, 9.870),
        Verdict.CORRECTED,
        "chapter 3 has πE*Δγ0/(2σ0²); the footnote to Eq. 2.18 has σc for σ0; in chapter 4 a0 is "
        "the radius of the start",
    ),
    Claim(
        "gent-schultz-speed",
        "Eq. 2.19",
        "v_ref = (k a^n)⁻¹",
        1.0,
        _reference_speed,
        (0.4, 0.41),
        Verdict.CORRECTED,
        "v_ref = (k a^n)^(−1/n)",
    ),
    Claim(
        "strength",
        "Eq. 3.5, 3.17",
        "Δγ0 = (9√3/16) σ0 h0",
        9 * 3**0.5 / 16,
        _peak,
        (0.97427, 0.97429),
        Verdict.HOLDS,
        "peak of the law at 3^(1/6) h0",
    ),
    Claim(
        "work-of-separation",
        "Eq. 3.36",
        "ŵ_sep = ∫ σ̂ dδ̂",
        1.0,
        _separation,
        (0.974, 0.975),
        Verdict.CORRECTED,
        "over −δ̂ and divided by α_LJ: the reversible work of a rigid body must be 1",
    ),
    Claim(
        "deflection",
        "Eq. 4.13",
        "u = (1/E0*) ∫ σ G ds",
        1.0,
        _hertz,
        (2.9, 3.1),
        Verdict.CORRECTED,
        "an s is missing under the integral, which Eq. 4.15 has",
    ),
    Claim(
        "creep",
        "Eq. 4.8, 4.9",
        "The creep of the power law has a closed form with K_n",
        0.0,
        _creep_forms,
        (0, 1e-8),
        Verdict.HOLDS,
        "against the integral over the spectrum",
    ),
    Claim(
        "two-solids",
        "Eq. 4.4, 4.9, Fig. 4.2",
        "R(t) and C(t) are of one material",
        0.0,
        _two_materials,
        (7, 9),
        Verdict.CORRECTED,
        "with the same n and τ0 they are two: simulation, theory and PDMS use the retardation form",
    ),
    Claim(
        "kramers-kronig",
        "Eq. 4.26",
        "The modulus of PDMS satisfies Kramers-Kronig",
        0.0,
        _kramers_kronig,
        (0, 0.02),
        Verdict.OPEN,
        "the fit of Eq. 4.27 does, as any linear solid; the measured modulus is not published",
    ),
    Claim(
        "tip-of-pdms",
        "Sec. 4.7",
        "l0 = 30.0 nm for h0 = 30.8 nm",
        30.0,
        _tip,
        (29.9, 30.1),
        Verdict.HOLDS,
        "arithmetic of Eq. 4.23",
    ),
    Claim(
        "range-of-pdms",
        "Sec. 4.7.2",
        "μ = 2.05 means h0 = 1.55 µm [µm]",
        1.55,
        _quasi_static_range,
        (1.54, 1.56),
        Verdict.HOLDS,
        "arithmetic of Eq. 31",
    ),
    Claim(
        "tabor-of-pdms",
        "Sec. 4.5, 4.6",
        "Eq. 4.24, fitted at μ = 3.24, serves for PDMS",
        3.24,
        _short_tabor,
        (100, 106),
        Verdict.FAILS,
        "30 times the Tabor number of the fit",
    ),
    Claim(
        "modulus-ratio",
        "Sec. 4.7.1",
        "k = 4.73e-4 of PDMS",
        4.73e-4,
        _modulus_ratio,
        (4.719e-4, 4.721e-4),
        Verdict.CORRECTED,
        "rounding",
    ),
    Claim(
        "rate",
        "Sec. 5.2",
        "r̂ = r/(τ0 h0)",
        1.0,
        _rate_units,
        (0, 1e-3),
        Verdict.CORRECTED,
        "r τ0/h0 as in Sec. 4.4; the other changes with the unit of time",
    ),
    Claim(
        "rate-of-the-fit",
        "Eq. 4.24, Sec. 5.2",
        "v̂ = 2.887 r̂^1.171 holds for rτ0/l0 and for rτ0/h0",
        1.0,
        _hidden_group,
        (5.5, 5.6),
        Verdict.FAILS,
        "these are two rates: l0 = h0 for one sphere alone; the authors' script uses a third, "
        "r_u/(3.24 π^(2/3))",
    ),
    Claim(
        "bonded",
        "App. I (1)",
        "δ_po = +√(2bΔγ/ζE*)",
        1.0,
        _bonded,
        (-1.0001, -0.9999),
        Verdict.CORRECTED,
        "δ_po is negative, as in Eq. 3.9",
    ),
    Claim(
        "history-sum",
        "App. V (34)",
        "The printed sum is the hereditary integral",
        2.0,
        _off_by_one,
        (0.9, 1.1),
        Verdict.CORRECTED,
        "its index asks for a step to come; read as one can, it is of first order. Means of C "
        "over the steps are exact for ramps",
    ),
    Claim(
        "work-scale",
        "App. VIII (42)",
        "ŵ_po has E0^(2/3) in its denominator",
        1.0,
        _contact_modulus,
        (1.2, 1.22),
        Verdict.CORRECTED,
        "it is E0*, as Eq. 43 needs",
    ),
    Claim(
        "load-scale",
        "App. IX (44)",
        "P̂ = 2â³ − 1.5√(8â³)",
        -1.0,
        _load_unit,
        (-2.26, -2.24),
        Verdict.CORRECTED,
        "multiplied by 1.5 instead of divided, and the unit of force has no h0",
    ),
    Claim(
        "jkr-work",
        "App. IX (46)",
        "The work to pull-off of JKR is 0.80182 μπ^(2/3)",
        0.80182,
        _jkr_work,
        (0.801822, 0.801823),
        Verdict.HOLDS,
        "closed form and quadrature",
    ),
    Claim(
        "simulation-time",
        "Sec. 5.4.1",
        "8,505 cases of 1.76e3 s are 1.66e7 s",
        1.66e7,
        _total_time,
        (1.4e7, 1.6e7),
        Verdict.CORRECTED,
        "the mean and the sum do not agree",
    ),
)
