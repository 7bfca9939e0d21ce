"""Force between two bodies: laws, roughness and bulk put together."""

from .base import Contact, State
from .elastic import ElasticContact, RingMemory
from .published import PublishedContact
from .rigid import RigidContact
from .smooth import SmoothContact
from .smooth_plastic import SmoothPlasticContact

__all__ = [
    "Contact",
    "ElasticContact",
    "PublishedContact",
    "RigidContact",
    "RingMemory",
    "SmoothContact",
    "SmoothPlasticContact",
    "State",
]
