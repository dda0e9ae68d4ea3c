"""Elasticities of a simulation as lines a person reads."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from viscotack.result.result import Sensitivities

_HEADS = {
    "pull_off_force": "force",
    "pull_off_stress": "stress",
    "work_to_pull_off": "work",
    "depth_at_pull_off": "depth",
    "contact_radius_at_pull_off": "radius",
    "ligament_at_pull_off": "ligament",
}


def table_of_sensitivities(found: Sensitivities) -> list[str]:
    """Return a table of elasticities at pull-off, largest of the first output first."""
    lines = []
    if shown := list(found.elasticities):
        first = found.elasticities[shown[0]]
        names = sorted(first, key=lambda name: -abs(first[name]))
        wide = max(map(len, names), default=0)
        heads = "".join(f"{_HEADS[name]:>9}" for name in shown)
        lines.append(f"  {'d ln y/d ln x at pull-off':<{wide}}{heads[max(25 - wide, 0) :]}")
        for name in names:
            values = (found.elasticities[y].get(name) for y in shown)
            row = "".join(f"{'':>9}" if v is None else f"{v:9.3f}" for v in values)
            lines.append(f"  {name:<{wide}}{row}")
    lines += [f"  no derivatives: {name}: {why}" for name, why in found.refused.items()]
    return lines
