"""Write the table and the reference of docs/operations.md from the declarations, with --write."""

import argparse
from collections import Counter
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
from viscotack.operations.declare.options import Option, options, spelled, summary
from viscotack.operations.declare.statement import Stated

PAGE = Path(__file__).resolve().parents[1] / "docs/operations.md"
BEGIN, END = "<!-- python docs/operations_page.py --write -->\n", "<!-- end -->\n"
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
    """Table of the operations that HTTP and the page refuse, with the reasons."""
    lines = ["| operation | refused over HTTP and on the page |", "|---|---|"]
    for word, kind in operations().items():
        if refused := kind.refused.get("http", ""):
            lines.append(f"| [{word}]({_place(word)}) | {refused} |")
    return "\n".join(lines) + "\n"


def _place(word: str) -> str:
    return f"#{word.replace(' ', '-')}"


def _commands(word: str, kind: type[Operation]) -> str:
    """Commands of an operation, where its word alone is none."""
    for card in (o.card for o in options(kind)):
        if isinstance(card, Stated) and card.spelling == "commands":
            each = (f"`viscotack {word} {name}`" for name in (*card.indenters, "case"))
            return f" Commands: {', '.join(each)}."
    return ""


def common() -> list[tuple[str, ...]]:
    """Name, meaning and value of options that three or more operations have."""
    rows = Counter(
        _row(option, kind)[:3] for kind in operations().values() for option in _by_part(kind)[0]
    )
    return [row for row, number in rows.items() if number >= 3]


def reference() -> str:
    """Every operation with its options, and the groups of options that several have."""
    groups: dict[type, list[str]] = {}
    sections = []
    shared = common()
    for word, kind in operations().items():
        own, parts = _by_part(kind)
        groups |= {part: _group(part, found, kind) for part, found in parts.items()}
        rows = [_row(option, kind) for option in own]
        links = [f"[group {part.__name__}]({_anchor(part)})" for part in parts]
        if also := [_with_default(row) for row in rows if row[:3] in shared]:
            links = [f"{', '.join(also)} ([common options](#common-options))", *links]
        rows = [row for row in rows if row[:3] not in shared]
        lines = [f"### {word}", "", _cell(spelled(summary(kind), kind)) + _commands(word, kind), ""]
        lines += _options(rows) if rows else [] if links else ["No options.", ""]
        lines += [f"{'Also' if rows else 'Options'}: {'; '.join(links)}.", ""] if links else []
        if kind.outputs:
            files = (f"`{o.name}` ({_output(spelled(o.words, kind))})" for o in kind.outputs)
            lines += [f"Outputs: {'; '.join(files)}.", ""]
        sections.append("\n".join(lines))
    head = ["### Common options", "", "| option | meaning | value |", "|---|---|---|"]
    head += [*(f"| {' | '.join(row)} |" for row in shared), ""]
    return "\n".join([*head, *sections, *("\n".join(lines) for lines in groups.values())])


def _with_default(row: tuple[str, ...]) -> str:
    name, _, _, default = row
    value = " (must be given)" if default == "must be given" else f" = {default}" if default else ""
    return name + value


def _output(words: str) -> str:
    """Describe an output without the words that all outputs share."""
    words = words.removesuffix(".").removesuffix("; - is standard output")
    return words.replace(" to a .png, .pdf or .svg file", "").rstrip(",")


def _by_part(kind: type[Operation]) -> tuple[list[Option], dict[type, list[Option]]]:
    """Return the options of an operation itself and the options of its parts."""
    hints = get_type_hints(kind)
    own, parts = [], {}
    for option in options(kind):
        (parts.setdefault(hints[option.part], []) if option.part else own).append(option)
    return own, parts


def _group(part: Any, found: list[Option], kind: type[Operation]) -> list[str]:
    words = cleandoc(part.__doc__ or "").partition("\n\n")[0].replace("\n", " ")
    where = f" In a study file they may be in a table `[{part.table}]`." if part.table else ""
    rows = [_row(option, kind) for option in found]
    return [f"### Group {part.__name__}", "", f"{words}{where}", "", *_options(rows)]


def _anchor(part: type) -> str:
    return f"#group-{part.__name__.lower()}"


def _row(option: Option, kind: type[Operation]) -> tuple[str, ...]:
    words = _cell(spelled(option.words, kind))
    return f"`{option.name}`", words, _value(option), _default(option)


def _options(rows: list[tuple[str, ...]]) -> list[str]:
    lines = ["| option | meaning | value | default |", "|---|---|---|---|"]
    return [*lines, *(f"| {' | '.join(row)} |" for row in rows), ""]


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
    """Return the page with its generated part renewed."""
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
