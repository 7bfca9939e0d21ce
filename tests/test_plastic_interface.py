"""Many asperities that yield: what each of them remembers, and what is lost."""

from functools import cache
from itertools import pairwise
from math import pi, radians, sqrt

import equinox as eqx
import numpy as np
import pytest

import asperity.plastic_interface as module
from asperity._jax import jax, jnp
from asperity.interface import Interface
from asperity.laws import Dmt, Hertz, Meniscus
from asperity.laws.base import Sum, terms
from asperity.laws.plastic import JacksonGreen, KogutEtsion, ThorntonNing
from asperity.plastic_interface import PlasticInterface
from asperity.roughness import Gaussian

BETA, E, NU, SIGMA, N = 2.5e-7, 5e9, 0.3, 4e-9, 1e14
PULL = E * sqrt(SIGMA / BETA) * SIGMA  # of adhesion against elasticity, times the next [J/m^2]
DMT, MENISCUS = Dmt(BETA, 0.02 * PULL), Meniscus(BETA, 0.0728, radians(40.0), 1.3e-9)
BESIDE = {"alone": Sum(()), "dmt": Sum((DMT,)), "dmt + meniscus": DMT + MENISCUS}
REACH = float(MENISCUS.reach)
YIELD = [0.003, 0.3, 30.0]  # rms
BATCH, NODES = 16, 4096

every_law = pytest.mark.parametrize("beside", BESIDE)
every_sum = pytest.mark.parametrize(
    ("beside", "lift"), [("alone", 0), *(("dmt + meniscus", n) for n in (0, 1))]
)
every_yield = pytest.mark.parametrize("overlap", YIELD)


def hardness(overlap):
    """Of a Kogut-Etsion contact that yields at this overlap, in rms [Pa]."""
    strain = 0.5 * pi * (0.454 + 0.41 * NU)
    return E / strain * sqrt(overlap * SIGMA / BETA)


def asperities(beside, overlap, rms=SIGMA):
    contact = KogutEtsion(BETA, E, hardness(overlap), NU)
    return PlasticInterface(contact, BESIDE[beside], Gaussian(rms), N)


@eqx.filter_jit
def _compiled(interface, separation, memory, lift):
    return interface.measure(separation, memory, lift)


def measured(interface, separation, memory, lift=0, call=_compiled):
    """Means at many separations, in batches of one shape: compiled once for each law."""
    h = np.asarray(separation, float)
    rows = [np.broadcast_to(b, h.shape) for b in memory]
    parts = []
    for first in range(0, h.size, BATCH):
        pick = np.minimum(np.arange(first, first + BATCH), h.size - 1)
        batch = call(interface, jnp.asarray(h[pick]), tuple(jnp.asarray(b[pick]) for b in rows),
                     lift)  # fmt: skip
        parts.append([np.asarray(x)[..., : h.size - first] for x in batch])
    return type(batch)(*(np.concatenate(x, axis=-1) for x in zip(*parts, strict=True)))


def after(interface, *places):
    """The memory after these reversals."""
    memory = interface.fresh()
    for h in places:
        memory = interface.remember(memory, jnp.asarray(h))
    return memory


def worst(found, exact, floor=1e-9, sizes=None):
    """Largest error over the sizes, or over ``floor`` times the largest size if that is more."""
    found, exact = np.asarray(found), np.asarray(exact)
    sizes = np.abs(exact if sizes is None else np.asarray(sizes))
    scale = np.maximum(sizes, floor * np.max(sizes, initial=0.0))
    return float(np.max(np.abs(found - exact) / np.where(scale > 0.0, scale, 1.0), initial=0.0))


# -- every asperity with its own memory ------------------------------------------------------


@eqx.filter_jit
def each(interface, height, path):
    """What asperities of these heights do at the end of a path, each after its own history.

    Returns rows to be summed (parts of the force, energy, bonds, touching, and the size of the
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


@every_yield
@every_law
def test_memory_is_that_of_all_asperities_over_random_reversals(beside, overlap):
    """Every asperity remembers how deep it was and whether it is bonded; two numbers suffice."""
    interface, path = asperities(beside, overlap), random_walk()
    memories, memory = [], interface.fresh()
    step = eqx.filter_jit(interface.remember)
    for h in path:
        memory = step(memory, jnp.asarray(h))
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
    names = [*interface.components, "energy", *interface.mechanisms, "touching"]
    rows = [*found.parts, found.energy, *found.bonds, found.touching]
    errors = {
        name: worst(row, sum_, 1e-6, energies if name == "energy" else sum_)
        for name, row, sum_ in zip(names, rows, exact, strict=True)
    }
    assert max(errors.values()) < 1e-8, errors


# -- limits ----------------------------------------------------------------------------------

LOADED = np.linspace(-0.5, 3.5, 9) * SIGMA


def from_psi(psi):
    """Yield overlap in rms at a plasticity index (E*/H) sqrt(rms/radius)."""
    return (0.5 * pi * (0.454 + 0.41 * NU) / psi) ** 2


@pytest.mark.parametrize(("psi", "tolerance"), [(0.3, 1e-3), (1e-4, 1e-9)])
@every_sum
def test_hard_asperities_are_those_of_hertz(beside, lift, psi, tolerance):
    interface = asperities(beside, from_psi(psi))
    elastic = Interface(Sum((Hertz(BETA, E), *terms(BESIDE[beside]))), Gaussian(SIGMA), N)
    for turn in (np.inf, -0.5 * SIGMA):
        memory = tuple(b if np.isinf(turn) else np.asarray(turn) for b in interface.fresh())
        found = measured(interface, LOADED, memory, lift)
        exact = elastic.measure(
            jnp.asarray(LOADED), tuple(jnp.full(LOADED.shape, b) for b in memory[1:]), lift
        )
        assert worst(found.parts, exact.parts) < tolerance
        assert worst(found.energy, exact.energy, 0.1) < tolerance  # adhesion cancels contact
        assert worst(found.bonds[1:], exact.bonds) < tolerance
        assert np.max(np.abs(found.bonds[0])) <= 1e-9 * np.max(np.abs(found.energy))


@pytest.mark.parametrize(
    "contact",
    [
        KogutEtsion(BETA, E, 0.02 * E, NU),
        JacksonGreen(BETA, E, 0.005 * E, NU),
        ThorntonNing(BETA, E, 0.01 * E),
    ],
    ids=["Kogut-Etsion", "Jackson-Green", "Thornton-Ning"],
)
def test_what_was_higher_stays_higher(contact):
    """The residual overlap grows by less than the overlap: one threshold tells who is bonded."""
    deepest = jnp.geomspace(1e-1, 1e6, 2001) * contact.yield_overlap
    left, slope = jax.jvp(contact.residual, (deepest,), (jnp.ones_like(deepest),))
    assert np.all(np.asarray(slope) < 1.0)
    assert np.all(np.diff(np.asarray(deepest - left)) > 0.0)


# -- energies --------------------------------------------------------------------------------


@eqx.filter_jit
def slopes(interface, separation, memory, lift):
    """Pressure, and slopes of the energy and of that with all that was lost on the way."""

    def energies(h):
        found = interface.measure(h, memory, lift)
        spent = jnp.tensordot(interface.losses()[0], found.bonds, 1)
        return jnp.sum(found.parts, axis=0), found.energy, found.energy + spent

    ways = jnp.ones_like(separation)
    (pressure, *_), (_, *both) = jax.jvp(energies, (separation,), (ways,))
    return pressure, *both


@every_sum
def test_pressure_is_the_slope_of_energy_and_of_the_work_of_first_approach(beside, lift):
    for overlap in YIELD:
        interface = asperities(beside, overlap)
        h = jnp.linspace(-1.5, 3.0, BATCH) * SIGMA
        fresh = tuple(jnp.full(h.shape, b) for b in interface.fresh())
        pressure, _, work = slopes(interface, h, fresh, lift)
        assert worst(-work, pressure, 1e-3) < 1e-7
        # Menisci neither form nor break within their reach of the closest approach.
        turns = h - jnp.linspace(0.05, 0.95, BATCH) * REACH
        parting = tuple(turns for _ in interface.fresh())
        pressure, energy, _ = slopes(interface, h, parting, lift)
        assert worst(-energy, pressure, 1e-3) < 1e-7


def work_between(interface, memory, first, last):
    """Work per area [J/m^2] done on the surfaces along a way, and the means at its end."""
    node, weight = np.polynomial.legendre.leggauss(BATCH)
    # Bonds begin to change where their memory is used up; the first force may be a jump.
    begin = min(first + REACH, last) if last > first else max(first - REACH, last)
    ends = np.concatenate([np.linspace(first, begin, 5), np.linspace(begin, last, 31)[1:]])
    span = np.diff(ends)[:, None]
    place = ends[:-1, None] + 0.5 * span * (1.0 + node)
    pressure = measured(interface, place.ravel(), memory).parts.sum(axis=0).reshape(place.shape)
    end = measured(interface, [last], memory)
    work = -float(np.sum(0.5 * span * pressure * weight))
    return work, end, interface.remember(memory, jnp.asarray(last))


@every_yield
@every_law
def test_work_over_a_cycle_is_what_was_kept_and_what_bonds_lost(beside, overlap):
    """First law from apart to apart: in, part of the way out, in deeper, and out."""
    interface = asperities(beside, overlap)
    formed, broken = (np.asarray(x) for x in interface.losses())
    far = 9.5 * SIGMA
    memory, done, lost, before = interface.fresh(), 0.0, 0.0, 0.0
    scale = 0.0
    for first, last in pairwise([far, 1.0 * SIGMA, 1.7 * SIGMA, 0.2 * SIGMA, far]):
        # Going in again, the surfaces come to where they were closest first.
        stops = [last]
        if float(memory[0]) < np.inf and last < float(memory[0]):
            stops = [float(memory[0]), last]
        for stop in stops:
            work, end, memory = work_between(interface, memory, first, stop)
            change, before = end.bonds[:, 0] - before, end.bonds[:, 0]
            done, first = done + work, stop
            lost += float(formed @ np.maximum(change, 0.0) + broken @ np.maximum(-change, 0.0))
            scale = max(scale, abs(done))
            assert done == pytest.approx(float(end.energy[0]) + lost, abs=1e-6 * scale)
    kept = float(before[0])
    assert float(end.energy[0]) == pytest.approx(0.0, abs=1e-9 * scale)
    assert done == pytest.approx(lost, abs=1e-6 * max(lost, 1e-6 * scale), rel=1e-6)
    assert kept >= 0.0
    assert (kept > 1e-3 * scale) == (overlap < 1.0)


@every_yield
@every_law
def test_a_second_approach_to_the_same_depth_keeps_nothing_more(beside, overlap):
    interface, depth = asperities(beside, overlap), 0.3 * SIGMA
    once, again = after(interface, depth), after(interface, depth, 9.0 * SIGMA, depth)
    np.testing.assert_array_equal(np.asarray(once[0]), np.asarray(again[0]))
    places = depth + np.linspace(0.0, 4.0, BATCH) * SIGMA
    first, second = (measured(interface, places, memory) for memory in (once, again))
    np.testing.assert_allclose(first.bonds[0], first.bonds[0, 0], rtol=1e-8)
    for x, y in zip(first, second, strict=True):
        np.testing.assert_allclose(y, x, rtol=1e-12)
    # Coming back, contact pushes by the force from which it parted.
    back = measured(interface, [depth], after(interface, depth, 9.0 * SIGMA))
    came = measured(interface, [depth], interface.fresh())
    np.testing.assert_allclose(back.parts[0], came.parts[0], rtol=1e-8)
    np.testing.assert_allclose(back.bonds, came.bonds, rtol=1e-8)


# -- numbers ---------------------------------------------------------------------------------


def test_means_do_not_depend_on_the_pieces_of_the_heights(monkeypatch):
    names = [name for name in ("_EVEN", "_RUNGS") if hasattr(module, name)]
    if not names:
        pytest.skip("pieces are counted otherwise")
    for name in names:
        monkeypatch.setattr(module, name, 2 * getattr(module, name))
    fine = eqx.filter_jit(lambda i, h, memory, lift: i.measure(h, memory, lift))
    h = np.tile(np.linspace(-1.0, 3.5, BATCH // 2), 2) * SIGMA
    turns = h - np.repeat([0.0, 0.7], BATCH // 2) * SIGMA
    errors = {}
    for overlap in (1e-3, 1e-2, 0.1, 1.0, 10.0):
        interface = asperities("dmt + meniscus", overlap)
        memory = (turns, turns)
        coarse = measured(interface, h, memory)
        better = measured(interface, h, memory, call=fine)
        names = [*interface.components, "energy", *interface.mechanisms, "touching"]
        rows = [[*x.parts, x.energy, *x.bonds, x.touching] for x in (coarse, better)]
        # The energies of contact and adhesion cancel at places, their sum is not small nearby.
        floors = [0.1 if name == "energy" else 1e-4 for name in names]
        errors |= {
            (overlap, name): worst(x, y, floor)
            for name, x, y, floor in zip(names, *rows, floors, strict=True)
        }
    assert max(errors.values()) < 1e-7, max(errors.items(), key=lambda item: item[1])


@eqx.filter_jit
def slope_along(interface, direction, separation, memory):
    """Change of the mean pressure as the interface changes."""
    push = lambda i: jnp.sum(i.measure(separation, memory).parts, axis=0)  # noqa: E731
    return jax.jvp(push, (interface,), (direction,))[1]


@pytest.mark.parametrize("quantity", ["hardness", "rms height"])
@pytest.mark.parametrize("overlap", YIELD[:2])
def test_slope_of_the_pressure_is_that_of_differences(quantity, overlap):
    place = (lambda i: i.contact.hardness) if quantity == "hardness" else (
        lambda i: i.heights.rms_height)  # fmt: skip
    interface = asperities("dmt + meniscus", overlap)
    h = np.linspace(-0.5, 2.5, BATCH) * SIGMA
    turns = np.where(np.arange(BATCH) % 2, h - 0.25 * SIGMA, np.inf)
    memory = (turns, turns)
    zero = jax.tree.map(jnp.zeros_like, interface)
    direction = eqx.tree_at(place, zero, place(interface))
    slope = slope_along(interface, direction, jnp.asarray(h), tuple(map(jnp.asarray, memory)))

    def pressure(factor):
        changed = eqx.tree_at(place, interface, place(interface) * factor)
        return measured(changed, h, memory).parts.sum(axis=0)

    step = 2e-4
    near, far = ((pressure(1.0 + s) - pressure(1.0 - s)) / (2.0 * s) for s in (step, 2.0 * step))
    assert worst(slope, (4.0 * near - far) / 3.0, 1e-3) < 1e-6
