"""``python -m asperity``: the same as ``asperity``."""

from asperity.cli import main

if __name__ == "__main__":
    main()
