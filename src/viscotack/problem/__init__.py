"""A problem: material, traction law, geometry and protocol, in SI, in groups and in files."""

from .problem import (
    LARGEST_CONTACT,
    Groups,
    Problem,
    Scales,
    check_parts,
    check_reduced,
    farthest,
    material_in_si,
    reduced_parts,
    sphere_scales,
    sphere_units,
    tabor_number,
)

__all__ = [
    "Groups",
    "LARGEST_CONTACT",
    "Problem",
    "Scales",
    "check_parts",
    "check_reduced",
    "farthest",
    "material_in_si",
    "reduced_parts",
    "sphere_scales",
    "sphere_units",
    "tabor_number",
]
