"""Whether what is installed is what the package requires."""

from __future__ import annotations

from asperity.cli.stack import requirements, version_of


def unmet(lines: list[str] | None = None) -> list[str]:
    """Requirements that are not met, a line each; those of an extra count where it is installed.

    Parameters
    ----------
    lines : list of str, optional
        Requirements in the form of a package's metadata; this package's unless given.
    """
    from packaging.requirements import Requirement

    found = []
    for line in requirements() if lines is None else lines:
        wanted = Requirement(line)
        marker = wanted.marker
        optional = marker is not None and "extra" in str(marker)
        if marker is not None and not optional and not marker.evaluate():
            continue  # of another system or Python
        version = version_of(wanted.name)
        if version is None:
            if not optional:
                found.append(f"{wanted.name}{wanted.specifier} is not installed")
        elif not wanted.specifier.contains(version, prereleases=True):
            found.append(f"{wanted.name}{wanted.specifier} is wanted; {version} is installed")
    return found
