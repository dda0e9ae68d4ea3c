"""Records and names of older versions as this one has them.

Version 0.1 had a class for each indenter: PunchProblem with `punch` and `layer`, ProfileProblem
with `profile`, ProfileGroups with `profile_exponent`, and PunchGroups with `size`, `thickness` and
`base`.
"""

import warnings
from collections.abc import Iterable, Mapping
from typing import Any

from viscotack.errors import InputError
from viscotack.geometry import Base, FlatPunch, Frictionless, Layer
from viscotack.problem.problem import Groups

# What numbers of an answer were called -> are called, as in `outputs`; in SI too.
_OUTPUTS = {
    f"{old}{tail}": f"{new}{tail}"
    for old, new in (
        ("pull_off_depth", "depth_at_pull_off"),
        ("other_peak_depth", "depth_at_other_peak"),
    )
    for tail in ("", "_m")
}
OUTPUTS = frozenset(_OUTPUTS)
# What numbers of a problem were called -> are called, by the beginning of their path.
_PATHS = {"punch.": "geometry.", "layer.": "body.", "profile.": "geometry."}
# The same of a dimensionless punch; in tables of other kinds two of these are columns of today.
_PATHS_OF_PUNCH = {
    "size": "geometry.half_width",
    "thickness": "body.thickness",
    "base.poisson_ratio": "body.base.poisson_ratio",
}
_SLIDING = Frictionless()


def PunchGroups(  # noqa: N802
    size: float, thickness: float, cohesion: float, *, base: Base = _SLIDING, **parts: Any
) -> Groups:
    """Return the dimensionless punch on a layer: an older name of :class:`viscotack.Groups`.

    Parameters
    ----------
    size, thickness : float
        Half width and thickness of the layer [a_0].
    cohesion : float
        sigma_0/E_0*.
    base : Frictionless or Bonded
        How the layer rests on the rigid body below.
    **parts
        Those of Groups: material, start, rate, ...
    """
    warnings.warn(
        "PunchGroups(size, thickness, cohesion, ...) is Groups(tabor=None, cohesion=..., "
        "geometry=FlatPunch(size), body=Layer(thickness, base), ...) now",
        DeprecationWarning,
        stacklevel=2,
    )
    body = Layer(thickness, base)
    return Groups(tabor=None, cohesion=cohesion, geometry=FlatPunch(size), body=body, **parts)


def upgraded(record: Any) -> Any:
    """Return a record of any version as one of this version; what is none is left as it is."""
    if not isinstance(record, dict):
        return record
    renamed = dict(record)
    match record.get("type"):
        case "PunchProblem" if {"punch", "layer"} <= record.keys():
            renamed["type"] = "Problem"
            renamed["geometry"], renamed["body"] = renamed.pop("punch"), renamed.pop("layer")
        case "ProfileProblem" if "profile" in record:
            renamed["type"] = "Problem"
            renamed["geometry"] = renamed.pop("profile")
        case "ProfileGroups" if "profile_exponent" in record:
            q = renamed.pop("profile_exponent")
            if not isinstance(q, int | float) or not q >= 1:
                raise InputError(f"profile_exponent must lie between 1 and 10, got {q!r}")
            renamed["type"] = "Groups"
            renamed["geometry"] = {"type": "PowerLawProfile", "coefficient": 1 / q, "exponent": q}
        case "PunchGroups" if {"size", "thickness"} <= record.keys():
            layer = {name: renamed.pop(name) for name in ("thickness", "base") if name in record}
            renamed["type"], renamed["tabor"] = "Groups", None
            renamed["geometry"] = {"type": "FlatPunch", "half_width": renamed.pop("size")}
            renamed["body"] = {"type": "Layer", **layer}
    return renamed


def upgraded_path(path: str) -> str:
    """Return the path of a number in a record, such as ``punch.half_width``, as it is now."""
    for old, new in _PATHS.items():
        if path.startswith(old):
            return new + path.removeprefix(old)
    return path


def upgraded_paths(paths: Iterable[str], record: Mapping[str, Any]) -> list[str]:
    """Compute the paths of today of numbers in a record, which has the names of today."""
    punch = record["type"] == Groups.__name__ and "cohesion" in record
    more = _PATHS_OF_PUNCH if punch else {}
    return [more.get(path, upgraded_path(path)) for path in paths]


def upgraded_output(name: str) -> str:
    """Return the name of a number of an answer, such as ``pull_off_depth``, as it is now."""
    return _OUTPUTS.get(name, name)


def naming(record: dict[str, Any]) -> dict[str, Any]:
    """Return a record as version 0.1 wrote it: names by content are made from that for ever."""
    shape, body = record.get("geometry", {}), record.get("body", {})
    renamed = {name: value for name, value in record.items() if name not in ("geometry", "body")}
    match record["type"], shape.get("type"), body.get("type"):
        case "Problem", "FlatPunch", _:
            return renamed | {"type": "PunchProblem", "punch": shape, "layer": body}
        case "Problem", "Cone" | "PowerLawProfile", None:
            return renamed | {"type": "ProfileProblem", "profile": shape}
        case "Groups", "Cone" | "PowerLawProfile", None:
            q = shape.get("exponent", 1.0)
            return renamed | {"type": "ProfileGroups", "profile_exponent": q}
        case "Groups", "FlatPunch", "Layer":
            layer = {name: value for name, value in body.items() if name != "type"}
            del renamed["tabor"]
            return renamed | {"type": "PunchGroups", "size": shape["half_width"], **layer}
    return record
