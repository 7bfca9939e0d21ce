"""One asperity, or one smooth sphere, against a plane: one law a file.

`law`: what a law is, two branches of force and energy over the gap, and how laws add up.
`hertz`, `bradley`, `dmt`, `jkr`, `maugis`, `lennard_jones`: elastic contact and dry adhesion;
`adhesive_zone` solves the Maugis-Dugdale equations. `liquid`: menisci. `plastic`: contacts that
yield. `published_pressures`: the publication's equations as printed.
`testing`: `check_law`, which proves of any law that force = -d(energy)/d(gap) and that no bond
gains energy; a law from outside the package is tested by it too.

A new law is a new file, its tests, and its line in this list. A law knows no heights, no body
and no case.
"""

from .bradley import Bradley
from .dmt import Dmt
from .hertz import Hertz
from .jkr import Jkr
from .law import Law, Powers, Sum, TruncatedPower
from .lennard_jones import LennardJones
from .liquid.constant_volume import ConstantVolume
from .liquid.kelvin_filling import KelvinFilling
from .liquid.meniscus import ByContact, ByKelvinGap, Meniscus
from .maugis import Maugis
from .published_pressures import HeightFunctions, PublishedPressure

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
    "LennardJones",
    "Maugis",
    "Meniscus",
    "Powers",
    "PublishedPressure",
    "Sum",
    "TruncatedPower",
]
