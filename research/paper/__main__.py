"""Build the manuscript: ``python -m research.paper``.

Computes its numbers, tables and figures, compares kept numbers with quick recomputations, and runs
Sphinx: HTML in out/paper/html, and out/paper/manuscript.pdf if latexmk and pdflatex are installed.
"""

import argparse
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

from . import figures, numbers

HERE = Path(__file__).parent
OUT = HERE.parents[1] / "out" / "paper"


def source(folder, *, drawn=True):
    """Write the folder from which Sphinx builds."""
    tables = folder / "tables"
    tables.mkdir(parents=True, exist_ok=True)
    values = numbers.numbers()
    text = (HERE / "manuscript.md").read_text("utf-8")
    unknown = set(re.findall(r"\{\{ *(\w+) *\}\}", text)) - set(values)
    if unknown:
        raise KeyError(f"the manuscript uses numbers that nothing computes: {sorted(unknown)}")
    (folder / "numbers.json").write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    for name, lines in numbers.tables().items():
        (tables / f"{name}.md").write_text(lines, encoding="utf-8")
    if drawn:
        figures.write(folder / "figures")
        shutil.copy(numbers.MEASURED / "comparison.png", folder / "figures" / "measured.png")
    for name in ("conf.py", "manuscript.md"):
        shutil.copy(HERE / name, folder / name)


def sphinx(builder, folder, target):
    """Run a builder of Sphinx; a warning is an error."""
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", builder]
    subprocess.run([*command, "-d", str(OUT / "cache"), str(folder), str(target)], check=True)


def main():
    """Build HTML, and a PDF if LaTeX is there."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--no-pdf", action="store_true", help="HTML alone")
    asked = parser.parse_args()
    folder = OUT / "source"
    source(folder)
    sphinx("html", folder, OUT / "html")
    print(f"{OUT / 'html' / 'manuscript.html'}")
    if asked.no_pdf:
        return
    if not (shutil.which("latexmk") and shutil.which("pdflatex")):
        print("no PDF: needs latexmk and pdflatex")
        return
    latex = OUT / "latex"
    sphinx("latex", folder, latex)
    command = ["latexmk", "-pdf", "-silent", "-interaction=nonstopmode", "manuscript.tex"]
    subprocess.run(command, cwd=latex, check=True, stdout=subprocess.DEVNULL)
    shutil.copy(latex / "manuscript.pdf", OUT / "manuscript.pdf")
    print(OUT / "manuscript.pdf")


if __name__ == "__main__":
    main()
