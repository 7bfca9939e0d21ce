"""What yielding asperities remember: each by itself, and all of them by two numbers."""

from functools import cache
from itertools import pairwise
from math import pi, sqrt

import equinox as eqx
import numpy as np

from asperity._jax import jax, jnp
from asperity.laws.law import terms
from plastic_asperities import (
    BATCH,
    SIGMA,
    N,
    after,
    asperities,
    every_yield,
    measured,
    worst,
)

NODES = 4096


@eqx.filter_jit
def each(interface, height, path):
    """What asperities of these heights do at the end of a path, each after its own history.

    Returns rows to be summed (parts of the force, energy, bonds, contacting, and the size of the
    energy), and what changes by jumps along the heights.
    """
    contact, laws = interface.contact, terms(interface.law)

    def move(state, h):
        deepest, left, held = state
        overlap = jnp.maximum(height - h, 0.0)
        deeper = jnp.maximum(deepest, overlap)
        grows = jnp.any(deeper > deepest)
        left = jax.lax.cond(grows, lambda: contact.residual(deeper), lambda: left)
        gap = h - height + left
        now = [
            (gap <= law.forming_gap) | (bond & (gap < law.breaking_gap))
            for law, bond in zip(laws, held, strict=True)
        ]
        return (deeper, left, now), None

    zero, free = jnp.zeros_like(height), jnp.zeros(height.shape, bool)
    (deepest, left, held), _ = jax.lax.scan(move, (zero, zero, [free] * len(laws)), path)
    overlap = jnp.maximum(height - path[-1], 0.0)
    gap = path[-1] - height + left
    flatter = jnp.where(deepest > 0.0, deepest / jnp.where(deepest > 0.0, deepest - left, 1.0), 1.0)
    pulling = jnp.where(overlap >= deepest, 1.0, flatter)
    parts = dict.fromkeys(interface.components, zero)
    parts["elastic"] = contact.force(overlap, deepest)
    energy = size_of_energy = contact.recoverable(overlap, deepest)
    bonds, jumps = [contact.dissipated(deepest)], [gap < 0.0]
    for law, bond in zip(laws, held, strict=True):
        size = law.radius_power
        if law.hysteretic:
            force = jnp.where(bond, law.bonded_force(gap), law.force(gap))
            stored = jnp.where(bond, law.bonded_energy(gap), law.energy(gap))
            bonds.append(jnp.where(bond, flatter**size, 0.0))
            jumps += [bond, gap < law.breaking_gap]
        else:
            force, stored = law.force(gap), law.energy(gap)
        parts[law.mechanism] = parts[law.mechanism] + pulling**size * force
        energy = energy + flatter**size * stored
        size_of_energy = size_of_energy + jnp.abs(flatter**size * stored)
    rows = [*(parts[name] for name in interface.components), energy, *bonds, gap < 0.0]
    rows.append(size_of_energy)
    return jnp.stack([row.astype(float) for row in rows]), jnp.stack(jumps)


def jump_places(interface, path, low, high):
    """Heights at which something jumps, by looking at ever finer sets of asperities."""
    grid = np.linspace(low, high, NODES)
    rows = np.asarray(each(interface, jnp.asarray(grid), path)[1])
    brackets = [(k, i) for k, i in zip(*np.nonzero(rows[:, 1:] != rows[:, :-1]), strict=True)]
    ends = [(k, grid[i], grid[i + 1]) for k, i in brackets]
    if not ends:
        return []
    share = NODES // len(ends)
    for _ in range(4):
        cells = [np.linspace(a, b, share) for _, a, b in ends]
        grid = np.concatenate([*cells, np.full(NODES - share * len(ends), high)])
        rows = np.asarray(each(interface, jnp.asarray(grid), path)[1])
        for j, (k, _, _) in enumerate(ends):
            row = rows[k, j * share : (j + 1) * share]
            i = int(np.argmax(row[1:] != row[:-1]))
            ends[j] = (k, cells[j][i], cells[j][i + 1])
    return [0.5 * (a + b) for _, a, b in ends]


_T, _W = np.polynomial.legendre.leggauss(12)
_LADDER = 4.0 ** np.arange(-13.0, 0.0)


def direct_sum(interface, path):
    """Sums over very many asperities, a twelfth of them around each of many places."""
    h, closest = float(path[-1]), float(np.min(path))
    high = max(closest, 0.0) + np.hypot(max(h, 0.0), 9.0 * SIGMA)
    low = -9.0 * SIGMA
    kinks = [closest, *(closest + float(kink) for kink in interface.contact.kinks)]
    ends = np.unique(np.clip([low, high, *kinks, *jump_places(interface, path, low, high)],
                             low, high))  # fmt: skip
    pieces = []
    for a, b in pairwise(ends):
        half = 0.5 * (b - a)
        pieces.append(np.concatenate([[a], a + half * _LADDER, [a + half],
                                      b - half * _LADDER[::-1], [b]]))  # fmt: skip
    total = 0.0
    bounds = [np.stack([p[:-1], p[1:]], axis=1) for p in pieces]
    bounds = np.concatenate(bounds) if bounds else np.zeros((0, 2))
    width = bounds[:, 1:] - bounds[:, :1]
    height = (bounds[:, :1] + 0.5 * width * (1.0 + _T)).ravel()
    count = np.exp(-0.5 * (height / SIGMA) ** 2) / (sqrt(2.0 * pi) * SIGMA)
    count = N * count * (0.5 * width * _W).ravel()
    for first in range(0, height.size, NODES):
        some = np.full(NODES, low)
        share = np.zeros(NODES)
        some[: height.size - first] = height[first : first + NODES]
        share[: height.size - first] = count[first : first + NODES]
        total = total + np.asarray(each(interface, jnp.asarray(some), path)[0]) @ share
    return total


@cache
def random_walk(seed=5, reversals=240):
    """Reversals ever deeper on the whole, by steps of the order of the memory of menisci."""
    random = np.random.default_rng(seed)
    mean = np.linspace(3.5, -1.5, reversals // 2)
    lower = (mean - 0.4 * np.abs(random.standard_normal(mean.size))) * SIGMA
    upper = lower + random.exponential(0.6, mean.size) * SIGMA
    return np.stack([lower, upper], axis=1).ravel()


def checks(path):
    """Moves of the path to look at, and where on them: deeper than ever, or not."""
    random = np.random.default_rng(11)
    least = np.minimum.accumulate(path)
    moves = np.arange(1, path.size)
    records = moves[path[1:] < least[:-1]]
    others = np.setdiff1d(moves, records)
    few, many = BATCH // 4, BATCH - BATCH // 4
    deeper, rest = (random.choice(x, n, replace=False) for x, n in ((records, few), (others, many)))
    chosen = np.sort(np.append(deeper, rest))
    along = np.where(random.random(BATCH) < 0.2, 1.0, random.random(BATCH))
    along = np.where(np.isin(chosen, records), np.maximum(along, 0.95), along)
    return [(int(m), float(path[m - 1] + s * (path[m] - path[m - 1])))
            for m, s in zip(chosen, along, strict=True)]  # fmt: skip


@eqx.filter_jit
def remember(interface, memory, separation):
    return interface.remember(memory, separation)


@every_yield
def test_memory_is_that_of_all_asperities_over_random_reversals(overlap):
    """Every asperity remembers how deep it was and whether it is bonded; two numbers suffice."""
    interface, path = asperities("dmt + meniscus", overlap), random_walk()
    memories, memory = [], interface.initial_memory()
    for h in path:
        memory = remember(interface, memory, jnp.asarray(h))
        memories.append([float(b) for b in memory])
    places = checks(path)
    rows = np.asarray([memories[move - 1] for move, _ in places]).T
    found = measured(interface, [h for _, h in places], tuple(rows))
    sums = []
    for move, h in places:
        walked = np.full(path.size + 1, 1.0)  # far away until the path begins
        walked[path.size - move :] = [*path[:move], h]
        sums.append(direct_sum(interface, jnp.asarray(walked)))
    *exact, energies = np.stack(sums, axis=1)
    names = [*interface.components, "energy", *interface.mechanisms, "contacting"]
    rows = [*found.parts, found.energy, *found.bonds, found.contacting]
    errors = {
        name: worst(row, sum_, 1e-6, energies if name == "energy" else sum_)
        for name, row, sum_ in zip(names, rows, exact, strict=True)
    }
    assert max(errors.values()) < 1e-8, errors


@every_yield
def test_a_second_approach_to_the_same_depth_keeps_nothing_more(overlap):
    interface, depth = asperities("dmt + meniscus", overlap), 0.3 * SIGMA
    once, again = after(interface, depth), after(interface, depth, 9.0 * SIGMA, depth)
    np.testing.assert_array_equal(np.asarray(once[0]), np.asarray(again[0]))
    places = depth + np.linspace(0.0, 4.0, BATCH) * SIGMA
    first, second = (measured(interface, places, memory) for memory in (once, again))
    np.testing.assert_allclose(first.bonds[0], first.bonds[0, 0], rtol=1e-8)
    for x, y in zip(first, second, strict=True):
        np.testing.assert_allclose(y, x, rtol=1e-12)
    # Coming back, contact pushes by the force from which it parted.
    back = measured(interface, [depth], after(interface, depth, 9.0 * SIGMA))
    came = measured(interface, [depth], interface.initial_memory())
    np.testing.assert_allclose(back.parts[0], came.parts[0], rtol=1e-8)
    np.testing.assert_allclose(back.bonds, came.bonds, rtol=1e-8)
