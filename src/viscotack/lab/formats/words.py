"""Headings of laboratory tables in the words and languages of instruments: words.toml."""

import tomllib
from importlib.resources import files

_TEXT = files(__package__).joinpath("words.toml").read_text(encoding="utf-8")
WORDS: dict[str, dict[str, str]] = tomllib.loads(_TEXT)
