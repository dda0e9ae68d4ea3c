"""How a command starts: it imports what it needs, and its words complete in a shell."""

import subprocess
import sys

import pytest

PREDICT = "predict sphere --tabor 1 --modulus-ratio 0.1 --exponent 0.6 --preload 1 --rate 10"
# Never imported by a list of commands; never by the help of a command; never by a prediction.
LISTED = ("numpy", "scipy", "pint", "matplotlib", "rich", "pyarrow", "viscotack.model.geometry")
HELPED = (
    "scipy.linalg",
    "scipy.optimize",
    "scipy.special",
    "pint",
    "matplotlib",
    "viscotack.simulate.march",
)
PREDICTED = (*HELPED, "scipy.interpolate", "scipy.integrate", "viscotack.campaign")


def loaded(arguments, modules):
    """Run a command in a fresh interpreter; return which of these modules it has imported."""
    code = (
        "import atexit, sys\n"
        "from viscotack.app.cli import main\n"
        f"atexit.register(lambda: print([m for m in {modules} if m in sys.modules], "
        "file=sys.stderr))\n"
        f"main({arguments.split()})"
    )
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    return done.stderr.splitlines()[-1]


@pytest.mark.parametrize(
    ("arguments", "modules"), [("--help", LISTED), ("predict --help", HELPED), (PREDICT, PREDICTED)]
)
def test_a_command_imports_nothing_that_it_does_not_need(arguments, modules):
    assert loaded(arguments, modules) == "[]"
