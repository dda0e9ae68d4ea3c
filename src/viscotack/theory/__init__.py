"""Closed forms and implicit laws of adhesive contact and of the viscoelastic crack.

Conventions: SI units; force positive in compression, depth positive into the solid,
pressure positive in compression; the sphere is rigid, of radius R, and the half-space has the
contact modulus E* = E / (1 - nu^2). The flat punch of ``punch`` is on a layer, in plane strain,
with stress positive in tension. The varying quantity is the first argument and may be an array,
followed by an object if there is one (``CrackLaw``, ``punch.Pad``); the parameters are
keywords, and arrays of them broadcast. A scalar gives a float. A value outside the domain of a
formula, in any element, raises ``InputError``, which is a ``ValueError``.

Four rooms, each of which imports only itself and earlier ones: ``elastic``, ``crack``, ``sphere``,
``punch``. The modules of the first three are also available directly, as ``theory.jkr``. Each is
imported on first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import crack as crack
    from . import elastic as elastic
    from . import punch as punch
    from . import sphere as sphere
    from .crack import CrackLaw as CrackLaw
    from .crack import SteadyCrack as SteadyCrack
    from .crack import greenwood as greenwood
    from .crack import persson_brener as persson_brener
    from .crack import steady as steady
    from .crack import tabulated_modulus as tabulated_modulus
    from .elastic import adhesion_map as adhesion_map
    from .elastic import bradley as bradley
    from .elastic import disc as disc
    from .elastic import dmt as dmt
    from .elastic import film as film
    from .elastic import hertz as hertz
    from .elastic import indenter as indenter
    from .elastic import jkr as jkr
    from .elastic import lennard_jones as lennard_jones
    from .elastic import maugis as maugis
    from .elastic import profiles as profiles
    from .elastic import transition as transition
    from .elastic import wavy as wavy
    from .sphere import bounds as bounds
    from .sphere import detachment as detachment
    from .sphere import edge_law as edge_law
    from .sphere import rate as rate
    from .sphere import unloading as unloading

# Room -> its modules that are also names of this package.
_ROOMS = {
    "elastic": (
        "adhesion_map bradley disc dmt film hertz indenter jkr lennard_jones maugis profiles "
        "transition wavy"
    ),
    "crack": "greenwood persson_brener steady tabulated_modulus",
    "sphere": "bounds detachment edge_law rate unloading",
    "punch": "",
}
_HOMES = {name: room for room, names in _ROOMS.items() for name in names.split()}
_CLASSES = ("CrackLaw", "SteadyCrack")

__all__ = [*_CLASSES, *_ROOMS, *_HOMES]  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name in _ROOMS:
        return import_module(f".{name}", __name__)
    if name in _HOMES:
        return import_module(f".{_HOMES[name]}.{name}", __name__)
    if name in _CLASSES:
        return getattr(import_module(".crack", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
