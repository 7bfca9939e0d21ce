"""Speed and memory of asperity against a plain SciPy script, in one run: ``make bench``."""
