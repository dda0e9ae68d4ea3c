"""Command `python -m release`, from the root of a checkout: `make release` calls it."""

import argparse
import hashlib
import shutil
import sys
import tempfile
from pathlib import Path

from .building import build, commit_time, export
from .metadata import CODEMETA, ROOT, codemeta, notes, recipe


def main() -> int:
    """Write the release folder, or `codemeta.json`."""
    parser = argparse.ArgumentParser(prog="python -m release", description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "out/release", help="release folder")
    parser.add_argument("--url", default="", help="address of the files of this release")
    parser.add_argument("--sbom", type=Path, help="bill of materials to include")
    parser.add_argument("--codemeta", action="store_true", help="write codemeta.json only")
    given = parser.parse_args()
    if given.codemeta:
        CODEMETA.write_text(codemeta(), "utf-8")
        return 0
    release(given.out, given.url, given.sbom)
    print(*sorted(path.name for path in given.out.iterdir()), sep="\n")
    return 0


def release(out: Path, url: str = "", sbom: Path | None = None) -> None:
    """Build twice, compare the bytes, and write everything that a release consists of.

    Raises
    ------
    RuntimeError
        If a build fails, or two builds of the same commit differ.
    """
    if out.exists():
        shutil.rmtree(out)
    out.mkdir(parents=True)
    epoch = commit_time(ROOT)
    with tempfile.TemporaryDirectory() as place:
        first, second = (_built(Path(place) / name, url, epoch) for name in ("one", "other"))
        if first != second:
            names = {name for name, _ in first.items() ^ second.items()}
            raise RuntimeError(f"two builds differ: {', '.join(sorted(names))}")
        for name, content in first.items():
            (out / name).write_bytes(content)
    (sdist,) = out.glob("*.tar.gz")
    (out / "recipe.yaml").write_text(recipe(sdist.name, _digest(sdist)), "utf-8")
    (out / "NOTES.md").write_text(notes(), "utf-8")
    for name in ("CITATION.cff", "codemeta.json"):
        shutil.copy(ROOT / name, out)
    if sbom:
        shutil.copy(sbom, out / "sbom.json")
    listed = [f"{_digest(path)}  {path.name}\n" for path in sorted(out.iterdir())]
    (out / "SHA256SUMS").write_text("".join(listed), "utf-8")


def _built(place: Path, url: str, epoch: int) -> dict[str, bytes]:
    source, out = place / "source", place / "out"
    source.mkdir(parents=True)
    export(ROOT, source, url)
    return {path.name: path.read_bytes() for path in build(source, out, epoch)}


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


if __name__ == "__main__":
    sys.exit(main())
