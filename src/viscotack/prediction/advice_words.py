"""The advice of :func:`viscotack.advise` in sentences."""

from __future__ import annotations

from typing import TYPE_CHECKING

from viscotack.model.problem.revolution import LARGEST_CONTACT
from viscotack.units import readable

from .cautions import beyond_linear
from .other_contacts import SATURATED, TOLERANCES, OtherContact

if TYPE_CHECKING:
    from .advice import Advice

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


def statements(advice: Advice) -> list[str]:
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


def of_tiers(advice: Advice) -> list[str]:
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
