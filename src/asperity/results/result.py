"""What a case gives: `Result` of a motion, `Curve` of force against separation."""

from __future__ import annotations

import importlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from asperity.config.html_table import card, counted
from asperity.results import netcdf_record, record_layout, results_folder, summary
from asperity.results.result_data import CurveData, ResultData

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure


def drawing(room: str = "asperity.plots") -> Any:
    """The module that draws, asked for by its name when a picture is wanted.

    Pictures are made from results, so that no import can lead from here to them.
    """
    return importlib.import_module(room)


@dataclass(frozen=True, eq=False, repr=False)
class Result(ResultData):
    """A motion from release to its end, with its measures; what it holds says `ResultData`."""

    def dataset(self) -> xarray.Dataset:
        """Everything as a dataset with units; the case and the measures are its attributes."""
        return netcdf_record.dataset(self)

    def plot(self) -> Figure:
        """Motion, forces and energy in one figure."""
        figure: Figure = drawing().figure(self)
        return figure

    def summary(self, *, published: bool | None = None) -> str:
        """Outcome and measures as text.

        Parameters
        ----------
        published : bool, optional
            Whether the publication's measures are in it: decrement and power losses; by default
            for a case with a [publication] table.
        """
        return summary.of_result(self, record_layout.attributes(self), published=published)

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
        text = self.summary(published=published).encode()
        found = {"record.nc": netcdf_record.encode(self), "summary.txt": text}
        if self.case.output.pictures if pictures is None else pictures:
            found |= drawing().pictures(self)
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
        return results_folder.write_folder(
            directory,
            self.files(),
            (*results_folder.RUN_FILES, *results_folder.SINGLE_BODY_FILES),
            force=force,
        )

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
class Curve(CurveData):
    """Force against separation without motion; what it holds says `CurveData`."""

    def dataset(self) -> xarray.Dataset:
        """Everything as a dataset with units; the case is its attribute."""
        return netcdf_record.dataset(self)

    def plot(self) -> Figure:
        """Force against separation, with the loss between the branches."""
        figure: Figure = drawing().figure(self)
        return figure

    def summary(self) -> str:
        """The curve's numbers as text."""
        return summary.of_curve(self, record_layout.attributes(self))

    def files(self, *, pictures: bool | None = None) -> dict[str, bytes]:
        """Content of every file of the curve, by name; ``pictures`` as for `Result.files`."""
        found = {"curve.nc": netcdf_record.encode(self), "curve.txt": self.summary().encode()}
        if self.case.output.pictures if pictures is None else pictures:
            found |= drawing().pictures(self)
        return found

    def save(self, directory: str | os.PathLike[str], force: bool = False) -> list[Path]:
        """Write record, summary and picture, all or none; as `Result.save`."""
        return results_folder.write_folder(
            directory, self.files(), results_folder.CURVE_FILES, force=force
        )

    def __repr__(self) -> str:
        pull = summary.amount(self.pull_off, "N")
        warned = counted(len(self.warnings), "warning")
        return f"<Curve {self.name}: pull-off force {pull}, {warned}>"

    def _repr_html_(self) -> str:
        rows = summary.shown_of_curve(self)
        return card(self.name, "Force against separation, in and out.", [("", rows)], self.warnings)
