"""Earlier names of functions and attributes, kept for one release with a DeprecationWarning.

docs/migration.md lists all of them.
"""

import warnings
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def earlier_names(
    module: str, names: Mapping[str, str], otherwise: Callable[[str], Any] | None = None
) -> Callable[[str], Any]:
    """Create the ``__getattr__`` of a module from which names were moved or renamed.

    Parameters
    ----------
    module : str
        ``__name__`` of the module.
    names : mapping
        Old name -> dotted path of the new object.
    otherwise : callable, optional
        Lookup for all other names; without it they raise an AttributeError.

    Returns
    -------
    callable
        The function to assign to ``__getattr__``.
    """

    def found(name: str) -> Any:
        if name not in names and otherwise is not None:
            return otherwise(name)
        if name not in names:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        _warn(f"{module}.{name}", names[name])
        home, _, new = names[name].rpartition(".")
        return getattr(import_module(home), new)

    return found


class Renamed:
    """Descriptor for an attribute of a class under its earlier name.

    Examples
    --------
    >>> class Peak:
    ...     force = 2.5
    ...     value = Renamed("force")
    >>> with warnings.catch_warnings(action="always", record=True) as given:
    ...     Peak().value
    2.5
    >>> print(given[0].message)
    Peak.value is Peak.force now
    """

    def __init__(self, new: str) -> None:
        self._new = new

    def __set_name__(self, owner: type, name: str) -> None:
        self._old = name

    def __get__(self, instance: Any, owner: type) -> Any:
        if instance is None:
            return self
        _warn(f"{owner.__name__}.{self._old}", f"{owner.__name__}.{self._new}")
        return getattr(instance, self._new)


def _warn(old: str, new: str) -> None:
    warnings.warn(f"{old} is {new} now", DeprecationWarning, stacklevel=3)
