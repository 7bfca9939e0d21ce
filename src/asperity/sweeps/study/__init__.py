"""A study: its file, base case, axes, samples and columns."""
