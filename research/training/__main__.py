"""Train a surrogate of the package: ``python -m research.training CONTACT --out DIR``."""

from .make import main

if __name__ == "__main__":
    main()
