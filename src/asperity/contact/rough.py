"""A rough body: what follows from its interface, whether its bulk deforms or not."""

from __future__ import annotations

from .._jax import jax
from ..interface.rough_planes import RoughPlanes
from .contact import Contact
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

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return self.interface.mechanisms

    @property
    def components(self) -> tuple[str, ...]:
        return self.interface.components

    def losses(self) -> tuple[jax.Array, jax.Array]:
        return self.interface.losses()
