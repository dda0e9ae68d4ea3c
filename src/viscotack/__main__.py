"""``python -m viscotack``: the command line."""

from viscotack.app.cli import main

if __name__ == "__main__":
    main()
