"""A surrogate for other programs: ``file`` writes it as ONNX, ``graph`` notes its formulas down.

``python -m viscotack.surrogate.onnx FILE`` writes the one that comes with the package; it needs
``pip install 'viscotack[onnx]'``, reading the file needs neither this package nor Python.
"""

from .file import CONFIDENCE, INPUTS, OUTPUTS, export

__all__ = ["CONFIDENCE", "INPUTS", "OUTPUTS", "export"]
