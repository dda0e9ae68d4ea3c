"""The ledger of claims, and its summary, docs/replication.md, from what is measured."""

import tomllib
from collections import Counter
from pathlib import Path
from textwrap import fill

import numpy as np

from ..kept import Numbers
from .claim import Claim, Measured, Of, Standing, Verdict, chapters

PAGE = Path(__file__).resolve().parents[3] / "docs" / "replication.md"
_WORDS = tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))
_HEAD = (
    "| claim | what the thesis says | thesis | here | apart | verdict | evidence | remeasured by "
    "|\n|---|---|---|---|---|---|---|---|"
)


def page(of: Of) -> str:
    """Return the summary: counts, and the claims that do not hold or stay open."""
    judged = _judged(of)
    parts = [
        f"# The thesis, claim by claim\n\n{_opening(judged)}",
        _differences(judged),
        f"## What the linear curve of Figure 4.10 is\n\n{fill(_linear_curve(of), 108)}",
        _WORDS["bound"],
    ]
    return "\n\n".join(parts) + "\n"


def ledger(of: Of) -> str:
    """Return every claim with its number, from numbers of figures that are kept or made afresh."""
    judged = _judged(of)
    parts = [
        f"# Ledger of claims\n\n{fill(_WORDS['reading'], 108)}",
        _derived_twice(of),
        _explanations(of),
    ]
    for chapter, claims in chapters().items():
        rows = "\n".join(claim.row(*judged[claim]) for claim in claims)
        parts.append(f"## {chapter}\n\n{_HEAD}\n{rows}")
    return "\n\n".join(parts) + "\n"


def _judged(of: Of) -> dict[Claim, tuple[Measured, Standing]]:
    return {claim: claim.judged(of) for claims in chapters().values() for claim in claims}


def _opening(judged: dict[Claim, tuple[Measured, Standing]]) -> str:
    *chapters_of_thesis, own = chapters().values()
    thesis = [claim for claims in chapters_of_thesis for claim in claims]
    counts = Counter(claim.verdict for claim in thesis)
    standings = Counter(judged[claim][1] for claim in thesis)
    said = ", ".join(f"{counts[verdict]} {_PLURAL[verdict]}" for verdict in Verdict)
    counted = ", ".join(f"{standings[standing]} {standing}" for standing in Standing)
    text = (
        "Which claims of A. Maghami, PhD thesis (2025), hold? "
        f"{len(thesis)} were measured with this package: "
        f"{said}. {len(own)} more were found here. How firmly they stand: {counted}. "
        f"{_WORDS['standings']}"
    )
    return "\n\n".join(fill(x, 108) for x in (text, _WORDS["remade"]))


def _differences(judged: dict[Claim, tuple[Measured, Standing]]) -> str:
    rows = [
        f"| `{claim.name}` | {claim.says} ({claim.place}) | {found.words} | {claim.evidence} |"
        for claim, (found, _) in judged.items()
        if claim.verdict in (Verdict.FAILS, Verdict.OPEN)
    ]
    head = "| claim | what the thesis says | here | why |\n|---|---|---|---|"
    return "## What does not hold or cannot be decided\n\n" + "\n".join([head, *rows])


_PLURAL = {
    Verdict.HOLDS: "hold",
    Verdict.CORRECTED: "hold with correction",
    Verdict.THEN: "hold as measured then",
    Verdict.FAILS: "do not hold",
    Verdict.OPEN: "cannot be decided",
}


def _derived_twice(of: Of) -> str:
    n = of("limits")
    lens = n["lens"]
    fast, limit = n["fast"], float(n["fast_theory"])
    rows = [
        "| claim | by simulation | by theory | difference | why |",
        "|---|---|---|---|---|",
        (
            f"| stress of an elastic layer at b1, in σ0 √(a0/a) | {n['at_b1_limit']:.4f}, from "
            f"a/a0 = 64, 256, 1024: {', '.join(f'{x:.3f}' for x in n['at_b1'])} | "
            f"{n['at_b1_exact']:.4f}, exact compliance of the strip | "
            f"{100 * (n['at_b1_limit'] / n['at_b1_exact'] - 1):+.2f} % | the crack of a finite "
            "zone recedes by a part of the order √(a0/a) before the pull-off; what is left is the "
            "extrapolation by a parabola |"
        ),
        (
            "| fast limit of k P/P_JKR at μ = 3.24, k = 0.1 | "
            f"{', '.join(f'{f:.4f} ({d:g} h0)' for d, f in zip(n['depth'], fast, strict=True))} | "
            f"{limit:.4f}, f(μk^(1/3)) by superposition | {100 * (fast[-1] / limit - 1):+.2f} % | "
            "the theory is that of an infinitely large start; the difference falls with the power "
            "-1.5 of the depth |"
        ),
        (
            "| pull-off of the PDMS lens with h0 = 30.8 nm at 1, 10, 100, 1000 µm/s, mN | "
            f"{', '.join(f'{x:.3f}' for x in lens['simulated'])} | "
            f"{', '.join(f'{x:.3f}' for x in lens['crack'])}, a contact whose edge is the steady "
            "crack | "
            f"{', '.join(f'{100 * x:+.2f}' for x in lens['simulated'] / lens['crack'] - 1)} % | "
            "at μ = 103 the zone is 1e-4 of the contact: both have the same limit; the theory "
            f"states a band of {100 * np.max(lens['band']):.1f} % |"
        ),
    ]
    return (
        "## Three claims derived twice\n\nNumbers of `python -m research.replication figure "
        "limits`; no constant is fitted on either side.\n\n" + "\n".join(rows)
    )


# Largest deviations at nine speeds of what is consistent with the curve, and of a conjecture.
_CONSISTENT, _CONJECTURE = 0.05, 0.15


def _explanations(of: Of) -> str:
    """Return the table of what may have given the thesis's linear curve."""
    n = of("linear-curve")
    rows = [
        f"| {n['explanation'][i]} | {n['force'][i][0]:.2f} to {n['force'][i][-1]:.2f} | "
        f"{100 * n['least'][i]:+.1f} to {100 * n['most'][i]:+.1f} % | {_word(n, i)} |"
        for i in np.argsort(n["rms"])
    ]
    head = "| explanation | force, mN | off the curve | |\n|---|---|---|---|"
    return "## The linear curve of Figure 4.10\n\n" + "\n".join([head, *rows])


def _word(n: Numbers, i: int) -> str:
    most = max(abs(float(n["least"][i])), abs(float(n["most"][i])))
    if most <= _CONJECTURE:
        return "consistent" if most <= _CONSISTENT else "conjecture"
    return "refuted"


def _linear_curve(of: Of) -> str:
    """Return what was tried to explain the thesis's linear curve, and how much of it agrees."""
    n = of("linear-curve")
    counts = Counter(_word(n, i) for i in range(len(n["rms"])))
    words = ", ".join(f"{counts[word]} {word}" for word in ("consistent", "conjecture", "refuted"))
    best = int(np.argmin(n["rms"]))
    return (
        "The thesis gives its linear curve, 4.26 to 10.9 mN at 1 to 1000 µm/s, for h0 = 30.8 nm. "
        "The curve itself is not published: here it is the quotient of two printed fits, Eq. 4.28 "
        "over 1 + (v/v1)^(1/2). Tried were simulations with three ranges and at three Tabor "
        "numbers, and Eq. 4.21 with Eq. 4.24. "
        f"Within {100 * _CONSISTENT:.0f} % at all nine speeds an explanation is consistent, within "
        f"{100 * _CONJECTURE:.0f} % a conjecture, otherwise refuted: {words}. Nearest is the "
        f"{n['explanation'][best]} ({100 * n['least'][best]:+.1f} to "
        f"{100 * n['most'][best]:+.1f} %), which the thesis does not have."
    )
