"""Methods that answer a problem: simulation, or a contact whose edge is a steady crack."""

from .by_crack import CrackContact, crack_contact
from .solving import has_start, solve

__all__ = ["CrackContact", "crack_contact", "has_start", "solve"]
