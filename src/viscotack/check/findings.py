"""Findings of the conformance checks: one for each identity, limit, bound or round trip."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.problem.nouns import MEMBERS, missing_members


class CheckFailed(InputError):
    """An object fails a conformance check."""


@dataclass(frozen=True)
class Finding:
    """The outcome of one check.

    Attributes
    ----------
    name : str
        The identity, limit, bound or round trip that was checked.
    expected, found : str
        Expected and found value, as text; numbers in SI unless stated.
    passed : bool
        Whether the object satisfies the check.

    Examples
    --------
    >>> print(Finding("energy far apart is 0", "0", "0.1", passed=False))
    FAIL energy far apart is 0: expected 0, found 0.1
    """

    name: str
    expected: str
    found: str
    passed: bool

    def __str__(self) -> str:
        mark = "ok  " if self.passed else "FAIL"
        return f"{mark} {self.name}" + (
            "" if self.passed else f": expected {self.expected}, found {self.found}"
        )


@dataclass(frozen=True)
class Report:
    """All findings for one object; returned by :func:`check_material` and its siblings.

    Attributes
    ----------
    noun : str
        Representation of the checked object.
    findings : tuple of Finding
        In the order of the checks.
    """

    noun: str
    findings: tuple[Finding, ...]

    @property
    def failures(self) -> tuple[Finding, ...]:
        """Findings of failed checks."""
        return tuple(finding for finding in self.findings if not finding.passed)

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return not self.failures

    def raise_if_failed(self) -> "Report":
        """Return the report, or raise `CheckFailed` with all failures if there are any."""
        if self.failures:
            raise CheckFailed(str(self))
        return self

    def __str__(self) -> str:
        count = f"{len(self.findings) - len(self.failures)} of {len(self.findings)} checks passed"
        shown = self.failures or self.findings
        return "\n".join([f"{self.noun}: {count}", *(f"  {finding}" for finding in shown)])


Check = Callable[..., Iterator[Finding]]


def report(
    noun: Any, checks: tuple[Check, ...], *arguments: Any, room: str | None = None
) -> Report:
    """Run checks on an object; an exception becomes a failed finding and ends that check only.

    With a room, an object without all members of its kind has this as its only finding.
    """
    if room and (missing := missing_members(noun, room)):
        lack = f"no {', '.join(missing)}"
        return Report(repr(noun), (Finding("members", ", ".join(MEMBERS[room]), lack, False),))
    found: list[Finding] = []
    for check in checks:
        try:
            with np.errstate(all="ignore"):
                found += check(noun, *arguments)
        except Exception as error:
            name = (check.__doc__ or check.__name__).partition(".")[0].strip()
            what = f"{type(error).__name__}: {error}"
            found.append(Finding(name, "an answer", what[:400], False))
    words = repr(noun)
    return Report(words if len(words) < 200 else f"{words[:197]}...", tuple(found))


def same(
    name: str, found: npt.ArrayLike, expected: npt.ArrayLike, *, rtol: float, atol: float = 0.0
) -> Finding:
    """Compare arrays; the finding shows the pair with the largest deviation."""
    x, y = np.broadcast_arrays(np.asarray(found), np.asarray(expected))
    allowed = atol + rtol * np.abs(y)
    with np.errstate(invalid="ignore"):
        # the difference of equal infinities is nan
        off = np.where(x == y, 0.0, np.abs(x - y) - allowed)
    off = np.where(np.isnan(off), np.inf, off)
    worst = np.unravel_index(np.argmax(off), off.shape)
    return Finding(name, f"{y[worst]:.8g}", f"{x[worst]:.8g}", bool(off[worst] <= 0))


def holds(name: str, truth: Any, expected: Any, found: Any) -> Finding:
    """Record a condition; the finding shows `found` if it does not hold."""
    return Finding(name, f"{expected}", f"{found}", bool(truth))


def rises(name: str, values: npt.ArrayLike, *, slack: float = 1e-12) -> Finding:
    """Check that values never decrease by more than round-off."""
    v = np.asarray(values, dtype=float)
    fall = float(np.max(-np.diff(v), initial=0.0))
    largest = float(np.max(np.abs(v), initial=0.0))
    within = fall <= slack * largest and bool(np.all(np.isfinite(v)))
    found = f"a decrease of {fall:.4g} in values up to {largest:.4g}"
    return Finding(name, "no decrease", found, within)


def refused(error: Exception) -> bool:
    """Whether an exception is a rejection of the input with a reason, not a defect."""
    return isinstance(error, InputError) and len(str(error).split()) >= 3
