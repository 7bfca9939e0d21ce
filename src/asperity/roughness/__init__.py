"""Rough surfaces: distributions of asperity heights."""

from .heights import Gaussian, Heights
from .sampled import Sampled, Spread, spread_of

__all__ = ["Gaussian", "Heights", "Sampled", "Spread", "spread_of"]
