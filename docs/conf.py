"""The site: every page of the checkout in its place, and the reference from the docstrings.

`make docs` builds it. The root of the checkout is the source folder, so that the links between
pages are the same in the checkout and on the site.
"""

import importlib
import shutil
import sys
import textwrap
from html import escape
from pathlib import Path
from types import ModuleType

from docutils.nodes import math_block, paragraph

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "src"), str(ROOT / "docs")]

import example_imports  # noqa: E402
import example_pages  # noqa: E402

from viscotack.version import __version__  # noqa: E402

project = "viscotack"
author = "The viscotack developers"
project_copyright = author
version = release = __version__
# `make lint` checks the links of the pages alone: no reference, and no example is run.
PAGES_ALONE = "pages" in tags  # noqa: F821  # given by Sphinx
root_doc = "docs/index"
include_patterns = [
    "docs/*.md",
    "docs/reference/**.rst",
    *([] if PAGES_ALONE else ["docs/examples/*.rst"]),
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "CODE_OF_CONDUCT.md",
    "SECURITY.md",
    "research/**.md",
    "examples/**/README.md",
    "tests/data/README.md",
    "data/viscotack_data/README.md",
]
exclude_patterns = [
    "research/paper/manuscript.md",
    "**/node_modules",
    ".*",
    "out",
    "build",
    "**/sg_execution_times.rst",
]
extensions = ["myst_parser"]
extensions += (
    []
    if PAGES_ALONE
    else [
        "sphinx.ext.autodoc",
        "sphinx.ext.autosummary",
        "sphinx.ext.napoleon",
        "sphinx_gallery.gen_gallery",
    ]
)

myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 4
# Blocks typed into a terminal are not highlighted as sessions: they have no prompt.
highlight_language = "none"

templates_path = [str(ROOT / "docs/templates")]
autosummary_generate = True
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = False

sphinx_gallery_conf = {
    "examples_dirs": str(example_pages.STAGE.relative_to(ROOT)),
    "gallery_dirs": str(example_pages.PAGES.relative_to(ROOT)),
    "filename_pattern": r"\.py$",
    "image_scrapers": ("example_pages.pictures",),
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "write_computation_times": False,
    "capture_repr": (),
}
if PAGES_ALONE:
    suppress_warnings = ["toc.not_readable"]
else:
    example_pages.stage()

html_math_renderer = "mathml"
html_theme = "pydata_sphinx_theme"
html_title = "viscotack"
html_extra_path = ["site"]
html_copy_source = False
html_favicon = str(ROOT / "src/viscotack/app/page/icon.svg")
html_context = {"default_mode": "auto"}
html_static_path = ["style"]
html_css_files = ["site.css"]
html_theme_options = {
    "header_links_before_dropdown": 7,
    "show_toc_level": 2,
    "navigation_with_keys": False,
    # without it every page has a menu of all others
    "collapse_navigation": True,
    "show_prev_next": False,
    "footer_start": ["copyright"],
    "footer_end": [],
}


def write_reference(app, config):
    """Write the pages of the reference: the public names by module, in the order of data flow."""
    import viscotack

    rooms = (*viscotack._ROOMS.values(), "testing")
    folder = ROOT / "docs/reference"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    if PAGES_ALONE:
        for name in ("viscotack", *rooms):
            (folder / f"{name}.rst").write_text(f"{name}\n{'=' * len(name)}\n")
        return
    face = [(room, "viscotack", names.split()) for room, names in viscotack._NAMES.items()]
    pages = {"viscotack": face}
    for room in rooms:
        module = importlib.import_module(f"viscotack.{room}")
        pages[room] = list(_sections(module, set(viscotack._HOMES)))
    for name, sections in pages.items():
        title = name if name == "viscotack" else f"viscotack.{name}"
        about = f".. automodule:: {title}\n   :no-members:\n"
        told = "\n".join(_listed(*section) for section in sections)
        (folder / f"{name}.rst").write_text(f"{title}\n{'=' * len(title)}\n\n{about}\n{told}")


def _sections(module, elsewhere):
    """Names of a room, then those of each of its public modules that the room exports."""
    names = [n for n in module.__all__ if callable(getattr(module, n)) and n not in elsewhere]
    if names:
        yield "", module.__name__, names
    for name in module.__all__:
        inner = getattr(module, name)
        if isinstance(inner, ModuleType):
            own = [n for n, x in vars(inner).items() if not n.startswith("_") and _own(x, inner)]
            if own:
                yield inner.__name__, inner.__name__, own


def _own(thing, module):
    return getattr(thing, "__module__", None) == module.__name__


def _listed(title, module, names):
    heading = f"{title}\n{'-' * len(title)}\n\n" if title else ""
    rows = "".join(f"   {name}\n" for name in names)
    return (
        f"{heading}.. currentmodule:: {module}\n\n.. autosummary::\n   :toctree: made\n\n{rows}\n"
    )


def math_in_page(writer, node):
    """Write a formula as MathML, so that pages need no script from another place."""
    from docutils.nodes import SkipNode
    from docutils.utils.math.latex2mathml import tex2mathml

    block = isinstance(node, math_block)
    # brackets of MathML grow with what they hold
    text = node.astext().replace(r"\Big", "").replace(r"\dots", r"\ldots")
    formula = tex2mathml(text, as_block=block)
    writer.body.append(f'<div class="math">{formula}</div>' if block else formula)
    raise SkipNode


def describe(app, name, template, context, doctree):
    """Give a page the beginning of its first paragraph as its description to search engines."""
    if doctree is not None and (first := next(doctree.findall(paragraph), None)):
        words = textwrap.shorten(first.astext(), 160, placeholder=" …")
        context["metatags"] += f'<meta name="description" content="{escape(words)}">\n'


def pack_examples(app, error):
    """Write the archive of the examples, which pages link, into the site."""
    if error is None and app.builder.format == "html":
        example_pages.pack(Path(app.outdir) / "examples.zip")


def leave_out(app, kind, name, member, skip, options):
    """Whether to leave out a field of a named tuple: the docstring of its class has it."""
    return True if type(member).__name__ == "_tuplegetter" else None


def with_imports(app, what, name, thing, options, lines):
    """Put the imports of an example's names in front of it, so that it can be pasted."""
    first = next((i for i, line in enumerate(lines) if line.startswith(">>>")), None)
    owner = getattr(thing, "fget", thing)
    module = thing.__name__ if what == "module" else getattr(owner, "__module__", None)
    if first is not None and module in sys.modules:
        needed = example_imports.imports("\n".join(lines), module)
        lines[first:first] = [f">>> {line}" for line in needed]


def setup(app):
    """Have the reference written before Sphinx looks for pages."""
    app.connect("config-inited", write_reference)
    app.connect("html-page-context", describe)
    app.connect("build-finished", pack_examples)
    if not PAGES_ALONE:
        app.connect("autodoc-skip-member", leave_out)
        app.connect("autodoc-process-docstring", with_imports)
    app.add_html_math_renderer("mathml", (math_in_page, None), (math_in_page, None))
    # the buttons of the theme's menu have no name for screen readers
    label = (
        'for (const s of document.querySelectorAll("nav summary")) s.ariaLabel = "pages inside";'
    )
    app.add_js_file(None, body=f'addEventListener("DOMContentLoaded", () => {{ {label} }});')
