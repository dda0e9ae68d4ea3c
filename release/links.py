"""Check a built site without a network: `python -m release.links FOLDER`, also by `make docs`.

Relative links lead to a file, with a fragment to a place in it. Scripts, styles and pictures come
from the site itself.
"""

import argparse
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class _Page(HTMLParser):
    """Links, embedded files and places of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.parts: list[str] = []
        self.places: set[str] = {"", "top"}
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        told = {name: value or "" for name, value in attrs}
        self.places |= {told[name] for name in ("id", "name") if name in told}
        if tag == "a" and "href" in told:
            self.links.append(told["href"])
        elif tag == "link" and told.get("rel") != "canonical" and "href" in told:
            self.parts.append(told["href"])
        elif "src" in told:
            self.parts.append(told["src"])


def broken(folder: Path) -> Iterator[str]:
    """Iterate over links of a site that lead nowhere, and parts from elsewhere, in words."""
    # the theme has templates among its files
    found = [path for path in sorted(folder.rglob("*.html")) if "_static" not in path.parts]
    pages = {path: _Page(path.read_text("utf-8")) for path in found}
    for path, page in pages.items():
        name = path.relative_to(folder)
        for link in [*page.links, *page.parts]:
            place = urlsplit(link)
            if place.scheme or place.netloc:
                if link in page.parts and place.scheme != "data":
                    yield f"{name}: {link} comes from another place"
                continue
            target = path
            if place.path:
                target = (path.parent / unquote(place.path)).resolve()
                if target.is_dir():
                    target /= "index.html"
            if not target.exists():
                yield f"{name}: {link} does not exist"
            elif target in pages and unquote(place.fragment) not in pages[target].places:
                yield f"{name}: {link} has no such place"


def main() -> int:
    """Print what is broken."""
    parser = argparse.ArgumentParser(prog="python -m release.links", description=__doc__)
    parser.add_argument("folder", type=Path, help="built site")
    found = list(broken(parser.parse_args().folder.resolve()))
    print(*found, f"{len(found)} broken links", sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
