"""A microsphere pulled off two silicones, predicted before it was compared: ``README.md``."""
