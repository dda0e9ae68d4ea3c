"""Integrity check of the folder of a campaign."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.files.arrow import arrow

from .cases import Cases, packed
from .parts import Part, Parts
from .store import Store, hash_of


@dataclass(frozen=True)
class Verdict:
    """Outcome of :func:`verify`.

    Attributes
    ----------
    files, rows : int
        Number of checked files and rows.
    wrong : tuple of str
        A sentence for each difference; () if there is none.
    strange : tuple of str
        Files that do not belong to the campaign; they are neither read nor removed.
    """

    files: int
    rows: int
    wrong: tuple[str, ...]
    strange: tuple[str, ...]


def verify(store: Store) -> Verdict:
    """Check that the folder of a campaign is complete and unchanged.

    All files are compared with the hashes in the provenance (whose own hash is checked when the
    store is opened), and the name and inputs of each row with the plan.

    Parameters
    ----------
    store : Store
        The folder.

    Returns
    -------
    Verdict
        Number of files and rows, and the differences.

    Examples
    --------
    >>> import tempfile
    >>> from viscotack import AtDepth, Elastic, Groups
    >>> from viscotack.campaign import Store, every_combination
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> base = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     verify(Store.create(folder, every_combination(base, {"tabor": [1, 2]}))).wrong
    ()
    """
    wrong = list(store.lost())
    if store.merging:
        wrong.append(f"{store.folder} holds a merge that has not ended; merge again into it")
    damaged = [*_wrong_files(store)]
    cases = None if damaged else store.cases()
    wrong += damaged
    files, rows = len(store.files()), 0
    strange: list[str] = []
    for name, parts in store.parts().items():
        seen: list[Any] = []
        for part in parts.kept():
            files, rows = files + 1, rows + part.rows
            wrong += _wrong_part(parts, part, cases, seen)
        if name == "results" and seen:
            names = np.concatenate(seen)
            if again := len(names) - len(np.unique(names)):
                wrong.append(f"{parts.folder}: {again} cases are stored more than once; one counts")
        strange += map(str, parts.strangers())
    return Verdict(files, rows, tuple(wrong), tuple(strange))


def _wrong_files(store: Store) -> Iterator[str]:
    for name, hashes in store.files().items():
        found = hash_of(store.folder / name)
        if found is None:
            yield f"{store.folder / name} is missing"
        elif found not in hashes:
            yield f"{store.folder / name} is not what was written: its hash is another"


def _wrong_part(parts: Parts, part: Part, cases: Cases | None, seen: list[Any]) -> Iterator[str]:
    try:
        table = parts.checked(part)
    except FileNotFoundError:
        yield f"{parts.folder / part.name} is missing: {part.rows} rows"
        return
    except InputError as error:
        yield str(error)
        return
    names = packed(table.column("name").to_pylist())
    seen.append(names)
    if cases is None:
        return
    places = cases.places(names)
    known = places >= 0
    for name, values in cases.columns.items():
        if name not in table.column_names or not known.any():
            continue
        # of a part without a value a column has no type of its own
        stored = table.column(name).cast(arrow().float64()).to_numpy(zero_copy_only=False)
        if not np.array_equal(stored[known], values[places[known]], equal_nan=True):
            yield f"{parts.folder / part.name}: {name} of a row is not that of its case in the plan"
