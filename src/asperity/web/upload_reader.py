"""Read one uploaded surface and write it as netCDF: a program of its own, which can be killed.

``python -m asperity.web.upload_reader FROM TO OPTIONS`` with OPTIONS as JSON
``{size, unit, channel}``.
It answers with one JSON object on standard output: ``{channel, channels, notes}``, or
``{"refusal": "..."}`` where the file cannot be read.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

MEMORY = 4 << 30
"""Address space that reading may take [bytes]."""

MOST_PIXELS = 2048 * 2048
"""Largest map that a page computes with: its summits are found in the server's own memory."""

SECONDS = 30
"""Processor time that reading may take [s]."""


def main(source: str, target: str, options: str) -> None:
    """Read, write, answer."""
    _bound()
    from asperity.errors import InputError

    try:
        found = _read(source, target, json.loads(options))
    except InputError as error:
        found = {"refusal": str(error)}
    except MemoryError:
        found = {"refusal": f"{Path(source).name}: needs more than {MEMORY >> 30} GB to be read"}
    sys.stdout.write(json.dumps(found))


def _bound() -> None:
    try:
        import resource
    except ImportError:  # not a POSIX system: the time limit of who waits is left
        return
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _read(source: str, target: str, options: dict[str, Any]) -> dict[str, Any]:
    from asperity.errors import InputError
    from asperity.surfaces.files.read_surface import read_surface
    from asperity.surfaces.files.write_surface import write_topography

    size = options["size"]
    reading = read_surface(
        source,
        size=None if size is None else (float(size[0]), float(size[1])),
        unit=options["unit"],
        channel=options["channel"],
    )
    pixels = reading.topography.heights.size
    if pixels > MOST_PIXELS:
        raise InputError(
            f"{Path(source).name}: a map must have at most 2048 x 2048 pixels on this page; take "
            f"`asperity run` for more; got {pixels} pixels"
        )
    write_topography(reading.topography, target, force=True)
    return {
        "channel": reading.channel,
        "channels": list(reading.channels),
        "notes": list(reading.notes),
    }


if __name__ == "__main__":
    main(*sys.argv[1:])
