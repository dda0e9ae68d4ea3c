"""Open datasets of simulated detachments, made by this package: load them, or make them again.

``load("broad")`` is a table of pyarrow, which comes with ``pip install 'viscotack[campaign]'``; so
are the other sets in NAMES. docs/datasets.md is their data card; the data are under
CC BY 4.0. ``python -m viscotack.datasets NAME --out DIR`` makes a set again.
"""

from .files import NAMES, load, metadata, path, plan_path

__all__ = ["NAMES", "load", "metadata", "path", "plan_path"]
