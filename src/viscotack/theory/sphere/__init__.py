"""Theories of the detachment of a sphere from a viscoelastic solid."""
