"""Mutated files: every reader reads or refuses them, in 10 s and 1 GB.

``python -m fuzz.files --seed 7 --files 1000 [--only READER]`` mutates small files of every format,
1,000 for each reader, and prints those that cause another error than a refusal, or take too long.
``--number N`` repeats the one of a finding. The small files are those of the tests and examples.
Members of archives are mutated as well as the archives. It ends with 1 if something was found.
"""

from __future__ import annotations

import argparse
import io
import sys
import tempfile
import time
import traceback
import zipfile
from collections import Counter
from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from viscotack import InputError, lab, load, read_case, system
from viscotack.campaign.apart import IMPORTS, check
from viscotack.lab import tack
from viscotack.materials import Prony
from viscotack.materials.exchange import CODES, exported, imported
from viscotack.materials.passport_file import read_passport
from viscotack.pool.apart import Apart

from .__main__ import limited
from .answers import TooLong

ROOT = Path(__file__).parents[1]
sys.path.append(str(ROOT / "tests"))

import lab_files  # noqa: E402
import tack_files  # noqa: E402
from stated import SPHERE, case_text  # noqa: E402
from test_measured_damage import OTHERS, mutated  # noqa: E402

_PATIENCE, _MEMORY = 10.0, 1e9
Corpus = Mapping[str, bytes]
Reader = tuple[Callable[[Path], Any], Corpus]


def damaged(content: bytes, rng: np.random.Generator) -> bytes:
    """Return a mutated file: its bytes, or those of a member of an archive."""
    if not content.startswith(b"PK") or rng.integers(2):
        return mutated(content, rng)
    packed = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as before, zipfile.ZipFile(packed, "w") as after:
        names = before.namelist()
        chosen = names[rng.integers(len(names))]
        for name in names:
            part = before.read(name)
            after.writestr(name, mutated(part, rng) if name == chosen else part)
    return packed.getvalue()


def readers(folder: Path, child: Apart) -> dict[str, Reader]:
    """Return every reader with its corpus, of which some files are written in a folder first."""
    from viscotack.campaign.listed import read_words
    from viscotack.campaign.parts import parquet, table_of
    from viscotack.campaign.plan import read_plan
    from viscotack.files.parquet import read_parquet
    from viscotack.files.quantities import read_quantities
    from viscotack.materials.library import published
    from viscotack.materials.passport_file import write_passport
    from viscotack.operations import ask, operation
    from viscotack.operations.declare.study import read_study
    from viscotack.theory.crack.modulus_file import read_modulus

    test = tack_files.made()
    lab_files.workbook(folder / "film.xlsx")
    tack_files.workbook(test, folder / "tack.xlsx")
    write_passport(published("pdms-10-1"), folder / "pdms.toml")
    ask("simulate", problem=SPHERE, until="pull-off", accuracy=0.02).files["save"](
        folder / "result.npz"
    )
    books = {name: (folder / name).read_bytes() for name in ("film.xlsx", "tack.xlsx")}
    tests = {f"{name}.csv": make(test) for name, make in tack_files.TEXTS.items()}
    curves = {name: make(test) for name, make in tack_files.BINARIES.items()}
    examples = sorted((ROOT / "examples").rglob("*.toml"))
    cases = {p.name: _beside(p, "worn.csv") for p in examples if p.parent.name == "from_toml"}
    studies = {p.name: _beside(p, "../from_toml") for p in examples if p.parent.name == "studies"}

    def proven(path: Path) -> Any:
        file = path, sha256(path.read_bytes()).hexdigest()
        check(child, *file)
        return read_parquet(*file)

    def rows(path: Path) -> list[Any]:
        return list(read_words(path)[1])

    table = parquet(lambda: [table_of([{"name": "a", "tabor": 1.0, "curve": [1.0, 2.0]}] * 9)])
    csv = {
        "cases.csv": b"tabor,modulus_ratio,exponent,preload,rate\n1,0.1,0.5,1,10\n2,0.1,0.5,1,1\n"
    }
    moduli = {
        "dma.csv": b"frequency_Hz,storage_MPa,loss_MPa\n"
        b"1,2,0.1\n10,3,0.4\n100,5,1\n1e3,8,2\n1e4,20,4\n"
    }
    law = {"law.csv": b"gap_nm,traction_kPa\n0,0\n1,10\n2,20\n5,3\n9,0\n"}
    plans = {
        "grid.toml": b"[[grid]]\ntabor = [1, 2]\nmodulus_ratio = 0.1\nexponent = 0.5\npreload = 1\n"
        b"rate = [1, 10]\n[settings]\naccuracy = 0.01\n",
        **csv,
    }
    return {
        "dma": (lab.read, {**OTHERS, "film.xlsx": books["film.xlsx"]}),
        "shifts": (lab.read_shifts, {k: v for k, v in OTHERS.items() if b"aT" in v}),
        "tack": (tack.read, {**tests, **curves, "tack.xlsx": books["tack.xlsx"]}),
        "case": (read_case, {**cases, "stated.toml": case_text().encode()}),
        "plan": (read_plan, plans),
        "study": (lambda path: read_study(path, known=operation, usual="identify rates"), studies),
        "passport": (read_passport, {"pdms.toml": (folder / "pdms.toml").read_bytes()}),
        "result": (load, {"result.npz": (folder / "result.npz").read_bytes()}),
        "parquet": (proven, {"part.parquet": bytes(table)}),
        "rows": (rows, csv),
        "modulus": (lambda path: read_modulus(path, rubbery_modulus=1e6), moduli),
        "law": (lambda path: read_quantities(path, {"gap": "m", "traction": "Pa"}), law),
        "exchange": (_imported, _exports()),
    }


def _beside(path: Path, name: str) -> bytes:
    """Return a file in which the name of another one is its whole path."""
    whole = str((path.parent / name).resolve())
    return path.read_text(encoding="utf-8").replace(name, whole).encode()


def _exports() -> Corpus:
    arms = ((2e6, 0.1), (1e6, 1.0))
    material = Prony(rubbery_modulus=1e6, branches=arms, poisson_ratio=0.47)
    return {code: exported(material, code).encode() for code in CODES}


def _imported(path: Path) -> Any:
    text = path.read_text(encoding="utf-8", errors="replace")
    if path.name == "pyvisco":
        return imported(text, path.name, poisson_ratio=0.47)
    return imported(text, path.name)


def wrong(read: Callable[[Path], Any], path: Path) -> tuple[str, str]:
    """Return how a file was answered, "read" or "refused", or what is wrong."""
    began = time.process_time()
    try:
        with limited(_PATIENCE):
            read(path)
        how = "read"
    except (InputError, FileNotFoundError, ImportError):
        how = "refused"
    except TooLong:
        return "wrong", f"took more than {_PATIENCE:g} s"
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        name = f"{type(error).__name__} at {Path(place.filename).name}:{place.lineno}"
        return "wrong", f"{name}: {error!s:.100}"
    took = time.process_time() - began
    return (how, "") if took < _PATIENCE else ("wrong", f"took {took:.0f} s")


def main(arguments: list[str] | None = None) -> int:
    """Return the exit status of the command: 1 where something was found."""
    parser = argparse.ArgumentParser(prog="python -m fuzz.files", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--files", type=int, default=1000, help="files for each reader")
    parser.add_argument("--only", help="a reader")
    parser.add_argument("--number", type=int, help="one of the files of a reader")
    given = parser.parse_args(arguments)
    found = 0
    with tempfile.TemporaryDirectory() as temporary, Apart(IMPORTS) as child:
        folder = Path(temporary)
        known = readers(folder, child)
        for name in [given.only] if given.only else known:
            read, corpus = known[name]
            counts: Counter[str] = Counter()
            chosen = range(given.files) if given.number is None else [given.number]
            for number in chosen:
                rng = np.random.default_rng((given.seed, number))
                source = list(corpus)[rng.integers(len(corpus))]
                path = folder / source
                path.write_bytes(damaged(corpus[source], rng))
                with np.errstate(all="ignore"):
                    how, why = wrong(read, path)
                counts[how] += 1
                if how == "wrong":
                    found += 1
                    again = (
                        f"python -m fuzz.files --seed {given.seed} --only {name} --number {number}"
                    )
                    print(f"{name}, {source}: {why}\n  {again}", flush=True)
            print(f"{name}: {', '.join(f'{n} {how}' for how, n in counts.items())}", flush=True)
    return int(found > 0)


if __name__ == "__main__":
    system.bound_memory(int(system.address_space() + _MEMORY))
    sys.exit(main())
