"""Heights from the formats of instruments, through SurfaceTopography."""

from __future__ import annotations

import contextlib
import dataclasses
import io
import logging
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

from ...errors import InputError, one_line
from ...units import shown
from ..topography import Topography
from .content import MOST_PIXELS, cut_short, refusal, suffix_of
from .header import agreed_size, agreed_unit, in_metres
from .reading import Asked, Reading

_OURS = ".npy .csv .txt .dat .xyz .nc"
"""Endings that the program reads itself, each also packed as .gz."""

_BY_ENDING = ("nms", "hgt")
"""Formats without a mark of their own, which fit many a file: taken by their ending alone."""


def instrument_reading(content: bytes, file: str, asked: Asked) -> Reading:
    """One channel of heights from a file of any format that SurfaceTopography reads.

    Parameters
    ----------
    content
        The file's bytes, unpacked.
    file
        Its name.
    asked
        What is said of it beside.

    Raises
    ------
    InputError
        Where the library cannot read the file, the channel is no map of heights, or size or unit
        are stated neither by the file nor by the caller, or by both differently.
    """
    with warnings.catch_warnings(record=True) as told, _silenced("igor2"):
        warnings.simplefilter("always")
        # Here, since it takes a second and a half to import, and warns that it has no MPI.
        import SurfaceTopography.IO as library

        try:
            reading = _read(library, content, file, asked)
        except InputError:
            raise
        except Exception as error:  # damaged files make its readers raise errors of every kind
            raise _unreadable(file, error) from error
    return dataclasses.replace(reading, notes=_notes(told))


@contextlib.contextmanager
def _silenced(name: str) -> Iterator[None]:
    """A logger and those below it kept still: it writes the file's bytes out before it raises."""
    logger, still = logging.getLogger(name), logging.NullHandler()
    before, logger.propagate = logger.propagate, False
    logger.addHandler(still)
    try:
        yield
    finally:
        logger.removeHandler(still)
        logger.propagate = before


def _read(library: Any, content: bytes, file: str, asked: Asked) -> Reading:
    with library.open_topography(io.BytesIO(content)) as reader:
        kind = reader.format()
        if kind in _BY_ENDING and suffix_of(file) != f".{kind}":
            raise _unknown(file)
        heights = [one for one in reader.channels if _is_map(one)]
        chosen = _chosen(heights, reader.default_channel, file, asked.channel)
        heights_unit = agreed_unit(chosen.unit or None, asked.unit, file)
        width, length = _size(chosen, heights_unit, asked.size, file)
        surface = chosen.topography(**_lacking(chosen))
        _check_others(library, reader.channels, chosen)
        columns, rows = surface.nb_grid_pts
        # Masked where undefined, and the first index along x.
        values = np.ma.filled(
            np.ma.asarray(surface.to_unit("m").heights(), dtype=np.float64), np.nan
        ).T
        made = values if chosen.unit else in_metres(values, heights_unit)
        return Reading(
            Topography(made, (width / columns, length / rows), file),
            str(reader.name()),
            _label(chosen),
            tuple(_label(one) for one in heights),
        )


def _size(
    channel: Any, heights_unit: str, size: tuple[float, float] | None, file: str
) -> tuple[float, float]:
    """Size (x, y) [m] of a channel; the library gives it in the unit of the heights."""
    own = channel.physical_sizes
    stated = None if own is None else in_metres(np.array(own, dtype=np.float64), heights_unit)
    return agreed_size(None if stated is None else (stated[0], stated[1]), size, file)


def _lacking(channel: Any) -> dict[str, Any]:
    """What the library insists on where the file is silent: as if all were in metres."""
    lacking = {} if channel.unit else {"unit": "m"}
    return lacking if channel.physical_sizes else {**lacking, "physical_sizes": (1.0, 1.0)}


def _check_others(library: Any, channels: list[Any], chosen: Any) -> None:
    """Read the other channels too: a file cut in half may still hold the first of them."""
    for one in channels:
        if one.index != chosen.index:
            try:
                one.topography()
            except library.CorruptFile:
                raise
            except Exception:  # noqa: BLE001 - a channel not asked for may be beyond the library
                continue


def _is_map(channel: Any) -> bool:
    """Whether a channel holds heights over a plane; a pair of units is that of another quantity."""
    uniform = channel.dim == 2 and channel.is_uniform is not False
    return bool(uniform and channel.is_height_channel and not isinstance(channel.unit, tuple))


def _chosen(heights: list[Any], default: Any, file: str, channel: str | int | None) -> Any:
    """The channel asked for by number or name, else the library's default."""
    listed = ", ".join(_label(one) for one in heights) or "none"
    if channel is None:
        found = [one for one in heights if one.index == default.index]
    else:
        found = [one for one in heights if channel in (one.index, one.name, str(one.index))]
    if len(found) != 1:
        got = _label(default) if channel is None else shown(channel)
        rule = "the channel must be one of heights" if not found else "the channel must be one"
        raise refusal(file, f"{rule}: {listed}; got {got}; give its number")
    (one,) = found
    if np.prod([float(count) for count in one.nb_grid_pts]) > MOST_PIXELS:
        raise refusal(file, f"must have at most {MOST_PIXELS} pixels; got {one.nb_grid_pts}")
    return one


def _label(channel: Any) -> str:
    return f"{channel.index} {channel.name}"


def _unreadable(file: str, error: Exception) -> InputError:
    """The library's refusal in one line; its list of all readers tried is left out."""
    if type(error).__name__ == "CannotDetectFileFormat":
        return _unknown(file)
    said = one_line(str(error))[:160] or type(error).__name__
    return cut_short(file, f"a file that SurfaceTopography cannot read ({said})")


def _unknown(file: str) -> InputError:
    return refusal(
        file,
        f"must be whole and in a known format ({_OURS}, or one that SurfaceTopography reads); got "
        "neither; export it again, as .csv if need be",
    )


def _notes(told: list[warnings.WarningMessage]) -> tuple[str, ...]:
    """What the library warns of, once each; warnings about code, not about the file, are left out.

    Those are for the authors of the libraries: a user can do nothing about them.
    """
    about_code = (DeprecationWarning, PendingDeprecationWarning, FutureWarning, ImportWarning)
    said = [one_line(str(one.message)) for one in told if not issubclass(one.category, about_code)]
    return tuple(dict.fromkeys(said))
