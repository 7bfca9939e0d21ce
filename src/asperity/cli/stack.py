"""What is installed: the versions of the program, of what it computes with, and of its extras.

Read from the packages' metadata; nothing is imported, so that ``asperity --version`` is quick.
"""

from __future__ import annotations

import json
import platform
import re
from importlib.metadata import PackageNotFoundError, requires, version

from asperity import __version__
from asperity.cli.terminal import tell

STACK = (
    "jax",
    "jaxlib",
    "equinox",
    "numpy",
    "scipy",
    "xarray",
    "netCDF4",
    "zarr",
    "distributed",
    "matplotlib",
    "SurfaceTopography",
)
"""Packages whose versions a result may depend on."""

NOT_INSTALLED = "not installed"

_EXTRA = re.compile(r"extra\s*==\s*[\"']([^\"']+)")
_NAME = re.compile(r"[\w.-]+")
_WIDE = 19


def tell_versions(*, as_json: bool) -> None:
    """Print the program's version, then those of its stack and of its extras.

    Parameters
    ----------
    as_json : bool
        Whether to print one JSON object.
    """
    found = versions()
    if as_json:
        tell(json.dumps(found))
        return
    extras = extras_of()
    first, *rest = found.items()
    lines = [" ".join(map(str, first))]
    for name, number in rest:
        note = f" (extra {extras[name]})" if name in extras else ""
        lines.append(f"  {name:<{_WIDE}}{number or NOT_INSTALLED}{note}")
    tell("\n".join(lines))


def versions() -> dict[str, str | None]:
    """Versions by name: program, Python, stack, extras, platform; None for what is missing."""
    return {
        "asperity": __version__,
        "python": f"{platform.python_version()} ({platform.python_implementation()})",
        **{name: version_of(name) for name in (*STACK, *extras_of())},
        "platform": platform.platform(terse=True) + f" {platform.machine()}",
    }


def version_of(package: str) -> str | None:
    """Version of an installed package; None where it is not installed."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def extras_of() -> dict[str, str]:
    """The packages that are optional, each with the name of its extra."""
    found = {}
    for line in requirements():
        name, extra = _NAME.match(line), _EXTRA.search(line)
        if name and extra:
            found[name[0]] = extra[1]
    return found


def requirements() -> list[str]:
    """What this package requires, as its metadata says; nothing where it is not installed."""
    try:
        return requires("asperity") or []
    except PackageNotFoundError:
        return []


def unmet(lines: list[str] | None = None) -> list[str]:
    """Requirements that are not met, a line each; those of an extra count where it is installed.

    Parameters
    ----------
    lines : list of str, optional
        Requirements in the form of a package's metadata; this package's unless given.
    """
    from packaging.requirements import Requirement

    found = []
    for wanted in map(Requirement, requirements() if lines is None else lines):
        optional = "extra" in str(wanted.marker or "")
        if wanted.marker is not None and not optional and not wanted.marker.evaluate():
            continue  # of another system or Python
        number = version_of(wanted.name)
        if number is None and not optional:
            found.append(f"{wanted.name}{wanted.specifier} is not installed")
        elif number is not None and not wanted.specifier.contains(number, prereleases=True):
            found.append(f"{wanted.name}{wanted.specifier} is wanted; {number} is installed")
    return found
