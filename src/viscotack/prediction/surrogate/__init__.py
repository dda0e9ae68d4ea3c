"""Surrogates: neural networks trained on simulations, evaluated with NumPy alone.

``model`` has the surrogate class, and ``contact`` the interface to its physics: ``physics``
(spheres on power laws), ``linear_solids`` (spheres on other solids), ``punch_physics`` and
``short_range``. ``network`` and ``line`` evaluate the networks, ``trust`` their intervals;
``store`` reads and writes files, including those of the package. The folder ``research`` of the
repository, which is not installed, made them and exports them as ONNX. ``import viscotack`` imports
nothing from here.
"""
