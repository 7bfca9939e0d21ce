"""First impacts of single bodies, each on summits of its own, beside the mean over all.

`placement`: the summits of a case. `launching`: bodies on them, launched together. `realising`: the
single bodies of a case, as a result holds them.
"""

from .launching import SingleBodies
from .realising import realise

__all__ = ["SingleBodies", "realise"]
