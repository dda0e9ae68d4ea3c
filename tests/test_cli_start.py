"""What a fresh interpreter imports: the package nothing heavy, a command what it needs."""

import subprocess
import sys

import pytest

import viscotack

RUN = "from viscotack.app.cli import main; main({})"
PREDICT = "predict sphere --tabor 1 --modulus-ratio 0.1 --exponent 0.6 --preload 1 --rate 10"
NAMES = [name for name in viscotack.__all__ if name != "__version__"]
LATE = ("pint", "matplotlib", "rich", "typer")
# Never imported by a list of commands; never by the help of a command; never by a prediction.
LISTED = ("numpy", "scipy", "pint", "matplotlib", "rich", "pyarrow", "viscotack.model.geometry")
HELPED = (
    *("scipy.linalg", "scipy.optimize", "scipy.special", "pint", "matplotlib"),
    "viscotack.simulate.march",
)
PREDICTED = (*HELPED, "scipy.interpolate", "scipy.integrate", "viscotack.campaign")


@pytest.mark.parametrize(
    ("code", "modules"),
    [
        ("import viscotack", ("numpy", "scipy", *LATE)),
        # simulating needs no library of the command line
        (f"import viscotack; [getattr(viscotack, name) for name in {NAMES}]", LATE),
        (RUN.format(["--help"]), LISTED),
        (RUN.format(["predict", "--help"]), HELPED),
        (RUN.format(PREDICT.split()), PREDICTED),
    ],
    ids=["package", "names", "list", "help", "prediction"],
)
def test_nothing_is_imported_that_is_not_needed(code, modules):
    told = f"print([m for m in {modules} if m in sys.modules], file=sys.stderr)"
    code = f"import atexit, sys; atexit.register(lambda: {told}); {code}"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stderr.splitlines()[-1] == "[]"
