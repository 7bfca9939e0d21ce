"""Many asperities that yield, between two planes: what was pressed flat stays flat."""

from __future__ import annotations

import equinox as eqx
import numpy as np

from ._jax import jax, jnp
from .errors import InputError
from .interface import Means, Memory
from .laws.base import Law, Real, quantity, terms
from .laws.plastic import PlasticContact
from .quadrature import Near, points
from .roughness.heights import Heights

PLASTIC = "plastic"
"""Mechanism of the work that asperities keep."""

_EVEN = 5  # pieces over the heights, besides those that kinks ask for
_RUNGS = 3  # of a ladder of pieces from where contact begins
_NODES = 12


class PlasticInterface(eqx.Module):
    """Asperities of random height that yield, with other laws beside their contact.

    Parameters
    ----------
    contact
        Elastic-plastic contact of one asperity.
    law
        Laws of finite range beside it that pull in contact as at touch, each on the tip as it was
        left; :class:`~asperity.laws.Sum` of none for none.
    heights
        Distribution of the heights before anything touched.
    density
        Asperities per area [1/m^2].

    Raises
    ------
    InputError
        If a law contains the elastic force.

    Notes
    -----
    An asperity of height z that was overlapped by z - h_min at closest approach h_min has the
    effective height y = z - residual(z - h_min). Since y grows with z, the memory of contact is
    h_min alone, and that of bonds a threshold of y each, as for
    :class:`~asperity.interface.Interface`. The work that contact keeps counts as bonds of the
    first mechanism, of 1 J each, which form and never break.

    A tip that was overlapped by D and springs back by S is flatter: its forces beside contact
    grow by D/S to the power of the tip radius that their law has, so that the energy of the
    area in contact is that at closest approach. It begins when the bodies part; what menisci
    gain by it counts as their formation.

    On a rigid paraboloid h - h_min is the same everywhere, so that ``lift`` 1 integrates means
    over the separation as before.
    """

    contact: PlasticContact
    law: Law
    heights: Heights
    density: Real = quantity()

    def __check_init__(self) -> None:
        for law in terms(self.law):
            if "elastic" in law.counts:
                raise InputError(
                    f"{type(law).__name__} and {type(self.contact).__name__} both contain the "
                    "elastic force; it would count twice"
                )

    @property
    def hysteretic(self) -> tuple[Law, ...]:
        """The laws beside contact that remember, in the order of their thresholds."""
        return tuple(law for law in terms(self.law) if law.hysteretic)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names under which the losses of :meth:`losses` are booked."""
        return (PLASTIC, *(law.mechanism for law in self.hysteretic))

    @property
    def components(self) -> tuple[str, ...]:
        """Mechanisms of the forces, elastic first: the contact's, whether it yields or not."""
        names = {name for law in terms(self.law) for name in law.counts or {law.mechanism}}
        return ("elastic", *sorted(names))

    @property
    def grain(self) -> float:
        """How fine its curves are; see :class:`~asperity.roughness.Heights`. Without values."""
        return self.heights.grain

    @property
    def blur(self) -> float:
        """Relative error of curves below which nothing is gained. Without values."""
        return self.heights.blur

    @property
    def reach(self) -> jax.Array:
        """Gap [m] beyond which no law pulls by more than 1e-6 of its largest pull."""
        return jnp.max(jnp.stack([jnp.zeros(()), *(law.reach for law in terms(self.law))]))

    @property
    def last_kink(self) -> jax.Array:
        """Gap [m] beyond which all laws are smooth."""
        return jnp.max(jnp.stack([jnp.zeros(()), *(law.last_kink for law in terms(self.law))]))

    @property
    def only_bonded(self) -> bool:
        """As for :class:`~asperity.interface.Interface`: no law reaches without end."""
        return True

    @property
    def yields(self) -> bool:
        """Whether what was pressed once stays changed. Without values."""
        return True

    @property
    def yield_overlap(self) -> jax.Array:
        """Overlap [m] at which an asperity begins to yield."""
        return self.contact.yield_overlap

    def touched(self, memory: Memory) -> jax.Array:
        """Whether anything was pressed so that it stays changed."""
        return jnp.any(memory[0] < jnp.inf)

    def swept(self, memory: Memory, parting: jax.Array | bool) -> Memory:
        """The memory on an outermost branch: of bonds alone, the asperities stay as they are."""
        deepest, *thresholds = memory
        end = jnp.where(parting, -jnp.inf, jnp.inf)
        return (deepest, *(jnp.full_like(b, end) for b in thresholds))

    def merging(self, memory: Memory, parting: jax.Array) -> list[jax.Array]:
        """Separations [m] at which the bonds of each law reach the outermost branch."""
        return [
            b + jnp.where(parting, law.breaking_gap, law.forming_gap)
            for law, b in zip(self.hysteretic, memory[1:], strict=True)
        ]

    def work_of_approach(self, separation: jax.Array, lift: int = 0) -> jax.Array:
        """Work per area [J/m^2] that bringing free surfaces to a separation takes, at least."""
        means = self.measure(separation, self.fresh(), lift)
        return means.energy + means.bonds[0]

    def fresh(self, place: jax.Array | float = 0.0) -> Memory:
        """Memory of surfaces that have never touched, one row a mechanism."""
        return tuple(jnp.full(jnp.shape(place), jnp.inf) for _ in self.mechanisms)

    def torn(self, place: jax.Array | float = 0.0) -> Memory:
        """Memory of whole asperities whose bonds hold as far as they can."""
        apart = jnp.full(jnp.shape(place), jnp.inf)
        return (apart, *(-apart for _ in self.hysteretic))

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        """The memory after the separation moved monotonically to ``separation`` [m]."""
        deepest, *thresholds = memory
        pairs = zip(self.hysteretic, thresholds, strict=True)
        bonds = (separation - _bond_gap(law, b, separation) for law, b in pairs)
        return (jnp.minimum(deepest, separation), *bonds)

    def measure(
        self, separation: jax.Array, memory: Memory, lift: int = 0, near: Near | None = None
    ) -> Means:
        """All means over the heights; see :meth:`~asperity.interface.Interface.measure`."""
        shape = jnp.shape(separation)
        rows = tuple(jnp.ravel(jnp.broadcast_to(b, shape)) for b in memory)
        each = jax.vmap(lambda h, b: self._measure_one(h, b, lift))(jnp.ravel(separation), rows)
        return Means(*(jnp.moveaxis(x, 0, -1).reshape(*x.shape[1:], *shape) for x in each))

    def pressure(self, separation: jax.Array, memory: Memory, lift: int = 0) -> jax.Array:
        """Mean pressure [Pa], positive when it pushes apart (``lift`` 1: N per 2 pi R)."""
        return jnp.sum(self.measure(separation, memory, lift).parts, axis=0)

    def energy(self, separation: jax.Array, memory: Memory, lift: int = 0) -> jax.Array:
        """Energy per area that comes back [J/m^2], 0 for free surfaces far apart."""
        return self.measure(separation, memory, lift).energy

    def losses(self) -> tuple[jax.Array, jax.Array]:
        """Energy [J] lost when one bond forms, and when it breaks, per mechanism."""
        formed = [jnp.ones(()), *(jnp.asarray(law.formation_loss) for law in self.hysteretic)]
        broken = [jnp.zeros(()), *(jnp.asarray(law.rupture_loss) for law in self.hysteretic)]
        return jnp.stack(formed), jnp.stack(broken)

    def _measure_one(self, separation: jax.Array, memory: Memory, lift: int) -> Means:
        """The means at one separation."""
        low = jnp.minimum(memory[0], separation)
        edges = self._edges(separation, memory)
        begin = self._height(separation, low)
        height, weight = points(self._bounds(separation, low, begin, edges, lift), _NODES)
        share = self.density * weight * self.heights.tail(lift, height)
        deepest = jnp.maximum(height - low, 0.0)
        overlap = jnp.maximum(height - separation, 0.0)
        gap = separation - height + self.contact.residual(deepest)
        flatter = self._flatter(deepest)
        # While it goes deeper than ever, a tip pulls as if it were whole.
        pulling = jnp.where(separation <= memory[0], 1.0, flatter)
        sums = dict.fromkeys(self.components, jnp.zeros(()))
        sums["elastic"] = jnp.sum(share * self.contact.force(overlap, deepest))
        energy = jnp.sum(share * self.contact.recoverable(overlap, deepest))
        kept = self._kept(low, lift)
        counts = []
        for law, edge in zip(terms(self.law), edges, strict=True):
            held, size = gap < edge, law.radius_power
            for name, part in law.components(gap, held).items():
                sums[name] = sums[name] + jnp.sum(share * pulling**size * part)
            stored = jnp.where(held, law.bonded_energy(gap), law.energy(gap))
            energy = energy + jnp.sum(share * flatter**size * stored)
            if law.hysteretic:
                counts.append(jnp.sum(share * jnp.where(held, flatter**size, 0.0)))
        return Means(
            parts=jnp.stack([sums[name] for name in self.components]),
            energy=energy,
            bonds=jnp.stack([kept, *counts]),
            touching=self.density * self.heights.tail(lift + 1, begin),
        )

    def _kept(self, low: jax.Array, lift: int) -> jax.Array:
        """Energy per area that contact down to a separation keeps.

        And what conservative laws beside it gain by flatter tips, which goes the same way.
        """
        last = jnp.maximum(self.heights.highest_beside(jnp.minimum(low, self.heights.top)), low)
        first = low if lift else jnp.clip(low, self.heights.bottom, last)
        uneven = jnp.clip(first, self.heights.bottom, last)
        even = uneven + (last - uneven) * np.linspace(0.0, 1.0, _EVEN + 1)
        kinks = jnp.stack([first, *(low + kink for kink in self.contact.kinks)])
        bounds = jnp.sort(jnp.clip(jnp.concatenate([even, kinks]), first, last))
        height, weight = points(bounds, _NODES)
        share = self.density * weight * self.heights.tail(lift, height)
        deepest = jnp.maximum(height - low, 0.0)
        kept = jnp.sum(share * self.contact.dissipated(deepest))
        for law in terms(self.law):
            if not law.hysteretic:
                gain = self._flatter(deepest) ** law.radius_power - 1.0
                kept = kept - jnp.sum(share * gain) * law.energy(jnp.zeros(()))
        return kept

    def _flatter(self, deepest: jax.Array) -> jax.Array:
        """Factor by which the radius of a tip has grown, of its deepest overlap [m]."""
        pressed = deepest > 0.0
        sprung = jnp.where(pressed, deepest - self.contact.residual(deepest), 1.0)
        return jnp.where(pressed, deepest / sprung, 1.0)

    def _edges(self, separation: jax.Array, memory: Memory) -> list[jax.Array]:
        """Gap [m] below which asperities are bonded, for each law."""
        thresholds, apart = iter(memory[1:]), jnp.asarray(-jnp.inf)
        return [
            _bond_gap(law, next(thresholds), separation) if law.hysteretic else apart
            for law in terms(self.law)
        ]

    def _height(self, effective: jax.Array, low: jax.Array) -> jax.Array:
        """Height [m] of the asperities that have come to an ``effective`` height."""
        recovered = jnp.maximum(effective - low, 0.0)
        return jnp.minimum(effective, low) + self.contact.deepest(recovered)

    def _bounds(
        self,
        separation: jax.Array,
        low: jax.Array,
        begin: jax.Array,
        edges: list[jax.Array],
        lift: int,
    ) -> jax.Array:
        """Ends of pieces of the heights between which everything is smooth."""
        laws = terms(self.law)
        pairs = zip(laws, edges, strict=True)
        gaps = [jnp.asarray(k, float) for law in laws for k in law.kinks if not _at_touch(k)]
        gaps += [jnp.maximum(edge, 0.0) for law, edge in pairs if law.hysteretic]
        marks = [self._height(separation - gap, low) for gap in gaps]
        first = jnp.min(jnp.stack([begin, *marks]))
        if lift == 0:
            first = jnp.maximum(first, self.heights.bottom)
        highest = self.heights.highest_beside(jnp.minimum(begin, self.heights.top))
        last = jnp.maximum(highest, first)
        uneven = jnp.maximum(first, self.heights.bottom)
        even = uneven + (last - uneven) * np.linspace(0.0, 1.0, _EVEN + 1)
        reach = last - begin
        yielding = self.contact.yield_overlap
        rung = jnp.minimum(0.25 * self.heights.rms, jnp.maximum(begin - low, yielding))
        rung = jnp.clip(rung, 0.0, jnp.maximum(reach, 0.0))
        ratio = jnp.where(rung > 0.0, reach / jnp.where(rung > 0.0, rung, 1.0), 1.0)
        ladder = begin + rung * ratio ** (np.arange(_RUNGS) / _RUNGS)
        kinks = low + jnp.stack(self.contact.kinks)
        ends = [even, ladder, kinks, jnp.stack([begin, first, *marks])]
        return jnp.sort(jnp.clip(jnp.concatenate(ends), first, last))


def _bond_gap(law: Law, threshold: jax.Array, separation: jax.Array) -> jax.Array:
    """Gap below which asperities are bonded."""
    return jnp.clip(separation - threshold, law.forming_gap, law.breaking_gap)


def _at_touch(kink: jax.Array | float) -> bool:
    """Whether a kink lies where bodies touch, by what is known without values."""
    return isinstance(kink, float) and kink == 0.0
