"""Scripts of the repository as modules, which no package has."""

import importlib.util


def module_at(path):
    """Return a script as a module, without running its main."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
