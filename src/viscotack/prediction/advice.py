"""Advice on a problem: its regime, the best prediction, and the estimate of every tier."""

from __future__ import annotations

from dataclasses import dataclass, replace

from viscotack.errors import OutOfRange
from viscotack.model.geometry import Sphere
from viscotack.model.materials import Elastic
from viscotack.model.problem import Groups, Problem
from viscotack.model.problem.revolution import ELASTIC_TABOR, LARGEST_CONTACT, SIMULATED_TABOR
from viscotack.simulate.crack_contact import too_short
from viscotack.simulate.crack_contact.crack_problem import ROOT
from viscotack.units import readable

from .cautions import LINEAR_SPEED, beyond_linear
from .closed_forms import Estimate, check_test, is_classic
from .other_contacts import SATURATED, TOLERANCES, OtherContact, check_contact, other_contact
from .prediction import Prediction
from .theories import (
    CLOSED_FORM,
    CRACK_CONTACT_VERIFIED,
    closed_form_limits,
    crack_limits,
    estimate_of,
    forms_of,
)
from .tier import LEARNED_PUNCH, SIMULATION, Question, Tier
from .tiers import CLOSED_FORMS, CRACK, EXACT, SOON, TIERS, best

# Strain of a film up to which linear elasticity is a good approximation.
_SMALL_FILM_STRAIN = 0.1
_ADHESION = {
    "jkr": "The forces have a short range: the contact peels like a crack (JKR).",
    "transition": "The range of the forces matters: neither JKR nor DMT alone holds.",
    "dmt": "The forces have a long range: the whole contact opens simultaneously (DMT).",
}
_REGIMES = {
    "elastic": "The solid is elastic: the computed force does not depend on speed.",
    "quasi-static": "The retraction is slow: the solid stays relaxed (rubbery).",
    "rate-dependent": "The retraction is fast enough for dissipation: the force depends on speed.",
    "glassy": "The retraction is so fast that the edge is glassy: more speed adds little force.",
    "unknown": "The regime is unknown.",
}
_PRESSING = {
    "raises": "would raise the force: the start is small for this rate",
    "lowers": "would lower the force: a larger contact takes longer to detach, so the bulk "
    "relaxes more",
    "same": "would change the force by little or nothing",
}
# Tabor numbers of Johnson and Greenwood's map without load, in its Lennard-Jones form.
_DMT, _JKR = 0.1, 3.0
# Range-corrected Tabor number up to which a simulation takes about a second.
_FAST_TABOR = 15.0
_SMALL_STRAIN = 0.2


@dataclass(frozen=True)
class Advice:
    """Regime of a problem and the recommended tier; forces in 1.5 pi R dg0.

    Attributes
    ----------
    tabor : float
        Tabor number of the relaxed solid.
    effective_tabor, glassy_tabor : float
        Range-corrected Tabor number, by the effective range of the law (the same for
        Lennard-Jones), and that of the fast limit, times k^(1/3).
    adhesion : str
        "jkr" (range-corrected Tabor number above 3, and on a film forces that do not reach through
        it), "transition" or "dmt" (below 0.1).
    pull_off_force : float or None
        Prediction of :func:`viscotack.predict` with its default budget [1.5 pi R dg0]; None if
        no tier within it is verified for this problem.
    interval : tuple of float, or None
        90 % interval of this force.
    rate_regime : str
        "elastic" for a solid without rate dependence, "quasi-static", "rate-dependent", "glassy",
        or "unknown" without a prediction.
    amplification : float or None
        Predicted force over the force of the slowest retraction.
    start_radius : float or None
        Relaxed contact radius of the start by JKR [(pi R^2 dg0/E0*)^(1/3)]; None if there is none.
    preload : str
        Effect on the force of pressing to twice that radius: "raises" or "lowers", if the whole
        ``preload_change`` does, or "same"; "any" in quasi-static retraction, where the start has no
        effect; "unknown" below a range-corrected Tabor number of 1, without a start, and for laws
        as steep as Dugdale's.
    preload_change : tuple of float or None
        90 % interval of the relative change of the force by this pressing.
    crack_speed_at_pull_off_m_per_s : float or None
        Estimated speed of the edge at pull-off; None for groups, which have no units.
    beyond_linear : bool or None
        Whether this speed is above 100 um/s, where experiments exceed linear theory.
    strain : float or None
        Contact radius of the start over sphere radius; None for groups.
    small_strain : bool or None
        Whether this ratio is below 0.2.
    use : str
        Tier of the prediction; "simulation" if there is none.
    estimates : tuple of Estimate
        Estimates of all tiers.
    force_scale : float or None
        1.5 pi R dg0 [N]; None for groups.
    length_scale, speed_scale : float or None
        beta [m] and h0 per time unit [m/s]; None for groups.
    contact : OtherContact or None
        Limits by theory, and what the thickness of a film does; None for a sphere on a half-space.
    """

    tabor: float
    effective_tabor: float
    glassy_tabor: float
    adhesion: str
    pull_off_force: float | None
    interval: tuple[float, float] | None
    rate_regime: str
    amplification: float | None
    start_radius: float | None
    preload: str
    preload_change: tuple[float, float] | None
    crack_speed_at_pull_off_m_per_s: float | None
    beyond_linear: bool | None
    strain: float | None
    small_strain: bool | None
    use: str
    estimates: tuple[Estimate, ...]
    force_scale: float | None
    length_scale: float | None = None
    speed_scale: float | None = None
    contact: OtherContact | None = None

    @property
    def statements(self) -> tuple[str, ...]:
        """The regime, the prediction and its limits in words, without the table of the tiers."""
        return tuple(_statements(self))

    @property
    def tiers(self) -> tuple[str, ...]:
        """The estimate of each tier in words, and the tier to use."""
        return (*_tier_words(self), f"Use: {self.use}.")

    @property
    def sentences(self) -> tuple[str, ...]:
        """The advice in words."""
        return self.statements + self.tiers


def advise(problem: Problem | Groups) -> Advice:
    """Determine the regime of a problem, the best fast prediction, and every tier's estimate.

    Parameters
    ----------
    problem : Problem or Groups
        A Problem in SI allows all checks; groups do not determine strain and speeds in m/s.

    Returns
    -------
    Advice
        Regimes, the prediction of :func:`viscotack.predict`, the estimate of each tier with its
        validity, and sentences.

    Raises
    ------
    ValueError
        If it is not the retraction of a relaxed contact of revolution at constant speed.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, RetardationPowerLaw
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> advice = advise(Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=1))
    >>> f"{advice.use}: {advice.rate_regime}; pressing harder: {advice.preload}"
    'surrogate: rate-dependent; pressing harder: same'
    """
    return advice_on(Question(problem))


def advice_on(asked: Question) -> Advice:
    """Return :func:`advise` for a question with cached intermediate results."""
    problem, groups = asked.problem, asked.groups
    check_contact(groups)
    check_test(groups)
    elastic, mu = isinstance(groups.material, Elastic), groups.effective_tabor
    scales = problem.scales()
    contact = change = None
    adhesion = "dmt" if mu < _DMT else "jkr" if mu > _JKR else "transition"
    regime, preload = "elastic" if elastic else "unknown", "unknown"
    if is_classic(groups):
        found, forms = _best(asked), asked.once(forms_of)
        slow, edge_speed, start = forms.slowest, forms.edge_speed, forms.start_radius
        if not elastic and found is not None:
            regime = forms.regime_of(found.pull_off_force)
        if not (CLOSED_FORM.refuses(groups) or closed_form_limits(asked)):
            change = forms.preload_change
        if change is not None:
            preload = forms.preload
        estimates = tuple(estimate_by(x, asked) for x in TIERS if x.name != LEARNED_PUNCH)
    else:
        # the search for the relaxed start of a simulation takes a second on a film
        known = not (CRACK_CONTACT_VERIFIED.refuses(groups) or crack_limits(groups))
        found, contact = _best(asked) if known else None, other_contact(groups)
        slow, edge_speed = contact.slow_force, contact.edge_speed
        start = None if contact.start_radius is None else contact.start_radius / ROOT
        if not elastic:
            regime = contact.regime_of(None if found is None else found.pull_off_force)
        if contact.reaches_through and adhesion == "jkr":
            adhesion = "transition"
        if isinstance(problem, Problem) and (strain := contact.film_strain) is not None:
            strain *= problem.scales().radius / ROOT / problem.radius
            contact = replace(contact, film_strain=strain)
        estimates = (*contact.estimates, estimate_by(CRACK, asked), estimate_by(EXACT, asked))
    speed = strain = None
    if scales is not None and edge_speed is not None:
        speed = edge_speed * scales.edge_speed
    if scales is not None and start is not None and isinstance(problem.geometry, Sphere):
        strain = start * scales.radius / problem.geometry.radius
    return Advice(
        tabor=groups.tabor,
        effective_tabor=mu,
        glassy_tabor=mu * groups.modulus_ratio ** (1 / 3),
        adhesion=adhesion,
        pull_off_force=None if found is None else found.pull_off_force,
        interval=None if found is None else found.interval,
        rate_regime=regime,
        amplification=None if found is None else found.pull_off_force / slow,
        start_radius=start,
        preload="any" if regime in ("elastic", "quasi-static") else preload,
        preload_change=change,
        crack_speed_at_pull_off_m_per_s=speed,
        beyond_linear=None if speed is None else speed > LINEAR_SPEED,
        strain=strain,
        small_strain=None if strain is None else strain < _SMALL_STRAIN,
        use=SIMULATION if found is None else found.method,
        estimates=estimates,
        force_scale=None if scales is None else scales.force,
        length_scale=None if scales is None else scales.radius / ROOT,
        speed_scale=None if scales is None else scales.length / scales.time,
        contact=contact,
    )


def _best(asked: Question) -> Prediction | None:
    """Return the prediction of the best fast tier, None if there is none."""
    try:
        return best(asked, SOON)
    except OutOfRange:
        return None


def estimates_without_advice(asked: Question) -> tuple[Estimate, ...]:
    """Return the estimates of all tiers but the simulation, for contacts without an advice."""
    return tuple(estimate_by(tier, asked, limits=False) for tier in TIERS if tier is not EXACT)


def estimate_by(tier: Tier, asked: Question, *, limits: bool = True) -> Estimate:
    """Return the estimate of a tier; `limits` is for closed forms that do not apply."""
    if tier is EXACT:
        return _simulated(asked.groups)
    try:
        found = tier.ask(asked)
    except OutOfRange as reason:
        limited = limits and tier.name in CLOSED_FORMS
        limit = estimate_of(asked, tier.name).pull_off_force if limited else None
        return Estimate(tier.name, limit, None, False, str(reason))
    low, high = found.interval
    error = (high - low) / (2 * found.pull_off_force)
    return Estimate(tier.name, found.pull_off_force, error, True, found.why)


def _simulated(groups: Groups) -> Estimate:
    low, high = SIMULATED_TABOR
    if not low <= groups.effective_tabor <= high or too_short(groups):
        note = (
            f"the simulation accepts range-corrected Tabor numbers from {low:g} to {high:g}, for "
            "elastic solids to "
        )
        return Estimate(SIMULATION, None, 2e-3, False, f"{note}{ELASTIC_TABOR:g}")
    time = "about a second" if groups.effective_tabor < _FAST_TABOR else "some seconds"
    return Estimate(
        SIMULATION, None, 2e-3, True, f"the simulation accepts this problem and takes {time}"
    )


def _statements(advice: Advice) -> list[str]:
    """Describe the regime, the prediction and its limits."""
    effective = ""
    if abs(advice.effective_tabor / advice.tabor - 1) > 1e-9:
        effective = f", {advice.effective_tabor:.3g} (range-corrected) for the range of this law"
    headline = " No fast tier was verified here: simulate."
    if advice.pull_off_force is not None and advice.interval is not None:
        low, high = advice.interval
        between = f"{_force(advice, low, to=high)}, 90 % interval, by the tier {advice.use!r}"
        headline = f" Pull-off force {_force(advice, advice.pull_off_force)} ({between})"
        if advice.rate_regime != "elastic":
            headline += f": {advice.amplification:.3g} times the slow force"
        headline += "."
    found = [
        f"{_ADHESION[advice.adhesion]} Tabor number {advice.tabor:.3g}{effective}.",
        f"{_REGIMES[advice.rate_regime]}{headline}",
    ]
    if advice.contact is not None:
        found += _of_contact(advice, advice.contact)
    if advice.preload_change is not None:
        low, high = (100 * x for x in advice.preload_change)
        found.append(
            f"Pressing to twice the contact radius first {_PRESSING[advice.preload]} ({low:+.0f} "
            f"to {high:+.0f} %)."
        )
    if advice.beyond_linear and (speed := advice.crack_speed_at_pull_off_m_per_s) is not None:
        found.append(beyond_linear(speed))
    if advice.small_strain is False:
        found.append(
            f"The contact radius is {advice.strain:.2g} sphere radii: strains are not small "
            f"(linear elasticity holds up to about {LARGEST_CONTACT}); use the numbers as "
            "estimates."
        )
    return found


def _tier_words(advice: Advice) -> list[str]:
    """Describe the estimate of each tier."""
    found = []
    for e in advice.estimates:
        value = "" if e.pull_off_force is None else f" {e.pull_off_force:.4g} x 1.5 pi R dg0"
        if advice.force_scale is not None and e.pull_off_force is not None:
            value += f" = {_force(advice, e.pull_off_force)}"
        error = "" if e.error is None else f" (to {100 * e.error:.2g} %)"
        verb = "applies" if e.applies else "does not apply"
        found.append(f"{e.tier} {verb}:{value}{error}; {e.why}.".replace(":;", ":"))
    return found


def _force(advice: Advice, value: float, *, to: float | None = None) -> str:
    """Return a force, or a range of forces, with its unit."""
    scale, unit = advice.force_scale or 1.0, "N" if advice.force_scale else "x 1.5 pi R dg0"
    return readable(scale * value, unit, to=None if to is None else scale * to)


def _of_contact(advice: Advice, contact: OtherContact) -> list[str]:
    """Describe the limits of a contact, and the effect of the thickness of a film."""

    def length(value: float) -> str:
        return readable(
            value * (advice.length_scale or 1.0), "m" if advice.length_scale else "beta"
        )

    def speed(value: float) -> str:
        unit = "m/s" if advice.speed_scale else "h0/tau0"
        return readable(value * (advice.speed_scale or 1.0), unit, digits=2)

    slow, fast = contact.slow_force, contact.fast_force
    words = f"is {_force(advice, slow)}"
    if fast > slow:
        words = (
            f"lies between {_force(advice, slow)} (relaxed) and {_force(advice, fast)} (fastest "
            "retraction from this start)"
        )
    found = [f"For forces of short range the pull-off force {words}."]
    if contact.strength_force is not None:
        found.append(
            f"Uniform detachment at the strength of the interface takes "
            f"{_force(advice, contact.strength_force)}."
        )
    if (ratio := contact.over_half_space) is not None:
        found.append(
            f"This film holds {ratio:.3g} times the slow force of a half-space; the radius of the "
            f"contact at pull-off is {contact.radius_over_thickness:.2g} thicknesses."
        )
    if contact.half_space_thickness is not None:
        each = zip(TOLERANCES, contact.half_space_thickness, strict=True)
        words = ", ".join(f"{length(value)} (to {part:.0%})" for part, value in each)
        found.append(f"In slow retraction the film is a half-space from a thickness of {words} on.")
    here, half_space = contact.saturation_rate, contact.half_space_saturation_rate
    if here is not None:
        on_film = "" if half_space is None else f", on a half-space at {speed(half_space)}"
        found.append(
            f"The force reaches {SATURATED:.0%} of the fast limit at a retraction speed of about "
            f"{speed(here)}{on_film}, by the theory of a receding crack."
        )
    elif advice.glassy_tabor < advice.effective_tabor:
        found.append("The speed at which the gain saturates is not known here: simulate.")
    if advice.length_scale is not None and (strain := contact.film_strain) is not None:
        small = strain < _SMALL_FILM_STRAIN
        verdict = "small" if small else "not small; use the numbers as estimates"
        found.append(f"The largest strain of the film at the start is {strain:.2g}: {verdict}.")
    return found
