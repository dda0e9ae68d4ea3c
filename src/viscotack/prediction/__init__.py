"""Predictions and their validity: surrogates, theories and the simulation, and their choice."""
