"""One asperity that yields, against a plane: one law a file."""

from .adhesive_sphere import AdhesiveThorntonNing
from .jackson_green import JacksonGreen
from .kogut_etsion import KogutEtsion
from .plastic_contact import PlasticContact
from .thornton_ning import ThorntonNing

__all__ = [
    "AdhesiveThorntonNing",
    "JacksonGreen",
    "KogutEtsion",
    "PlasticContact",
    "ThorntonNing",
]
