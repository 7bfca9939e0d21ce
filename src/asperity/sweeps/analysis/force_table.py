"""Force against distance of sphere and plane, as codes for many particles read it.

Numbers are written with all the digits that a float has, so that reading them gives the same
floats.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from asperity.errors import InputError
from asperity.writing import aside, check_file, ending_of

if TYPE_CHECKING:
    from asperity.results.result import Curve

_LEAST_POINTS = 4


@dataclass(frozen=True)
class Branch:
    """Force of one way of an impact, as a table of a potential.

    Parameters
    ----------
    name
        Of the section, in capitals.
    distance
        From the sphere's middle to the mean plane of the counterface [m], ascending.
    energy
        Work against the force from the farthest distance to each [J].
    force
        Contact force [N], positive apart.
    slopes
        Derivatives of the force at both ends [N/m].
    """

    name: str
    distance: np.ndarray
    energy: np.ndarray
    force: np.ndarray
    slopes: tuple[float, float]


def branches_of(curve: Curve) -> tuple[Branch, Branch]:
    """Both ways of a curve as tables of a potential.

    The energy is the integral of the cubic spline through the forces, so that it agrees with them
    between the points as codes interpolate them.

    Raises
    ------
    InputError
        Where the curve has too few points, or one at no positive distance.
    """
    return (
        _branch("LOADING", curve, curve.force_loading),
        _branch("UNLOADING", curve, curve.force_unloading),
    )


def _branch(name: str, curve: Curve, force: np.ndarray) -> Branch:
    from scipy.interpolate import CubicSpline

    # Codes that place a sphere by its middle know no separation, which may be negative besides.
    distance = curve.rigid_separation + curve.case.body.radius
    keep = np.concatenate([[True], np.diff(distance) > 0.0])
    distance, force = distance[keep], force[keep]
    if distance.size < _LEAST_POINTS or not np.all(np.isfinite(force)) or distance[0] <= 0.0:
        raise InputError(
            f"a table of forces must have {_LEAST_POINTS} points of finite force at positive "
            f"distances; got {distance.size} from {distance[0]:.6g} m"
        )
    spline = CubicSpline(distance, force)
    work = spline.antiderivative()(distance)
    slopes = spline.derivative()(distance[[0, -1]])
    return Branch(name, distance, work[-1] - work, force, (float(slopes[0]), float(slopes[1])))


def write_force_table(curve: Curve, file: str | os.PathLike[str], *, force: bool = False) -> Path:
    """Write force and energy against distance for LAMMPS, ``fix wall/table`` in units ``si``.

    Sections ``LOADING`` and ``UNLOADING``: a potential has one value at each distance, so that
    each section alone loses no energy; the header says how much the cycle of both loses.

    Parameters
    ----------
    curve
        Force against separation.
    file
        What to write, ending in ``.table``.
    force
        Whether a file that is there may be replaced.

    Raises
    ------
    InputError
        Where the ending is another, the file is there already, or the curve is no such table.
    OutputError
        Where it cannot be written.
    """
    target = Path(file)
    check_force_table(target, force=force)
    heads = [
        f"{curve.name}: force between sphere and plane, UNITS: si",
        "distance [m] from the sphere's middle to the counterface's mean plane, energy [J], "
        "force [N]",
        f"in and out lose {curve.loss!r} J, which neither section loses alone",
    ]
    sections = [line for branch in branches_of(curve) for line in _section(branch)]
    with aside(target, force=force) as path:
        text = "\n".join([*(f"# {line}" for line in heads), *sections, ""])
        path.write_text(text, encoding="utf-8")
    return target


def check_force_table(target: Path, *, force: bool = False) -> None:
    """See to it, before anything is computed, that a table of forces can be written.

    Raises
    ------
    InputError
        Where the ending is not ``.table``, or the file is there and ``force`` is not set.
    OutputError
        Where it cannot be written.
    """
    ending_of(target, [".table"])
    check_file(target, force=force)


def _section(branch: Branch) -> list[str]:
    low, high = branch.slopes
    rows = zip(*(x.tolist() for x in (branch.distance, branch.energy, branch.force)), strict=True)
    return [
        "",
        branch.name,
        f"N {branch.distance.size} FP {low!r} {high!r}",
        "",
        *(f"{number} {r!r} {e!r} {f!r}" for number, (r, e, f) in enumerate(rows, start=1)),
    ]
