"""A rough body: what follows from its interface, whether its bulk deforms or not."""

from __future__ import annotations

import equinox as eqx

from .._jax import jax
from ..errors import InputError
from ..interface.rough_planes import RoughPlanes
from ..laws.law import Real, quantity
from .contact import Contact, YieldingContact
from .profile import Sphere


class RoughContact(Contact):
    """A rough body on a plane.

    Parameters
    ----------
    interface
        What happens between the two mean planes.
    shape
        The body.
    resolved
        As for every contact; by default as its forces ask for.
    """

    interface: RoughPlanes
    shape: Sphere

    def __check_init__(self) -> None:
        if self.interface.yields and not isinstance(self, YieldingContact):
            raise InputError(
                f"asperities that yield need a RigidPlasticContact; got {type(self).__name__}"
            )

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return self.interface.mechanisms

    @property
    def components(self) -> tuple[str, ...]:
        return self.interface.components

    def losses(self) -> tuple[jax.Array, jax.Array]:
        return self.interface.losses()


class DeformingContact(RoughContact):
    """A rough body on a plane, whose bulk deforms in rings about its axis.

    Parameters
    ----------
    rings
        Number of rings (static).
    modulus
        Contact modulus E* [Pa] of the bulk.
    """

    rings: int = eqx.field(static=True)
    modulus: Real = quantity()
