"""The compiled steps of cases of one structure: their curves, their next impacts, their measures.

One case is a batch of one: its axis is taken off within the step, so that it runs the code of one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from equinox.internal import unvmap_any

from .._jax import jax, jnp
from ..contact import Contact, ElasticContact, RigidContact
from ..contact.rough import RoughContact
from ..dynamics import Begun, Body, Impacts, Progress, Table, integrate_impacts, prepare, start
from ..dynamics.curve_table import ATTRACTION, CENTRAL, CONTACTING, FORCE, outer_row
from ..dynamics.release import at_release
from ..numerics.compilation import AT_ONCE, QUICKLY, Options, Program
from ..numerics.trees import choose
from ..results import conversion
from ..results.first_contact import FirstContact, first_contact, passing_at
from ..results.measures import Measures, measure
from .batch_records import (
    Batch,
    Checks,
    FirstImpact,
    ImpactRows,
    unbatched_shapes,
    whole,
)

FEW_CASES = 64
"""Cases up to which a group counts as small."""

_NARROW = 32  # width of a call for few cases, most of which would be empty in a wide one
_IMPACTS = 16  # of a compiled call of a batch
_LEAST = 4  # panels that count as one time, where a contact has fewer
_REFINEMENTS = (1, 2, 4, 8)
_OF_A_RUN, _OF_A_CHEAP_RUN = (2, 8), (3, 8)
_CHUNK, _QUICK = 20, 100  # of one case: short enough for Ctrl-C, where all is quick

_FAST: Options = {"xla_cpu_multi_thread_eigen": False}
"""XLA's own choices, a third faster than what compiles quickly; a thread for each task, no more."""

_SOON: Options = {**QUICKLY, **_FAST}
"""For a few rigid or smooth bodies: they take less time than it takes to compile for them."""


def _curves(batch: Batch, cuts: np.ndarray, tabulated: bool) -> tuple[Begun, Checks]:
    """The curves of each case, with panels cut at separations [m], and its release."""

    def one(values: tuple[Batch, jax.Array]) -> tuple[Begun, Checks]:
        (contact, body, _), cuts = values
        table, reference = prepare(contact, body, tabulated, cuts)
        # Beyond it a rough contact has panels of its own kind.
        reach = contact.interaction_range if isinstance(contact, RoughContact) else table.ends[-1]
        checks = Checks(table.ends, table.errors, table.residual, reach, at_release(table, body))
        return start(contact, body, table, reference), checks

    return _over(batch)(one)((batch, cuts))


def _impacts(
    batch: Batch, begun: Begun, first: FirstImpact | None, count: int
) -> tuple[Progress, FirstImpact | None, ImpactRows]:
    """The next impacts of each case, so many at most; with their phases where no first is kept."""

    def one(
        values: tuple[Batch, Begun, FirstImpact | None],
    ) -> tuple[Progress, FirstImpact | None, ImpactRows]:
        (contact, body, limits), begun, first = values
        table = begun.table
        after, impacts = integrate_impacts(contact, body, begun, limits, count)
        if first is None:
            return after, None, ImpactRows(impacts)
        now = begun.progress.made == 0
        found = jax.lax.cond(
            unvmap_any(now), lambda: _first_impact(table, impacts, body), lambda: first
        )
        first = choose(now, found, first)
        passing = None
        if body.damped_apart:
            passing = passing_at(body, table, impacts, first.contact.end)
        slim = impacts._replace(fall=None, rise=None)  # type: ignore[arg-type]
        return after, first, ImpactRows(slim, passing)

    return _over(batch)(one)((batch, begun, first))


def _first_impact(table: Table, impacts: Impacts, body: Body) -> FirstImpact:
    deepest = outer_row(table, 0, impacts.closest_approach[0])
    at_depth = [deepest[CONTACTING], deepest[FORCE] - deepest[ATTRACTION], deepest[CENTRAL]]
    return FirstImpact(first_contact(table, impacts, body), jnp.stack(at_depth))


def _measure(batch: Batch, ends: Begun, first: FirstContact, rows: ImpactRows) -> Measures:
    """Measures of motions that have ended; their tables are not needed."""

    def one(body: Body, ends: Begun, first: FirstContact, rows: ImpactRows) -> Measures:
        return measure(whole(ends, rows), body, rows.passing, first)

    return jax.vmap(one)(batch.body, ends, first, rows)


def _over(batch: Batch) -> Callable[[Any], Any]:
    """Side by side, or one after the other where each is a large computation of its own."""
    if batch.limits.rest.shape[0] == 1:
        return _alone
    if isinstance(batch.contact, ElasticContact):
        return lambda one: lambda values: jax.lax.map(one, values)
    return jax.vmap


def _alone(one: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """The step of a batch of one."""

    def step(values: Any) -> Any:
        answer = one(jax.tree_util.tree_map(lambda leaf: leaf[0], values))
        return jax.tree_util.tree_map(lambda leaf: jnp.asarray(leaf)[None], answer)

    return step


class Steps(NamedTuple):
    """The compiled steps of a batch, and how they are called.

    Attributes
    ----------
    curves, impacts, measure
        The curves, the next impacts, the measures.
    width
        Cases of a compiled call.
    together
        Impacts of a compiled call.
    tabulated
        Whether the scanning curves are tabulated first.
    drawn
        Whether the motion of one case is measured and drawn: that is compiled meanwhile.
    refinements
        Times the panels, at most, one after the other, until the curves meet the tolerance. Each is
        compiled: of a single run there are two.
    """

    curves: Program[..., Any]
    impacts: Program[..., Any]
    measure: Program[..., Any]
    width: int
    together: int = _IMPACTS
    tabulated: bool = True
    drawn: bool = False
    refinements: tuple[int, ...] = _REFINEMENTS

    @classmethod
    def of_batch(cls, batch: Batch, cases: int, width: int | None = None) -> Steps:
        """Those of a batch, for so many cases in all; without a width, what suits them."""
        wide = width or _width(batch, cases)
        return cls(*(_OF_FEW if wide == _NARROW else _OF_MANY), wide)

    @classmethod
    def of_one(cls, contact: Contact, body: Body, *, many: bool, drawn: bool = False) -> Steps:
        """Those of one case; ``many`` as for :func:`asperity.integration.integrate`."""
        programs = _OF_ONE
        if isinstance(contact, ElasticContact):
            programs = _ON_HALF_SPACE if many else _FEW_ON_HALF_SPACE
        cheap = isinstance(contact, RigidContact) and not body.damped
        finer = _OF_A_CHEAP_RUN if cheap else _REFINEMENTS if many else _OF_A_RUN
        return cls(*programs, 1, _impacts_together(contact, body), many, drawn, finer)

    def most_cuts(self, contact: Contact, factor: int) -> int:
        """Number of cuts in the panels of a contact's curves at one of the refinements."""
        return (factor - 1) * max(contact.resolved.panels, _LEAST)

    def compile_ahead(self, batch: Batch, cuts: np.ndarray | None = None) -> None:
        """Compile for a batch of the width of a call in threads, where that is not done."""
        cuts = np.zeros((self.width, 0)) if cuts is None else cuts
        begun, _checks = self.curves.ahead(batch, cuts, self.tabulated)
        _progress, _first, rows = self.impacts.ahead(batch, begun, self.before, self.together)
        if self.drawn:
            begun, rows, body = unbatched_shapes((begun, rows, batch.body))
            conversion.compile_ahead(whole(begun, rows), body)

    @property
    def before(self) -> FirstImpact | None:
        """What is known of first impacts before any: None for one case, which keeps its phases."""
        return FirstImpact.unknown(self.width) if self.width > 1 else None


def _width(batch: Batch, cases: int) -> int:
    if isinstance(batch.contact, ElasticContact):
        return 8
    if cases <= FEW_CASES:
        return _NARROW
    return 256 if jax.default_backend() == "cpu" else 4096


def _impacts_together(contact: Contact, body: Body) -> int:
    """Impacts of one case in one compiled call."""
    if isinstance(contact, RigidContact) and not body.damped:
        return _QUICK if contact.interface.closed else _CHUNK
    return _CHUNK


_Programs = tuple[Program[..., Any], Program[..., Any], Program[..., Any]]


def _compiled(options: Options) -> _Programs:
    """The curves, the impacts and the measures, with XLA's options."""
    return Program(_curves, options), Program(_impacts, options), Program(_measure, options)


_OF_MANY, _OF_FEW, _OF_ONE = _compiled(_FAST), _compiled(_SOON), _compiled(AT_ONCE)
# Rings are solved so often that optimised code pays, but for curves that serve one motion.
_ON_HALF_SPACE: _Programs = (*_compiled(QUICKLY)[:2], _OF_ONE[2])
_FEW_ON_HALF_SPACE: _Programs = (_OF_ONE[0], *_ON_HALF_SPACE[1:])
