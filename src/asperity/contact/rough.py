"""A rough body: what follows from its interface, whether its bulk deforms or not."""

from __future__ import annotations

import dataclasses
from typing import Self

import equinox as eqx

from .._jax import jax
from ..interface.rough_planes import RoughPlanes
from .contact import Contact
from .profile import Sphere
from .resolution import Resolution


class RoughContact(Contact):
    """A rough body on a plane.

    Parameters
    ----------
    interface
        What happens between the two mean planes.
    shape
        The body.
    resolved
        How finely its curves are cut (static); by default as its forces ask for.
    """

    interface: RoughPlanes
    shape: Sphere
    resolved: Resolution = eqx.field(static=True)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return self.interface.mechanisms

    @property
    def components(self) -> tuple[str, ...]:
        return self.interface.components

    @property
    def error_floor(self) -> float:
        return self.interface.error_floor

    def refined(self, factor: int) -> Self:
        return dataclasses.replace(self, resolved=self.resolved.finer(factor))

    def losses(self) -> tuple[jax.Array, jax.Array]:
        return self.interface.losses()
