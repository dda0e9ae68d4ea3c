"""A rough surface and its test as they are stated: by numbers and files, without the map itself.

Cases of campaigns are stated so: a record has the seed of a generated map, or the name of a file
with its hash, and :meth:`StatedSurface.map` makes the map.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from viscotack.cards import Exact, Quantity, cards, conform
from viscotack.errors import InputError
from viscotack.model.geometry import HalfSpace
from viscotack.model.problem import revolution
from viscotack.model.protocol import Retraction
from viscotack.model.surfaces import HeightMap, bumps, pillars, read_map, self_affine, sphere
from viscotack.model.surfaces.heights import FEWEST, MOST_GENERATED

# Generated maps: their function, numbers that are needed, and numbers that may be given.
KINDS: dict[str, tuple[Any, tuple[str, ...], tuple[str, ...]]] = {
    "sphere": (sphere, ("radius",), ()),
    "self-affine": (self_affine, ("hurst", "rms_height"), ("seed", "roll_off", "shortest")),
    "bumps": (bumps, ("radius", "spacing", "height"), ("scatter", "seed")),
    "pillars": (pillars, ("radius", "spacing", "height"), ()),
}
_PIXELS = ("pixels", "pixel")
_OF_FILE = ("pixel", "height_unit")
_WHOLE = ("pixels", "seed")


def _length(symbol: str, words: str, example: str, **range: Any) -> Quantity:
    return Quantity("m", symbol, words, example=example, **(range or {"above": 0}))


_Pixels = Annotated[
    float,
    Quantity("1", "N", "pixels of each side", least=FEWEST, most=MOST_GENERATED, example="128"),
]
_Pixel = Annotated[float, _length("dx", "side of a pixel", "1 um")]
_HeightUnit = Annotated[float, _length("u", "unit of the heights of a file", "1 nm")]
_Radius = Annotated[float, _length("R", "radius of sphere, bumps or pillars", "5 mm")]
_Hurst = Annotated[float, Quantity("1", "H", "Hurst exponent", least=0, most=1, example="0.8")]
_RmsHeight = Annotated[float, _length("h_rms", "root mean square of the heights", "1 um")]
_Seed = Annotated[float, Quantity("1", "n", "seed of the map; 0 without it", least=0, example="1")]
_RollOff = Annotated[float, _length("L_r", "wave length above which the spectrum is flat", "1 mm")]
_Shortest = Annotated[float, _length("L_s", "shortest wave length", "10 um")]
_Spacing = Annotated[float, _length("a", "distance of neighbouring bumps or pillars", "80 um")]
_Height = Annotated[float, _length("h", "height of bumps or pillars", "5 um")]
_Scatter = Annotated[
    float, _length("s", "standard deviation of the heights of bumps", "0.1 um", least=0)
]


@dataclass(frozen=True)
class StatedSurface:
    """A map of heights by its numbers, or by its file; the table [surface] of a file.

    Attributes
    ----------
    kind : tuple of str
        Generated maps that are added up: sphere, self-affine, bumps, pillars; () for a file.
    file, sha256 : str
        File of a measured map, and the hash of its content.
    periodic : bool or None
        Whether the map repeats; None for what the kind does by itself.
    level, remove_curvature : bool
        Whether mean and tilt, and a paraboloid, are removed.

    The other attributes are the parameters of the functions of :mod:`viscotack.model.surfaces`, in
    SI.

    Examples
    --------
    >>> stated = StatedSurface(kind=("bumps",), pixels=32, pixel=1e-6, radius=2e-5, spacing=8e-6,
    ...                        height=1e-6)
    >>> stated.map().heights.shape
    (32, 32)
    """

    kind: tuple[str, ...] = ()
    file: str = ""
    sha256: str = ""
    periodic: Annotated[bool, Exact] | None = None
    level: Annotated[bool, Exact] = False
    remove_curvature: Annotated[bool, Exact] = False
    pixels: _Pixels | None = None
    pixel: _Pixel | None = None
    height_unit: _HeightUnit | None = None
    radius: _Radius | None = None
    hurst: _Hurst | None = None
    rms_height: _RmsHeight | None = None
    seed: _Seed | None = None
    roll_off: _RollOff | None = None
    shortest: _Shortest | None = None
    spacing: _Spacing | None = None
    height: _Height | None = None
    scatter: _Scatter | None = None

    def __post_init__(self) -> None:
        conform(self)
        object.__setattr__(self, "kind", tuple(self.kind))
        for name in _WHOLE:
            value = getattr(self, name)
            if value is not None:
                if value != int(value):
                    raise InputError(f"{name} must be a whole number, got {value:g}")
                object.__setattr__(self, name, int(value))
        if unknown := [kind for kind in self.kind if kind not in KINDS]:
            raise InputError(f"kind must be one of {', '.join(KINDS)}, got {unknown[0]!r}")
        if bool(self.kind) == bool(self.file):
            raise InputError("a surface has either a kind, which is generated, or a file")
        if missing := [name for name in self.needed if getattr(self, name) is None]:
            raise InputError(f"the surface needs {' and '.join(missing)}")
        if extra := [name for name in self.unused if getattr(self, name) is not None]:
            of = f"of kind {', '.join(self.kind)}" if self.kind else "from a file"
            raise InputError(f"a surface {of} has no {min(extra)}; leave it out")
        if self.periodic is not None and self.kind and "self-affine" not in self.kind:
            raise InputError("periodic belongs to self-affine maps and to files; leave it out")

    @property
    def needed(self) -> tuple[str, ...]:
        """Numbers that the surface must have."""
        if self.file:
            return ()
        return (*_PIXELS, *dict.fromkeys(name for kind in self.kind for name in KINDS[kind][1]))

    @property
    def unused(self) -> frozenset[str]:
        """Numbers that the surface does not have."""
        used = {*_OF_FILE} if self.file else {*self.needed}
        used |= {name for kind in self.kind for name in KINDS[kind][2]}
        return frozenset(cards(StatedSurface)) - used

    def map(self) -> HeightMap:
        """Generate the map, or read it.

        Raises
        ------
        ValueError
            If the numbers do not go together, or the file is no map or has changed.
        """
        if self.file:
            if self.sha256 and hash_of(self.file) != self.sha256:
                raise InputError(f"{self.file} has changed since it was planned; plan it again")
            found = read_map(
                self.file, pixel=self.pixel, unit=self.height_unit, periodic=bool(self.periodic)
            )
        else:
            maps: list[HeightMap] = []
            for kind in self.kind:
                make, needed, optional = KINDS[kind]
                given = {name: getattr(self, name) for name in (*needed, *optional)}
                if kind == "self-affine":
                    given |= {"seed": self.seed or 0, "periodic": self.periodic}
                stated = {name: value for name, value in given.items() if value is not None}
                maps.append(make(self.pixels, self.pixel, **stated))
            found, *others = maps
            for other in others:
                found = found + other
        return found.levelled(curvature=self.remove_curvature) if self.level else found


@dataclass(frozen=True)
class RoughCase:
    """A stated surface on a body and its test; `rough.problem_of` makes the problem.

    Parameters
    ----------
    surface : StatedSurface
        The map of heights, by numbers or a file.
    material, traction, protocol, body
        As of a :class:`viscotack.simulate.rough.RoughProblem`.
    """

    surface: StatedSurface
    material: Any
    traction: Any
    protocol: Retraction
    body: Any = HalfSpace()

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the numbers that the machine controls."""
        return revolution.SI

    @property
    def unused(self) -> frozenset[str]:
        """Paths of numbers that the surface does not have."""
        return frozenset(f"surface.{name}" for name in self.surface.unused)


def hash_of(path: str | Path) -> str:
    """Return the SHA-256 of the content of a file."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
