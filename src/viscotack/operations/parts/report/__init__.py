"""One page for a lab: what was measured, what it says, what to expect, and how that was found."""

from .rendering import page

__all__ = ["page"]
