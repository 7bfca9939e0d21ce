"""Case files: the schema and its reading and writing; strings of a case live in this room alone."""

from asperity.case.asperities import Asperities
from asperity.case.bodies import Body, Counterface, Material
from asperity.case.forces import Adhesion, Capillary
from asperity.case.publication import Publication
from asperity.case.reading import BUILTINS, FIRST, SIZE_LIMIT, builtin, load, load_file, template
from asperity.case.roughness import Roughness
from asperity.case.running import Impact, Numerics, Output
from asperity.case.schema import Case

__all__ = [
    "BUILTINS",
    "FIRST",
    "SIZE_LIMIT",
    "Adhesion",
    "Asperities",
    "Body",
    "Capillary",
    "Case",
    "Counterface",
    "Impact",
    "Material",
    "Numerics",
    "Output",
    "Publication",
    "Roughness",
    "builtin",
    "load",
    "load_file",
    "template",
]
