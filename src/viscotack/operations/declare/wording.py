"""Spelling of options and lists in messages."""

from collections.abc import Sequence


def flag(name: str) -> str:
    """Return an option as the command line spells it.

    Examples
    --------
    >>> flag("modulus_ratio")
    '--modulus-ratio'
    """
    return f"--{name.replace('_', '-')}"


def listed(words: Sequence[str]) -> str:
    """Return words with commas between them, and an "and" before the last.

    Examples
    --------
    >>> listed(["--tabor", "--rate", "--preload"])
    '--tabor, --rate and --preload'
    """
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
