"""Format a passport as text for the terminal."""

import numpy as np

from viscotack.cards import cards
from viscotack.model.materials.passport import Passport
from viscotack.model.materials.shift import TabulatedShift
from viscotack.model.materials.words import word_of
from viscotack.units import readable


def in_words(passport: Passport) -> str:
    """Format a passport as lines of text."""
    solid = passport.material
    model = word_of(solid)
    lines = [f"{passport.name}: {model}"]
    for name, field in cards(type(solid)).items():
        number = readable(getattr(solid, name), field.card.unit, digits=5)
        lines.append(f"  {name:<18}{number:>16}")
    lines.append(f"  {'modulus_ratio':<18}{solid.modulus_ratio:>16.5g}")
    if model == "prony":
        lines.append(f"  {'branches':<18}{len(solid.branches):>16}")
        lines += [
            f"    {readable(E, 'Pa', digits=5):>16}{readable(t, 's', digits=5):>16}"
            for E, t in solid.branches
        ]
    if passport.temperature is not None:
        law = "no shift" if passport.shift is None else type(passport.shift).__name__
        lines.append(f"  at {passport.temperature - 273.15:.4g} C; times shift by: {law}")
    lines += shift_lines(passport)
    if passport.temperatures is not None:
        low, high = (T - 273.15 for T in passport.temperatures)
        lines.append(f"  measured from {low:.4g} to {high:.4g} C")
    if passport.frequencies is not None:
        low, high = (w / (2 * np.pi) for w in passport.frequencies)
        lines.append(f"  known from {readable(low, 'Hz', digits=3, to=high)}")
    origin = passport.origin
    for words in (origin.reference, origin.doi and f"doi:{origin.doi}", origin.file):
        if words:
            lines.append(f"  source: {words}")
    if passport.evidence is not None:
        for name, low, high in passport.evidence.intervals:
            level = 100 * passport.evidence.level
            lines.append(f"  {level:.0f} % interval of {name}: {low:.5g} to {high:.5g}")
        lines += [f"  Not determined: {words}" for words in passport.evidence.undetermined]
        lines += [f"  Note: {words}" for words in passport.evidence.cautions]
    return "\n".join(line.rstrip() for line in lines)


def shift_lines(passport: Passport) -> list[str]:
    """Format a table of shifts and its fitted law as lines; empty without a table."""
    shift = passport.shift
    if not isinstance(shift, TabulatedShift):
        return []
    unknown = [np.nan] * len(shift.values)
    rows = zip(
        shift.temperature,
        np.asarray(shift.log10_shift(shift.temperature)),
        shift.uncertainty or unknown,
        shift.vertical or unknown,
        strict=True,
    )
    lines = ["         T [C]   log10 a_T          +-    log10 b_T"]
    lines += [
        f"    {round(T - 273.15, 2) + 0.0:>10.2f}{value:>12.3f}{doubt:>12.2g}{up:>13.3f}".replace(
            "nan", "  -"
        )
        for T, value, doubt, up in rows
    ]
    if passport.fitted_shift is None:
        return (
            [*lines, "  no WLF or Arrhenius law fits the table"] if len(shift.values) > 2 else lines
        )
    return [*lines, f"  nearest law: {passport.fitted_shift.words()}"]
