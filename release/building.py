"""Wheels and sdist whose bytes depend on the sources and the build tools only."""

import gzip
import io
import os
import subprocess
import sys
import tarfile
from pathlib import Path

from .metadata import readme_for_index


def export(checkout: Path, folder: Path, url: str = "") -> None:
    """Write the committed files of a checkout into a folder, with the README for an index."""
    command = ["git", "archive", "--format=tar", "HEAD"]
    packed = subprocess.run(command, cwd=checkout, check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        archive.extractall(folder, filter="data")
    for path in folder.rglob("*"):
        # archives of wheels keep permissions, which depend on the umask
        path.chmod(0o755 if path.is_dir() or os.access(path, os.X_OK) else 0o644)
    readme = folder / "README.md"
    readme.write_text(readme_for_index(readme.read_text("utf-8"), url), "utf-8")


def commit_time(checkout: Path) -> int:
    """Time of the last commit in seconds since 1970, the time of every file of a release."""
    command = ["git", "log", "-1", "--format=%ct"]
    return int(subprocess.run(command, cwd=checkout, check=True, capture_output=True).stdout)


def build(source: Path, out: Path, epoch: int) -> list[Path]:
    """Build the sdist and the wheel of the package and the wheel of the data sets.

    Parameters
    ----------
    source : Path
        Folder that :func:`export` wrote; builds leave files in it.
    out : Path
        Folder for the results.
    epoch : int
        ``SOURCE_DATE_EPOCH``: time of the files in the archives [s since 1970].

    Returns
    -------
    list of Path
        The built files, sorted.
    """
    settings = os.environ | {"SOURCE_DATE_EPOCH": str(epoch)}
    for folder, kinds in ((source, ["--sdist", "--wheel"]), (source / "data", ["--wheel"])):
        command = [sys.executable, "-m", "build", "--no-isolation", *kinds, "--outdir", str(out)]
        done = subprocess.run([*command, str(folder)], env=settings, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{' '.join(command)}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    for sdist in out.glob("*.tar.gz"):
        sdist.write_bytes(settled(sdist.read_bytes(), epoch))
    return sorted([*out.glob("*.tar.gz"), *out.glob("*.whl")])


def settled(packed: bytes, epoch: int) -> bytes:
    """Tar archive with sorted names, one time and no owners, which setuptools does not write."""
    fresh = io.BytesIO()
    with (
        tarfile.open(fileobj=io.BytesIO(packed)) as old,
        gzip.GzipFile(fileobj=fresh, mode="wb", filename="", mtime=epoch) as compressed,
        tarfile.open(fileobj=compressed, mode="w", format=tarfile.PAX_FORMAT) as new,
    ):
        for member in sorted(old.getmembers(), key=lambda member: member.name):
            content = old.extractfile(member)
            member.mtime, member.uid, member.gid = epoch, 0, 0
            member.uname = member.gname = ""
            member.pax_headers = {}
            new.addfile(member, content)
    return fresh.getvalue()
