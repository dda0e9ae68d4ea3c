"""The files of the page: its text, its looks and its program, all that a browser gets."""
