"""What can go wrong and how a motion can end: errors, exit codes, outcomes, tolerances."""

from __future__ import annotations

import enum
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

EXIT_INPUT = 2
EXIT_NUMERICS = 3
EXIT_OUTPUT = 4
EXIT_INTERRUPTED = 130


class InputError(ValueError):
    """A case, file or argument that cannot be used; the message is one line.

    Parameters
    ----------
    message : str
        What is wrong: argument, rule, value. Line breaks and control characters in it become
        spaces or escapes.
    file : str, optional
        Path of the file at fault; None where the input came from no file.
    key : str, optional
        Dotted key at fault, e.g. ``body.radius``; None where no single key is.
    also : sequence of InputError
        What else is wrong with the same input; the message tells of the first problem alone.
    """

    def __init__(
        self,
        message: str,
        *,
        file: str | None = None,
        key: str | None = None,
        also: Sequence[InputError] = (),
    ) -> None:
        super().__init__(one_line(message))
        self.file = file
        self.key = key
        self.also = tuple(also)

    @property
    def problems(self) -> tuple[InputError, ...]:
        """All that is wrong with the input, this problem first."""
        return (self, *(one for other in self.also for one in other.problems))


def refuse_all(problems: Iterable[InputError]) -> None:
    """Raise the first of some problems, with the others beside it; nothing where there is none."""
    found = list(problems)
    if found:
        found[0].also = (*found[0].also, *found[1:])
        raise found[0]


def check_each(*checks: Callable[[], object]) -> None:
    """Make every check, and raise what they refuse: the first problem with the others beside it."""
    found = []
    for check in checks:
        try:
            check()
        except InputError as error:
            found.append(error)
    refuse_all(found)


class SimulationError(RuntimeError):
    """The numerics failed; what was computed until then is kept.

    Parameters
    ----------
    message : str
        What failed, and where.
    partial : object, optional
        The result, motion or curve computed so far; None where there is nothing.
    """

    def __init__(self, message: str, partial: Any = None) -> None:
        super().__init__(message)
        self.partial = partial


class OutputError(OSError):
    """A result cannot be written: no permission, full disk, a folder in use.

    Parameters
    ----------
    message : str
        What could not be written, and why; one line.
    path : str, optional
        Path of the file or folder that could not be written.
    """

    def __init__(self, message: str, *, path: str | None = None) -> None:
        super().__init__(one_line(message))
        self.path = path


class Outcome(enum.Enum):
    """How a motion ended."""

    REST = "rest"
    OSCILLATING = "oscillating"
    ESCAPED = "escaped"
    STOPPED = "stopped"
    TIME_LIMIT = "time_limit"
    MAX_IMPACTS = "max_impacts"
    INTERRUPTED = "interrupted"
    FAILED = "failed"

    @property
    def message(self) -> str:
        """The outcome in a sentence for the user."""
        return _MESSAGES[self]

    @property
    def ok(self) -> bool:
        """True where the motion reached one of its own ends."""
        return self not in (Outcome.INTERRUPTED, Outcome.FAILED)


ENDS = (
    Outcome.REST,
    Outcome.OSCILLATING,
    Outcome.ESCAPED,
    Outcome.TIME_LIMIT,
    Outcome.MAX_IMPACTS,
    Outcome.FAILED,
    Outcome.STOPPED,
)
"""Outcomes in the order of their codes, in a motion and in a study's column ``outcome``."""

_MESSAGES = {
    Outcome.REST: "The body came to rest: its rebound fell below `numerics.rest_height_ratio` of "
    "the first.",
    Outcome.OSCILLATING: "The body oscillates: a whole cycle loses no energy, so it never rests.",
    Outcome.ESCAPED: "The body escaped: it left the surface and nothing brings it back.",
    Outcome.STOPPED: "The gas film stopped the body where nothing else acts on it.",
    Outcome.TIME_LIMIT: "The motion was stopped at `numerics.time_limit`.",
    Outcome.MAX_IMPACTS: "The motion was stopped after `numerics.max_impacts` impacts.",
    Outcome.INTERRUPTED: "The run was interrupted; what was computed until then is kept.",
    Outcome.FAILED: "The numerics failed; what was computed until then is kept.",
}


@dataclass(frozen=True)
class Tolerance:
    """How closely to solve and when to stop.

    Parameters
    ----------
    relative : float
        Relative error allowed to the force curves that the motion runs on [-].
    rest : float
        The motion is at rest below this fraction of the first rebound height [-].
    time_limit : float
        Longest simulated time [s].
    max_impacts : int
        Largest number of impacts [-].
    rings : int
        Number of rings that resolve an axisymmetric conjunction [-].
    """

    relative: float = 1e-8
    rest: float = 1e-3
    time_limit: float = math.inf
    max_impacts: int = 200
    rings: int = 80


def one_line(text: str) -> str:
    """Text on one printable line: white space runs become a blank, control characters escapes."""
    joined = " ".join(text.split())
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in joined)
