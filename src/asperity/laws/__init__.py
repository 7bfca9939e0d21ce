"""One asperity, or one smooth body, against a plane: one law a file."""

from .base import Law, Powers, Sum, TruncatedPower
from .bradley import Bradley
from .dmt import Dmt
from .hertz import Hertz
from .jkr import Jkr
from .meniscus import ByContact, ByKelvinGap, Meniscus
from .published import HeightFunctions, PublishedPressure

__all__ = [
    "Bradley",
    "ByContact",
    "ByKelvinGap",
    "Dmt",
    "HeightFunctions",
    "Hertz",
    "Jkr",
    "Law",
    "Meniscus",
    "Powers",
    "PublishedPressure",
    "Sum",
    "TruncatedPower",
]
