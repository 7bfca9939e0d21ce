"""Distributions of asperity heights above their mean plane: Gaussian, or as measured."""

from .distribution import Gaussian, Heights
from .measured_heights import Sampled, Spread, spread_of
from .panel_length import Fineness

__all__ = ["Fineness", "Gaussian", "Heights", "Sampled", "Spread", "spread_of"]
