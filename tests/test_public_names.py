import subprocess
import sys

import viscotack

HEAVY = ("numpy", "scipy", "pint", "matplotlib", "rich", "typer")


def run(code):
    """Return what a fresh interpreter prints."""
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    return done.stdout.strip()


def test_importing_the_package_imports_nothing_heavy():
    loaded = run(f"import sys, viscotack; print([m for m in {HEAVY} if m in sys.modules])")
    assert loaded == "[]"


def test_simulating_needs_no_library_of_the_command_line():
    late = ("pint", "matplotlib", "rich", "typer")
    names = [name for name in viscotack.__all__ if name != "__version__"]
    code = f"import sys, viscotack; [getattr(viscotack, n) for n in {names}]; "
    assert run(code + f"print([m for m in {late} if m in sys.modules])") == "[]"
