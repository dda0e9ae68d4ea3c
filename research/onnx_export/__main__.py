"""Export the surrogate of the package as ONNX: ``python -m research.onnx_export FILE``."""

import argparse
from pathlib import Path

from viscotack.prediction.surrogate.store import shipped

from .file import export


def main() -> None:
    """Write the file and print its path."""
    parser = argparse.ArgumentParser(
        prog="python -m research.onnx_export",
        description="Write the surrogate that comes with viscotack as one ONNX file.",
    )
    parser.add_argument(
        "file", type=Path, metavar="FILE", help="output file, for example tack.onnx"
    )
    file = parser.parse_args().file
    export(shipped(), file)
    print(file)


if __name__ == "__main__":
    main()
