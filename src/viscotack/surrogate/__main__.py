"""Train the surrogate that is shipped: ``python -m viscotack.surrogate --out DIR``."""

from .training.make import main

if __name__ == "__main__":
    main()
