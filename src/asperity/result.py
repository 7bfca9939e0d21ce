"""What a case gives: `Result` of a motion, `Curve` of force against separation."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from asperity import summary
from asperity.cards import card, counted
from asperity.errors import Outcome

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from asperity.case import Case

Arrays = dict[str, np.ndarray]


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """A motion from release to its end, with its measures.

    Parameters
    ----------
    case : Case
        The resolved case.
    name : str
        What the case is called.
    outcome : Outcome
        How the motion ended.
    time : numpy.ndarray
        Time since the release [s].
    separation, central_separation : numpy.ndarray
        Rigid separation, and with the bodies' deformation [m]; as long as ``time``.
    speed : numpy.ndarray
        d(separation)/dt [m/s], positive apart; as long as ``time``.
    forces : dict of str to numpy.ndarray
        "weight", "elastic", "adhesion", "capillary", "contact" (all but the weight), "total" [N],
        positive apart; those that the case has, as long as ``time``.
    energies : dict of str to numpy.ndarray
        "kinetic", "potential", "stored" and "lost_MECHANISM" [J]; as long as ``time``.
    regime, measures, ledger : dict
        Plain numbers, lists and text in SI, None where one does not apply; see ``asperity run
        --json``.
    warnings : list of str
        What to know before the numbers are used.
    events : dict of str to numpy.ndarray
        "deepest_time", "apex_time" [s], "deepest_separation", "apex_separation" [m], per impact.
    input_sha256 : str, optional
        SHA-256 of the text that the case was read from; without it, of the resolved case's.
    case_file : str, optional
        Path of the case's file, or which built-in case it is; None of a case made in Python.
    surface : dict, optional
        Measured surfaces: files with their SHA-256, what was done to them, and what was found,
        in SI; None for a case of numbers.
    """

    case: Case
    name: str
    outcome: Outcome
    time: np.ndarray
    separation: np.ndarray
    central_separation: np.ndarray
    speed: np.ndarray
    forces: Arrays
    energies: Arrays
    regime: dict[str, Any]
    measures: dict[str, Any]
    ledger: dict[str, Any]
    warnings: list[str]
    events: Arrays
    input_sha256: str | None = None
    case_file: str | None = None
    surface: dict[str, Any] | None = None

    def dataset(self) -> xarray.Dataset:
        """Everything as a dataset with units; the case and the measures are its attributes."""
        from asperity import records

        return records.dataset(self)

    def plot(self) -> Figure:
        """Motion, forces and energy in one figure."""
        from asperity import plots

        return plots.figure(self)

    def summary(self, *, published: bool | None = None) -> str:
        """Outcome and measures as text.

        Parameters
        ----------
        published : bool, optional
            Whether the publication's measures are in it: decrement and power losses; by default
            for a case with a [publication] table.
        """
        from asperity import records

        return summary.of_result(self, records.attributes(self), published=published)

    def files(
        self, *, pictures: bool | None = None, published: bool | None = None
    ) -> dict[str, bytes]:
        """Content of every file of the result, by name.

        Parameters
        ----------
        pictures : bool, optional
            Whether to draw; without it as the case's ``output.pictures`` says.
        published : bool, optional
            As for `summary`.
        """
        from asperity import records

        text = self.summary(published=published).encode()
        found = {"record.nc": records.encode(self), "summary.txt": text}
        if self.case.output.pictures if pictures is None else pictures:
            from asperity import plots

            found |= plots.pictures(self)
        return found

    def save(self, directory: str | os.PathLike[str], force: bool = False) -> list[Path]:
        """Write record, summary and pictures, all or none; the paths written.

        Parameters
        ----------
        directory : path
            Folder to write into, made where it is missing.
        force : bool
            Whether to replace the files of an earlier result there; others stay in any case.

        Raises
        ------
        InputError
            Where the folder is not empty and ``force`` is not set.
        OutputError
            Where the files cannot be written.
        """
        from asperity import records

        return records.write_folder(directory, self.files(), records.RUN_FILES, force=force)

    def __repr__(self) -> str:
        kept = [e for e in self.measures.get("restitution") or [] if e is not None]
        impacts = len(self.measures.get("restitution") or [])
        first = f", first restitution {kept[0]:.3g}" if kept else ""
        return (
            f"<Result {self.name}: {self.outcome.value}, {counted(impacts, 'impact')}{first}, "
            f"{counted(len(self.warnings), 'warning')}>"
        )

    def _repr_html_(self) -> str:
        sentence, sections = summary.shown_of(self)
        return card(self.name, sentence, sections, self.warnings)


@dataclass(frozen=True, eq=False, repr=False)
class Curve:
    """Force against separation, on the way in and on the way out, without motion.

    Parameters
    ----------
    case : Case
        The resolved case.
    name : str
        What the case is called.
    rigid_separation, central_separation : numpy.ndarray
        Rigid separation, and with the bodies' deformation on the way in [m].
    force_approach, force_parting : numpy.ndarray
        Contact force [N], positive apart; as long as ``rigid_separation``.
    components_approach, components_parting : dict of str to numpy.ndarray
        The forces taken apart by mechanism [N].
    deepest : float
        Closest rigid separation [m].
    pull_off : float
        Largest tension while unloading [N].
    pull_off_separation : float, optional
        Rigid separation there [m]; None where nothing pulls.
    work_of_separation : float
        Work against tension while unloading, from the separation of zero force on [J].
    preload : float, optional
        Load at closest approach [N] where these three depend on it; None where any larger load
        gives the same.
    loss : float
        Energy lost over in and out [J].
    warnings : list of str
        What to know before the numbers are used.
    input_sha256 : str, optional
        SHA-256 of the text that the case was read from; without it, of the resolved case's.
    case_file : str, optional
        Path of the case's file, or which built-in case it is; None of a case made in Python.
    """

    case: Case
    name: str
    rigid_separation: np.ndarray
    central_separation: np.ndarray
    force_approach: np.ndarray
    force_parting: np.ndarray
    components_approach: Arrays
    components_parting: Arrays
    deepest: float
    pull_off: float
    pull_off_separation: float | None
    work_of_separation: float
    preload: float | None
    loss: float
    warnings: list[str]
    input_sha256: str | None = None
    case_file: str | None = None

    def dataset(self) -> xarray.Dataset:
        """Everything as a dataset with units; the case is its attribute."""
        from asperity import records

        return records.dataset(self)

    def plot(self) -> Figure:
        """Force against separation, with the loss between the branches."""
        from asperity import plots

        return plots.figure(self)

    def summary(self) -> str:
        """The curve's numbers as text."""
        from asperity import records

        return summary.of_curve(self, records.attributes(self))

    def files(self, *, pictures: bool | None = None) -> dict[str, bytes]:
        """Content of every file of the curve, by name; ``pictures`` as for `Result.files`."""
        from asperity import records

        found = {"curve.nc": records.encode(self), "curve.txt": self.summary().encode()}
        if self.case.output.pictures if pictures is None else pictures:
            from asperity import plots

            found |= plots.pictures(self)
        return found

    def save(self, directory: str | os.PathLike[str], force: bool = False) -> list[Path]:
        """Write record, summary and picture, all or none; as `Result.save`."""
        from asperity import records

        return records.write_folder(directory, self.files(), records.CURVE_FILES, force=force)

    def __repr__(self) -> str:
        pull = summary.amount(self.pull_off, "N")
        warned = counted(len(self.warnings), "warning")
        return f"<Curve {self.name}: pull-off force {pull}, {warned}>"

    def _repr_html_(self) -> str:
        rows = summary.shown_of_curve(self)
        return card(self.name, "Force against separation, in and out.", [("", rows)], self.warnings)
