"""Rough surfaces: distributions of asperity heights."""

from .heights import Gaussian, Heights

__all__ = ["Gaussian", "Heights"]
