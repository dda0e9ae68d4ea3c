"""Figures of results, predictions, fits and tack tests, in one style."""
