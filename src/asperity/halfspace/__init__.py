"""Displacement of an elastic or viscoelastic half-space under a pressure.

`ring_displacement`: axisymmetric displacement by rings of constant pressure (Boussinesq).
`viscoelastic_paraboloid`: a paraboloid pressed into a standard linear solid, for any history.
`hertz_influence`: displacement beside a Hertz contact.
`residual_indentation`: what such a half-space still shows where it was pressed.

Nothing here knows where the pressure comes from.
"""

from .hertz_influence import hertz_influence
from .ring_displacement import (
    PANEL_COUNT,
    Rings,
    finer_rings,
    mesh_on,
    ring_mesh,
    rings_of_mesh,
)

__all__ = [
    "PANEL_COUNT",
    "Rings",
    "finer_rings",
    "hertz_influence",
    "mesh_on",
    "ring_mesh",
    "rings_of_mesh",
]
