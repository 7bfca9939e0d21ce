"""Cases of one structure, integrated together by a few impacts; those at rest make room."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from asperity._jax import jax, jnp
from asperity.contact import ElasticContact
from asperity.dynamics import (
    Body,
    Impacts,
    Limits,
    Motion,
    Progress,
    Table,
    integrate_impacts,
    prepare,
    start,
)
from asperity.dynamics.curve_table import ATTRACTION, CENTRAL, CONTACTING, FORCE, outer_row
from asperity.dynamics.release import AtRelease, at_release
from asperity.dynamics.static_equilibrium import Reference
from asperity.numerics.compilation import QUICKLY, Program, kept
from asperity.results.measures import (
    FirstContact,
    Measures,
    Passing,
    first_contact,
    measure,
    passing_at,
)
from asperity.sweeps.compute.building import Batch

IMPACTS = 16
"""Impacts of a compiled call."""

FEW_CASES = 64
"""Cases up to which a group counts as small."""

_NARROW = 32  # width of a call for few cases, most of which would be empty in a wide one
_FAST: dict[str, bool | int] = {"xla_cpu_multi_thread_eigen": False}
"""XLA's own choices, a third faster than what compiles quickly; a thread for each task, no more."""

_SOON: dict[str, bool | int] = {**QUICKLY, **_FAST}
"""For a few rigid or smooth bodies: they take less time than it takes to compile for them."""


@kept
class Begun(NamedTuple):
    """What a motion goes on from.

    Attributes
    ----------
    table, reference, origin
        Curves, static equilibrium, and mechanical energy at the release [J].
    progress
        The motion at its last apex.
    first
        The first contact; None before it.
    """

    table: Table
    reference: Reference
    origin: jax.Array
    progress: Progress
    first: FirstContact | None


@kept
class Checks(NamedTuple):
    """What must hold before a motion is believed.

    Attributes
    ----------
    error, residual
        Relative errors of the interpolation and of the contact's equilibrium.
    at_release
        The forces at the release.
    at_depth
        :class:`asperity.regimes.validity.AtDepth` of the first impact.
    """

    error: jax.Array
    residual: jax.Array
    at_release: AtRelease
    at_depth: jax.Array


Rows = tuple[Impacts, Passing | None]
"""Impacts without their phases, and the energies with which each passes the end of contact."""


def _begin(batch: Batch) -> tuple[Begun, Checks, Rows]:
    """The curves of each case and its first impacts."""

    def one(batch: Batch) -> tuple[Begun, Checks, Rows]:
        contact, body = batch.contact, batch.body
        table, reference = prepare(contact, body, True)
        progress, origin = start(contact, body, table)
        begun = Begun(table, reference, origin, progress, None)
        progress, impacts = _integrated(batch, begun)
        deepest = outer_row(table, 0, impacts.closest_approach[0])
        at_depth = jnp.stack(
            [deepest[CONTACTING], deepest[FORCE] - deepest[ATTRACTION], deepest[CENTRAL]]
        )
        outset = at_release(table, body)
        checks = Checks(table.error, table.residual, outset, at_depth)
        begun = begun._replace(progress=progress, first=first_contact(table, impacts, body))
        return begun, checks, _slim(body, begun, impacts)

    return _over(batch)(one)(batch)


def _go_on(batch: Batch, begun: Begun) -> tuple[Progress, Rows]:
    """The next impacts of each case."""

    def one(pair: tuple[Batch, Begun]) -> tuple[Progress, Rows]:
        batch, begun = pair
        progress, impacts = _integrated(batch, begun)
        return progress, _slim(batch.body, begun, impacts)

    return _over(batch)(one)((batch, begun))


def _integrated(batch: Batch, begun: Begun) -> tuple[Progress, Impacts]:
    limits = Limits(*(jnp.asarray(end) for end in batch[2:]))
    return integrate_impacts(
        batch.contact, batch.body, begun.table, begun.reference, begun.origin, begun.progress,
        limits, IMPACTS,
    )  # fmt: skip


def _slim(body: Body, begun: Begun, impacts: Impacts) -> Rows:
    passing = None
    if body.damped_apart:
        assert begun.first is not None
        passing = passing_at(body, begun.table, impacts, begun.first.end)
    return impacts._replace(fall=None, rise=None), passing  # type: ignore[arg-type]


def _measure(
    batch: Batch, ends: tuple[Reference, jax.Array, Progress, FirstContact], rows: Rows
) -> Measures:
    """Measures of motions that have ended."""

    def one(batch: Batch, ends: Any, rows: Rows) -> Measures:
        reference, origin, progress, first = ends
        impacts, passing = rows
        # The table is not needed where the first contact is known.
        motion = Motion(impacts, progress, None, reference, origin)  # type: ignore[arg-type]
        return measure(motion, batch.body, passing, first)

    return jax.vmap(one)(batch, ends, rows)


def _over(batch: Batch) -> Callable[[Any], Any]:
    """Side by side, or one after the other where each is a large computation of its own."""
    if isinstance(batch.contact, ElasticContact):
        return lambda one: lambda values: jax.lax.map(one, values)
    return jax.vmap


class Steps(NamedTuple):
    """The compiled steps of a batch: its first impacts, the next ones, the measures."""

    begin: Program[..., Any]
    go_on: Program[..., Any]
    measure: Program[..., Any]

    @classmethod
    def compiled(cls, options: dict[str, bool | int]) -> Steps:
        """Each step with XLA's ``options``."""
        return cls(*(Program(step, options) for step in (_begin, _go_on, _measure)))


_OF_MANY, _OF_FEW = Steps.compiled(_FAST), Steps.compiled(_SOON)


def steps(cases: int) -> Steps:
    """The compiled steps of batches of so many cases."""
    return _OF_FEW if cases == _NARROW else _OF_MANY


def width(batch: Batch, count: int) -> int:
    """Number of cases of a compiled call, for so many in all."""
    if isinstance(batch.contact, ElasticContact):
        return 8
    if count <= FEW_CASES:
        return _NARROW
    return 256 if jax.default_backend() == "cpu" else 4096


class Stopped(Exception):
    """A task that was asked to stop; nothing of it is kept."""


class Clock:
    """Time in compiled code [s], and the share of the batch that did something.

    Parameters
    ----------
    stop
        Ends the task when set: `Stopped` is raised before the next compiled call.
    """

    def __init__(self, stop: threading.Event | None = None) -> None:
        self.stop = stop
        self.compiled = 0.0
        self.useful = 0
        self.all = 0

    def run(self, program: Program[..., Any], *args: Any) -> Any:
        """The answer of a compiled call."""
        self.look()
        call = program.ready(*args)
        began = time.perf_counter()
        answer = jax.block_until_ready(call())
        self.compiled += time.perf_counter() - began
        return answer

    def look(self) -> None:
        """Raise `Stopped` where the task is to end."""
        if self.stop is not None and self.stop.is_set():
            raise Stopped

    def count(self, made: np.ndarray) -> None:
        """Count the impacts that the batch made in a call: all wait for the last."""
        self.useful += int(made.sum())
        self.all += made.shape[0] * int(made.sum(axis=1).max(initial=0))

    @property
    def batch_use(self) -> float:
        """Share of the batch's time that was of use."""
        return self.useful / self.all if self.all else 1.0
