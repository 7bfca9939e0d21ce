"""Files of surfaces: read and written, in metres."""
