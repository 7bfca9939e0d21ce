"""Below its lower bound no body comes, however much attraction hastens it."""

import pytest

from asperity._jax import jax, jnp
from asperity.contact import ElasticContact
from asperity.contact.profile import Sphere
from asperity.interface.interface import Interface
from asperity.laws import Bradley, Hertz
from asperity.surfaces.heights import Gaussian

RMS, TIP, MODULUS, RELEASE = 4e-10, 3.6e-9, 5e11, 1e-8
HARD = Hertz(TIP, MODULUS)


@pytest.mark.parametrize("work", [0.35, 1e-6])
def test_a_contact_stores_all_that_a_body_has_before_its_lower_bound(work):
    planes = Interface(HARD + Bradley(TIP, work, 3.2e-10), Gaussian(RMS), 1.6e17)
    contact = ElasticContact(planes, Sphere(8.7e-7), MODULUS)
    kinetic = jnp.asarray(4e-21)

    @jax.jit
    def stored():
        lowest = contact.lower_bound(jnp.asarray(RELEASE), kinetic, jnp.zeros_like)
        places = jnp.stack([jnp.asarray(RELEASE), lowest])
        return [contact.state(place, contact.branches()[0]).stored for place in places]

    at_release, deepest = stored()
    assert deepest > at_release + kinetic
    # Attraction gives the first body a million times what it is launched with.
    assert deepest - at_release > (1e3 if work > 0.1 else 1.0) * kinetic
