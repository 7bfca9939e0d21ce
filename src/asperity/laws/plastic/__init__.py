"""One asperity that yields, against a plane: one law a file."""

from .adhesive import AdhesiveThorntonNing
from .base import PlasticContact
from .jackson_green import JacksonGreen
from .kogut_etsion import KogutEtsion
from .thornton_ning import ThorntonNing

__all__ = [
    "AdhesiveThorntonNing",
    "JacksonGreen",
    "KogutEtsion",
    "PlasticContact",
    "ThorntonNing",
]
