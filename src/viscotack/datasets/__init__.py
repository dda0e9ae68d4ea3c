"""Open datasets of simulated detachments, made by this package: load them, or make them again.

``load("broad")`` is a table of pyarrow; so are the other sets in NAMES. pyarrow and the files, the
distribution ``viscotack-data``, come with ``pip install 'viscotack[data]'``; in a checkout the
files are found in its folder ``data``. docs/datasets.md is their data card; the data are under
CC BY 4.0. In a checkout ``python -m research.datasets NAME --out DIR`` makes a set again.
"""

from .files import NAMES, load, metadata, path, plan_path

__all__ = ["NAMES", "load", "metadata", "path", "plan_path"]
