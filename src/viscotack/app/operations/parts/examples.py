"""Example cases for new users, also used to warm up worker processes."""

import tomllib
from importlib.resources import files
from typing import Any

# Title -> tables of a case file.
EXAMPLES: dict[str, dict[str, dict[str, Any]]] = tomllib.loads(
    files("viscotack.app.page").joinpath("examples.toml").read_text("utf-8")
)
FIRST = next(iter(EXAMPLES.values()))
