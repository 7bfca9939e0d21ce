"""Displacement of an elastic half-space under pressure."""

from .rings import PANEL_COUNT, Rings, finer_rings, ring_mesh, rings_of_mesh

__all__ = ["PANEL_COUNT", "Rings", "finer_rings", "ring_mesh", "rings_of_mesh"]
