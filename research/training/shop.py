"""Where networks are fitted: processes, and a folder of those that are done."""

import hashlib
import io
import os
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.files.whole import write_whole
from viscotack.prediction.surrogate.contact import LEAST_WAY, STEEP
from viscotack.prediction.surrogate.network import Networks, from_arrays

from .fitting import Fit, Task, fit


@dataclass
class Shop:
    """Processes that fit networks, which do not depend on how many `workers` there are.

    The folder keeps fitted networks, one file each; a run that was stopped goes on from there.
    """

    folder: Path
    workers: int = 1

    def __enter__(self) -> "Shop":
        self.folder.mkdir(parents=True, exist_ok=True)
        # Buffers of megabytes are made anew in every step; kept by the process, instead of given
        # back to the system and fetched again, they cost a third less time.
        os.environ.setdefault("MALLOC_MMAP_THRESHOLD_", str(2**32))
        os.environ.setdefault("MALLOC_TRIM_THRESHOLD_", str(2**34))
        self._pool = ProcessPoolExecutor(self.workers, mp_context=get_context("spawn"))
        return self

    def __exit__(self, *error: object) -> None:
        self._pool.shutdown(cancel_futures=True)

    def fit(self, task: Task, how: Fit, *, seed: int = 0) -> Future[Networks]:
        """Begin to fit a network."""
        return self._pool.submit(_fitted, task, how, seed, self.folder)


def _fitted(task: Task, how: Fit, seed: int, folder: Path) -> Networks:
    path = folder / f"{_name(task, how, seed)}.npz"
    if path.exists():
        with np.load(path, allow_pickle=False) as file:
            return from_arrays(file)
    found = fit(task, how, seed=seed)
    content = io.BytesIO()
    arrays: dict[str, Any] = {**found.arrays()}
    np.savez(content, **arrays)
    write_whole(path, content.getvalue())
    return found


def _name(task: Task, how: Fit, seed: int) -> str:
    meaning = STEEP, LEAST_WAY, task.inputs.shape, task.target.shape
    content = hashlib.sha256(repr((how, seed, meaning)).encode())
    arrays = [task.inputs, task.target, task.weight, *(task.between or ())]
    if task.before is not None:
        arrays += [task.before, np.array(task.gain)]
    if task.quantile is not None:
        arrays.append(np.array(task.quantile))
    for array in arrays:
        content.update(np.ascontiguousarray(array).tobytes())
    return content.hexdigest()[:20]
