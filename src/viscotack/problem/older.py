"""Records and names of older versions as this one writes them.

Version 0.1 had a class for each indenter: PunchProblem with `punch` and `layer`, ProfileProblem
with `profile`, and ProfileGroups with `profile_exponent`.
"""

from typing import Any

from viscotack.errors import InputError

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
    return renamed


def upgraded_path(path: str) -> str:
    """Return the path of a number in a record, such as ``punch.half_width``, as it is now."""
    for old, new in _PATHS.items():
        if path.startswith(old):
            return new + path.removeprefix(old)
    return path


def upgraded_output(name: str) -> str:
    """Return the name of a number of an answer, such as ``pull_off_depth``, as it is now."""
    return _OUTPUTS.get(name, name)


def naming(record: dict[str, Any]) -> dict[str, Any]:
    """Return a record as version 0.1 wrote it: names by content are made from that for ever."""
    shape = record.get("geometry", {})
    kind = shape.get("type")
    renamed = {name: value for name, value in record.items() if name not in ("geometry", "body")}
    match record["type"], kind:
        case "Problem", "FlatPunch":
            return renamed | {
                "type": "PunchProblem",
                "punch": shape,
                "layer": record["body"],
            }
        case "Problem", "Cone" | "PowerLawProfile":
            return renamed | {"type": "ProfileProblem", "profile": shape}
        case "Groups", "Cone" | "PowerLawProfile":
            q = shape.get("exponent", 1.0)
            return renamed | {"type": "ProfileGroups", "profile_exponent": q}
    return record
