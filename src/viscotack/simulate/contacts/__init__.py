"""Indenters on bodies: discretised surface, node placement and relaxed state."""
