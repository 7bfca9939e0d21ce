"""Rough surfaces: distributions of asperity heights."""

from .fineness import Fineness
from .heights import Gaussian, Heights
from .sampled import Sampled, Spread, spread_of

__all__ = ["Fineness", "Gaussian", "Heights", "Sampled", "Spread", "spread_of"]
