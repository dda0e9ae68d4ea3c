"""Settings of Sphinx for the manuscript; `research.paper` copies them beside its numbers."""

import json
from pathlib import Path

project = "The steady crack of a finite-range law in viscoelastic contacts"
author = "The viscotack developers"
extensions = ["myst_parser", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath", "amsmath", "substitution"]
myst_substitutions = json.loads((Path(__file__).parent / "numbers.json").read_text("utf-8"))
exclude_patterns = ["tables"]
root_doc = "manuscript"
numfig = True
math_number_all = False
html_theme = "alabaster"
html_theme_options = {"nosidebar": True, "page_width": "60em"}
html_show_sourcelink = False
latex_elements = {
    "papersize": "a4paper",
    "pointsize": "10pt",
    "preamble": r"""
\DeclareUnicodeCharacter{2212}{\ensuremath{-}}
\DeclareUnicodeCharacter{0393}{\ensuremath{\Gamma}}
\DeclareUnicodeCharacter{00B5}{\ensuremath{\mu}}
""",
}
latex_documents = [("manuscript", "manuscript.tex", project, author, "howto")]
