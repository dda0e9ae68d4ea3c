"""Exceptions for invalid input, as opposed to defects of the package."""

# Message for numbers that overflow or divide by zero, such as 1e300 squared.
TOO_LARGE = "a number is too large or too small to compute with; check its unit"


class InputError(ValueError):
    """Invalid input: the message states the problem, the value with its unit, and a remedy.

    Any other exception raised by the package, except an error of the operating system or a
    missing library, is a defect.
    """


class NotInstalled(InputError, ModuleNotFoundError):
    """An optional library is missing; the message contains the command that installs it."""


class OutOfRange(InputError):
    """A problem outside the range of a theory or surrogate; the message names the quantity."""
