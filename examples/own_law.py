"""A law of one's own, in twenty lines: polymer chains that grip, stretch and snap.

The law says what one chain does; heights, memory, motion and ledger follow. Here a silica sphere
of 50 um radius falls on silicon carbide whose summits carry one chain each.
"""

from math import pi

import jax

import asperity
from asperity.contact import RigidContact
from asperity.contact.profile import Sphere
from asperity.interface.interface import Interface
from asperity.laws import Hertz, Law
from asperity.laws.law import Real, jnp, quantity
from asperity.laws.testing import check_law
from asperity.surfaces.heights import Gaussian


# The law, from here
class Tether(Law):
    """A chain that grips on touch, pulls like a spring [N/m] and snaps at its extent [m]."""

    stiffness: Real = quantity()
    extent: Real = quantity()

    mechanism = "tethers"
    counts = frozenset({"tethers"})
    hysteretic = True
    forming_gap = property(lambda self: 0.0)
    breaking_gap = property(lambda self: self.extent)
    kinks = property(lambda self: (0.0, self.extent))

    def force(self, gap):
        return jnp.zeros_like(gap)

    energy = force

    def bonded_force(self, gap):
        return -self.stiffness * jnp.maximum(gap, 0.0)

    def bonded_energy(self, gap):
        return 0.5 * self.stiffness * jnp.maximum(gap, 0.0) ** 2


# to here.


def main():
    tether = Tether(stiffness=0.05, extent=20e-9)
    check_law(tether, dimensions={"stiffness": (-1, 1), "extent": (1, 0)})

    law = Hertz(radius=25e-9, modulus=56.8e9) + tether
    contact = RigidContact(Interface(law, Gaussian(0.5e-9), density=3e14), Sphere(50e-6))
    body = asperity.Body(4 / 3 * pi * 50e-6**3 * 2200, gravity=9.81, release=1e-6)

    @jax.jit
    def impacts(body):
        motion = asperity.simulate(contact, body, tolerance=asperity.Tolerance(max_impacts=5))
        return asperity.measure(motion, body)

    measures = impacts(body)
    for height, restitution in zip(measures.rebound_height, measures.restitution, strict=True):
        print(f"rebound to {height * 1e9:7.2f} nm, restitution {restitution:.4f}")
    return measures


if __name__ == "__main__":
    main()
