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
        names = sorted(found.inputs, key=lambda name: -abs(first.get(name, 0.0)))
        title, wide = "d ln y/d ln x at pull-off", max(map(len, names))
        lines.append(f"  {title:<{wide}}" + "".join(f"{_HEADS[name]:>9}{'':7}" for name in shown))
        for name in names:
            cells = [
                f"{found.elasticities[y][name]:9.3f} ±{found.errors[y][name]:.3f}"
                if name in found.elasticities[y]
                else ""
                for y in shown
            ]
            lines.append(f"  {name:<{max(wide, len(title))}}" + "".join(f"{x:<16}" for x in cells))
    lines += [f"  no elasticity: {name}: {why}" for name, why in found.refused.items()]
    return [line.rstrip() for line in lines]
