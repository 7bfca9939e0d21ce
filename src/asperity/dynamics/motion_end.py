"""When and how a motion ends: one list of rules, for compiled motions and for those in steps."""

from __future__ import annotations

from typing import Any, NamedTuple

from .._jax import jax, jnp
from ..errors import ENDS, Outcome
from .record import IN_MOTION, Limits

LEAST_LOSS = 1e-9
"""Share of the impact energy below which a cycle loses none: the body goes on bouncing."""


class EndRules(NamedTuple):
    """What holds after an impact, each a truth value of any shape; the first that holds ends it.

    Attributes
    ----------
    failed
        The motion could not be followed.
    at_rest, stuck
        It came to rest without a turn; flattened tips hold it.
    stopped, escaped
        Drag alone stopped it; it left for good.
    late, low, repeats, enough
        Past the time limit; too low a rebound; no loss in a cycle; as many impacts as asked for.
    """

    failed: Any
    at_rest: Any
    stopped: Any
    stuck: Any
    escaped: Any
    late: Any
    low: Any
    repeats: Any
    enough: Any

    @classmethod
    def of(
        cls,
        limits: Limits,
        *,
        failed: Any,
        at_rest: Any,
        stopped: Any,
        stuck: Any,
        escaped: Any,
        time: Any,
        height: Any,
        first: Any,
        cycle: Any,
        energy: Any,
        made: Any,
        settled: Any = True,
    ) -> EndRules:
        """The rules after an impact.

        Parameters
        ----------
        limits
            Ends of the motion.
        failed, at_rest, stuck, escaped
            See the attributes.
        stopped
            By drag alone; it counts before the time limit.
        time
            Of the apex [s].
        height, first
            Of the apex after this impact and after the first, over the static equilibrium; on a
            spring over the closest approach [m].
        cycle, energy
            What the impact lost, and the impact energy of the first [J].
        made
            Number of impacts.
        settled
            Whether the next cycles are like this one: not where menisci are still forming.
        """
        return cls(
            failed, at_rest, stopped & (time < limits.time), stuck, escaped,
            late=time >= limits.time,
            low=height < limits.rest * first,
            repeats=settled & (cycle < LEAST_LOSS * energy),
            enough=made >= limits.impacts,
        )  # fmt: skip

    def code(self) -> jax.Array:
        """Index of the outcome in ``ENDS``, or IN_MOTION."""
        code = jnp.asarray(IN_MOTION)
        for holds, outcome in reversed(list(zip(self, _OUTCOMES, strict=True))):
            code = jnp.where(holds, ENDS.index(outcome), code)
        return code

    def outcome(self) -> Outcome | None:
        """The outcome of rules that are known; None where the motion goes on."""
        known = zip(self, _OUTCOMES, strict=True)
        return next((outcome for holds, outcome in known if holds), None)


_OUTCOMES = (
    Outcome.FAILED,
    Outcome.REST,
    Outcome.STOPPED,
    Outcome.REST,
    Outcome.ESCAPED,
    Outcome.TIME_LIMIT,
    Outcome.REST,
    Outcome.OSCILLATING,
    Outcome.MAX_IMPACTS,
)
