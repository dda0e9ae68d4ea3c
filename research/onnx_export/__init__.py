"""Export a surrogate as ONNX: ``file`` writes the file, ``graph`` records the formulas.

``python -m research.onnx_export FILE`` exports the surrogate of the package. Export needs
``pip install onnx``; reading the file needs neither this package nor Python.
"""

from .file import CONFIDENCE, INPUTS, OUTPUTS, export

__all__ = ["CONFIDENCE", "INPUTS", "OUTPUTS", "export"]
