"""The contact whose edge is a steady crack: a history in a tenth of a second."""

from viscotack.simulate.crack_contact.by_crack import CrackContact, crack_contact

__all__ = ["CrackContact", "crack_contact"]
