"""Methods that solve a problem: simulation or the steady-crack contact model.

Functions that simulate are imported on first use, because predictions do not need them.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .by_crack import CrackContact, crack_contact

if TYPE_CHECKING:
    from .solving import has_start, solve

__all__ = ["CrackContact", "crack_contact", "has_start", "solve"]


def __getattr__(name: str) -> Any:
    if name in __all__:
        return getattr(import_module(".solving", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
