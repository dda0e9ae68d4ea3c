"""Files written whole or not at all; what the package has for it is not among its public names."""

from pathlib import Path


def write_whole(path: Path, text: str) -> None:
    """Write a text; where that fails, the file is as before and no draft is left."""
    draft = path.with_name(f".{path.name}.draft")
    try:
        draft.write_text(text, encoding="utf-8", newline="")
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)
