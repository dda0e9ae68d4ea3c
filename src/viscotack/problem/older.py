"""Convert records and names of earlier versions to the current ones.

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

# Old -> current names of outputs, as in `outputs`; in SI too.
_OUTPUTS = {
    f"{old}{tail}": f"{new}{tail}"
    for old, new in (
        ("pull_off_depth", "depth_at_pull_off"),
        ("other_peak_depth", "depth_at_other_peak"),
    )
    for tail in ("", "_m")
}
OUTPUTS = frozenset(_OUTPUTS)
# Old -> current prefixes of paths of inputs.
_PATHS = {"punch.": "geometry.", "layer.": "body.", "profile.": "geometry."}
# The same for a dimensionless punch; in tables of other kinds two of these are current columns.
_PATHS_OF_PUNCH = {
    "size": "geometry.half_width",
    "thickness": "body.thickness",
    "base.poisson_ratio": "body.base.poisson_ratio",
}
_SLIDING = Frictionless()


def PunchGroups(  # noqa: N802
    size: float, thickness: float, cohesion: float, *, base: Base = _SLIDING, **parts: Any
) -> Groups:
    """Return the dimensionless punch on a layer; former name of :class:`viscotack.Groups`.

    Parameters
    ----------
    size, thickness : float
        Half width of the punch and thickness of the layer [a_0].
    cohesion : float
        sigma_0/E_0*.
    base : Frictionless or Bonded
        Lower boundary of the layer.
    **parts
        Further parameters of Groups: material, start, rate, ...

    Returns
    -------
    Groups
        With ``tabor=None``, a flat punch and a layer.

    Raises
    ------
    InputError
        If a number is out of range, or the parts do not fit together.

    Examples
    --------
    >>> import warnings
    >>> from viscotack.materials import StandardSolid
    >>> from viscotack.protocol import AtDepth
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> with warnings.catch_warnings(action="ignore"):
    ...     case = PunchGroups(64.85, 3.24, 0.05, material=solid, start=AtDepth(1.0), rate=10.0)
    >>> case.body
    Layer(thickness=3.24, base=Frictionless())
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
    """Convert a record of any version to the current one; other objects are unchanged."""
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
    """Convert the path of a number in a record, such as ``punch.half_width``."""
    for old, new in _PATHS.items():
        if path.startswith(old):
            return new + path.removeprefix(old)
    return path


def upgraded_paths(paths: Iterable[str], record: Mapping[str, Any]) -> list[str]:
    """Convert paths of numbers in a record that already has the current names."""
    punch = record["type"] == Groups.__name__ and "cohesion" in record
    more = _PATHS_OF_PUNCH if punch else {}
    return [more.get(path, upgraded_path(path)) for path in paths]


def upgraded_output(name: str) -> str:
    """Convert the name of an output, such as ``pull_off_depth``."""
    return _OUTPUTS.get(name, name)


def naming(record: dict[str, Any]) -> dict[str, Any]:
    """Return a record as version 0.1 wrote it; run ids are always computed from that form."""
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
