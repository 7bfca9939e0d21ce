"""Many asperities that yield, and their means at many separations: what tests of them share."""

from math import pi, radians, sqrt

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.interface.height_quadrature import ladder, points
from asperity.interface.named_means import bond_gaps
from asperity.interface.plastic_interface import PlasticInterface
from asperity.interface.residual_profile import flatness
from asperity.laws import Dmt, Meniscus
from asperity.laws.law import Sum, terms
from asperity.laws.plastic import KogutEtsion
from asperity.surfaces.heights import Gaussian

BETA, E, NU, SIGMA, N = 2.5e-7, 5e9, 0.3, 4e-9, 1e14
ATTRACTION = (
    E * sqrt(SIGMA / BETA) * SIGMA
)  # of adhesion against elasticity, times the next [J/m^2]
DMT, MENISCUS = Dmt(BETA, 0.02 * ATTRACTION), Meniscus(BETA, 0.0728, radians(40.0), 1.3e-9)
BESIDE = {"alone": Sum(()), "dmt": Sum((DMT,)), "dmt + meniscus": DMT + MENISCUS}
REACH = float(MENISCUS.interaction_range)
YIELD = [0.003, 0.3, 30.0]  # rms
BATCH = 16
_EVEN = 10  # pieces over the heights, besides those that kinks ask for
_STEPS = 6  # of a ladder of pieces from where contact begins
_NODES = 12

every_law = pytest.mark.parametrize("beside", BESIDE)
every_sum = pytest.mark.parametrize(
    ("beside", "integrated"), [("alone", 0), *(("dmt + meniscus", n) for n in (0, 1))]
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
def _compiled(interface, separation, memory, integrated):
    return interface.measure(separation, memory, integrated)


def measured(interface, separation, memory, integrated=0, call=_compiled):
    """Means at many separations, in batches of one shape: compiled once for each law."""
    h = np.asarray(separation, float)
    rows = [np.broadcast_to(b, h.shape) for b in memory]
    parts = []
    for first in range(0, h.size, BATCH):
        pick = np.minimum(np.arange(first, first + BATCH), h.size - 1)
        batch = call(interface, jnp.asarray(h[pick]), tuple(jnp.asarray(b[pick]) for b in rows),
                     integrated)  # fmt: skip
        parts.append([np.asarray(x)[..., : h.size - first] for x in batch])
    return type(batch)(*(np.concatenate(x, axis=-1) for x in zip(*parts, strict=True)))


def after(interface, *places):
    """The memory after these reversals."""
    memory = interface.initial_memory()
    for h in places:
        memory = interface.remember(memory, jnp.asarray(h))
    return memory


def worst(found, exact, floor=1e-9, sizes=None):
    """Largest error over the sizes, or over ``floor`` times the largest size if that is more."""
    found, exact = np.asarray(found), np.asarray(exact)
    sizes = np.abs(exact if sizes is None else np.asarray(sizes))
    scale = np.maximum(sizes, floor * np.max(sizes, initial=0.0))
    return float(np.max(np.abs(found - exact) / np.where(scale > 0.0, scale, 1.0), initial=0.0))


def integrated_means(interface, separation, memory, integrated):
    """The means by integration over the heights, for each separation and memory of a row."""

    def at(h, b):
        edges = bond_gaps(interface.laws, h, b[1:])
        sums = means_at(interface, h, b[0], edges, integrated)
        return interface._means(sums, sums["kept"], h)

    return jax.vmap(at, out_axes=-1)(separation, memory)


def means_at(interface, separation, closest, edges, integrated):
    """Means at one separation [m]: forces by mechanism, energy, what is kept, bonds, contacts.

    Each law is bonded where the gap is below its edge.
    """
    contact, law, heights = interface.contact, interface.law, interface.heights
    low = jnp.minimum(closest, separation)
    begin = _height(contact, separation, low)
    bounds = _bounds(interface, (separation, low, begin), edges, integrated)
    height, weight = points(bounds, _NODES)
    share = weight * heights.tail(integrated, height)
    deepest = jnp.maximum(height - low, 0.0)
    overlap = jnp.maximum(height - separation, 0.0)
    gap = separation - height + contact.residual(deepest)
    flatter = flatness(deepest, deepest - contact.residual(deepest))
    # While it goes deeper than ever, a tip pulls as if it were whole.
    pulling = jnp.where(separation <= closest, 1.0, flatter)
    sums = {
        "elastic": jnp.sum(share * contact.force(overlap, deepest)),
        "energy": jnp.sum(share * contact.recoverable(overlap, deepest)),
        "kept": _kept(interface, low, integrated),
        "contacting": heights.tail(integrated + 1, begin),
    }
    for k, (one, edge) in enumerate(zip(terms(law), edges, strict=True)):
        held, size = gap < edge, one.radius_power
        for name, part in one.response(gap, held).items():
            by = flatter if name == "energy" else pulling
            sums[name] = sums.get(name, 0.0) + jnp.sum(share * by**size * part)
        if one.hysteretic:
            sums[f"bonds {k}"] = jnp.sum(share * jnp.where(held, flatter**size, 0.0))
    return sums


def _kept(interface, low, integrated):
    """Energy that contact down to a separation keeps.

    And what conservative laws beside it gain by flatter tips, which goes the same way.
    """
    contact, law, heights = interface.contact, interface.law, interface.heights
    last = jnp.maximum(heights.highest_beside(jnp.minimum(low, heights.top)), low)
    first = low if integrated else jnp.clip(low, heights.bottom, last)
    uneven = jnp.clip(first, heights.bottom, last)
    even = uneven + (last - uneven) * np.linspace(0.0, 1.0, _EVEN + 1)
    kinks = jnp.stack([first, *(low + kink for kink in contact.kinks)])
    bounds = jnp.sort(jnp.clip(jnp.concatenate([even, kinks]), first, last))
    height, weight = points(bounds, _NODES)
    share = weight * heights.tail(integrated, height)
    deepest = jnp.maximum(height - low, 0.0)
    kept = jnp.sum(share * contact.dissipated(deepest))
    flatter = flatness(deepest, deepest - contact.residual(deepest))
    for one in terms(law):
        if not one.hysteretic:
            gain = flatter**one.radius_power - 1.0
            kept = kept - jnp.sum(share * gain) * one.energy(jnp.zeros(()))
    return kept


def _height(contact, effective, low):
    """Height [m] of the asperities that have come to an ``effective`` height."""
    recovered = jnp.maximum(effective - low, 0.0)
    return jnp.minimum(effective, low) + contact.deepest(recovered)


def _bounds(interface, places, edges, integrated):
    """Ends of pieces of the heights between which everything is smooth.

    ``places`` are the separation, the closest approach and the height from which asperities touch.
    """
    contact, law, heights = interface.contact, interface.law, interface.heights
    separation, low, begin = places
    laws = terms(law)
    pairs = zip(laws, edges, strict=True)
    gaps = [jnp.asarray(k, float) for one in laws for k in one.kinks if not _at_touch(k)]
    gaps += [jnp.maximum(edge, 0.0) for one, edge in pairs if one.hysteretic]
    marks = [_height(contact, separation - gap, low) for gap in gaps]
    first = jnp.min(jnp.stack([begin, *marks]))
    if integrated == 0:
        first = jnp.maximum(first, heights.bottom)
    highest = heights.highest_beside(jnp.minimum(begin, heights.top))
    last = jnp.maximum(highest, first)
    uneven = jnp.maximum(first, heights.bottom)
    even = uneven + (last - uneven) * np.linspace(0.0, 1.0, _EVEN + 1)
    span = last - begin
    narrowest = jnp.minimum(0.25 * heights.rms, jnp.maximum(begin - low, contact.yield_overlap))
    narrowest = jnp.clip(narrowest, 0.0, jnp.maximum(span, 0.0))
    kinks = low + jnp.stack(contact.kinks)
    ends = [even, begin + ladder(narrowest, span, _STEPS), kinks, jnp.stack([begin, first, *marks])]
    return jnp.sort(jnp.clip(jnp.concatenate(ends), first, last))


def _at_touch(kink):
    """Whether a kink lies where bodies touch, by what is known without values."""
    return isinstance(kink, float) and kink == 0.0
