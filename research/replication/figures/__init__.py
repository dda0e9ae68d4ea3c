"""Functions that make and draw the figures and tables of figures.toml."""
