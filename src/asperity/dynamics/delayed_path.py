"""A path on summits of which some have a meniscus that took time to form."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..laws.law import Real
from .summit_path import SummitPath


class Delay(NamedTuple):
    """Menisci that take time to form.

    Attributes
    ----------
    time
        Formation time [s], above 0.
    law
        Number of their law among those that remember.
    """

    time: Real
    law: int


class Formation(NamedTuple):
    """Menisci under a body.

    Attributes
    ----------
    lag
        By how much the separation that they follow lies above the body's [m].
    formed
        Whether each summit has made one, shape (n,).
    lost
        Energy [J] that those take by the time they are broken, of the summit that made each,
        shape (n,).
    """

    lag: jax.Array
    formed: jax.Array
    lost: jax.Array


class DelayedPath(NamedTuple):
    """A path on summits of which some have a meniscus.

    Attributes
    ----------
    prompt
        The path with the bonds that form at once.
    formed
        Whether each summit has a meniscus, shape (n,).
    law
        Number of their law.
    """

    prompt: SummitPath
    formed: jax.Array
    law: int

    def each(self, separation: jax.Array) -> jax.Array:
        """Work [J] of each from far away to a separation [m], shape (n,)."""
        summits, gaps = self.prompt.pressed.summits, separation - self.prompt.offsets
        branch = self.prompt.branch
        branch = summits.branch(gaps) if branch is None else branch
        return summits.work(gaps, branch + 2**self.law * self.formed)

    def work(self, separation: jax.Array) -> jax.Array:
        """That of all [J]."""
        return jnp.sum(self.each(separation))

    def force(self, separation: jax.Array) -> jax.Array:
        """Force of all [N], positive apart."""
        return -jax.jvp(self.work, (separation,), (jnp.ones_like(separation),))[1]


def with_menisci(path: SummitPath, delay: Delay, menisci: Formation) -> SummitPath:
    """The way out with those menisci alone that have formed."""
    assert path.branch is not None
    bit = 2**delay.law
    prompt = path.branch - bit * ((path.branch // bit) % 2)
    return path._replace(branch=prompt + bit * menisci.formed)


def prompt_path(path: SummitPath, delay: Delay) -> SummitPath:
    """The same path with the bonds alone that form at once."""
    summits = path.pressed.summits
    summits = summits._replace(forming=summits.forming.at[delay.law].set(-jnp.inf))
    return path._replace(pressed=path.pressed._replace(summits=summits))
