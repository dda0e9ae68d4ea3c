"""pyarrow, which reads and writes Parquet and comes with the extra ``campaign``."""

from typing import Any

from viscotack.errors import NotInstalled


def arrow(stored: str = "campaigns are stored") -> Any:
    """Import pyarrow with the modules that are used here.

    Parameters
    ----------
    stored : str
        What needs it, for the error.

    Raises
    ------
    NotInstalled
        If it is missing.
    """
    try:
        import pyarrow
        import pyarrow.compute
        import pyarrow.feather
        import pyarrow.parquet
    except ImportError:
        raise NotInstalled(
            f"{stored} in Parquet, which needs pyarrow; install it with "
            "pip install 'viscotack[campaign]'"
        ) from None
    return pyarrow
