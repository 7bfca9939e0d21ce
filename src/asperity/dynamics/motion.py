"""Fall, touch, rebound, again: the phases of a motion in a row."""

from __future__ import annotations

from typing import NamedTuple

from equinox.internal import unvmap_any

from .._jax import jax, jnp
from ..contact.contact import Contact, Held, YieldingContact
from ..errors import Tolerance
from ..laws.law import Real
from ..numerics.trees import choose, zeros_of
from .curve_table import (
    CENTRAL,
    CONTACTING,
    FORCE,
    NO_CUTS,
    SIZE,
    STORED,
    Table,
    join,
    outer_row,
    quantities,
    tabulate,
    tabulate_again,
)
from .instability import over_folds
from .motion_end import EndRules
from .overdamped import Rest, come_to_rest
from .phase import TurningPoint, in_order, look_ahead, mechanical_at_end, pull_work, row_at
from .phase_time import travel_time
from .record import IN_MOTION, Begun, Body, Impacts, Limits, Motion, Phase, Progress
from .scanning_table import inner_pieces, solve_reversals
from .static_equilibrium import Reference, find_reference
from .turning_point import find_turning_point

LEAST_RISE = 1e-9
"""Share of the fall: a body that rises less stays where it turned."""

FEW = 8
"""Impacts up to which each reversal is better solved as it comes."""


def prepare(
    contact: Contact, body: Body, many: bool = False, cuts: Real = NO_CUTS
) -> tuple[Table, Reference]:
    """Tabulate a contact over all separations that a body can reach; find its static equilibrium.

    With the scanning curves where ``many`` impacts follow (static): a few are integrated sooner
    without. ``cuts`` as for :func:`asperity.dynamics.curve_table.tabulate`.
    """
    low = jax.lax.stop_gradient(
        contact.lower_bound(body.release, body.kinetic, body.load.potential)
    )
    height = body.load.apex_height(body.release, body.kinetic)
    top = body.release + jnp.where(jnp.isfinite(height), height, 0.0)
    high = jax.lax.stop_gradient(top + 1e-6 * (top - low))
    # A release so deep that the table would be empty is refused elsewhere; keep it finite here.
    low = jnp.minimum(low, body.release - 1e-3 * jnp.abs(body.release))
    yields = isinstance(contact, YieldingContact)
    if isinstance(contact, YieldingContact):
        table = _yielded_table(contact, body, low, high, cuts)
    else:
        table = tabulate(contact, low, high, cuts)
    if body.rebounds_from is None:
        reference = find_reference(table, body.load, int(yields))
    else:
        reference = Reference(body.rebounds_from, jnp.zeros(()))
    if many and not yields:
        table = solve_reversals(contact.reading(table.means), body, table, reference)
    return table, reference


def _yielded_table(
    contact: YieldingContact, body: Body, low: jax.Array, high: jax.Array, cuts: Real
) -> Table:
    """The curves of a contact that yields, before its first impact and as that leaves it.

    Nothing that follows goes deeper than the first impact: it has lost energy since.
    """
    before = tabulate(contact, low, high, cuts)
    begun = start(contact, body, before, find_reference(before, body.load, 0))
    rest = Rest(begun.reference.equilibrium, jnp.zeros(()))
    after, _fall = _phase_of_impact(contact, body, before, rest, begun.progress, jnp.asarray(False))
    return tabulate_again(contact, before, after.memory, after.place, cuts)


def start(contact: Contact, body: Body, table: Table, reference: Reference) -> Begun:
    """The state at the release, outside contact, with the curves that a motion goes on from."""
    zero = jnp.zeros(())
    row = outer_row(table, 0, body.release)
    progress = Progress(
        memory=contact.initial_memory(),
        place=body.release,
        kinetic=body.kinetic,
        time=zero,
        lost=jnp.zeros(len(contact.mechanisms) + len(body.mechanisms)),
        bonds=row[quantities(contact).bonds],
        central=row[CENTRAL],
        first=zero,
        impact_energy=zero,
        outcome=jnp.asarray(IN_MOTION),
        made=jnp.asarray(0),
    )
    origin = row[STORED] + body.kinetic + body.load.potential(body.release)
    return Begun(table, reference, origin, progress)


def integrate_impacts(
    contact: Contact, body: Body, begun: Begun, limits: Limits, impacts: int
) -> tuple[Progress, Impacts]:
    """Go on for at most ``impacts`` impacts (static), inert once the motion has ended."""

    @jax.jit  # traced once, for its shapes and for itself
    def one(progress: Progress, _: None) -> tuple[Progress, Impacts]:
        return _impact(contact, body, begun._replace(progress=progress), limits)

    shapes = jax.eval_shape(one, begun.progress, None)[1]

    def none(progress: Progress, _: None) -> tuple[Progress, Impacts]:
        return progress, zeros_of(shapes)

    def step(progress: Progress, _: None) -> tuple[Progress, Impacts]:
        active = progress.outcome == IN_MOTION
        after, row = jax.lax.cond(unvmap_any(active), one, none, progress, None)
        row = row._replace(made=jnp.logical_and(active, row.made))
        return choose(active, after, progress), row

    return jax.lax.scan(step, begun.progress, None, length=impacts)


def simulate(contact: Contact, body: Body, *, tolerance: Tolerance | None = None) -> Motion:
    """Motion of a body until it rests, escapes or reaches a limit.

    Parameters
    ----------
    contact
        The contact.
    body
        The body and its release, outside contact.
    tolerance
        Ends of the motion; ``max_impacts`` is static.

    Notes
    -----
    Works under ``jit``, ``vmap`` and ``grad``; nothing is raised, the outcome is data.
    """
    tolerance = tolerance or Tolerance()
    most = tolerance.max_impacts
    begun = start(contact, body, *prepare(contact, body, most > FEW))
    end, impacts = integrate_impacts(contact, body, begun, Limits.of(tolerance), most)
    return Motion(impacts, end, begun.table, begun.reference, begun.origin)


class _PhaseEnd(NamedTuple):
    turn: TurningPoint
    phase: Phase
    row: jax.Array
    pull_work: jax.Array
    at_rest: jax.Array
    followed: jax.Array
    stopped: jax.Array
    leaving: jax.Array


_Ended = tuple[Progress, _PhaseEnd]


def _phase_of_impact(
    contact: Contact,
    body: Body,
    table: Table,
    rest: Rest,
    progress: Progress,
    unloading: jax.Array,
) -> _Ended:
    """One phase down or up, and the bonds that it makes or breaks."""
    fate = jnp.asarray(False), jnp.asarray(True), jnp.asarray(False)
    inner = inner_pieces(contact, table, progress.memory, progress.place, unloading)
    branch = contact.branch_of(progress.memory, unloading)
    reversal = progress.place, progress.central
    branch, jumps = over_folds(contact, table, branch, inner, reversal, unloading)
    ahead = look_ahead(table, branch, inner, progress.kinetic, body.load, progress.place, unloading)
    if not body.damped:
        inwards = jnp.logical_or(bool(body.forces), jnp.logical_not(unloading))
        wanted = jnp.logical_and(progress.made == 0, inwards)
        turn, dissipated = find_turning_point(ahead, wanted), jnp.zeros(0)
        spent = jnp.asarray(jnp.nan)
        time = progress.time + travel_time(ahead, turn, body.mass)
    else:
        pieces = join(table, branch, inner, progress.place, unloading)
        done, part, spent = come_to_rest(body, pieces, progress.kinetic, rest, unloading)
        turn = done.turn._replace(piece=part[done.turn.piece])
        turn, dissipated = in_order(ahead, turn), done.lost
        fate = done.at_rest, done.followed, done.stopped
        time = progress.time + done.duration
    row = row_at(ahead, turn)
    layout = quantities(contact)
    bonds = row[layout.bonds]
    parts = table.lost_by_bonds(bonds - progress.bonds), dissipated
    lost = jnp.concatenate([*parts, jumps.lost(turn.place, unloading)]) + progress.lost
    drawn = inner._replace(values=inner.values[..., : layout.components.stop])
    phase = Phase(
        progress.place, turn.place, progress.kinetic, progress.time, branch, drawn,
        progress.lost, progress.bonds, jumps, spent,
    )  # fmt: skip
    held = Held(turn.piece >= ahead.pieces, unloading, row[SIZE], row[layout.field])
    after = progress._replace(
        memory=contact.update_memory(progress.memory, turn.place, held), place=turn.place,
        kinetic=turn.kinetic, time=time, lost=lost, bonds=bonds, central=row[CENTRAL],
    )  # fmt: skip
    end = _PhaseEnd(
        turn, phase, row[: layout.components.stop], -pull_work(ahead, turn),
        *fate, mechanical_at_end(ahead) - jnp.sum(dissipated),
    )  # fmt: skip
    return after, end


def _no_rise(fall: _Ended, rise: _Ended) -> _Ended:
    """A way up that is none where drag stopped the body on its way down."""
    after, here = fall
    stay = here._replace(
        phase=rise[1].phase._replace(stop=rise[1].phase.start), pull_work=jnp.zeros(())
    )
    return choose(here.stopped, (after, stay), rise)


def _impact(contact: Contact, body: Body, begun: Begun, limits: Limits) -> tuple[Progress, Impacts]:
    """Down to closest approach and up to the next apex."""
    table, reference, origin, progress = begun
    rest = Rest(reference.equilibrium, limits.rest)

    def one_phase(progress: Progress, unloading: jax.Array) -> tuple[Progress, _Ended]:
        after, end = _phase_of_impact(contact, body, table, rest, progress, unloading)
        return after, (after, end)

    # One body of code for both directions: half to compile.
    _, both = jax.lax.scan(one_phase, progress, jnp.asarray([False, True]))
    down, up = (jax.tree_util.tree_map(lambda leaf, k=k: leaf[k], both) for k in (0, 1))
    up = _no_rise(down, up) if body.damped_apart else up
    (deepest, fall), (end, rise) = down, up
    ends, phases = jax.tree_util.tree_map(lambda a, b: jnp.stack([a, b]), down, up)
    potential = body.load.potential(ends.place)
    mechanical = ends.kinetic + potential + phases.row[:, STORED]
    energy_balance_error = jnp.max(jnp.abs(mechanical + jnp.sum(ends.lost, axis=1) - origin))
    # On a spring a body may be held anywhere: how far it swings tells whether it rests.
    height = end.place - (deepest.place if body.forces else reference.equilibrium)
    first = jnp.where(progress.made == 0, height, progress.first)
    energies = phases.turn.maximum_kinetic
    largest = jnp.max(energies) if body.forces else energies[0]
    energy = jnp.where(progress.made == 0, largest, progress.impact_energy)
    cycle = jnp.sum(end.lost - progress.lost)
    risen, fallen = end.place - deepest.place, body.release - deepest.place
    sound = fall.turn.found & jnp.all(phases.followed) & jnp.isfinite(mechanical[1])
    rules = EndRules.of(
        limits,
        failed=jnp.logical_not(sound),
        at_rest=jnp.any(phases.at_rest),
        stopped=fall.stopped | rise.stopped,
        # Flattened tips may pull at once by more than what they press.
        stuck=jnp.logical_and(isinstance(contact, YieldingContact), risen <= LEAST_RISE * fallen),
        escaped=jnp.logical_not(rise.turn.found),
        time=end.time,
        height=height,
        first=first,
        cycle=cycle,
        energy=energy,
        made=progress.made + 1,
    )
    after = end._replace(
        first=first, impact_energy=energy, outcome=rules.code(), made=progress.made + 1
    )
    row = Impacts(
        jnp.asarray(True), deepest.place, end.place, deepest.time, end.time, mechanical[1],
        rise.leaving, fall.row[FORCE], fall.row[CONTACTING], deepest.bonds, end.lost,
        energy_balance_error, rise.pull_work, energy, fall.phase, rise.phase,
    )  # fmt: skip
    return after, row
