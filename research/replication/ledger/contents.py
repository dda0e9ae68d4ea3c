"""All claims, in the order of the thesis."""

from __future__ import annotations

from viscotack import InputError

from . import equations, layers, learning, rubber, spheres
from .claim import Claim

CHAPTERS: dict[str, tuple[Claim, ...]] = {
    "Equations and text": equations.CLAIMS,
    "Chapter 3: a punch on a layer": layers.CLAIMS,
    "Chapter 4: a sphere, its crack and its work": spheres.CLAIMS,
    "Chapter 4: a lens on silicone rubber": rubber.CLAIMS,
    "Chapter 5: simulated campaigns and what is learned from them": learning.CLAIMS,
}
# What was found here, and the thesis does not say.
OWN: tuple[Claim, ...] = (*spheres.OWN, *rubber.OWN, *learning.OWN)


def of_thesis() -> tuple[Claim, ...]:
    """Return all claims of the thesis."""
    return tuple(claim for claims in CHAPTERS.values() for claim in claims)


def every() -> tuple[Claim, ...]:
    """Return all claims, those of the thesis first."""
    return of_thesis() + OWN


def named(name: str) -> Claim:
    """Return a claim by its name.

    Raises
    ------
    ValueError
        If there is none.
    """
    found = [claim for claim in every() if claim.name == name]
    if not found:
        raise InputError(
            f"there is no claim {name!r}; there are {', '.join(claim.name for claim in every())}"
        )
    return found[0]
