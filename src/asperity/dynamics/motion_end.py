"""When and how a motion ends: one list of rules, for compiled motions and for those in steps."""

from __future__ import annotations

from typing import Any, NamedTuple

from .._jax import jax, jnp
from ..errors import ENDS, Outcome
from .record import IN_MOTION, Limits

LEAST_LOSS = 1e-9
"""Share of the impact energy below which a cycle loses none: the body goes on bouncing."""


class EndRules(NamedTuple):
    """What may end a motion after an impact.

    Attributes
    ----------
    rules
        Whether each holds, a truth value of any shape, and the outcome that it leads to. The first
        that holds ends the motion.
    """

    rules: tuple[tuple[Any, Outcome], ...]

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
        failed
            Whether the motion could not be followed.
        at_rest, stuck
            Whether it came to rest without a turn; whether flattened tips hold it.
        stopped
            Whether drag alone stopped it; that counts before the time limit.
        escaped
            Whether it left for good.
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
            (
                (failed, Outcome.FAILED),
                (at_rest, Outcome.REST),
                (stopped & (time < limits.time), Outcome.STOPPED),
                (stuck, Outcome.REST),
                (escaped, Outcome.ESCAPED),
                (time >= limits.time, Outcome.TIME_LIMIT),
                (height < limits.rest * first, Outcome.REST),
                (settled & (cycle < LEAST_LOSS * energy), Outcome.OSCILLATING),
                (made >= limits.impacts, Outcome.MAX_IMPACTS),
            )
        )

    def code(self) -> jax.Array:
        """Index of the outcome in ``ENDS``, or IN_MOTION."""
        code = jnp.asarray(IN_MOTION)
        for holds, outcome in reversed(self.rules):
            code = jnp.where(holds, ENDS.index(outcome), code)
        return code

    def outcome(self) -> Outcome | None:
        """The outcome of rules that are known; None where the motion goes on."""
        return next((outcome for holds, outcome in self.rules if holds), None)
