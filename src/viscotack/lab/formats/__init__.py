"""Readers of files: what each layout looks like, and its columns as numbers in SI."""
