"""The tables [punch] and [layer] of a case file."""

from collections.abc import Iterable, Mapping
from typing import Any, Protocol

from viscotack.geometry import Bonded, FlatPunch, Frictionless, Layer
from viscotack.materials import Material


class Table(Protocol):
    """What a table of a case file offers, with errors that name file, table and key."""

    def quantity(self, key: str, unit: str) -> float: ...  # noqa: D102
    def word(self, key: str, allowed: Iterable[str]) -> str: ...  # noqa: D102
    def make(self, kind: Any, *value: Any, **values: Any) -> Any: ...  # noqa: D102


def punch_parts(tables: Mapping[str, Table], material: Material) -> dict[str, Any]:
    """Return the punch and the layer of a problem; a bonded layer is as its material is."""
    punch, layer = tables["punch"], tables["layer"]
    bonded = layer.word("base", ("frictionless", "bonded")) == "bonded"
    base = Bonded(poisson_ratio=material.poisson_ratio) if bonded else Frictionless()
    return {
        "punch": punch.make(FlatPunch, half_width=punch.quantity("half_width", "m")),
        "layer": layer.make(Layer, thickness=layer.quantity("thickness", "m"), base=base),
    }
