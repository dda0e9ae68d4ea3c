"""Every public class and function is documented: summary, parameters, returns, errors, example."""

import ast
import inspect
import re
import textwrap
from dataclasses import fields, is_dataclass
from enum import EnumMeta

import pytest

import viscotack

# Rooms whose names are described by formula: the parameters may stand once, in the module.
SHARED = "viscotack.theory."
SECTION = re.compile(r"^(\w[\w ]*)\n-+$", re.M)
UNIT = re.compile(r"\[[^\]]+\]|[Dd]imensionless|\bover\b|[Rr]atio|exponent")


def public():
    """Public classes and functions by the dotted path at which a user finds them."""
    found = {}

    def add(path, thing):
        if inspect.ismodule(thing):
            names = getattr(thing, "__all__", None) or [
                name
                for name, value in vars(thing).items()
                if not name.startswith("_") and getattr(value, "__module__", None) == thing.__name__
            ]
            for name in names:
                add(f"{path}.{name}", getattr(thing, name))
        elif callable(thing) and getattr(thing, "__module__", "").startswith("viscotack."):
            found.setdefault(thing, path)

    for name in viscotack.__all__:
        add(name, getattr(viscotack, name))
    return {path: thing for thing, path in found.items()}


# Rooms that are checked; add a room when all of its public names pass.
ROOMS = (
    "bem campaign cards check datasets errors files forecast geometry lab materials methods "
    "operations pictures pool problem protocol result theory traction units"
).split()
PUBLIC = public()
CHECKED = [path for path, thing in PUBLIC.items() if thing.__module__.split(".")[1] in ROOMS]


def parameters_of(thing):
    """Names that a caller passes and that no card documents."""
    if getattr(thing, "_is_protocol", False) or isinstance(thing, EnumMeta):
        return []
    if is_dataclass(thing):
        return [
            field.name
            for field in fields(thing)
            if field.init and not field.name.startswith("_") and "card" not in field.metadata
        ]
    try:
        return list(inspect.signature(thing).parameters)
    except ValueError:
        return []


def raises(function):
    """Whether the body of a function has a `raise` statement."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    return any(isinstance(node, ast.Raise) for node in ast.walk(tree))


def missing(thing):
    """Parts of the documentation that a public class or function lacks."""
    is_class = isinstance(thing, type)
    text = (vars(thing).get("__doc__") if is_class else thing.__doc__) or ""
    text = inspect.cleandoc(text)
    if not text or text.startswith(f"{thing.__name__}("):  # what dataclasses write themselves
        return ["docstring"]
    if is_class and issubclass(thing, Exception):
        return []
    lacks = [] if text.split("\n")[0].endswith(".") else ["summary in one line"]
    sections = set(SECTION.findall(text))
    in_module = inspect.getmodule(thing).__doc__ if thing.__module__.startswith(SHARED) else ""
    named = set(re.findall(r"\w+", f"{text} {in_module}"))
    if undescribed := [name for name in parameters_of(thing) if name not in named]:
        lacks.append(f"parameters {', '.join(undescribed)}")
    if not is_class:
        annotation = str(inspect.signature(thing).return_annotation)
        shared = in_module and UNIT.search(text.split("\n\n")[0])
        if annotation != "None" and "Returns" not in sections and not shared:
            lacks.append("returns")
        if raises(thing) and "Raises" not in sections:
            lacks.append("raises")
    # a class that is only returned refers to the function that returns it
    if ">>>" not in text and not (is_class and re.search(":(func|meth|class):", text)):
        lacks.append("example")
    return lacks


@pytest.mark.parametrize("path", CHECKED)
def test_public_names_are_documented(path):
    assert missing(PUBLIC[path]) == []


def test_the_check_finds_each_missing_part():
    def bare(load):
        if load < 0:
            raise ValueError
        return load

    bare.__doc__ = "Double it"
    bare.__module__ = "viscotack"
    parts = ["summary in one line", "parameters load", "returns", "raises", "example"]
    assert missing(bare) == parts


def by_room():
    """Print what is missing, by room: `python tests/test_docstrings.py`."""
    for path, thing in sorted(PUBLIC.items(), key=lambda pair: pair[1].__module__):
        if parts := missing(thing):
            print(thing.__module__.removeprefix("viscotack."), path, "; ".join(parts), sep="  ")


if __name__ == "__main__":
    by_room()
