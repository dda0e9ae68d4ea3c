"""Exceptions for invalid input, as opposed to defects of the package."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

# Message for numbers that overflow or divide by zero, such as 1e300 squared.
TOO_LARGE = "a number is too large or too small to compute with; check its unit"


class InputError(ValueError):
    """Invalid input: the message states the problem, the value with its unit, and a remedy.

    It is a `ValueError`. Its subclasses are `OutOfRange` and `NotInstalled`, which is an
    `ImportError` too. Others are `SimulationError`, a `RuntimeError`, for a simulation that stopped
    early; `TypeError` for an argument of the wrong kind; and `OSError` of the operating system. Any
    other exception raised by the package is a defect.

    Parameters
    ----------
    message : str
        The message; with a field it begins with its name.
    field : str
        Name of the invalid option of a request, which the command line spells ``--name``.
    """

    field = ""

    def __init__(self, *message: object, field: str = "") -> None:
        super().__init__(*message)
        self.field = field


class NotInstalled(InputError, ModuleNotFoundError):
    """An optional library is missing; the message contains the command that installs it."""


class OutOfRange(InputError):
    """A problem outside the range of a theory or surrogate; the message names the quantity."""


@contextmanager
def placed(where: str, field: str = "") -> Iterator[None]:
    """Put a place before the message of invalid input in the block, unless it names the file.

    Parameters
    ----------
    where : str
        Such as "lens.toml:" or "lens.toml, [protocol]".
    field : str
        Field of the error, if it names none itself.

    Examples
    --------
    >>> with placed("lens.toml:"):
    ...     raise InputError("radius must be positive")
    Traceback (most recent call last):
    viscotack.errors.InputError: lens.toml: radius must be positive
    """
    try:
        yield
    except ValueError as error:
        file = where.partition(", ")[0].removesuffix(":")
        if isinstance(error, InputError) and str(error).startswith(file):
            raise
        own = getattr(error, "field", "")
        raise InputError(f"{where} {error}", field=own or field) from None


# What pydantic's types of errors say.
_WANTED = {
    "tuple_type": "a list",
    "string_type": "text",
    "path_type": "the name of a file",
    **dict.fromkeys(("int_type", "int_parsing", "int_from_float"), "a whole number"),
    **dict.fromkeys(("bool_type", "bool_parsing"), "true or false"),
}


def wrong_value(error: Mapping[str, Any]) -> str:
    """Return what is wrong with a value, from an error of pydantic; its name stands before it."""
    own, message = error.get("ctx", {}).get("error"), error["msg"]
    wanted = message.removeprefix("Input should be ").removeprefix("a valid ")
    wanted = _WANTED.get(error["type"], wanted)
    return str(own or f"must be {wanted}, got {error['input']!r:.60}").strip()


def install_command(extra: str) -> str:
    """Command that installs an extra, a group of optional libraries, beside this package.

    Parameters
    ----------
    extra : str
        Name of the extra, such as "lab".

    Returns
    -------
    str
        For a package installed from an index or a wheel ``python -m pip install 'viscotack[lab]'``;
        for an editable installation the command with the path of the checkout, because the name
        alone would replace the checkout by a released version.
    """
    checkout = _checkout()
    if checkout is None:
        return f"python -m pip install 'viscotack[{extra}]'"
    place = "." if Path.cwd() == checkout else checkout
    return f"python -m pip install -e '{place}[{extra}]'"


def _checkout() -> Path | None:
    """Folder of an editable installation (PEP 610), or None."""
    # imported here: a command that needs no other library starts sooner without them
    import json
    from importlib.metadata import PackageNotFoundError, distribution
    from urllib.parse import urlparse
    from urllib.request import url2pathname

    try:
        origin = json.loads(distribution("viscotack").read_text("direct_url.json") or "{}")
    except PackageNotFoundError:
        return None
    if not origin.get("dir_info", {}).get("editable"):
        return None
    return Path(url2pathname(urlparse(origin["url"]).path))
