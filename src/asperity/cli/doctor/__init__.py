"""``asperity doctor``: what is installed, on what it runs, and whether it works."""

from asperity.cli.doctor.examining import empty, examine

__all__ = ["empty", "examine"]
