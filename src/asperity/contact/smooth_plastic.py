"""A smooth body that yields: what was pressed flat stays flat."""

from __future__ import annotations

import dataclasses

import equinox as eqx

from .._jax import jax, jnp
from ..interface.residual_profile import flatness
from ..interface.rough_planes import losses_of
from ..laws.law import Law, Sum, components_of, refuse_twice, terms
from ..laws.plastic import AdhesiveThorntonNing, PlasticContact
from .contact import Held, Potential, State, YieldingContact
from .resolution import Resolution
from .scanning_curve import STEPS, lowest_place, panels_around
from .smooth import LADDER, combinations, gaps_of, number_of

PLASTIC = "plastic"
"""Mechanism of the work that the body keeps."""

Pressed = tuple[jax.Array, jax.Array]
"""Lowest separation so far [m], inf before the first impact, and a flag for each bond."""


class SmoothPlasticContact(YieldingContact):
    """A smooth body on a smooth plane, elastic-plastic, with other laws beside its contact.

    Parameters
    ----------
    contact
        The contact, with the radius of the body; it may adhere.
    law
        Laws that act beside it, none by default.
    resolved
        Panels of its curves on each side of a non-smooth point (static).
    left
        Memory and separation [m] at the deepest point of the first impact, where it has had one.

    Raises
    ------
    InputError
        If a law contains a force that the contact contains.

    Notes
    -----
    The separation is the gap of the body before anything touched. At the deepest overlap D a
    tip is left that stands back by the residual r: laws beside contact act at the separation
    plus r, and times the flatness to the power of the tip radius that they have. The flatness
    is D/(D - r); where contact adheres, and r is not where its force ends, it is the radius of
    the flattened tip over that before. While it goes deeper than ever, the body pulls as if it
    were whole.

    The ledger closes since all that a law cannot give back is a function of D:

    - Work that is kept counts as bonds of the first mechanism, of 1 J each, that form once. A
      law beside contact adds what its energy lost as the tip became flatter, less what that
      adds to the formation of its bonds. Where adhesion alone makes it yield, the work kept is
      at first slightly negative: 1 J is given back for each such bond that breaks.
    - Bonds of a law beside contact count with the flatness to the power of their law.
    - Formation and rupture of an adhesive contact lose what those of the whole tip lose, times
      the same factor f of D, 1 at first. Held, its bond counts 1; broken, 1 - f. So the first
      touch loses the formation of the whole tip, and rupture and another touch those of the
      flattened one.
    """

    contact: PlasticContact | AdhesiveThorntonNing
    law: Law = Sum(())
    resolved: Resolution = eqx.field(static=True, kw_only=True, default=Resolution(STEPS))
    left: tuple[Pressed, jax.Array] | None = None

    def __check_init__(self) -> None:
        refuse_twice((self.contact, {"elastic", *self._adhesion}), laws=terms(self.law))

    @property
    def _hysteretic(self) -> tuple[Law, ...]:
        return tuple(law for law in terms(self.law) if law.hysteretic)

    @property
    def _adhesion(self) -> tuple[str, ...]:
        return ("adhesion",) if isinstance(self.contact, AdhesiveThorntonNing) else ()

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return (PLASTIC, *self._adhesion, *(law.mechanism for law in self._hysteretic))

    @property
    def components(self) -> tuple[str, ...]:
        return components_of(terms(self.law), ("elastic", *self._adhesion))

    def initial_memory(self) -> Pressed:
        return jnp.asarray(jnp.inf), jnp.zeros(len(self.mechanisms) - 1)

    def left_by(self, memory: Pressed, separation: jax.Array) -> tuple[Pressed, jax.Array]:
        return memory, separation

    def after(self, left: tuple[Pressed, jax.Array]) -> SmoothPlasticContact:
        return dataclasses.replace(self, left=left)

    def branches(self) -> tuple[Pressed, ...]:
        """That of a body that never touched; after that, all combinations of bonds."""
        if self.left is None:
            return (self.initial_memory(),)
        lowest = self.left[0][0]
        return tuple((lowest, flags) for flags in combinations(len(self.mechanisms) - 1))

    def branch_of(self, memory: Pressed, unloading: jax.Array) -> jax.Array:
        lowest, flags = memory
        return jnp.where(jnp.isinf(lowest), 0, 1 + number_of(flags))

    def state(self, separation: jax.Array, memory: Pressed) -> State:
        lowest, flags = self.update_memory(memory, separation)
        deepest = jnp.maximum(-lowest, 0.0)
        gap = separation + self.contact.residual(deepest)
        held = list(flags > 0.5)
        each = {name: jnp.zeros_like(separation) for name in (*self.components, "energy")}
        if isinstance(self.contact, AdhesiveThorntonNing):
            tip, on = self.contact.tip(deepest), held.pop(0)
            each.update(tip.response(gap, on))
            grown = tip.formation_loss / self.contact.tip(jnp.zeros(())).formation_loss
            counts = [jnp.where(on, 1.0, 1.0 - grown)]
        else:
            overlap = jnp.maximum(-separation, 0.0)
            each["elastic"] = self.contact.force(overlap, deepest)
            each["energy"], counts = self.contact.recoverable(overlap, deepest), []
        kept, flatness = self.contact.dissipated(deepest), self._flatness(deepest)
        deeper = separation <= memory[0]
        for law in terms(self.law):
            on = held.pop(0) if law.hysteretic else jnp.zeros((), bool)
            grown = flatness**law.radius_power
            whole, flat = law.response(separation, on), law.response(gap, on)
            each["energy"] = each["energy"] + grown * flat.pop("energy")
            for name, part in flat.items():
                each[name] = each[name] + jnp.where(deeper, whole[name], grown * part)
            kept = kept + self._flattening(law, deepest, grown)
            if law.hysteretic:
                counts.append(jnp.where(on, grown, 0.0))
        stored = each.pop("energy")
        parts = jnp.stack(list(each.values()))
        bonds, touching = jnp.stack([kept, *counts]), jnp.where(gap < 0.0, 1.0, 0.0)
        return State.undeformed(separation, (self.components, parts), stored, bonds, touching)

    def update_memory(
        self, memory: Pressed, separation: jax.Array, held: Held | None = None
    ) -> Pressed:
        lowest = jnp.minimum(memory[0], separation)
        deepest = jnp.maximum(-lowest, 0.0)
        gap = separation + self.contact.residual(deepest)
        near = jnp.where(separation <= memory[0], separation, gap)
        rows = []
        for law, flag in zip(self._bonds(deepest), memory[1], strict=True):
            kept = jnp.logical_and(flag > 0.5, gap < law.breaking_gap)
            rows.append(jnp.where(jnp.logical_or(near <= law.forming_gap, kept), 1.0, 0.0))
        return lowest, jnp.stack(rows) if rows else jnp.zeros((0,))

    def losses(self) -> tuple[jax.Array, jax.Array]:
        formed, broken = losses_of(self._bonds(jnp.zeros(())))
        return jnp.append(1.0, formed), jnp.append(-1.0, broken)

    def lower_bound(
        self, release: jax.Array, kinetic: jax.Array, potential: Potential
    ) -> jax.Array:
        def work(places: jax.Array) -> jax.Array:
            states = jax.vmap(lambda d: self.state(d, self.initial_memory()))(places)
            return states.stored + states.bonds @ self.losses()[0]

        return lowest_place(work, LADDER, release, kinetic, potential)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        """All kinks, before and after the first impact, with panels that narrow to each."""
        turn = low if self.left is None else self.left[1] - _BELOW * jnp.abs(self.left[1])
        return panels_around(self._kinks(), low, high, self.resolved.panels, (turn,))

    @property
    def interaction_range(self) -> jax.Array:
        laws = (*self._bonds(jnp.zeros(())), *terms(self.law))
        return jnp.max(jnp.stack([jnp.zeros(()), *(law.interaction_range for law in laws)]))

    def _bonds(self, deepest: jax.Array) -> tuple[Law, ...]:
        """The laws that bond, at the gap of the tip as it was left."""
        if isinstance(self.contact, AdhesiveThorntonNing):
            return self.contact.tip(deepest), *self._hysteretic
        return self._hysteretic

    def _flatness(self, deepest: jax.Array) -> jax.Array:
        """How much more a tip pulls, to the power of its radius in a law, that was pressed."""
        if isinstance(self.contact, AdhesiveThorntonNing):
            return self.contact.tip_radius(deepest) / self.contact.radius
        return flatness(deepest, deepest - self.contact.residual(deepest))

    def _flattening(self, law: Law, deepest: jax.Array, grown: jax.Array) -> jax.Array:
        """Energy [J] of a law beside contact that a tip loses by becoming flatter.

        Without what it adds to the formation of a bond.
        """
        lost = law.bonded_energy(-deepest)
        lost = lost - grown * law.bonded_energy(self.contact.residual(deepest) - deepest)
        if law.hysteretic:
            lost = lost - (grown - 1.0) * law.formation_loss
        return jnp.where(deepest > self.contact.yield_overlap, lost, 0.0)

    def _kinks(self) -> jax.Array:
        """Separations [m] at which a curve is not smooth."""
        begin = self.contact.yield_overlap
        overlaps = self.contact.kinks if isinstance(self.contact, PlasticContact) else (begin,)
        marks: list[jax.Array | float] = [0.0, *(-overlap for overlap in overlaps)]
        marks += _gaps(terms(self.law))
        if self.left is not None:
            deepest = jnp.maximum(-self.left[0][0], 0.0)
            gaps = [0.0, *_gaps((*self._bonds(deepest), *terms(self.law)))]
            marks += [gap - self.contact.residual(deepest) for gap in gaps]
        return jnp.stack([jnp.asarray(mark, float) for mark in marks])


def _gaps(laws: tuple[Law, ...]) -> list[jax.Array | float]:
    """Those of :func:`gaps_of` but for 0."""
    return [gap for gap in gaps_of(laws) if isinstance(gap, jax.Array) or gap != 0.0]


# Of the turn: a panel ends so far below it, where the curve that it leaves on begins. An end in
# the very place would have the body turn in the rounding of its energy.
_BELOW = 1e-9
