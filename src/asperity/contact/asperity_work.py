"""Work of one asperity against its gap, on each branch that its bonds give it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import product

from .._jax import jax, jnp
from ..laws.law import Law, terms
from ..laws.plastic import PlasticContact

Along = Callable[[jax.Array], jax.Array]


def work_on_branches(law: Law, contact: PlasticContact | None) -> list[Along]:
    """Work [J] from far away to a gap [m] on each branch of :class:`Asperities`, in its order."""
    every = terms(law)
    hysteretic = [one for one in every if one.hysteretic]
    others = [one for one in every if not one.hysteretic]

    def work(gap: jax.Array, formed: tuple[bool, ...] | None) -> jax.Array:
        """By the laws whose bond was formed; without them on approach."""
        total = sum((one.energy(gap) for one in others), jnp.zeros_like(gap))
        for k, one in enumerate(hysteretic):
            formed_loss, broken_loss = one.losses
            # Below its gap a bond that takes time to form exerts no force until then.
            free = one.energy(jnp.maximum(gap, one.forming_gap))
            gone = one.energy(gap) + formed_loss + broken_loss
            bonded = formed_loss + one.bonded_energy(gap)
            bonded = jnp.where(gap < one.breaking_gap, bonded, gone)
            on = gap <= one.forming_gap if formed is None else formed[k]
            total = total + jnp.where(on, bonded, free)
        return total

    sets = [bits[::-1] for bits in product((False, True), repeat=len(hysteretic))]
    found: list[Along] = [partial(work, formed=formed) for formed in (*sets, None)]
    return found if contact is None else [*found, work_with_contact(found[-1], contact)]


def approach_work(law: Law) -> Along:
    """Work [J] from far away to a gap [m] of an asperity on which each bond forms in its turn."""
    return work_on_branches(law, None)[-1]


def work_with_contact(beside: Along, contact: PlasticContact | None) -> Along:
    """Work [J] with that of the first loading where tips yield."""
    if contact is None:
        return beside
    return lambda gap: beside(gap) + contact.loading_work(jnp.maximum(-gap, 0.0))
