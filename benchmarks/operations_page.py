"""Write the table and the reference of docs/operations.md from the declarations, with --write."""

import argparse
from inspect import cleandoc
from pathlib import Path
from typing import Any, get_type_hints

from viscotack.operations import Operation, operations
from viscotack.operations.declare.cards import (
    File,
    Folder,
    Known,
    Named,
    Number,
    Spelled,
    Switch,
    Table,
    Two,
    Whole,
)
from viscotack.operations.declare.description import path
from viscotack.operations.declare.options import Option, options, spelled, summary
from viscotack.operations.declare.statement import Stated

PAGE = Path(__file__).resolve().parents[1] / "docs/operations.md"
BEGIN, END = "<!-- python benchmarks/operations_page.py --write -->\n", "<!-- end -->\n"
# What a card takes; the first kind that fits.
_VALUES = {
    Stated: "problem",
    Table: "rows, or a CSV file",
    Switch: "true or false",
    Folder: "folder",
    File: "file",
    Named: "published name, or file",
    Spelled: "text, which may name a file",
    Known: "number, or number and its uncertainty",
    Whole: "whole number",
    Two: "two quantities",
    Number: "number",
}


def generated() -> str:
    """Return the table and the reference as Markdown."""
    return f"{table()}\n{reference()}"


def table() -> str:
    """Return the table operation x interface: where each is, or why it is refused."""
    lines = ["| operation | Python, study | command line | HTTP | page |", "|---|---|---|---|---|"]
    for word, kind in operations().items():
        lines.append(f"| {' | '.join(_row(word, kind))} |")
    return "\n".join(lines) + "\n"


def _row(word: str, kind: type[Operation]) -> tuple[str, ...]:
    link = f"[{word}](#{word.replace(' ', '-')})"
    commands = [f"`viscotack {word}`"]
    for card in (o.card for o in options(kind)):
        if isinstance(card, Stated) and card.spelling == "commands":
            commands = [f"`viscotack {word} {each}`" for each in (*card.indenters, "case")]
    refused = kind.refused.get("http", "")
    http = f"refused: {refused}" if refused else f"`/api/{path(word)}`"
    page = "refused, as over HTTP" if refused else "All operations"
    return link, f'`"{word}"`', ", ".join(commands), http, page


def reference() -> str:
    """Return every operation with its options, and the groups of options that several have."""
    groups: dict[type, list[str]] = {}
    sections = []
    for word, kind in operations().items():
        own, parts = _by_part(kind)
        groups |= {part: _group(part, found, kind) for part, found in parts.items()}
        links = " and ".join(f"[group {part.__name__}]({_anchor(part)})" for part in parts)
        lines = [f"### {word}", "", _cell(spelled(summary(kind), kind)), ""]
        lines += _options(own, kind) if own else [] if parts else ["No options.", ""]
        lines += [f"{'Also the' if own else 'The'} options of {links}.", ""] if parts else []
        if kind.outputs:
            files = (f"`{o.name}` ({spelled(o.words, kind).rstrip('.')})" for o in kind.outputs)
            lines += [f"Outputs: {'; '.join(files)}.", ""]
        sections.append("\n".join(lines))
    return "\n".join([*sections, *("\n".join(lines) for lines in groups.values())])


def _by_part(kind: type[Operation]) -> tuple[list[Option], dict[type, list[Option]]]:
    """Return the options of an operation itself, and those of each of its parts."""
    hints = get_type_hints(kind)
    own, parts = [], {}
    for option in options(kind):
        (parts.setdefault(hints[option.part], []) if option.part else own).append(option)
    return own, parts


def _group(part: Any, found: list[Option], kind: type[Operation]) -> list[str]:
    told = cleandoc(part.__doc__ or "").partition("\n\n")[0].replace("\n", " ")
    where = f" In a study file they may stand in a table `[{part.table}]`." if part.table else ""
    return [f"### Group {part.__name__}", "", f"{told}{where}", "", *_options(found, kind)]


def _anchor(part: type) -> str:
    return f"#group-{part.__name__.lower()}"


def _options(found: list[Option], kind: type[Operation]) -> list[str]:
    lines = ["| option | meaning | value | default |", "|---|---|---|---|"]
    for option in found:
        words = _cell(spelled(option.words, kind))
        lines.append(f"| `{option.name}` | {words} | {_value(option)} | {_default(option)} |")
    return [*lines, ""]


def _value(option: Option) -> str:
    card, choices = option.card, getattr(option.card, "choices", ())
    unit = getattr(card, "unit", "1")
    said = next((words for kind, words in _VALUES.items() if isinstance(card, kind)), "text")
    said = ", ".join(f"`{choice}`" for choice in choices) or said
    if isinstance(card, Known) and option.uncertainty:
        said = "number"
    return ("one or more: " if option.many else "") + (said if unit == "1" else f"{said}, {unit}")


def _default(option: Option) -> str:
    default, choices = option.default, getattr(option.card, "choices", ())
    if option.needed:
        return "must be given"
    if default in (None, (), "") or (choices and default not in choices):
        return ""
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    return f"`{default:.6g}`" if isinstance(default, float) else f"`{default}`"


def _cell(words: str) -> str:
    return words.replace("|", "\\|").replace("\n", " ")


def page() -> str:
    """Return the page with what is generated made anew."""
    text = PAGE.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}{generated()}{END}{after}"


def main() -> None:
    """Print what is generated, or write it into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"write it into {PAGE.name}")
    if parser.parse_args().write:
        PAGE.write_text(page(), encoding="utf-8")
    else:
        print(generated())


if __name__ == "__main__":
    main()
