"""Learned answers: what was learned from simulations, evaluated with NumPy alone.

``physics`` has what is known without learning, ``network`` and ``line`` what is said with it,
``model`` puts them together, ``trust`` says how sure it is, ``store`` reads and writes files;
``shipped.npz`` is the surrogate of the package. How it was made is in ``training``, which
``python -m viscotack.surrogate`` runs; ``onnx`` hands it to other programs. Nothing here is
imported by ``import viscotack``.
"""
