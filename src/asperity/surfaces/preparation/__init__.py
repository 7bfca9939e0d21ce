"""A surface made ready: missing pixels, line levelling, form removal, Gaussian filter."""
