"""Steady cracks and pull-offs by other formulations than those of the package."""
