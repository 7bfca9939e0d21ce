"""Pressure and energy between two rough planes, with the memory of every bond."""

from __future__ import annotations

from typing import NamedTuple

import equinox as eqx
import numpy as np

from ._jax import jax, jnp
from .laws.base import Law, Powers, Real, TruncatedPower, quantity, terms
from .roughness.heights import Heights

Memory = tuple[jax.Array, ...]
"""One threshold height b [m] per hysteretic law: the asperities higher than b are bonded."""

_WINDOW = 8.6  # heights beyond this many rms weigh less than 1e-16
_PIECES = 12  # quadrature pieces, besides those that a law's kinks and range ask for
_NODES, _WEIGHTS = (np.asarray(a) for a in np.polynomial.legendre.leggauss(16))


class Means(NamedTuple):
    """Means over the heights, per area (``lift`` 1: per 2 pi R).

    Attributes
    ----------
    parts
        Pressure by mechanism [Pa], in the order of :attr:`Interface.components`.
    energy
        Stored energy [J/m^2].
    bonds
        Bonds by law [1/m^2].
    touching
        Asperities with a negative gap [1/m^2].
    """

    parts: jax.Array
    energy: jax.Array
    bonds: jax.Array
    touching: jax.Array


class Interface(eqx.Module):
    """Many asperities of one radius and random height between two planes.

    Parameters
    ----------
    law
        What one asperity does (a :class:`~asperity.laws.Law` or a sum of them).
    heights
        Distribution of their heights.
    density
        Asperities per area [1/m^2].

    Notes
    -----
    Separation h [m] is the distance between the mean planes; the gap of an asperity of
    height z is h - z. Asperities differ in height alone, so the bonded ones are always
    those above a threshold b, which follows b <- clamp(b, h - g_break, h - g_form): a play
    operator, exact for any sequence of reversals (Visintin 1994; ``docs/theory``).

    ``lift`` 0 gives means over the plane (pressure [Pa], energy per area [J/m^2]); ``lift``
    1 integrates them once more over the separation from h to infinity, which times
    2 pi R is the force and energy of a rigid paraboloid of radius R whose apex is at h.
    """

    law: Law
    heights: Heights
    density: Real = quantity()

    @property
    def hysteretic(self) -> tuple[Law, ...]:
        """The laws that remember, in the order of the memory."""
        return tuple(law for law in terms(self.law) if law.hysteretic)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names under which the losses of :meth:`change` are booked."""
        return tuple(law.mechanism for law in self.hysteretic)

    @property
    def components(self) -> tuple[str, ...]:
        """Mechanisms of the forces, elastic first."""
        names = {name for law in terms(self.law) for name in law.counts or {law.mechanism}}
        return tuple(sorted(names, key=lambda name: (name != "elastic", name)))

    @property
    def reach(self) -> jax.Array:
        """Gap [m] beyond which no law pulls by more than 1e-6 of its largest pull."""
        return jnp.max(jnp.stack([law.reach for law in terms(self.law)]))

    def fresh(self, place: jax.Array | float = 0.0) -> Memory:
        """Memory of surfaces that have never touched, one threshold per ``place``."""
        return tuple(jnp.full(jnp.shape(place), jnp.inf) for _ in self.hysteretic)

    def torn(self, place: jax.Array | float = 0.0) -> Memory:
        """Memory on the outermost parting branch: all bonds that can hold do."""
        return tuple(jnp.full(jnp.shape(place), -jnp.inf) for _ in self.hysteretic)

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        """The memory after the separation moved monotonically to ``separation`` [m]."""
        return tuple(
            separation - self._bond_gap(law, b, separation)
            for law, b in zip(self.hysteretic, memory, strict=True)
        )

    def measure(self, separation: jax.Array, memory: Memory, lift: int = 0) -> Means:
        """All means over the heights at a separation reached monotonically from ``memory``.

        Parameters
        ----------
        separation
            Separation of the mean planes [m], any shape.
        memory
            Thresholds at the last reversal, each of that shape or a scalar.
        lift
            0 for a plane, 1 for a rigid paraboloid (times 2 pi R).
        """
        edges = {k: self._bond_gap(law, b, separation) for k, (law, b) in self._pairs(memory)}
        laws = dict(enumerate(terms(self.law)))
        requests: list[tuple[str, Powers]] = [("touching", (TruncatedPower(1.0, 0.0, 0.0),))]
        for k, law in laws.items():
            if law.hysteretic:
                requests.append((f"bonds {k}", (TruncatedPower(1.0, 0.0, edges[k]),)))
            powers = law.powers(edges[k])
            if powers is not None:
                requests.append((law.mechanism, powers[0]))
                requests.append(("energy", powers[1]))
        flat = tuple(term for _, terms_ in requests for term in terms_)
        values = self.heights.mean_powers(flat, lift, separation)
        sums: dict[str, jax.Array] = {}
        for (name, _), value in zip(
            [(name, t) for name, terms_ in requests for t in terms_], values, strict=True
        ):
            sums[name] = sums.get(name, 0.0) + self.density * value
        for k, law in laws.items():
            if law.powers(edges[k]) is None:
                for name in (*self._force_names(law), "energy"):
                    mean = self._quadrature(law, edges[k], separation, lift, name)
                    target = law.mechanism if name == "force" else name
                    sums[target] = sums.get(target, 0.0) + self.density * mean
        zero = jnp.zeros_like(separation)
        bonds = [sums[f"bonds {k}"] for k, law in laws.items() if law.hysteretic]
        return Means(
            parts=jnp.stack([sums.get(name, zero) for name in self.components]),
            energy=sums.get("energy", zero),
            bonds=jnp.stack(bonds) if bonds else jnp.zeros((0, *separation.shape)),
            touching=sums["touching"],
        )

    def pressure(self, separation: jax.Array, memory: Memory, lift: int = 0) -> jax.Array:
        """Mean pressure [Pa], positive when it pushes apart (``lift`` 1: N per 2 pi R)."""
        return self._total(separation, memory, lift, "force")

    def _total(self, separation: jax.Array, memory: Memory, lift: int, name: str) -> jax.Array:
        """Mean of the force or of the energy of all laws."""
        edges = {k: self._bond_gap(law, b, separation) for k, (law, b) in self._pairs(memory)}
        total = jnp.zeros_like(separation)
        flat: Powers = ()
        for k, law in enumerate(terms(self.law)):
            powers = law.powers(edges[k])
            if powers is None:
                total = total + self._quadrature(law, edges[k], separation, lift, name)
            else:
                flat += powers[0 if name == "force" else 1]
        if flat:
            total = total + jnp.sum(self.heights.mean_powers(flat, lift, separation), axis=0)
        return self.density * total

    def energy(self, separation: jax.Array, memory: Memory, lift: int = 0) -> jax.Array:
        """Stored energy per area [J/m^2], 0 for free surfaces far apart."""
        return self._total(separation, memory, lift, "energy")

    def losses(self) -> tuple[jax.Array, jax.Array]:
        """Energy [J] lost when one bond forms, and when it breaks, per hysteretic law."""
        return (
            _stack([jnp.asarray(law.formation_loss) for law in self.hysteretic]),
            _stack([jnp.asarray(law.rupture_loss) for law in self.hysteretic]),
        )

    def _pairs(self, memory: Memory) -> list[tuple[int, tuple[Law, jax.Array | None]]]:
        thresholds = iter(memory)
        return [
            (k, (law, next(thresholds) if law.hysteretic else None))
            for k, law in enumerate(terms(self.law))
        ]

    @staticmethod
    def _bond_gap(law: Law, threshold: jax.Array | None, separation: jax.Array) -> jax.Array:
        """Gap below which asperities are bonded: the clamp, seen from the gap."""
        if threshold is None:
            return jnp.full_like(separation, -jnp.inf)
        return jnp.clip(separation - threshold, law.forming_gap, law.breaking_gap)

    @staticmethod
    def _force_names(law: Law) -> tuple[str, ...]:
        """The parts into which a law without powers takes its force apart."""
        if len(law.counts) < 2:
            return ("force",)
        zero = jnp.zeros(())
        return tuple(law.components(zero, zero > 1.0))

    def _quadrature(
        self, law: Law, edge: jax.Array, separation: jax.Array, lift: int, name: str
    ) -> jax.Array:
        """Mean of a law without truncated powers, by Gauss-Legendre between its kinks."""

        def one(e: jax.Array, h: jax.Array) -> jax.Array:
            return self._one_quadrature(law, e, h, lift, name)

        flat = jax.vmap(one)
        shape = jnp.shape(separation)
        value: jax.Array = flat(jnp.ravel(jnp.broadcast_to(edge, shape)), jnp.ravel(separation))
        return value.reshape(shape)

    def _one_quadrature(
        self, law: Law, edge: jax.Array, separation: jax.Array, lift: int, name: str
    ) -> jax.Array:
        sigma = self.heights.rms
        lowest = jnp.minimum(separation, 0.0) - _reach(separation / sigma) * sigma
        highest = separation + _WINDOW * sigma
        bounds = _pieces(lowest, highest, (*law.kinks, edge), law.length, sigma)
        gap, weight = _points(bounds)
        value = _branch_value(law, gap, gap < edge, name)
        inner = jnp.sum(weight * value * self.heights.tail(lift, separation - gap))
        if lift == 0:
            return inner
        return inner + _beyond(law, highest, sigma, name)


def _branch_value(law: Law, gap: jax.Array, bonded: jax.Array, name: str) -> jax.Array:
    if name == "energy":
        if not law.hysteretic:
            return law.energy(gap)
        return jnp.where(bonded, law.bonded_energy(gap), law.energy(gap))
    if name == "force":
        if not law.hysteretic:
            return law.force(gap)
        return jnp.where(bonded, law.bonded_force(gap), law.force(gap))
    return law.components(gap, bonded)[name]


def _reach(reduced: jax.Array) -> jax.Array:
    """How far above h, in rms, heights still weigh 1e-16 of those at h."""
    inside = jnp.maximum(reduced, 0.0)
    return jnp.sqrt(inside**2 + _WINDOW**2) - inside


def _pieces(
    lowest: jax.Array,
    highest: jax.Array,
    kinks: tuple[jax.Array | float, ...],
    length: jax.Array | float,
    sigma: jax.Array | float,
) -> jax.Array:
    """Sorted ends of the pieces: the kinks, and a ladder from them to both ends."""
    kink = jnp.sort(jnp.clip(jnp.stack([jnp.asarray(k, float) for k in kinks]), lowest, highest))
    uniform = lowest + (highest - lowest) * np.linspace(0.0, 1.0, _PIECES + 1)
    ladder = jnp.minimum(length, sigma) * 4.0 ** np.arange(-1.0, 7.0)
    ladder = jnp.concatenate([kink[0] - ladder, kink[-1] + ladder])
    return jnp.sort(jnp.clip(jnp.concatenate([uniform, kink, ladder]), lowest, highest))


def _points(bounds: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Nodes and weights on all pieces, gathered at both ends of each (square-root ends)."""
    t = 0.5 * (_NODES + 1.0)
    inner = t * t * (3.0 - 2.0 * t)
    slope = 6.0 * t * (1.0 - t) * 0.5 * _WEIGHTS
    width = jnp.diff(bounds)[:, None]
    return (bounds[:-1, None] + width * inner).ravel(), (width * slope).ravel()


def _beyond(law: Law, start: jax.Array, sigma: jax.Array | float, name: str) -> jax.Array:
    """Integral of a free branch over all gaps beyond ``start``, where T_1 is 1.

    An energy that falls like 1/gap has none: it is cut at a gap fixed by the law, which
    shifts the zero of energy and nothing else.
    """
    if name != "energy":
        whole = law.energy(start)
        return jnp.where(name == "force" or name == law.mechanism, whole, 0.0)
    ladder = jnp.minimum(law.length, sigma) * 2.0 ** np.arange(-2.0, 34.0)
    kink = jnp.stack([jnp.asarray(k, float) for k in law.kinks])
    gap, weight = _points(jnp.sort(jnp.maximum(jnp.concatenate([kink, ladder]), start)))
    return jnp.sum(weight * law.energy(gap))


def _stack(rows: list[jax.Array]) -> jax.Array:
    return jnp.stack(rows) if rows else jnp.zeros((0,))
