"""Settings that belong to the whole process, changed for a block of code in any thread."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from threading import Lock, RLock
from typing import Any, Literal

_LOCK, _WARNINGS = Lock(), RLock()
# One entry for each block that has one BLAS thread now; the first one restores the number.
_held: list[Any] = []


@cache
def _pools() -> tuple[Any, Any]:
    """Return the BLAS whose limit is of the calling thread, and those with one for the process.

    Cached, because the search is slow. The import loads the BLAS of SciPy, which a search before it
    would miss.
    """
    import scipy.linalg  # noqa: F401
    from threadpoolctl import ThreadpoolController

    found = ThreadpoolController()
    own = found.select(internal_api="mkl", threading_layer="openmp")
    paths = {each.filepath for each in found.lib_controllers}
    paths -= {each.filepath for each in own.lib_controllers}
    return own, found.select(filepath=list(paths))


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Run the enclosed code with one BLAS thread: the matrices are small, so more do not help.

    The number of BLAS threads changes the last digits. OpenBLAS has one number for the process, so
    the first of several threads in such blocks sets it, and the last one restores it.

    Examples
    --------
    >>> with one_blas_thread(), one_blas_thread():
    ...     pass
    """
    own, shared = _pools()
    with own.limit(limits=1, user_api="blas"):
        with _LOCK:
            _held.append(None if _held else _by_any_thread(shared, _limited))
        try:
            yield
        finally:
            with _LOCK:
                # blocks of several threads may end in any order
                limiter = _held.pop(0)
                if _held:
                    _held[0] = limiter
                else:
                    _by_any_thread(shared, lambda _: limiter.restore_original_limits())


def _limited(pools: Any) -> Any:
    return pools.limit(limits=1, user_api="blas")


def _by_any_thread(pools: Any, change: Callable[[Any], Any]) -> Any:
    """Change limits that threadpoolctl, from 3.8 on, leaves to the thread that set them first."""
    for pool in pools.lib_controllers:
        getattr(pool, "clear_controlling_thread", lambda **_: None)(force=True)
    changed = change(pools)
    for pool in pools.lib_controllers:
        getattr(pool, "clear_controlling_thread", lambda **_: None)(force=True)
    return changed


@contextmanager
def caught_warnings(action: Literal["always", "ignore"]) -> Iterator[list[Any]]:
    """Catch the warnings of the enclosed code, in one thread at a time.

    ``warnings.catch_warnings`` in two threads may end in the wrong order, and would leave the
    process without warnings.

    Examples
    --------
    >>> with caught_warnings("always") as caught:
    ...     warnings.warn("slow", stacklevel=1)
    >>> str(caught[0].message)
    'slow'
    """
    with _WARNINGS, warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter(action)
        yield caught
