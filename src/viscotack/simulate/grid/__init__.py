"""Boundary elements on a rectangular grid: surfaces without an axis, by fast Fourier transforms."""
