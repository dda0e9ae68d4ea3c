"""Tell where the training is: ``python -m viscotack.surrogate`` trained before it moved."""

import sys

if __name__ == "__main__":
    sys.exit(
        "The package evaluates surrogates; the code that trains them is not installed with it. "
        "Train from the root of a checkout of the repository: python -m training --out DIR"
    )
