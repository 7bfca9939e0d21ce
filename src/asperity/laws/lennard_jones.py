"""Adhesion by the Lennard-Jones pressure between two elastic surfaces, in equilibrium with them."""

from __future__ import annotations

from typing import ClassVar, NamedTuple

import numpy as np

from .._jax import jax, jnp
from .bradley import Bradley
from .law import Law, Real, quantity
from .lennard_jones_equilibria import Folds, energy_beyond, equilibria, solved
from .lennard_jones_path import GAP, Equilibria, largest_gap, smallest_gap


class LennardJones(Law):
    """A paraboloid and a plane that attract and repel by the 3-9 potential, Hertz included.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    modulus
        Contact modulus E* [Pa].
    work_of_adhesion
        Energy to part unit area w [J/m^2].
    spacing
        Interatomic spacing eps [m]: surfaces at this distance exert no pressure, and the gap
        counts from there.

    Notes
    -----
    The pressure (8 w/(3 eps)) ((eps/h)^9 - (eps/h)^3) at a distance h of the surfaces deforms
    them as half-spaces, and the distance follows. Greenwood (1997) and Feng (2000) solved this;
    here all equilibria are tabulated over the Tabor number mu, 0.01 to 5. For mu above about 1
    the curve of force against gap is S-shaped: a body comes in on the outer branch until it folds
    and jumps into contact there, and leaves by the inner branch until that folds. What the energy
    drops by at a jump is lost. Below, both branches are one curve and nothing is lost. In an
    overlap above 6e4 spacings the force grows with its power 3/2.
    """

    radius: Real = quantity()
    modulus: Real = quantity()
    work_of_adhesion: Real = quantity()
    spacing: Real = quantity()

    counts: ClassVar[frozenset[str]] = frozenset({"elastic", "adhesion"})

    @property
    def tabor(self) -> jax.Array:
        """Tabor number (R w^2/(E*^2 eps^3))^(1/3)."""
        w, r, e = self.work_of_adhesion, self.radius, self.modulus
        return jnp.cbrt(r * (w / e) ** 2) / self.spacing

    @property
    def hysteretic(self) -> bool:
        return True

    @property
    def forming_gap(self) -> jax.Array:
        return self.kinks[0]

    @property
    def breaking_gap(self) -> jax.Array:
        return self.kinks[1]

    @property
    def kinks(self) -> tuple[jax.Array, ...]:
        """Where the path folds."""
        folds = self._solved[1]
        return tuple(self.spacing * (row[GAP] - 1.0) for row in (folds.inwards, folds.outwards))

    @property
    def interaction_range(self) -> jax.Array:
        return 1.5e3 * self.spacing

    @property
    def length(self) -> jax.Array | float:
        return self.spacing

    def force(self, gap: jax.Array) -> jax.Array:
        return self._at(gap)[0].force

    def energy(self, gap: jax.Array) -> jax.Array:
        return self._at(gap)[0].energy

    def bonded_force(self, gap: jax.Array) -> jax.Array:
        return self._at(gap)[1].force

    def bonded_energy(self, gap: jax.Array) -> jax.Array:
        return self._at(gap)[1].energy

    def response(self, gap: jax.Array, bonded: jax.Array) -> dict[str, jax.Array]:
        """The force where surfaces press each other and where they attract, and the energy."""
        outer, inner = self._at(gap)
        pressed = jnp.where(bonded, inner.pressed, outer.pressed)
        return {
            "elastic": pressed,
            "adhesion": jnp.where(bonded, inner.force, outer.force) - pressed,
            "energy": jnp.where(bonded, inner.energy, outer.energy),
        }

    @property
    def losses(self) -> jax.Array:
        folds = self._solved[1]
        jumps = jnp.stack([folds.inwards[GAP], folds.outwards[GAP]]) - 1.0
        outer, inner = self._at(self.spacing * jumps)
        drop = (outer.energy - inner.energy) * np.array([1.0, -1.0])
        return jnp.where(folds.some, drop, 0.0)

    def energy_beyond(self, gap: jax.Array) -> jax.Array:
        """As Bradley's, which it is where the bodies hardly deform each other."""
        (path, folds), last = self._solved, largest_gap()
        reduced = gap / self.spacing + 1.0
        near = jnp.clip(reduced, folds.inwards[GAP], last)
        unit = self.work_of_adhesion * self.radius * self.spacing**2
        rigid = Bradley(self.radius, self.work_of_adhesion, self.spacing)
        beyond = rigid.energy_beyond(self.spacing * (jnp.maximum(reduced, last) - 1.0))
        return unit * energy_beyond(near, path, folds) + beyond

    @property
    def _solved(self) -> tuple[Equilibria, Folds]:
        """All equilibria, and where their path folds."""
        return solved(jnp.log(self.tabor))

    def _at(self, gap: jax.Array) -> tuple[Branch, Branch]:
        """The outer and the inner branch, each at its end beyond it."""
        (path, folds), reduced = self._solved, gap / self.spacing + 1.0
        first, last = smallest_gap(), largest_gap()
        outside = jnp.clip(reduced, folds.inwards[GAP], last)
        inside = jnp.clip(reduced, first, folds.outwards[GAP])
        both = equilibria(jnp.stack([outside, inside]), path, folds)
        outer, inner = (Branch(*(row[k] for row in both)) for k in (0, 1))
        force = self.work_of_adhesion * self.radius
        energy = force * self.spacing
        rigid = Bradley(self.radius, self.work_of_adhesion, self.spacing)
        beyond, deeper = reduced > last, jnp.maximum(reduced / first, 1.0)
        inner = Branch(
            inner.force * deeper**1.5,
            inner.pressed + inner.force * (deeper**1.5 - 1.0),
            inner.energy - 0.4 * inner.force * first * (deeper**2.5 - 1.0),
        )
        outer = Branch(
            jnp.where(beyond, rigid.force(gap) / force, outer.force),
            outer.pressed,
            jnp.where(beyond, rigid.energy(gap) / energy, outer.energy),
        )
        units = Branch(force, force, energy)
        outer, inner = (
            Branch(*(unit * row for unit, row in zip(units, branch, strict=True)))
            for branch in (outer, inner)
        )
        return outer, inner


class Branch(NamedTuple):
    """Force [N], its part where surfaces press each other, and energy [J] along a branch."""

    force: jax.Array
    pressed: jax.Array
    energy: jax.Array
