"""The pictures of gallery/README.md, small, from the kept numbers."""

from pathlib import Path

from PIL import Image

from .bench import picture
from .figures.catalogue import figures
from .kept import kept

PICTURES = Path(__file__).with_name("gallery")


def write() -> None:
    """Draw the pictures with the 256 colours that lines and words need."""
    for name in figures():
        path = picture(name, kept(name), PICTURES, dpi=64)
        with Image.open(path) as drawn:
            few = drawn.convert("RGB").quantize(
                256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE
            )
        few.save(path, optimize=True)
