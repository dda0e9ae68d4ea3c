"""Punches on layers with other sizes."""

from dataclasses import replace

from viscotack.model.geometry import FlatPunch, Layer


def resized(groups, *, size=None, thickness=None, base=None, **others):
    """Replace the sizes and the base of a dimensionless punch, and other parts of it."""
    size = groups.geometry.half_width if size is None else size
    thickness = groups.body.thickness if thickness is None else thickness
    base = groups.body.base if base is None else base
    return replace(groups, geometry=FlatPunch(size), body=Layer(thickness, base), **others)
