"""How the bulk under a contact creeps: a standard linear solid."""

from __future__ import annotations

import dataclasses

import equinox as eqx

from ..laws import Hertz
from ..laws.law import Real, quantity
from .contact import Contact
from .delayed_formation import DelayedContact
from .elastic import ElasticContact
from .smooth import SmoothContact

VISCOUS = "viscous"
"""Mechanism of the energy that the bulk takes by its creep. What moves slowly loses none to it."""


class Relaxation(eqx.Module):
    """A half-space whose modulus relaxes, E*(t)/E* = k + (1 - k) exp(-t/time).

    Parameters
    ----------
    contact
        The contact while nothing has relaxed yet, with the instantaneous modulus: an
        :class:`ElasticContact`, or a :class:`SmoothContact` of Hertz's law.
    ratio
        Relaxed over instantaneous modulus k, in (0, 1].
    time
        Relaxation time [s]. Under a load it creeps with time/k.
    delayed
        What the menisci of rings take time by, on a bulk that does not creep.
    """

    contact: Contact
    ratio: Real = quantity()
    time: Real = quantity()
    delayed: DelayedContact | None = None

    @classmethod
    def none(cls, delayed: DelayedContact) -> Relaxation:
        """A bulk that does not creep, under menisci that take time."""
        return cls(delayed.base, 1.0, 1.0, delayed)

    def relaxed(self) -> Contact:
        """The contact after a long time, as what moves slowly meets it."""
        base = self.contact
        if isinstance(base, ElasticContact):
            return dataclasses.replace(base, modulus=self.ratio * base.modulus)
        assert isinstance(base, SmoothContact)
        assert isinstance(base.law, Hertz)
        law = dataclasses.replace(base.law, modulus=self.ratio * base.law.modulus)
        return dataclasses.replace(base, law=law)
