"""Force between two bodies: laws, roughness and bulk put together."""

from .base import Contact, State
from .elastic import ElasticContact, RingMemory
from .rigid import RigidContact
from .smooth import SmoothContact

__all__ = ["Contact", "ElasticContact", "RigidContact", "RingMemory", "SmoothContact", "State"]
