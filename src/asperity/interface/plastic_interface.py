"""Many asperities that yield, between two planes: what was pressed flat stays flat."""

from __future__ import annotations

import dataclasses
from functools import reduce

import numpy as np

from .._jax import jax, jnp
from ..errors import InputError
from ..laws.law import Law, Real, components_of, quantity, refuse_twice, terms
from ..laws.plastic import PlasticContact
from ..numerics.trees import choose
from ..surfaces.heights.distribution import Heights
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Near
from .named_means import asked_powers, bond_gaps, means_of
from .residual_profile import HIGHEST, Flattened, contact_means, flatten, in_reach, power_means
from .rough_planes import Means, Memory, RoughPlanes, Scale
from .virgin_loading import NODES, Loaded, first_loading

PLASTIC = "plastic"
"""Mechanism of the work that asperities keep."""

_FEW_NODES = 4  # where a bound is asked for alone
_MISSED = 0.01  # of it, at most


class PlasticInterface(RoughPlanes):
    """Asperities of random height that yield, with other laws beside their contact.

    Parameters
    ----------
    contact
        Elastic-plastic contact of one asperity.
    law
        Laws beside it that pull in contact as at touch, each on the tip as it was left, and are
        sums of truncated powers; :class:`~asperity.laws.Sum` of none for none.
    heights
        Distribution of the heights before anything touched.
    density
        Asperities per area [1/m^2].
    pressed
        What a closest approach left, for :meth:`measure` at separations and memories after it.

    Raises
    ------
    InputError
        If a law contains the elastic force, or is no sum of truncated powers of whole exponents
        up to 2.

    Notes
    -----
    An asperity of height z that was overlapped by z - h_min at closest approach h_min has the
    effective height y = z - residual(z - h_min). Since y grows with z, the memory of contact is
    h_min alone, and that of bonds a threshold of y each, as for
    :class:`~asperity.interface.interface.Interface`. The work that contact keeps counts as bonds of
    the first mechanism, of 1 J each, which form and never break.

    A tip that was overlapped by D and springs back by S is flatter: its forces beside contact
    grow by D/S to the power of the tip radius that their law has, so that the energy of the
    area in contact is that at closest approach. It begins when the bodies part; what menisci
    gain by it counts as their formation.

    On a rigid paraboloid h - h_min is the same everywhere, so that ``integrated`` 1 integrates
    means over the separation as before.
    """

    contact: PlasticContact
    law: Law
    heights: Heights
    density: Real = quantity()
    pressed: Flattened | None = None

    def __check_init__(self) -> None:
        refuse_twice((self.contact, ("elastic",)), laws=self.laws)
        for law in self.laws:
            if not _in_powers(law):
                raise InputError(
                    "a law beside a contact that yields must be truncated powers of exponents 0 "
                    f"to {HIGHEST}; {type(law).__name__} is not"
                )

    @property
    def laws(self) -> tuple[Law, ...]:
        """The laws beside contact."""
        return terms(self.law)

    @property
    def scale(self) -> Scale:
        return Scale.of(self.heights)

    @property
    def panel_lengths(self) -> PanelLengths:
        return self.heights.panel_lengths

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return (PLASTIC, *super().mechanisms)

    @property
    def components(self) -> tuple[str, ...]:
        """The contact's too, whether it yields or not."""
        return components_of(self.laws, ("elastic",))

    @property
    def interaction_range(self) -> jax.Array:
        return reduce(jnp.maximum, [law.interaction_range for law in self.laws], jnp.zeros(()))

    @property
    def last_kink(self) -> jax.Array:
        return jnp.max(jnp.stack([jnp.zeros(()), *(law.last_kink for law in self.laws)]))

    @property
    def only_bonded(self) -> bool:
        """As for :class:`~asperity.interface.interface.Interface`: no law reaches without end."""
        return True

    @property
    def yields(self) -> bool:
        return True

    @property
    def unloading_panels(self) -> jax.Array:
        assert self.pressed is not None  # the contact has had its first impact
        return self.pressed.unloading_panels

    def has_yielded(self, memory: Memory) -> jax.Array:
        return jnp.any(memory[0] < jnp.inf)

    def branch_memory(self, memory: Memory, unloading: jax.Array | bool) -> Memory:
        """The memory on a major branch: of bonds alone, the asperities stay as they are."""
        deepest, *thresholds = memory
        end = jnp.where(unloading, -jnp.inf, jnp.inf)
        return (deepest, *(jnp.full_like(b, end) for b in thresholds))

    def rejoining(self, memory: Memory, unloading: jax.Array) -> list[jax.Array]:
        return super().rejoining(memory[1:], unloading)

    def work_of_approach(self, separation: jax.Array, integrated: int = 0) -> jax.Array:
        means = self._approached(separation, integrated, _FEW_NODES)
        work = means.energy + means.bonds[0]
        return work - _MISSED * jnp.abs(work)

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        deepest, *thresholds = memory
        gaps = bond_gaps(self.hysteretic, separation, tuple(thresholds))
        return (jnp.minimum(deepest, separation), *(separation - gap for gap in gaps))

    def measure(
        self, separation: jax.Array, memory: Memory, integrated: int = 0, near: Near | None = None
    ) -> Means:
        if self.pressed is not None:
            return self._measure_pressed(self.pressed, separation, memory)
        shape = jnp.shape(separation)
        rows = tuple(jnp.ravel(jnp.broadcast_to(b, shape)) for b in memory)
        each = jax.vmap(lambda h, b: self._measure_one(h, b, integrated))(
            jnp.ravel(separation), rows
        )
        return Means(*(jnp.moveaxis(x, 0, -1).reshape(*x.shape[1:], *shape) for x in each))

    def first_approach(self, separation: jax.Array, integrated: int = 0) -> Means:
        return self._approached(separation, integrated, NODES)

    def _approached(self, separation: jax.Array, integrated: int, nodes: int) -> Means:
        """:meth:`first_approach` by so many nodes on a piece."""

        def one(h: jax.Array) -> Loaded:
            return first_loading(self.contact, self.heights, self._sizes, h, integrated, nodes)

        shape = jnp.shape(separation)
        loaded = jax.vmap(one)(jnp.ravel(separation))
        loaded = jax.tree_util.tree_map(lambda x: x.reshape(*shape, *x.shape[1:]), loaded)
        edges = [jnp.asarray(law.forming_gap if law.hysteretic else -jnp.inf)
                 for law in self.laws]  # fmt: skip
        asked = asked_powers(self.laws, edges)
        whole = self.heights.mean_powers(tuple(ask.term for ask in asked), integrated, separation)
        sums: dict[str, jax.Array] = {"elastic": loaded.force, "energy": loaded.recoverable}
        for ask, value in zip(asked, whole, strict=True):
            # While it goes deeper than ever, a tip pulls as if it were whole.
            if ask.name not in self.components:
                gained = loaded.gained[..., self._sizes.index(ask.size), :]
                sums[ask.name] = sums.get(ask.name, 0.0) + in_reach(ask.term, gained)
            sums[ask.name] = sums.get(ask.name, 0.0) + value
        return self._means(sums, self._kept(loaded.dissipated, loaded.gained), separation)

    def flattened(self, memory: Memory, integrated: int) -> Flattened:
        """What a first approach leaves, tabulated; its closest approach is in the memory."""
        gaps = [law.breaking_gap for law in self.hysteretic]
        interaction_range = jnp.max(
            jnp.stack([self.last_kink, *(jnp.asarray(gap, float) for gap in gaps)])
        )
        return flatten(
            self.contact, self.heights, self._sizes, (memory[0], interaction_range), integrated
        )

    def as_flattened(self, pressed: Flattened | None) -> PlasticInterface:
        return dataclasses.replace(self, pressed=pressed)

    def losses(self) -> tuple[jax.Array, jax.Array]:
        formed, broken = super().losses()
        return jnp.append(1.0, formed), jnp.append(0.0, broken)

    def _measure_pressed(self, pressed: Flattened, separation: jax.Array, memory: Memory) -> Means:
        """The means after a closest approach."""
        asked = asked_powers(self.laws, bond_gaps(self.laws, separation, memory[1:]))
        powers = [(ask.term, self._sizes.index(ask.size)) for ask in asked]
        values = power_means(pressed, powers, separation)
        rows = jnp.concatenate([contact_means(pressed, separation), values])
        sums = _summed(("elastic", "energy", *(ask.name for ask in asked)), rows)
        return self._means(sums, self._kept(pressed.dissipated, pressed.gained), separation)

    @property
    def _sizes(self) -> tuple[float, ...]:
        """Powers of the tip radius that the laws beside contact have, 0 among them."""
        return tuple(sorted({0.0, *(law.radius_power for law in self.laws)}))

    def _kept(self, dissipated: jax.Array, gained: jax.Array) -> jax.Array:
        """What one asperity per area keeps, by what its contact and the flatter tips give."""
        for law in self.laws:
            if not law.hysteretic:
                gain = gained[..., self._sizes.index(law.radius_power), 0]
                dissipated = dissipated - gain * law.energy(jnp.zeros(()))
        return dissipated

    def _means(self, sums: dict[str, jax.Array], kept: jax.Array, separation: jax.Array) -> Means:
        """The means put together, from those of one asperity per area."""
        means = means_of(self.laws, self.components, sums, separation)
        kept = jnp.broadcast_to(kept, (1, *separation.shape))
        means = means._replace(bonds=jnp.concatenate([kept, means.bonds]))
        return jax.tree_util.tree_map(lambda mean: self.density * mean, means)

    def _measure_one(self, separation: jax.Array, memory: Memory, integrated: int) -> Means:
        """The means at one separation: of a first approach, or after the closest one."""
        deepest = memory[0]
        first = self.first_approach(separation, integrated)
        left = self.flattened((jnp.minimum(deepest, separation),), integrated)
        after = self._measure_pressed(left, separation, memory)
        return choose(separation <= deepest, first, after)


def _in_powers(law: Law) -> bool:
    """Whether a law is a sum of the powers that are tabulated."""
    powers = law.powers(jnp.zeros(()))
    if powers is None:
        return False
    return all(term.exponent in range(HIGHEST + 1) for part in powers for term in part)


def _summed(names: tuple[str, ...], rows: jax.Array) -> dict[str, jax.Array]:
    """Sums of the rows of each name.

    As one product, or XLA would compute the rows again for all that follows from them.
    """
    each = tuple(dict.fromkeys(names))
    chosen = np.asarray([[name == one for name in names] for one in each], float)
    sums = jnp.tensordot(chosen, rows, axes=1)
    return dict(zip(each, sums, strict=True))
