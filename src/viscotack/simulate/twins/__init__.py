"""Slow, obvious twins of the solver, which share nothing with it but the problem."""
