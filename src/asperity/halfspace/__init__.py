"""Displacement of an elastic half-space under pressure."""

from .rings import Rings, ring_mesh

__all__ = ["Rings", "ring_mesh"]
