"""A surface made ready: gaps, scan lines, form, wavelengths."""
