"""Run each example of a docstring as the reference shows it: its imports, an empty folder."""

import contextlib
from tempfile import TemporaryDirectory

import pytest
from _pytest.doctest import DoctestItem

from docs import example_imports

# Settings of the manuscript, which read the numbers that are made for it.
collect_ignore = ["research/paper/conf.py"]


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    """Give an example nothing but the names that its import lines import."""
    if not isinstance(item, DoctestItem):
        return (yield)
    test = item.dtest
    module = test.globs["__name__"]
    lines = example_imports.imports(test.docstring, module)
    test.globs.clear()
    test.globs["__name__"] = "__main__"
    exec("\n".join(lines), test.globs)
    with TemporaryDirectory() as folder, contextlib.chdir(folder):
        return (yield)
