"""Options for the master curve: time-temperature superposition of tests."""

from pathlib import Path
from typing import Any, Literal

import numpy as np

from viscotack.errors import InputError
from viscotack.units import parse

from ..options import file_name, number, option, quoted, text, two_of
from ..request import Caller, Request

_SEVERAL = 3.0  # K: a chamber holds its temperature better
_MOVES = ("none", "auto", "free")


def _moving(value: Any) -> str | float:
    """Return a word of the vertical shift, or a coefficient of volume expansion [1/K]."""
    if value in _MOVES:
        return value
    try:
        return parse(value, "1/K")
    except InputError:
        raise InputError(
            f"must be {', '.join(_MOVES)} or the coefficient of volume expansion, "
            f'"6e-4 1/K", got {value!r:.60}'
        ) from None


def _constants(value: Any) -> tuple[float, float]:
    """Return the constants of WLF."""
    c1, c2 = two_of(value)
    return parse(c1, "1"), parse(c2, "K")


class ShiftLaw(Request):
    """Options for a known shift of tests at several temperatures; temperatures in K."""

    reference_temperature: float | None = number(
        'Temperature of the master curve, "20 degC"; required for a shift, and for a DMA at '
        "several temperatures.",
        "K",
    )
    glass_transition: float | None = number(
        'Shift by WLF with c1 = 17.44 and c2 = 51.6 K at this temperature, "-115 degC".', "K"
    )
    wlf: tuple[float, float] | None = text(
        'Shift by WLF with these constants, "8.86,101.6 K", at the reference temperature.',
        metavar="C1,C2",
        to=_constants,
    )
    shift_file: Path | None = file_name("Shift by this table of log_aT.")

    def check(self) -> None:
        """Check that at most one shift is given, with its reference temperature."""
        named = self.named
        if len(named) > 1:
            raise InputError(f"give one shift, got {quoted(named)}")
        if named and self.reference_temperature is None:
            raise InputError(f"`{named[0]}` needs `reference_temperature`")

    @property
    def named(self) -> list[str]:
        """Names of the given shifts."""
        laws = ("glass_transition", "wlf", "shift_file")
        return [name for name in laws if getattr(self, name) is not None]

    def law(self, caller: Caller) -> Any:
        """Return the given shift law or table; None without one."""
        from viscotack.model.materials.shift import WLF

        if self.glass_transition is not None:
            return WLF.from_glass_transition(self.glass_transition)
        if self.wlf is not None:
            assert self.reference_temperature is not None, "checked above"
            c1, c2 = self.wlf
            return WLF(reference_temperature=self.reference_temperature, c1=c1, c2=c2)
        if self.shift_file is not None:
            from viscotack.lab import read_shifts

            return read_shifts(caller.file(self.shift_file))
        return None

    def referred(self, caller: Caller) -> Any:
        """Return the given shift law with the reference temperature; None without one."""
        law = self.law(caller)
        return None if law is None else law.at_reference(self.reference_temperature)


class Shifting(ShiftLaw):
    """Options for the shift of a DMA, relaxation or creep tests; temperatures in K."""

    shift_by: Literal["both", "storage", "loss", "tan"] | None = option(
        "Quantity that must superpose where shifts are fitted to the overlap of the sweeps, as "
        "they are by default. Default without --vertical: both, or storage if it is clearly "
        "more causal."
    )
    vertical: str | float | None = text(
        "Vertical shift with temperature: none (the default), auto (as far as the data "
        "determine it), free, or by density and temperature with a volume expansion of "
        '"6e-4 1/K".',
        metavar="WORD|EXPANSION",
        to=_moving,
    )
    leave_out: tuple[float, ...] = number(
        'Exclude the sweep at this temperature, "-30 degC". Can be repeated.', "K", default=()
    )

    def check(self) -> None:
        """Check that one shift is given with its parameters."""
        super().check()
        if self.named and (self.shift_by is not None or self.vertical is not None):
            raise InputError(
                f"`shift_by` and vertical are for shifts found from overlap; with "
                f"{self.named[0]} leave them out"
            )

    def swept(self, sweeps: Any, caller: Caller) -> tuple[Any, Any, tuple[str, ...]]:
        """Return the master curve of a DMA, the shift of times, and doubts about it."""
        from viscotack.lab import contradiction, master_curve, superposition
        from viscotack.model.materials.shift import WLF

        law, file = self.law(caller), _named(sweeps.source.path.split(", "))
        for kelvin in self.leave_out:
            sweeps = sweeps.chosen(_others(sweeps.temperature, kelvin, file))
        known = sweeps.temperature[np.isfinite(sweeps.temperature)]
        several = known.size > 0 and np.ptp(known) > _SEVERAL
        self._ask_reference(file, known)
        if law is None and np.ptp(sweeps.angular_frequency) == 0 and several:
            raise InputError(
                f"{file} is a temperature ramp at one frequency, so nothing overlaps that could "
                'tell the shift; give `glass_transition` "-115 degC", wlf or `shift_file`'
            )
        curve = master_curve(
            sweeps,
            reference_temperature=self.reference_temperature,
            shift=law,
            by=self.shift_by,
            vertical=self.vertical,
        )
        # before anything is counted by less
        cautions = [contradiction(curve)]
        if curve.shifts is not None and len(curve.shifts) > 1:
            cautions += superposition(sweeps, curve.shifts)
        if self.glass_transition is not None:
            cautions += _below(known, self.glass_transition)
        shift = law if isinstance(law, WLF) else curve.shifts
        return curve, shift, tuple(words for words in cautions if words)

    def stepped(self, measured: Any, caller: Caller) -> tuple[Any, Any, tuple[str, ...]]:
        """Return relaxation or creep tests as one at one temperature, and how times shift."""
        from viscotack.lab import superposed
        from viscotack.model.materials.shift import WLF

        law = self.law(caller)
        tests = measured if isinstance(measured, tuple) else (measured,)
        file = _named(list(dict.fromkeys(test.source.path for test in tests)))
        known = np.array([np.nan if t.temperature is None else t.temperature for t in tests])
        for kelvin in self.leave_out:
            keep = _others(known, kelvin, file)
            tests, known = tuple(t for t, k in zip(tests, keep, strict=True) if k), known[keep]
        if len(tests) == 1 and self.reference_temperature is None:
            if self.vertical is not None:
                raise InputError(
                    f"{file}: one temperature, there is nothing to shift; leave vertical out"
                )
            return tests[0], None, ()
        self._ask_reference(file, known[np.isfinite(known)])
        if self.reference_temperature is None:
            raise InputError(f"{file}: say at which temperature, `reference_temperature`")
        same: Any = tests  # all of them relaxation, or all creep
        curve, table = superposed(
            same,
            reference_temperature=self.reference_temperature,
            shift=law,
            vertical="none" if self.vertical is None else self.vertical,
        )
        return curve, law if isinstance(law, WLF) else table, ()

    def _ask_reference(self, file: str, known: Any) -> None:
        if self.reference_temperature is None and known.size and np.ptp(known) > _SEVERAL:
            raise InputError(
                f"{file}: measured from {known.min() - 273.15:.1f} to {known.max() - 273.15:.1f} "
                "C; say at which temperature the material is wanted, `reference_temperature` "
                '"20 degC"'
            )


def _named(paths: list[str]) -> str:
    """Return the names of files, of many the first."""
    return ", ".join(paths) if len(paths) < 4 else f"{paths[0]} and {len(paths) - 1} more"


def _others(temperature: Any, asked: float, file: str) -> Any:
    """Return which points are not of the sweep at a temperature [K]."""
    near = np.abs(temperature - asked) <= 1.0
    words = f'--leave-out "{asked - 273.15:.4g} degC"'
    if not near.any():
        known = np.unique(np.round(temperature[np.isfinite(temperature)] - 273.15))
        there = ", ".join(f"{T:g} C" for T in known) or "temperatures that it does not say"
        raise InputError(f"{words}: {file}: no test within 1 K of it; there are some at {there}")
    if near.all():
        raise InputError(f"{words} leaves nothing of {file}")
    return ~near


def _below(temperature: Any, glass: float) -> list[str]:
    """Warn if WLF was used below the glass transition."""
    count = int(np.sum(temperature < glass))
    if not count:
        return []
    return [
        f"{count} points lie below the glass transition, down to "
        f"{np.min(temperature) - 273.15:.4g} C, where a glass need not follow WLF: the highest "
        "frequencies and the glassy modulus rest on them"
    ]
