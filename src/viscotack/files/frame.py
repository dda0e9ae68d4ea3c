"""Tables by optional libraries: DataFrames by pandas, Parquet by pyarrow."""

from collections.abc import Mapping, Sequence
from typing import Any

from viscotack.errors import NotInstalled, install_command


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


def arrow(stored: str = "the table is stored") -> Any:
    """Import pyarrow and the submodules used in this package.

    Parameters
    ----------
    stored : str
        Subject of the error message: what needs pyarrow.

    Raises
    ------
    NotInstalled
        If pyarrow is not installed.
    """
    try:
        import pyarrow
        import pyarrow.compute
        import pyarrow.ipc
        import pyarrow.parquet
    except ImportError:
        raise NotInstalled(
            f"{stored} in Parquet, which needs pyarrow; install it with: "
            f"{install_command('campaign')}"
        ) from None
    return pyarrow
