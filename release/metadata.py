"""Files written from `pyproject.toml`, `CITATION.cff` and the changelog."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
CODEMETA = ROOT / "codemeta.json"
# Libraries that conda-forge has under other names.
_CONDA = {"matplotlib": "matplotlib-base"}


def project(folder: Path = ROOT) -> dict[str, Any]:
    """Table `project` of a `pyproject.toml`."""
    return tomllib.loads((folder / "pyproject.toml").read_text("utf-8"))["project"]


def codemeta() -> str:
    """Text of `codemeta.json`, for archives and catalogues of research software."""
    told = project()
    facts = {
        "@context": "https://w3id.org/codemeta/3.0",
        "@type": "SoftwareSourceCode",
        "name": told["name"],
        "version": told["version"],
        "description": told["description"],
        "license": f"https://spdx.org/licenses/{told['license']}",
        "author": [{"@type": "Organization", "name": a["name"]} for a in told["authors"]],
        "keywords": told["keywords"],
        "programmingLanguage": f"Python {told['requires-python']}",
        "softwareRequirements": told["dependencies"],
        "developmentStatus": "wip",
        "readme": "README.md",
    }
    return json.dumps(facts, indent=2) + "\n"


def notes() -> str:
    """Newest section of the changelog, the notes of a release."""
    sections = re.split(r"(?m)^(?=## )", (ROOT / "CHANGELOG.md").read_text("utf-8"))
    return sections[1]


def recipe(sdist: str, sha256: str) -> str:
    """Recipe for conda-forge (rattler-build); its source is the sdist of the release folder."""
    told = project()
    return (Path(__file__).with_name("recipe.yaml").read_text("utf-8")).format(
        sdist=sdist,
        sha256=sha256,
        run="".join(f"    - {_conda(library)}\n" for library in told["dependencies"]),
        least=told["requires-python"].removeprefix(">="),
        **told,
    )


def _conda(requirement: str) -> str:
    found = re.fullmatch(r"([\w-]+)(.*)", requirement)
    assert found, requirement
    return f"{_CONDA.get(found[1], found[1])} {found[2]}"


def readme_for_index(text: str, url: str = "") -> str:
    """README with absolute links, because a package index does not have the files of the checkout.

    Parameters
    ----------
    text : str
        The README, with links relative to the root.
    url : str
        Address below which the files of the release can be read; without it, images are left out
        and links become their texts.
    """
    below = f"{url.rstrip('/')}/" if url else ""
    images, links = r"!\[([^]]*)\]\((?!http)([^)]+)\)\n*", r"\[([^]]*)\]\((?!http|#)([^)]+)\)"
    if not below:
        return re.sub(links, r"\1", re.sub(images, "", text))
    return re.sub(links, rf"[\1]({below}\2)", text)
