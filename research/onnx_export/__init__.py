"""Export a surrogate as ONNX: ``file`` writes the file, ``graph`` records the formulas."""

from .file import export

__all__ = ["export"]
