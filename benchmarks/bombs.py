"""Files made to take all memory or all time, given to every command that reads their format.

``python benchmarks/bombs.py [--folder FOLDER] [--only WORD]`` writes the files, runs each command
in a process of its own, and prints its peak memory [MB], its processor and wall time [s] and its
exit status beside the message. Memory is that of the largest process among the command and its
children. It ends with 1 if a command takes more than 300 MB or 5 s of processor time, prints a
traceback, or reports no error.
"""

from __future__ import annotations

import argparse
import gzip
import hashlib
import io
import json
import multiprocessing
import os
import shlex
import struct
import subprocess
import sys
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from time import monotonic

_INPUTS = ("tabor", "modulus_ratio", "exponent", "preload", "rate")
_PART = "xl/worksheets/sheet1.xml"
MOST_MEMORY, MOST_TIME = 300e6, 5.0
_TESTS = Path(__file__).parents[1] / "tests"

# Commands by what they read.
LAB = (
    "material fit {} --poisson-ratio 0.5",
    "material fit {good} --poisson-ratio 0.5 --shift-file {}",
    "theory persson-brener --modulus-table {} --rubbery-modulus 1MPa",
)
TACK = (
    "test read {}",
    "identify slow {} --radius 5mm",
    "identify rates {} --material pdms-10-1 --radius 5mm",
)
BOTH = (LAB[0], TACK[0])
CASE = ("predict {}", "simulate case {}", "advise {}", "campaign inputs {}")
TOML = (*CASE, "campaign plan {}", "study {}", "forecast {}", "material show {}")
RESULT = ("show {}",)
ROWS = ("predict {} --csv -", "sweep {case} {}", "campaign plan {}", LAB[2])
STORE = ("campaign status {}", "campaign verify {}", "campaign export {} --csv -")
FOREIGN = ("material convert {} --from rheojax", "material convert {} --from abaqus")
ANY = (LAB[0], TACK[0], CASE[0], TOML[4], TOML[5], TOML[7], RESULT[0], ROWS[1], FOREIGN[0])


@dataclass(frozen=True)
class Bomb:
    """A file, what writes it, and the commands that are given it."""

    name: str
    write: Callable[[Path], object]
    commands: tuple[str, ...]


def _text(content: str) -> Callable[[Path], object]:
    return lambda path: path.write_text(content, encoding="utf-8")


def _repeated(head: str, piece: str, count: int, tail: str = "") -> Callable[[Path], object]:
    def write(path: Path) -> None:
        with path.open("w", encoding="utf-8") as file:
            file.write(head)
            for _ in range(count // 1000):
                file.write(piece * 1000)
            file.write(tail)

    return write


def _zip(path: Path, parts: dict[str, bytes]) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)


def _book(rows: str = "", parts: dict[str, str] | None = None) -> Callable[[Path], object]:
    def write(path: Path) -> None:
        from test_bounded_files import BOOK, HEAD, TAIL

        sheet = {_PART: HEAD + rows + TAIL}
        found = BOOK | sheet | (parts or {})
        _zip(path, {name: content.encode() for name, content in found.items()})

    return write


def _nested_zip(path: Path) -> None:
    inner = b"\0" * 10_000_000
    for _ in range(4):
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for i in range(10):
                archive.writestr(f"segments/{i}/part.zip", inner)
        inner = packed.getvalue()
    path.write_bytes(inner)


def _quadratic(path: Path) -> None:
    kinds = f'<!DOCTYPE x [<!ENTITY a "{"y" * 100_000}">]>'
    _book("", {"xl/sharedStrings.xml": f"{kinds}<sst>{'&a;' * 50_000}</sst>"})(path)


def _shared(path: Path) -> None:
    item = f"<si><t>{'x' * 32_000}</t></si>"
    rows = "".join(
        f'<row r="{i}"><c r="A{i}" t="s"><v>{i % 1000}</v></c></row>' for i in range(1, 100_000)
    )
    name = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml.sharedStrings+xml"
    types = f'<Override PartName="/xl/sharedStrings.xml" ContentType="{kind}"/></Types>'
    from test_bounded_files import BOOK

    parts = {
        "[Content_Types].xml": BOOK["[Content_Types].xml"].replace("</Types>", types),
        "xl/sharedStrings.xml": f'<sst xmlns="{name}">{item * 1000}</sst>',
    }
    _book(rows, parts)(path)


def _old_book(path: Path) -> None:
    # a compound file whose sector table states four billion sectors
    head = (
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
        + bytes(16)
        + struct.pack("<HHHHH", 62, 3, -2 & 0xFFFF, 9, 6)
    )
    head += bytes(10) + struct.pack("<IIIIIIIII", 2**31, 0, 0, 4096, 0, 2**31, 0, 2**31, 0)
    path.write_bytes(head.ljust(512, b"\0") + bytes(4096))


def _hdf(path: Path) -> None:
    try:
        import h5py
    except ImportError:
        path.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(4096))
        return
    with h5py.File(path, "w") as file:
        group = file.create_group("0")
        group.attrs["software"] = "afmformats"
        for name in ("force", "height (measured)", "time"):
            group.create_dataset(name, (10**10,), "f8", chunks=(10**6,), compression="gzip")
        file.attrs["software"] = "afmformats"


def _packed_map(path: Path) -> None:
    zeros = bytes(190_000_000)
    _zip(
        path,
        {
            "header.properties": b"type=force-scan-map\n",
            "index/0/segments/0/segment-header.properties": b"force-segment-header.num-points=9\n",
            "index/0/segments/0/channels/vDeflection.dat": zeros,
        },
    )


def _packed_curve(path: Path) -> None:
    _zip(
        path,
        {
            "segments/0/segment-header.properties": b"a=1\n",
            **{f"segments/0/channels/{i}.dat": bytes(19_000_000) for i in range(10)},
        },
    )


def _wave(path: Path) -> None:
    head = bytearray(1000)
    struct.pack_into("<hHiiii4i4iiii", head, 0, 5, 0, 2**31 - 1, 0, 2**31 - 1, 0, *[0] * 11)
    struct.pack_into("<ih", head, 64 + 12, 4_900_000, 4)
    struct.pack_into("<4i", head, 64 + 68, 4_900_000, 1, 0, 0)
    path.write_bytes(bytes(head))


def _nid(path: Path) -> None:
    path.write_bytes(
        b"[DataSet]\nGr0-Ch0=DataSet-0:0\n[DataSet-0:0]\nPoints=100000000000\nLines=1\n"
        b"SaveBits=32\nFrame=Spec forward\n#!" + bytes(100)
    )


def _npz(shape: str, size: int) -> Callable[[Path], object]:
    def write(path: Path) -> None:
        head = (
            f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape},), }}".ljust(117) + "\n"
        )
        array = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode()
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            with archive.open("header.npy", "w") as member:
                member.write(array)
                for _ in range(size // 1_000_000):
                    member.write(bytes(1_000_000))

    return write


def _campaign(write: Callable[[Path], None]) -> Callable[[Path], None]:
    """Write a campaign whose table of cases is another one, with its hash."""

    def make(path: Path) -> None:
        from viscotack.campaign.provenance import read_provenance, write_provenance

        plan = path.with_suffix(".toml")
        plan.write_text("[[grid]]\n" + "".join(f"{name} = 1\n" for name in _INPUTS))
        run(["campaign", "run", str(plan), "--out", str(path)])
        file = path / "cases.parquet"
        before = hashlib.sha256(file.read_bytes()).hexdigest()
        write(file)
        after = hashlib.sha256(file.read_bytes()).hexdigest()
        forged = json.dumps(read_provenance(path)).replace(before, after)
        write_provenance(path, {k: v for k, v in json.loads(forged).items() if k != "seal"})

    return make


def _parquet_rows(file: Path) -> None:
    """Write a hundred million rows in three megabytes."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    ones = pa.array([1.0] * 1_000_000)
    words = pa.array(["x"] * 1_000_000).dictionary_encode()
    rows = pa.table({"name": words, **dict.fromkeys(_INPUTS, ones)})
    with pq.ParquetWriter(file, rows.schema, compression="zstd") as writer:
        for _ in range(100):
            writer.write_table(rows)


def _parquet_words(file: Path) -> None:
    """Write 200 words of ten megabytes in 600 bytes; what the file states of itself is small."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    words = pa.DictionaryArray.from_arrays(pa.array([0] * 200, pa.int32()), ["x" * 10_000_000])
    pq.write_table(pa.table({"name": words}), file, compression="zstd", store_schema=False)


def _deep_provenance(path: Path) -> None:
    path.mkdir()
    (path / "provenance.json").write_text("[" * 200_000 + "]" * 200_000)


def _long_provenance(path: Path) -> None:
    path.mkdir()
    with (path / "provenance.json").open("wb") as file:
        file.truncate(400_000_000)


def _long_cell(path: Path) -> None:
    text = "x" * 150_000_000
    _book(f'<row><c t="inlineStr"><is><t>{text}</t></is></c></row>')(path)


def _elsewhere(path: Path) -> None:
    from test_bounded_files import BOOK, HEAD, TAIL

    sheet = f'{HEAD}<row r="1048576"><c r="XFD1048576"><v>1</v></c></row>{TAIL}'
    parts = {name: text.replace("worksheets/sheet1", "theme/a") for name, text in BOOK.items()}
    _zip(path, {name: text.encode() for name, text in (parts | {"xl/theme/a.xml": sheet}).items()})


def _lying(path: Path) -> None:
    # a part states 100 bytes, and the checksum of these; it unpacks to 50 MB
    from test_bounded_files import BOOK, HEAD

    start = HEAD.encode().ljust(100)
    _zip(path, {n: t.encode() for n, t in BOOK.items()} | {_PART: start + b" " * 50_000_000})
    content = bytearray(path.read_bytes())
    stated = struct.pack("<I", zlib.crc32(start))
    for mark, at in ((b"PK\x03\x04", 14), (b"PK\x01\x02", 16)):
        place = content.rindex(mark)
        content[place + at : place + at + 4] = stated
        content[place + at + 8 : place + at + 12] = struct.pack("<I", 100)
    path.write_bytes(content)


def _filled(path: Path) -> None:
    _book(("<row>" + "<c><v>1</v></c>" * 100 + "</row>") * 49_000)(path)


def _named_columns(path: Path) -> None:
    names = ",".join(f"c{i}" for i in range(1_000_000))
    path.write_text(f"{names}\n{'1,' * 999_999}1\n")


def _tables(path: Path) -> None:
    path.write_text("".join(f"[t{i}]\n" for i in range(200_000)))


def _grid(path: Path) -> None:
    values = ", ".join(str(1 + i / 1e3) for i in range(1000))
    axes = "".join(f"{name} = [{values}]\n" for name in ("tabor", "rate", "preload"))
    path.write_text(f"[[grid]]\n{axes}modulus_ratio = 0.1\nexponent = 0.5\n")


def _utf16(path: Path) -> None:
    path.write_bytes(b"\xff\xfe" + "1,".encode("utf-16-le") * 20_000_000)


def _gzip(path: Path) -> None:
    path.write_bytes(gzip.compress(bytes(200_000_000)))


def _hole(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(3_000_000_000)


_NEVER = "x = [" + "\n".join(["  " + "1, " * 100] * 1900) + "\n]\ny = 1\ny = 2\n"
_RESULTS = '{"Results": ['
_RECORD = '{"parameters": {"G_inf": {"value": '
_TABLE = "f, E', E'', T\nHz, MPa, MPa, C\n"
BOMBS = [
    Bomb("a device", lambda path: path.symlink_to("/dev/zero"), ANY),
    Bomb("a pipe", lambda path: os.mkfifo(path), ANY),
    Bomb("a folder", lambda path: path.mkdir(), ANY),
    Bomb("a hole.csv", _hole, ANY),
    Bomb("far cell.xlsx", _book('<row r="1048576"><c r="XFD1048576"><v>1</v></c></row>'), BOTH),
    Bomb("sparse.xlsx", _book('<row r="200000"><c r="Y200000"><v>1</v></c></row>'), BOTH),
    Bomb("far cell elsewhere.xlsx", _elsewhere, BOTH),
    Bomb("wrong size.xlsx", _lying, BOTH),
    Bomb("long cell.xlsx", _long_cell, BOTH),
    Bomb("filled.xlsx", _filled, BOTH),
    Bomb("shared texts.xlsx", _shared, BOTH),
    Bomb("entities.xlsx", _quadratic, BOTH),
    Bomb("zip in zip.xlsx", _nested_zip, BOTH),
    Bomb("old book.xls", _old_book, BOTH),
    Bomb("zip in zip.jpk-force", _nested_zip, TACK),
    Bomb("packed.jpk-force", _packed_curve, TACK),
    Bomb("packed.jpk-force-map", _packed_map, TACK),
    Bomb("shape.h5", _hdf, TACK),
    Bomb("shape.ibw", _wave, TACK),
    Bomb("shape.nid", _nid, TACK),
    Bomb("columns.csv", _repeated("", "f,", 1_000_000, "\n1\n"), (*BOTH, *ROWS)),
    Bomb("named columns.csv", _named_columns, (*BOTH, *ROWS)),
    Bomb("cell of 150 MB.csv", _repeated("a,b\n1,", "9" * 1000, 150_000, "\n"), (*BOTH, *ROWS)),
    Bomb("cell of 40 MB.csv", _repeated(_TABLE + "1,", "9" * 1000, 40_000, "\n"), BOTH),
    Bomb("rows.csv", _repeated(_TABLE, "1,2,3,20\n", 5_400_000), BOTH),
    Bomb("short rows.csv", _repeated(_TABLE, "1\n", 24_000_000), BOTH),
    Bomb("empty rows.csv", _repeated(_TABLE, "\n", 49_000_000), BOTH),
    Bomb("cells.csv", _repeated(_TABLE, "," * 1000, 49_000, "\n"), BOTH),
    Bomb("rows of 90 MB.csv", _repeated("a,b\n", "1,2\n", 22_000_000), ROWS),
    Bomb("one quote.csv", _repeated('a,b\n"', "1,2\n", 30_000_000), ROWS),
    Bomb("utf-16.csv", _utf16, (*BOTH, *ROWS)),
    Bomb("packed.csv.gz", _gzip, (*BOTH, *ROWS)),
    Bomb("twice.toml", _text(_NEVER), TOML),
    Bomb("nested.toml", _text("x = " + "[" * 100_000 + "]" * 100_000), TOML),
    Bomb("dotted.toml", _text(".".join("a" * 40_000) + " = 1"), TOML),
    Bomb("numbers.toml", _repeated("x = [", "1, " * 100, 6_000, "]\n"), TOML),
    Bomb("tables.toml", _tables, TOML),
    Bomb("grid.toml", _grid, TOML[4:5]),
    Bomb("digits.toml", _repeated("x = ", "9" * 1000, 1000), TOML),
    Bomb("nested.json", _text(_RESULTS + "[" * 200_000), (LAB[0], *FOREIGN)),
    Bomb("objects.json", _repeated(_RESULTS, '{"a":[]},', 5_000_000, "{}]}"), (LAB[0], FOREIGN[0])),
    Bomb("digits.json", _repeated(_RECORD, "9" * 1000, 20_000, "}}}"), (LAB[0], FOREIGN[0])),
    Bomb("shape.npz", _npz("10000000000000", 1_000_000), RESULT),
    Bomb("packed.npz", _npz("112500000", 900_000_000), RESULT),
    Bomb("rows campaign", _campaign(_parquet_rows), STORE),
    Bomb("words campaign", _campaign(_parquet_words), STORE),
    Bomb("deep campaign", _deep_provenance, STORE),
    Bomb("long campaign", _long_provenance, STORE),
]  # fmt: skip


@dataclass(frozen=True)
class Outcome:
    """What a command did with a file."""

    status: int
    memory: float
    processor: float
    wall: float
    said: str

    @property
    def wrong(self) -> str:
        """What is wrong, or nothing."""
        found = ["memory"] * (self.memory > MOST_MEMORY) + ["time"] * (self.processor > MOST_TIME)
        found += ["traceback"] * ("Traceback" in self.said or self.status not in (1, 2))
        return ", ".join(found)


def run(words: list[str], most: float = 60.0) -> Outcome:
    """Run a command with at most 8 GB of address space, and measure it and its children."""
    limited = f"import resource as r; r.setrlimit(r.RLIMIT_AS, (8 << 30, 8 << 30)); {_PROGRAM}"
    before = monotonic()
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(
            ["timeout", str(most), sys.executable, "-c", limited, *words],
            stdout=said, stderr=said, stdin=subprocess.DEVNULL,
        )  # fmt: skip
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        told = said.read().decode("utf-8", "replace")
    took = monotonic() - before
    spent = used.ru_utime + used.ru_stime
    return Outcome(process.returncode, 1024.0 * used.ru_maxrss, spent, took, told)


_PROGRAM = "from viscotack.app.cli import main; main()"


def _cases(folder: Path, only: str) -> Iterator[tuple[Bomb, Path]]:
    for bomb in BOMBS:
        if only in bomb.name:
            path = folder / bomb.name.replace(" ", "_")
            if not path.exists() and not path.is_symlink():
                # a child: the peak memory of this process is counted as that of its children
                child = multiprocessing.get_context("fork").Process(target=bomb.write, args=(path,))
                child.start()
                child.join()
            yield bomb, path


def main() -> int:
    """Run all commands; return 1 if one takes too much."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--only", default="")
    asked = parser.parse_args()
    sys.path.append(str(_TESTS))
    from lab_files import plain
    from stated import case_text

    bad = count = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = asked.folder or Path(temporary)
        folder.mkdir(exist_ok=True)
        (folder / "good.csv").write_bytes(plain())
        (folder / "case.toml").write_text(case_text())
        others = {name: str(folder / f"{name}") for name in ("good.csv", "case.toml")}
        named = {name.partition(".")[0]: path for name, path in others.items()}
        for bomb, path in _cases(folder, asked.only):
            for command in bomb.commands:
                words = [word.format(path, **named) for word in shlex.split(command)]
                found = run(words)
                last = found.said.strip().splitlines()[-1:] or [""]
                bad, count = bad + bool(found.wrong), count + 1
                print(
                    f"{found.wrong or 'ok':<18} {found.status:>4} {found.memory / 1e6:>6.0f} MB "
                    f"{found.processor:>5.1f} s {found.wall:>5.1f} s  {bomb.name}: "
                    f"{' '.join(command.split()[:2])}: {last[0][:110]}",
                    flush=True,
                )
    print(
        f"{count} runs, {bad} of them beyond {MOST_MEMORY / 1e6:g} MB or {MOST_TIME:g} s, or "
        "without a refusal"
    )
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
