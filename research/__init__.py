"""Questions about the package that are asked again, one command each (README.md); not packaged."""
