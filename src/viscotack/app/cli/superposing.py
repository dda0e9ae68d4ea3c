"""From a laboratory's file and the flags of shift to one curve at one temperature."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.materials.shift import WLF
from viscotack.units import parse

_SEVERAL = 3.0  # K: a chamber holds its temperature better


@dataclass(frozen=True)
class Shifting:
    """What the flags say of shifts; temperatures [K] but those that are text."""

    reference: float | None
    glass_transition: str | None
    wlf: str | None
    shift_file: Path | None
    by: str | None
    vertical: str | None
    leave_out: tuple[str, ...]

    def law(self) -> Any:
        """Return the one law or table that is given; None where shifts are to be found."""
        given = {
            "glass-transition": self.glass_transition,
            "wlf": self.wlf,
            "shift-file": self.shift_file,
        }
        named = [name for name, value in given.items() if value is not None]
        if len(named) > 1:
            raise InputError(f"give one shift, got {' and '.join(f'--{n}' for n in named)}")
        if not named:
            return None
        if self.reference is None:
            raise InputError(f"--{named[0]} needs --reference-temperature")
        if self.by is not None or self.vertical is not None:
            raise InputError(
                f"--shift-by and --vertical are for shifts found from overlap; with --{named[0]} "
                "leave them out"
            )
        if self.glass_transition is not None:
            return WLF.from_glass_transition(parse(self.glass_transition, "K"))
        if self.wlf is not None:
            words = [word.strip() for word in self.wlf.split(",")]
            if len(words) != 2:
                raise InputError(f"--wlf needs two values with a comma between, got {self.wlf!r}")
            return WLF(self.reference, parse(words[0], "1"), parse(words[1], "K"))
        from viscotack.lab import read_shifts

        assert self.shift_file is not None, "one of three was given"
        return read_shifts(self.shift_file)

    def moved(self) -> str | float | None:
        """Return how far moduli may move."""
        if self.vertical is None or self.vertical in ("auto", "none", "free"):
            return self.vertical
        try:
            return parse(self.vertical, "1/K")
        except ValueError:
            raise InputError(
                "--vertical must be auto, none, free or the coefficient of volume expansion, "
                f'"6e-4 1/K", got {self.vertical!r}'
            ) from None


def swept(sweeps: Any, shifting: Shifting) -> tuple[Any, Any, tuple[str, ...]]:
    """Return the master curve of a DMA, how times shift, and what speaks against it."""
    from viscotack.lab import contradiction, master_curve, superposition

    law, file = shifting.law(), _named(sweeps.source.path.split(", "))
    for words in shifting.leave_out:
        sweeps = sweeps.chosen(_others(sweeps.temperature, words, file))
    known = sweeps.temperature[np.isfinite(sweeps.temperature)]
    several = known.size > 0 and np.ptp(known) > _SEVERAL
    _ask_reference(file, known, shifting)
    if law is None and np.ptp(sweeps.angular_frequency) == 0 and several:
        raise InputError(
            f"{file}: a temperature ramp at one frequency, nothing overlaps that could tell the "
            'shift; give --glass-transition "-115 degC", --wlf or --shift-file'
        )
    curve = master_curve(
        sweeps,
        reference_temperature=shifting.reference,
        shift=law,
        by=shifting.by,
        vertical=shifting.moved(),
    )
    # before anything is counted by less
    cautions = [contradiction(curve)]
    if curve.shifts is not None and len(curve.shifts) > 1:
        cautions += superposition(sweeps, curve.shifts).words()
    if shifting.glass_transition is not None:
        cautions += _below(known, parse(shifting.glass_transition, "K"))
    shift = law if isinstance(law, WLF) else curve.shifts
    return curve, shift, tuple(words for words in cautions if words)


def stepped(measured: Any, shifting: Shifting) -> tuple[Any, Any, tuple[str, ...]]:
    """Return relaxation or creep tests as one at one temperature, and how times shift."""
    from viscotack.lab import superposed

    law = shifting.law()
    tests = measured if isinstance(measured, tuple) else (measured,)
    file = _named(list(dict.fromkeys(test.source.path for test in tests)))
    known = np.array([np.nan if t.temperature is None else t.temperature for t in tests])
    for words in shifting.leave_out:
        keep = _others(known, words, file)
        tests, known = tuple(t for t, k in zip(tests, keep, strict=True) if k), known[keep]
    if len(tests) == 1 and shifting.reference is None:
        if shifting.vertical is not None:
            raise InputError(
                f"{file}: one temperature, there is nothing to shift; leave --vertical out"
            )
        return tests[0], None, ()
    _ask_reference(file, known[np.isfinite(known)], shifting)
    if shifting.reference is None:
        raise InputError(f"{file}: say at which temperature, --reference-temperature")
    moved = shifting.moved()
    same: Any = tests  # all of them relaxation, or all creep
    curve, table = superposed(
        same, reference_temperature=shifting.reference, shift=law, vertical=moved
    )
    return curve, law if isinstance(law, WLF) else table, ()


def _named(paths: list[str]) -> str:
    """Return the names of files, of many the first."""
    return ", ".join(paths) if len(paths) < 4 else f"{paths[0]} and {len(paths) - 1} more"


def _ask_reference(file: str, known: Any, shifting: Shifting) -> None:
    if shifting.reference is None and known.size and np.ptp(known) > _SEVERAL:
        raise InputError(
            f"{file}: measured from {known.min() - 273.15:.1f} to {known.max() - 273.15:.1f} C; "
            'say at which temperature the material is wanted, --reference-temperature "20 degC"'
        )


def _others(temperature: Any, words: str, file: str) -> Any:
    """Return which points are not of the sweep at a temperature."""
    asked = parse(words, "K")
    near = np.abs(temperature - asked) <= 1.0
    if not near.any():
        known = np.unique(np.round(temperature[np.isfinite(temperature)] - 273.15))
        there = ", ".join(f"{T:g} C" for T in known) or "temperatures that it does not say"
        raise InputError(
            f"--leave-out {words}: {file}: no test within 1 K of it; there are some at {there}"
        )
    if near.all():
        raise InputError(f"--leave-out {words} leaves nothing of {file}")
    return ~near


def _below(temperature: Any, glass: float) -> list[str]:
    """Return that WLF was used where a glass need not follow it."""
    count = int(np.sum(temperature < glass))
    if not count:
        return []
    return [
        f"{count} points lie below the glass transition, down to "
        f"{np.min(temperature) - 273.15:.4g} C, where a glass need not follow WLF: the highest "
        "frequencies and the glassy modulus rest on them"
    ]
