"""Steady cracks and pull-offs by formulations that share nothing with the package but the statement."""
