"""Manuscript on the steady crack: its computations, numbers, figures and build."""
