"""One asperity, or one smooth body, against a plane: one law a file."""

from .base import Law, Powers, Sum, TruncatedPower
from .bradley import Bradley
from .constant_volume import ConstantVolume
from .dmt import Dmt
from .filling import KelvinFilling
from .hertz import Hertz
from .jkr import Jkr
from .maugis import Maugis
from .meniscus import ByContact, ByKelvinGap, Meniscus
from .published import HeightFunctions, PublishedPressure

__all__ = [
    "Bradley",
    "ByContact",
    "ByKelvinGap",
    "ConstantVolume",
    "Dmt",
    "HeightFunctions",
    "Hertz",
    "Jkr",
    "KelvinFilling",
    "Law",
    "Maugis",
    "Meniscus",
    "Powers",
    "PublishedPressure",
    "Sum",
    "TruncatedPower",
]
