"""Import of pyarrow, which reads and writes Parquet and is installed by the extra ``campaign``."""

from typing import Any

from viscotack.errors import NotInstalled, install_command


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
