"""Export a surrogate as ONNX: ``file`` writes the file, ``graph`` records the formulas.

``python -m viscotack.surrogate.onnx FILE`` exports the surrogate of the package. Export needs
``pip install 'viscotack[onnx]'``; reading the file needs neither this package nor Python.
"""

from .file import CONFIDENCE, INPUTS, OUTPUTS, export

__all__ = ["CONFIDENCE", "INPUTS", "OUTPUTS", "export"]
