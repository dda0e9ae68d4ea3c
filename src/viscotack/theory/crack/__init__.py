"""Theories of the steady crack in a viscoelastic solid."""

from .law import CrackLaw
from .steady import SteadyCrack

__all__ = ["CrackLaw", "SteadyCrack"]
