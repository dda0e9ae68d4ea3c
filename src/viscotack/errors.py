"""Wrong input, told apart from defects of the package."""

# Said of numbers with which arithmetic fails: 1e300 squared, or over nothing.
TOO_LARGE = "a number is too large or too small to compute with; check its unit"


class InputError(ValueError):
    """Bad input, said so that whoever gave it can mend it: what was wrong, given, and to be done.

    Whatever else escapes from the package, other than an error of the operating system or of a
    missing library, is a defect of it.
    """


class NotInstalled(InputError, ModuleNotFoundError):
    """A library that comes with an extra is missing; says which one and how to install it."""


class OutOfRange(InputError):
    """A problem that a theory, or what was learned, does not answer; says what is out of range."""
