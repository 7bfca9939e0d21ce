"""A rough body: what follows from its interface, whether its bulk deforms or not."""

from __future__ import annotations

from .._jax import jax
from ..errors import InputError
from ..interface.rough_planes import RoughPlanes
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
