"""Headings of laboratory tables in the words and languages of instruments: words.toml."""

import tomllib
from pathlib import Path

_TEXT = Path(__file__).with_name("words.toml").read_text(encoding="utf-8")
WORDS: dict[str, dict[str, str]] = tomllib.loads(_TEXT)
