"""Tables as pandas DataFrames, where pandas is installed."""

from collections.abc import Mapping, Sequence
from typing import Any

from viscotack.errors import NotInstalled


def frame(table: Mapping[str, Any] | Sequence[Mapping[str, Any]]) -> Any:
    """Return columns by name, or rows, as a pandas DataFrame.

    Raises
    ------
    NotInstalled
        If pandas is not installed.
    """
    try:
        import pandas  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise NotInstalled(
            "a data frame needs pandas; install it with: python -m pip install pandas"
        ) from None
    return pandas.DataFrame(table)
