"""A page that predicts without Python: the exported surrogate in ONNX Runtime Web.

``python -m release.static_page FOLDER`` writes it, as files for any web server; ``make docs`` makes
it part of the site. npm fetches the runtime, whose version and checksum are fixed here.
"""

import base64
import hashlib
import io
import json
import shutil
import subprocess
import tarfile
import tempfile
from pathlib import Path
from typing import Any

from viscotack.app import page
from viscotack.app.engine.forms import forms
from viscotack.cards import PLAUSIBLE
from viscotack.operations.parts.examples import FIRST
from viscotack.problem.outputs import REVOLUTION
from viscotack.surrogate.onnx import CONFIDENCE, export
from viscotack.surrogate.store import shipped
from viscotack.version import __version__

HERE = Path(__file__).parent
# Modules of the page of `viscotack app` that this one uses.
SHARED = (
    *("answer.js", "drawing.js", "fields.js", "numbers.js", "plot.js", "theme.js"),
    *("style.css", "icon.svg"),
)
RUNTIME, VERSION = "onnxruntime-web", "1.30.0"
_SHA512 = "q0y+JrrtukXSzsBWEMccVfqX25LRmosXHF+CaRJmg8pZClzcV7svNc4rKY3jL02Vb7QmRMDs1SigqR4CXAfKYQ=="
_FILES = ("dist/ort.wasm.bundle.min.mjs", "dist/ort-wasm-simd-threaded.wasm")
# The lens of examples/from_toml/lens.toml; 1.5 mN press it to this depth.
EXAMPLE = {
    "sphere": FIRST["sphere"],
    "protocol": {"preload_depth": "8.27 um", "speed": "100 um/s"},
    "material": FIRST["material"],
    "interface": FIRST["interface"],
}


def write(folder: Path) -> None:
    """Write the page with its model and its runtime into a folder.

    Raises
    ------
    RuntimeError
        If npm is missing, cannot fetch the runtime, or fetches other bytes.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("index.html", "predict.js"):
        shutil.copy(HERE / name, folder)
    for name in SHARED:
        shutil.copy(Path(page.__file__).parent / name, folder)
    export(shipped(), folder / "tack.onnx")
    (folder / "facts.json").write_text(json.dumps(facts()), "utf-8")
    for name, content in runtime().items():
        (folder / Path(name).name).write_bytes(content)


def facts() -> dict[str, Any]:
    """Fields, axes and ranges for the page, from the cards and from the surrogate."""
    asked = forms()
    (material,) = (x for x in asked["material"] if x["word"] == EXAMPLE["material"]["model"])
    (law,) = (x for x in asked["interface"] if x["word"] == EXAMPLE["interface"]["law"])
    (shape,) = (x for x in asked["shape"] if x["word"] == "sphere")
    protocol = asked["protocol"]["revolution"]
    (depth,) = (x for x in protocol["starts"] if x["key"] == "preload_depth")
    # all of the training range is pressed in
    depth |= {"above": 0, "range": "be positive", "example": "8 um"}
    numbers = {
        name: REVOLUTION.observables[name] for name in ("pull_off_force", "work_to_pull_off")
    }
    series = {name: REVOLUTION.of(name) for name in ("depth", "force")}
    return {
        "version": __version__,
        "confidence": CONFIDENCE,
        "limits": shipped().limits,
        "plausible": PLAUSIBLE,
        "example": EXAMPLE,
        "fields": {
            "sphere": shape["fields"],
            "protocol": [depth, protocol["speed"]],
            "material": material["fields"],
            # a range, not a strength
            "interface": [{k: v for k, v in x.items() if k != "or"} for x in law["fields"]],
        },
        "axes": {
            name: {"words": x.words, "unit": x.unit.si} for name, x in (numbers | series).items()
        },
    }


def runtime() -> dict[str, bytes]:
    """Files of ONNX Runtime Web, from its package on the registry of npm, by name."""
    npm = shutil.which("npm")
    if npm is None:
        raise RuntimeError("the page without Python needs npm, which fetches ONNX Runtime Web")
    with tempfile.TemporaryDirectory() as place:
        command = [npm, "pack", "--silent", f"{RUNTIME}@{VERSION}"]
        done = subprocess.run(command, cwd=place, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{' '.join(command)}\n{done.stderr[-2000:]}")
        packed = (Path(place) / f"{RUNTIME}-{VERSION}.tgz").read_bytes()
    found = base64.b64encode(hashlib.sha512(packed).digest()).decode()
    if found != _SHA512:
        raise RuntimeError(f"{RUNTIME} {VERSION} has the checksum {found}, expected {_SHA512}")
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        return {name: _content(archive, f"package/{name}") for name in _FILES}


def _content(archive: tarfile.TarFile, name: str) -> bytes:
    file = archive.extractfile(name)
    assert file is not None, name
    return file.read()
