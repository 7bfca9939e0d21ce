"""Distributions of asperity heights above their mean plane: Gaussian, or as measured."""

from .distribution import Gaussian, Heights
from .measured_heights import Sampled, Spread, spread_of
from .panel_length import PanelLengths

__all__ = ["Gaussian", "Heights", "PanelLengths", "Sampled", "Spread", "spread_of"]
