"""Files of surfaces: read and written, in metres. One kind of file a module."""
