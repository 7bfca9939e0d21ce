"""Means over heights of laws without truncated powers, against a quadrature of their own."""

import equinox as eqx
import numpy as np
import pytest
from numpy.polynomial import chebyshev

from asperity._jax import jax, jnp
from asperity.contact import RigidContact
from asperity.contact.profile import Sphere
from asperity.interface.height_quadrature import Near
from asperity.interface.interface import Interface
from asperity.laws import Bradley, ConstantVolume, Jkr, LennardJones, Maugis
from asperity.surfaces.heights import Gaussian
from chosen import long_but

TIP, E, W = 50e-9, 50e9, 0.05
LAWS = {
    "stiff JKR": Jkr(TIP, E, W),
    "soft JKR": Jkr(TIP, 1e9, W),
    "Maugis": Maugis(TIP, E, W, 3e-10),
    "Bradley": Bradley(TIP, W, 3e-10),
    "bridge": ConstantVolume(TIP, 0.0728, 0.5, 1e-8),
}
X, WEIGHT = np.polynomial.legendre.leggauss(20)
POINTS = chebyshev.chebpts1(16)


ROWS = 6
DEPTHS = {5.0: 1e-7, 40.0: 1e-7, 300.0: 3e-3}


def exact(law, rms, separation, edge):
    """Integrals of force and energy times the share of higher asperities.

    On pieces about all that bends: one body of code for all places.
    """
    kinks = jnp.stack([jnp.asarray(k, float) for k in law.kinks])
    kinks = jnp.append(kinks, jnp.where(jnp.isfinite(edge), edge, 0.0))
    low = separation - jnp.hypot(9.0 * rms, jnp.maximum(separation, 0.0))
    top = jnp.maximum(separation + 9.0 * rms, jnp.max(kinks))
    far = top + 1e10 * jnp.maximum(1e-9, jnp.abs(top))
    ladder = jnp.geomspace(1e-4 * rms, far, 160)
    ends = [kinks, separation + rms * np.linspace(-9.0, 9.0, 40), jnp.stack([low, far])]
    for place in (*kinks, separation):
        ends += [place + ladder, place - ladder]
    ends = jnp.sort(jnp.clip(jnp.concatenate(ends), low, far))
    t = 0.5 * (X + 1.0)
    width = jnp.diff(ends)[:, None]
    gap = ends[:-1, None] + width * t * t * (3.0 - 2.0 * t)
    share = 0.5 * jax.lax.erfc((separation - gap) / (rms * np.sqrt(2.0)))
    measure = width * 3.0 * t * (1.0 - t) * WEIGHT * share
    force = jnp.where(gap < edge, law.bonded_force(gap), law.force(gap))
    energy = jnp.where(gap < edge, law.bonded_energy(gap), law.energy(gap))
    return jnp.stack([jnp.sum(force * measure), jnp.sum(energy * measure)])


def panels_of(interface, low):
    """Chebyshev points of some panels of a rigid sphere's curves, the first and last among them."""
    contact = RigidContact(interface, Sphere(20e-6))
    count = contact.resolved.panels
    ends = np.asarray(contact.panels(jnp.asarray(low), jnp.asarray(1e-5)))[: count + 1]
    rows = 0.5 * (ends[:-1] + ends[1:])[:, None] + 0.5 * np.diff(ends)[:, None] * POINTS
    return rows[np.linspace(0, count - 1, ROWS).astype(int)], contact.resolved.shared


@eqx.filter_jit
def found(interface, memory, rows, shared):
    """Force and energy at rows of places, each place alone and those of a row together."""

    def of(separation, near):
        means = interface.measure(separation, memory, 1, near)
        return jnp.stack([jnp.sum(means.parts, axis=0), means.energy], axis=-1)

    alone = jax.vmap(jax.vmap(lambda d: of(d[None], None)[0]))(rows)
    if not shared:
        return alone, alone
    return alone, jax.vmap(lambda row: of(row, Near(level=True, pieces=shared)))(rows)


@jax.jit
def true(law, rms, edge, rows):
    return jax.lax.map(jax.vmap(lambda d: exact(law, rms, d, edge)), rows)


@pytest.mark.parametrize("name", long_but(LAWS, "Maugis"))
def test_a_paraboloid_however_deep_or_far(name):
    """Also where every asperity beside the apex is well within its law.

    Relative to the largest value of a panel. Places of one panel share their nodes, which are
    too few for panels of a hundred rms. Bradley's energy counts from a gap of its own.
    """
    law = LAWS[name]
    columns = slice(0, 1) if name == "Bradley" else slice(0, 2)
    for rms in (0.2e-9, 2e-9, 20e-9):
        interface = Interface(law, Gaussian(rms), 1.0)
        for bonded in (False, True) if law.hysteretic else (False,):
            b = jnp.asarray(-jnp.inf if bonded else jnp.inf)
            edge = jnp.asarray(-jnp.inf)
            if law.hysteretic:
                edge = jnp.asarray(law.breaking_gap if bonded else law.forming_gap)
            for depth, limit in DEPTHS.items():
                rows, shared = panels_of(interface, -depth * rms)
                one, row = found(interface, tuple(b for _ in interface.hysteretic), rows, shared)
                truth = np.asarray(true(law, jnp.asarray(rms), edge, rows[:, ::5]))
                # Nothing small beside the largest pull.
                pull = np.abs(np.minimum(truth, 0.0)).max(axis=(0, 1))
                size = np.maximum(np.abs(truth).max(axis=1, keepdims=True), 1e-6 * pull)
                off = (np.abs(np.asarray(x)[:, ::5] - truth) / size for x in (one, row))
                alone, together = (np.max(x[..., columns]) for x in off)
                assert alone < 1e-7
                assert together < limit


class Unintegrated(Bradley):
    """A law whose energy falls like 1/gap, and has no closed integral."""

    def energy_beyond(self, gap):
        return None


@pytest.mark.parametrize(
    "law",
    [LennardJones(TIP, E, W, 3e-10), Bradley(TIP, W, 3e-10), Unintegrated(TIP, W, 3e-10)],
    ids=["Lennard-Jones", "Bradley", "by quadrature"],
)
def test_energies_of_low_asperities_add_up_metres_away(law):
    """A body may bounce so high; its attraction ends nowhere. The zero of energy was at 1.5 m."""
    interface = Interface(law, Gaussian(0.1e-9), 1.0)
    memory = tuple(jnp.asarray(jnp.inf) for _ in interface.hysteretic)

    @jax.jit
    def slope_and_force(place):
        def stored(d):
            return interface.measure(d, memory, 1).energy

        return jax.grad(stored)(place), jnp.sum(interface.measure(place, memory, 1).parts)

    for place in (1e-8, 1e-6, 1e-3, 1.0, 3.0):
        slope, force = slope_and_force(jnp.asarray(place))
        assert float(slope) == pytest.approx(-float(force), rel=1e-6, abs=0.0)
