"""Solids, liquids and gases, each number of the catalogue with its source.

`solids`: elastic constants, density, hardness, yield strength, and the contact modulus E*.
`liquids`: surface tension, molar volume, and the Kelvin radius of a meniscus.
`gases`: viscosity, mean free path and slip length.

The catalogue is data: `solids.toml` and `adhesion.toml` (measured works of adhesion). To add a
solid, add its entry with a source for every number; no code changes. All values are SI.
"""

from asperity.materials.gases import GASES, Gas
from asperity.materials.liquids import LIQUIDS, Liquid, kelvin_radius
from asperity.materials.solids import ADHESION, SOLIDS, Adhesion, Solid, contact_modulus

__all__ = [
    "ADHESION",
    "GASES",
    "LIQUIDS",
    "SOLIDS",
    "Adhesion",
    "Gas",
    "Liquid",
    "Solid",
    "contact_modulus",
    "kelvin_radius",
]
