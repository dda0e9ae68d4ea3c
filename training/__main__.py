"""Train the surrogate of spheres on power laws: ``python -m training --out DIR``."""

from .make import main

if __name__ == "__main__":
    main()
