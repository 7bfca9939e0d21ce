"""The records of a motion that was stepped in time: energies, ends, impacts, phases."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .._jax import jnp
from ..contact.contact import Contact
from ..errors import ENDS, Outcome
from ..numerics.trees import stacked
from .curve_table import (
    ATTRACTION,
    CONTACTING,
    FORCE,
    STORED,
    Table,
    quantities,
)
from .motion_end import LEAST_LOSS, EndRules
from .record import IN_MOTION, Body, Impacts, Limits, Motion, Progress
from .static_equilibrium import Reference
from .stepped_phase import AT_REST, FAILED, LEFT, STOPPED, Samples, SteppedPhase
from .stepped_series import Trajectory


class SteppedImpact(NamedTuple):
    """One impact: the sample that it starts from, the phase inwards and that outwards."""

    begin: Samples
    fall: SteppedPhase
    rise: SteppedPhase

    @property
    def middle(self) -> Samples:
        """The sample at closest approach."""
        return _last(self.fall, self.begin)

    @property
    def end(self) -> Samples:
        """The sample at the next apex."""
        return _last(self.rise, self.middle)


def _last(phase: SteppedPhase, before: Samples) -> Samples:
    samples = phase.samples
    return Samples(*(column[-1:] for column in samples)) if samples.time.size else before


class Ledger(NamedTuple):
    """What energies and ends of a motion are counted by.

    Attributes
    ----------
    contact, body
        What moves on what.
    prepared
        The table of the contact when its bulk has relaxed, and the static equilibrium.
    limits
        Ends of the motion.
    """

    contact: Contact
    body: Body
    prepared: tuple[Table, Reference]
    limits: Limits

    @property
    def ends(self) -> tuple[float, float, float]:
        """Separations [m]: at rest, how close counts as there, and where a body has left."""
        table, reference = self.prepared
        still = float(reference.equilibrium)
        near = float(self.limits.rest) * (float(self.body.release) - still)
        return still, near, float(table.ends[-1])

    def kinetic(self, samples: Samples) -> np.ndarray:
        """Kinetic energy [J]."""
        energy: np.ndarray = 0.5 * float(self.body.mass) * samples.speed**2
        return energy

    def energy(self, samples: Samples) -> np.ndarray:
        """Kinetic, potential and stored energy [J]."""
        above = float(self.body.weight) * samples.separation
        whole: np.ndarray = self.kinetic(samples) + above + samples.rows[:, STORED]
        return whole

    def left(self, sample: Samples) -> float:
        """The same without what an indentation holds, where the body has left it [J]."""
        indentation = sample.rows[0, STORED] if sample.rows[0, FORCE] == 0.0 else 0.0
        return float(self.energy(sample)[0] - indentation)

    def maximum_kinetic(self, impact: SteppedImpact) -> float:
        """Largest kinetic energy inwards [J]."""
        joined = Samples.joined([impact.begin, impact.fall.samples])
        return float(np.max(self.kinetic(joined)))

    def height(self, impact: SteppedImpact) -> float:
        """Height of the next apex above the equilibrium [m]."""
        return float(impact.end.separation[0]) - float(self.prepared[1].equilibrium)

    def outcome(self, done: Sequence[SteppedImpact], waits: float) -> Outcome | None:
        """How the motion ends with its last impact; None where it goes on.

        Menisci that are still forming, by a threshold that ``waits`` [m], change later cycles.
        """
        last, both = done[-1], (done[-1].fall.end, done[-1].rise.end)
        return EndRules.of(
            self.limits,
            failed=FAILED in both,
            at_rest=AT_REST in both,
            stopped=STOPPED in both,
            stuck=False,
            escaped=last.rise.end == LEFT,
            time=last.end.time[0],
            height=self.height(last),
            first=self.height(done[0]),
            cycle=np.sum(last.end.lost - last.begin.lost),
            energy=self.maximum_kinetic(done[0]),
            made=len(done),
            settled=waits <= LEAST_LOSS * float(self.contact.interaction_range),
        ).outcome()

    def motion(self, done: Sequence[SteppedImpact], outcome: Outcome) -> tuple[Motion, Trajectory]:
        """The records of a motion."""
        table, reference = self.prepared
        origin = float(self.energy(done[0].begin)[0])
        largest = self.maximum_kinetic(done[0])
        impacts = stacked([self._row(one, origin, largest) for one in done])
        code = ENDS.index(outcome) if outcome in ENDS else IN_MOTION
        time = done[-1].end.time[0]
        over = Progress.over(*(jnp.asarray(x) for x in (time, code, len(done))))
        motion = Motion(impacts, over, table, reference, jnp.asarray(origin))
        phases = [phase.samples for one in done for phase in (one.fall, one.rise)]
        return motion, Trajectory.of(self.body, done[0].begin, phases)

    def _row(self, one: SteppedImpact, origin: float, largest: float) -> Impacts:
        samples = Samples.joined([one.begin, one.fall.samples, one.rise.samples])
        energy = self.energy(samples) + np.sum(samples.lost, axis=1)
        middle, end, work = one.middle, one.end, one.rise.pull_work
        if work is None:
            work = _pull_work(Samples.joined([middle, one.rise.samples]))
        columns: dict[str, Any] = {
            "made": np.asarray(True),
            "closest_approach": middle.separation[0],
            "apex": end.separation[0],
            "closest_approach_time": middle.time[0],
            "apex_time": end.time[0],
            "mechanical": np.asarray(self.left(end)),
            "leaving": np.asarray(np.nan),
            "force": middle.rows[0, FORCE],
            "contacting": middle.rows[0, CONTACTING],
            "bonds": middle.rows[0, quantities(self.contact).bonds],
            "lost": end.lost[0],
            "energy_balance_error": np.max(np.abs(energy - origin)),
            "pull_work": np.asarray(work),
            "maximum_kinetic": np.asarray(largest),
            "fall": (),  # it is drawn from its samples, not from pieces
            "rise": (),
        }
        return Impacts(**columns)


def _pull_work(samples: Samples) -> float:
    """Work against the attractive forces along a phase [J], by trapezoids."""
    attraction, step = samples.rows[:, ATTRACTION], np.diff(samples.separation)
    return float(0.0 - np.sum(0.5 * (attraction[1:] + attraction[:-1]) * step))
