"""Indenters on bodies: the surface of given nodes, where nodes go, the relaxed state."""
