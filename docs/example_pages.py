"""Examples on the site: titles for sphinx-gallery, their pictures, and an archive of files."""

import hashlib
import re
import shutil
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Copies of the examples with a title; they run there, and write their pictures into it.
STAGE = ROOT / "out/examples/scripts"
PAGES = ROOT / "docs/examples"
_INDEX = """\
Scripts, run
============

Each script of the folder ``examples``, run when this site was built, with its picture, what it
prints and its code. :doc:`Examples </docs/examples>` lists the files beside them.
"""


def pack(target):
    """Write an archive of the examples, which commands of the pages find when it is unpacked."""
    examples = ROOT / "examples"
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(examples.rglob("*")):
            name = path.relative_to(ROOT)
            # what running them has left is hidden, or compiled
            if path.is_file() and not any(part.startswith((".", "__")) for part in name.parts):
                archive.write(path, name)
        # pages call the case of their text lens.toml
        archive.write(examples / "from_toml/lens.toml", "lens.toml")


def stage():
    """Copy the examples; if the package has changed since they ran, have all of them run again."""
    STAGE.mkdir(parents=True, exist_ok=True)
    for old in STAGE.glob("*.py"):
        old.unlink()
    for example in sorted((ROOT / "examples").glob("*.py")):
        (STAGE / example.name).write_text(with_title(example.read_text("utf-8")), "utf-8")
    (STAGE / "GALLERY_HEADER.rst").write_text(_INDEX, "utf-8")
    sources = sorted((ROOT / "src/viscotack").rglob("*.py"))
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()
    mark = STAGE.parent / "package"
    if not mark.exists() or mark.read_text() != digest:
        shutil.rmtree(PAGES, ignore_errors=True)
        mark.write_text(digest)


def with_title(script):
    """Script whose docstring has its first sentence as the title of a page."""
    first, end, rest = re.match(r'"""(.+?)([.?!])(?:\s+|(?="))(.*)', script, re.DOTALL).groups()
    title = f"{' '.join(first.split())}{end if end != '.' else ''}"
    return f'"""{title}\n{"=" * len(title)}\n\n{rest}'


def pictures(block, variables, gallery, **more):
    """Pictures that a block of an example saved, as reST; a scraper of sphinx-gallery."""
    from sphinx_gallery.scrapers import figure_rst

    names, kept = variables["image_path_iterator"], []
    for found in sorted(STAGE.rglob("*.png")):
        kept.append(next(names))
        shutil.move(found, kept[-1])
    return figure_rst(kept, gallery["src_dir"])
