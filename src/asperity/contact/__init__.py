"""Force between two bodies: laws, heights, profile and half-space put together.

`contact`: what the equation of motion asks of every contact. `profile`: shapes of bodies.
`smooth`, `smooth_plastic`: one law for the whole body. `rough`: a rough body. `rigid`,
`rigid_plastic`: without bulk deformation. `elastic`: the same on a half-space; `equilibrium`
solves one separation, `continuation` follows a path of them, `ring_error` estimates the mesh error.
`viscoelastic`, `delayed_formation`: contacts whose force depends on time.
`published_conjunction`: the publication's own. `resolution`: panel lengths of the force curves.
`asperity_work`, `asperity_table`: energies of one asperity.
`coupled_summits`: some on a half-space.
`scanning_curve`: separations along a scanning curve. `ring_reversals`: few that stand for all.

A contact is immutable; its memory is passed in and out.
"""

from .contact import Contact, State, YieldingContact, interaction_range_of
from .elastic import ElasticContact
from .published_conjunction import PublishedContact
from .rigid import RigidContact
from .rigid_plastic import RigidPlasticContact
from .smooth import SmoothContact
from .smooth_plastic import SmoothPlasticContact

__all__ = [
    "Contact",
    "ElasticContact",
    "PublishedContact",
    "RigidContact",
    "RigidPlasticContact",
    "SmoothContact",
    "SmoothPlasticContact",
    "State",
    "YieldingContact",
    "interaction_range_of",
]
