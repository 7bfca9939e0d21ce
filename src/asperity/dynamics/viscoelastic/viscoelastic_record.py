"""The usual records of a motion on a bulk that creeps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..._jax import jax, jnp
from ...contact.contact import Contact
from ...errors import Outcome
from ...numerics.polynomials import NODES
from ..curve_table import ATTRACTION, CONTACTING, FORCE, STORED, Pieces, Table, quantities
from ..motion import LEAST_LOSS
from ..record import ENDS, Body, Impacts, Limits, Motion, Phase, Progress
from ..static_equilibrium import Reference
from ..stepped_phase import AT_REST, FAILED, LEFT, Samples
from ..stepped_series import Trajectory
from ..time_series import Series


class Way(NamedTuple):
    """The way from one turning point to the next: how it ends, and its samples past the start."""

    fate: str
    samples: Samples


class Bounced(NamedTuple):
    """One impact: the sample that it starts from, the way in and the way out."""

    begin: Samples
    fall: Way
    rise: Way

    @property
    def middle(self) -> Samples:
        """The sample at the deepest point."""
        return _last(self.fall, self.begin)

    @property
    def end(self) -> Samples:
        """The sample at the next apex."""
        return _last(self.rise, self.middle)


def _last(way: Way, before: Samples) -> Samples:
    return Samples(*(c[-1:] for c in way.samples)) if way.samples.time.size else before


class Ledger(NamedTuple):
    """What energies and ends of a motion are counted by.

    Attributes
    ----------
    contact, body
        What moves on what; the contact has a ``viscous`` loss where its bulk creeps.
    prepared
        The table of the contact when its bulk has relaxed, and the reference separation.
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

    def maximum_kinetic(self, bounced: Bounced) -> float:
        """Largest kinetic energy on the way in [J]."""
        joined = Samples.joined([bounced.begin, bounced.fall.samples])
        return float(np.max(self.kinetic(joined)))

    def height(self, bounced: Bounced) -> float:
        """Height of the next apex above the equilibrium [m]."""
        return float(bounced.end.separation[0]) - float(self.prepared[1].equilibrium)

    def outcome(self, done: Sequence[Bounced], waits: float) -> Outcome | None:
        """How the motion ends with its last impact; None where it goes on.

        Menisci that are on their way, by a threshold that ``waits`` [m], change the cycles to come.
        """
        last, limits = done[-1], self.limits
        cycle = np.sum(last.end.lost - last.begin.lost)
        repeats = waits <= LEAST_LOSS * float(self.contact.interaction_range)
        rules = (
            (FAILED in (last.fall.fate, last.rise.fate), Outcome.FAILED),
            (AT_REST in (last.fall.fate, last.rise.fate), Outcome.REST),
            (last.rise.fate == LEFT, Outcome.ESCAPED),
            (last.end.time[0] >= limits.time, Outcome.TIME_LIMIT),
            (self.height(last) < limits.rest * self.height(done[0]), Outcome.REST),
            (repeats and cycle < LEAST_LOSS * self.maximum_kinetic(done[0]), Outcome.OSCILLATING),
            (len(done) >= limits.impacts, Outcome.MAX_IMPACTS),
        )
        return next((outcome for holds, outcome in rules if holds), None)

    def motion(self, done: Sequence[Bounced], outcome: Outcome) -> tuple[Motion, Trajectory]:
        """The records of a motion."""
        table, reference = self.prepared
        origin = float(self.energy(done[0].begin)[0])
        maximum_kinetic = self.maximum_kinetic(done[0])
        rows = [self._row(one, origin, maximum_kinetic) for one in done]
        impacts: Impacts = jax.tree_util.tree_map(lambda *leaves: np.stack(leaves), *rows)
        end = self._progress(done, outcome)
        motion = Motion(impacts, end, table, reference, jnp.asarray(origin))
        return motion, self._trajectory(done)

    def _row(self, one: Bounced, origin: float, maximum_kinetic: float) -> Impacts:
        samples = Samples.joined([one.begin, one.fall.samples, one.rise.samples])
        energy = self.energy(samples) + np.sum(samples.lost, axis=1)
        middle, end = one.middle, one.end
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
            "pull_work": np.asarray(_pull_work(Samples.joined([middle, one.rise.samples]))),
            "maximum_kinetic": np.asarray(maximum_kinetic),
            "fall": self._phase(one.begin, middle),
            "rise": self._phase(middle, end),
        }
        return Impacts(**columns)

    def _phase(self, start: Samples, stop: Samples) -> Phase:
        """What a way started from; it is drawn from its samples, not from pieces."""
        layout = quantities(self.contact)
        none: Any = np.zeros(0)
        values: Any = np.zeros((0, NODES, layout.components.stop))
        columns: dict[str, Any] = {
            "start": start.separation[0],
            "stop": stop.separation[0],
            "kinetic": self.kinetic(start)[0],
            "begun": start.time[0],
            "branch": np.asarray(0),
            "inner": Pieces(none, none, none, none, values),
            "lost": start.lost[0],
            "bonds": start.rows[0, layout.bonds],
        }
        return Phase(**columns)

    def _progress(self, done: Sequence[Bounced], outcome: Outcome) -> Progress:
        last = done[-1].end
        end: dict[str, Any] = {
            "memory": self.contact.initial_memory(),
            "place": last.separation[0],
            "kinetic": self.kinetic(last)[0],
            "time": last.time[0],
            "lost": last.lost[0],
            "bonds": last.rows[0, quantities(self.contact).bonds],
            "first": self.height(done[0]),
            "impact_energy": self.maximum_kinetic(done[0]),
            "outcome": ENDS.index(outcome) if outcome in ENDS else -1,
            "made": len(done),
        }
        return Progress(**jax.tree_util.tree_map(jnp.asarray, end))

    def _trajectory(self, done: Sequence[Bounced]) -> Trajectory:
        parts = [done[0].begin]
        phases = [np.zeros(1, int)]
        for number, one in enumerate(done):
            for inwards, way in ((0, one.fall), (1, one.rise)):
                parts.append(way.samples)
                phases.append(np.full(way.samples.time.size, 2 * number + inwards))
        whole = Samples.joined(parts)
        # Where stretches meet rounding may set the clock back.
        whole = whole._replace(time=np.maximum.accumulate(whole.time))
        none = np.zeros((whole.time.size, len(self.body.mechanisms)))
        series = Series(
            whole.time, whole.separation, whole.speed, whole.rows, none, none,
            np.concatenate(phases),
        )  # fmt: skip
        return Trajectory(series, whole.lost)


def _pull_work(samples: Samples) -> float:
    """Work against the attractive forces along a way [J]."""
    attraction, step = samples.rows[:, ATTRACTION], np.diff(samples.separation)
    return float(0.0 - np.sum(0.5 * (attraction[1:] + attraction[:-1]) * step))
