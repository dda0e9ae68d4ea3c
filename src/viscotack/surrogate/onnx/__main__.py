"""Write the surrogate of the package: ``python -m viscotack.surrogate.onnx FILE``."""

import argparse
from pathlib import Path

from ..store import shipped
from .file import export


def main() -> None:
    """Write it and say where it is."""
    parser = argparse.ArgumentParser(
        prog="python -m viscotack.surrogate.onnx",
        description="Write the surrogate that comes with viscotack as one ONNX file.",
    )
    parser.add_argument("file", type=Path, metavar="FILE", help="where to, for example tack.onnx")
    file = parser.parse_args().file
    export(shipped(), file)
    print(file)


if __name__ == "__main__":
    main()
