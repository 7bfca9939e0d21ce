"""Coefficient of restitution of the first impact against its speed, over decades."""

from __future__ import annotations

import dataclasses
import json
import os
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..config import Case
from ..config.html_table import card, counted
from ..config.resolve import resolve
from ..critical_velocity import Launcher, Rebound, critical_measures
from ..dynamics import Limits
from ..errors import SimulationError
from ..integration import Report, integrate, silently
from ..model import build
from ..results.assessment import assessment_of
from ..results.case_source import CaseLike, case_of
from ..results.conversion import measured
from ..results.realisations import percent
from ..results.record_layout import plain
from ..results.result import drawing
from ..results.results_folder import RESTITUTION_FILES, write_folder
from ..results.summary import amount, warning_lines
from ..writing import csv_of
from .capture_probability import CaptureProbability, capture_probability
from .curve_speeds import checked, chosen, left_out

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

_PICTURE = "asperity.plots.restitution_plot"

POINTS, FEWER = 61, 31
"""Speeds that are computed where none are given, besides some close to the edges of capture; and of
a case with single bodies, a thousand for each speed."""


@dataclass(frozen=True, eq=False, repr=False)
class RestitutionCurve:
    """Restitution of a case's first impact for many speeds of approach.

    Parameters
    ----------
    case : Case
        The resolved case; its own speed does not count.
    name : str
        What it is called.
    speed : numpy.ndarray
        Speeds of approach where forces begin [m/s], ascending.
    restitution : numpy.ndarray
        Coefficient of restitution, 0 where the first impact captures, NaN where gas alone holds
        the body; as long as ``speed``.
    captured : numpy.ndarray
        Whether the first impact captures; as long as ``speed``.
    critical_velocity : float, optional
        Lowest speed at which capture gives way to rebound, or the reverse [m/s]; None where all
        speeds that were tried do the same.
    capture_edges : list of float
        All such speeds [m/s], ascending.
    note : str, optional
        Why there is no critical velocity, or which speeds are captured where it is not just those
        below it.
    own_speed : float
        Speed of approach of the case itself [m/s].
    warnings : list of str
        What to know before the numbers are used, for the case's own speed.
    single_bodies : CaptureProbability, optional
        What single bodies do at these speeds; None where the case does not ask for them.
    input_sha256 : str, optional
        SHA-256 of the text that the case was read from.
    case_file : str, optional
        Path of the case's file, or which built-in case it is; None of a case made in Python.
    """

    case: Case
    name: str
    speed: np.ndarray
    restitution: np.ndarray
    captured: np.ndarray
    critical_velocity: float | None
    capture_edges: list[float]
    note: str | None
    own_speed: float
    warnings: list[str]
    single_bodies: CaptureProbability | None = None
    input_sha256: str | None = None
    case_file: str | None = None

    def dataset(self) -> xarray.Dataset:
        """The curve as a dataset over the speed, with units."""
        import xarray

        about = {"units": "1", "long_name": "coefficient of restitution of the first impact"}
        speed = {"units": "m/s", "long_name": "speed of approach"}
        return xarray.Dataset(
            {
                "restitution": ("speed", self.restitution, about),
                "captured": ("speed", self.captured, {"long_name": "captured at first impact"}),
            },
            coords={"speed": ("speed", self.speed, speed)},
            attrs={"name": self.name, "case": self.case.toml()},
        )

    def json_object(self) -> dict[str, Any]:
        """Plain values in SI, None where one does not apply."""
        held = dataclasses.asdict(self)
        del held["case"]
        found: dict[str, Any] = plain(held)
        return found

    def plot(self) -> Figure:
        """Restitution against speed, with the critical velocity."""
        figure: Figure = drawing(_PICTURE).figure(
            self.speed,
            self.restitution,
            self.captured,
            edges=tuple(self.capture_edges),
            critical=self.critical_velocity,
            own_speed=self.own_speed,
            single_bodies=self.single_bodies,
            name=self.name,
        )
        return figure

    def summary(self) -> str:
        """Critical velocity and a table of restitution, as text."""
        lines = [f"{self.name}: restitution of the first impact against speed of approach", ""]
        lines.append(f"  {'critical velocity':<26}{self._critical()}")
        lines.append(f"  {'speed of the case':<26}{amount(self.own_speed, 'm/s')}")
        if self.single_bodies is not None:
            lines.append(f"  {'half are captured at':<26}{self._half()}")
        beside = "" if self.single_bodies is None else "  captured  of single bodies"
        lines += ["", f"  {'speed':<26}restitution{beside}"]
        lines += [f"  {speed:<26}{told}" for speed, told in self._points()]
        return "\n".join([*lines, *warning_lines(self.warnings)])

    def _critical(self) -> str:
        """The critical velocity, or why there is none."""
        if self.critical_velocity is None:
            return self.note or ""
        note = f"  ({self.note})" if self.note else ""
        return amount(self.critical_velocity, "m/s") + note

    def _half(self) -> str:
        """The speed at which half of single bodies are captured, with its interval."""
        found = self.single_bodies
        if found is None or found.half_velocity is None:
            return "no speed that was tried"
        low, high = (amount(speed, "m/s") for speed in found.half_interval)
        return f"{amount(found.half_velocity, 'm/s')}  (95 % interval: {low} to {high})"

    def _points(self) -> list[tuple[str, str]]:
        """Some thirteen of the speeds, and the restitution at each."""
        found = []
        for at in range(0, self.speed.size, max(1, (self.speed.size - 1) // 12)):
            kept, held = self.restitution[at], self.captured[at]
            told = "captured" if held else "-" if np.isnan(kept) else f"{kept:.4f}"
            if (bodies := self.single_bodies) is not None:
                low, median, high = bodies.restitution[at]
                told = f"{told:<10}{percent(bodies.probability[at]):>6} %    {median:.4f}"
                told += f"  ({low:.4f} to {high:.4f})"
            found.append((amount(float(self.speed[at]), "m/s"), told))
        return found

    def files(self, *, pictures: bool = True) -> dict[str, bytes]:
        """Content of every file, by name: a table, its numbers as JSON, pictures, a summary."""
        found = {
            "restitution.csv": self._table(),
            "restitution.json": json.dumps(self.json_object(), allow_nan=False).encode() + b"\n",
            "restitution.txt": self.summary().encode() + b"\n",
        }
        if pictures:
            found |= drawing(_PICTURE).pictures(self.plot())
        return found

    def save(self, directory: str | os.PathLike[str], force: bool = False) -> list[Path]:
        """Write table, pictures and summary, all or none; as `Result.save`."""
        return write_folder(directory, self.files(), RESTITUTION_FILES, force=force)

    def _table(self) -> bytes:
        more = {} if self.single_bodies is None else self.single_bodies.columns()
        columns = (self.speed, self.restitution, self.captured, *more.values())
        rows = zip(*(column.tolist() for column in columns), strict=True)
        return csv_of(
            ["speed [m/s]", "restitution [-]", "captured", *more],
            ((speed, "" if e != e else e, int(held), *rest) for speed, e, held, *rest in rows),
        )

    def __repr__(self) -> str:
        critical = amount(self.critical_velocity, "m/s")
        return (
            f"<RestitutionCurve {self.name}: {counted(self.speed.size, 'speed')}, critical "
            f"velocity {critical}, {counted(len(self.warnings), 'warning')}>"
        )

    def _repr_html_(self) -> str:
        rows = [
            ("critical velocity", self._critical()),
            ("speed of the case", amount(self.own_speed, "m/s")),
            *([] if self.single_bodies is None else [("half are captured at", self._half())]),
            *self._points(),
        ]
        sentence = "Restitution of the first impact against speed of approach."
        return card(self.name, sentence, [("", rows)], self.warnings)


def restitution_curve(
    case: CaseLike,
    speeds: np.ndarray | None = None,
    *,
    ends: tuple[float, float] | None = None,
    points: int | None = None,
    name: str | None = None,
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> RestitutionCurve:
    """Restitution of the first impact against speed of approach, and the critical velocity.

    Parameters
    ----------
    case
        A case, or the name or path of one; the body is launched where the forces on it begin.
    speeds
        Speeds of launch [m/s], all positive; without them they are chosen.
    ends
        Smallest and largest speed [m/s] of those chosen, at even ratios; by default they lie over
        three decades about the critical velocity, or about the case's own speed where there is
        none.
    points
        How many are chosen: 61, or 31 with single bodies.
    name, progress, stop
        As for :func:`asperity.solve`.

    Raises
    ------
    InputError, SimulationError
        As :func:`asperity.solve`.
    """
    case = case_of(case)
    name = case.name if name is None else name
    if speeds is not None:
        speeds = checked(speeds)
    _, report = case.launch, progress or silently
    inputs = resolve(case).one_impact()
    problem, limits = build(inputs), Limits.of(inputs.tolerance)
    solution = integrate(problem, report, stop, drawn=False)
    about = assessment_of(name, problem._replace(contact=solution.contact), solution.motion)
    measures = measured(solution)
    own = float(measures.impact_speed)  # none where gas stops the body before
    own = own if np.isfinite(own) else float(measures.maximum_speed)
    launcher = Launcher(problem, solution, limits, finer=True, stop=stop)
    report(0.3, "critical velocity")
    found = critical_measures(launcher.edges(solution))
    if speeds is None:
        count = points or (POINTS if inputs.placement is None else FEWER)
        speeds = chosen(ends, count, found["capture_edges"], own)
    rebounds: list[Rebound] = []
    for number, speed in enumerate(speeds.tolist()):
        report(0.4 + 0.6 * number / speeds.size, f"{number} of {speeds.size} speeds")
        rebounds.append(launcher(speed))
    known = sorted((r for r in rebounds if np.isfinite(r.speed)), key=lambda r: r.speed)
    if not known:
        raise SimulationError("no first impact could be computed at any of the speeds")
    warnings = [*about.warnings, *left_out(len(rebounds) - len(known), len(rebounds))]
    speed = np.array([rebound.speed for rebound in known])
    turning_point = float(solution.motion.impacts.closest_approach[0])
    bodies = capture_probability(problem, turning_point, speed, lambda _, t: report(0.99, t), stop)
    report(1.0, "done")
    return RestitutionCurve(
        case=case,
        name=name,
        speed=speed,
        restitution=np.array([rebound.restitution for rebound in known]),
        captured=np.array([rebound.captured for rebound in known]),
        critical_velocity=found["critical_velocity"],
        capture_edges=found["capture_edges"],
        note=found["critical_velocity_note"],
        own_speed=own,
        warnings=warnings,
        single_bodies=bodies,
    )
