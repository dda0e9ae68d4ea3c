"""Learned answers: what was learned from simulations, evaluated with NumPy alone.

``model`` has the one surrogate, ``contact`` what physics is plugged in: ``physics`` (spheres on
power laws), ``linear_solids`` (on others), ``punch_physics`` and ``short_range``. ``network`` and
``line`` have what is said with it, ``trust`` how sure it is; ``store`` reads and writes files, and
has those of the package; ``onnx`` exports one to other programs. The repository trains them in its
folder ``training``, which is not installed. Nothing here is imported by ``import viscotack``.
"""
