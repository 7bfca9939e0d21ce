r"""Axisymmetric displacement of an elastic half-space, by rings of pressure.

The normal displacement under a pressure p(s) is

.. math:: u(r) = \frac{4}{\pi E^*}\int_0^\infty \frac{s\,p(s)}{r+s}
          K\!\left(\frac{4rs}{(r+s)^2}\right)\mathrm{d}s

(Johnson 1985, eq. 3.96a with the ring integrated), K the complete elliptic integral of
parameter m. Pressure is a polynomial on each panel of a mesh that is fixed in units of a
length, dense near 1, where the edge of a Hertz-like contact is put; the logarithm of the
kernel is integrated exactly enough not to show. One dimensionless matrix then serves every
contact.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import ceil
from typing import NamedTuple

import numpy as np
from scipy.special import ellipkm1

_PANELS = np.array([0.0, 0.6, 0.85, 0.954, 1.0, 1.057, 1.2, 1.7, 3.5])
PANEL_COUNT = len(_PANELS) - 1


class Rings(NamedTuple):
    """A mesh of rings in units of one length.

    Attributes
    ----------
    radius
        Radii of the rings, shape (n,).
    area
        Their areas, such that sum(area * p) is the load, shape (n,).
    compliance
        Displacement at ring i per pressure at ring j, times E*, shape (n, n).
    end
        Radius where the mesh ends.
    axis
        Weights that give an even function of the radius at the axis from its values, (n,).
    """

    radius: np.ndarray
    area: np.ndarray
    compliance: np.ndarray
    end: float
    axis: np.ndarray


def rings_of_mesh(rings: int) -> int:
    """Rings of the mesh that has at least so many: an equal number on each of its 8 panels."""
    return PANEL_COUNT * max(1, ceil(rings / PANEL_COUNT))


@cache
def ring_mesh(rings: int) -> Rings:
    """The mesh with at least ``rings`` rings, as :func:`rings_of_mesh` counts them."""
    return mesh_on(_PANELS, rings_of_mesh(rings) // PANEL_COUNT)


def mesh_on(panels: np.ndarray, order: int) -> Rings:
    """The mesh with ``order`` rings on each of the panels that end at ascending radii, from 0."""
    node, weight = np.polynomial.legendre.leggauss(order)
    low, high = panels[:-1, None], panels[1:, None]
    radius = (0.5 * (low + high) + 0.5 * (high - low) * node).ravel()
    area = 2.0 * np.pi * radius * (0.5 * (high - low) * weight).ravel()
    matrix = np.concatenate(
        [_panel_columns(radius, pair, node) for pair in pairwise(panels)], axis=1
    )
    axis = np.zeros_like(radius)
    axis[:order] = _lagrange(radius[:order] ** 2, np.zeros(1))[:, 0]
    return Rings(radius, area, matrix, float(panels[-1]), axis)


def finer_rings(rings: int, more: int) -> np.ndarray:
    """From values at the rings of one mesh to those at another's, shape (more, rings)."""
    node, fine = (
        np.polynomial.legendre.leggauss(rings_of_mesh(count) // PANEL_COUNT)[0]
        for count in (rings, more)
    )
    return np.kron(np.eye(PANEL_COUNT), _lagrange(node, fine).T)


def _panel_columns(targets: np.ndarray, panel: tuple[float, float], node: np.ndarray) -> np.ndarray:
    """Displacement at all targets for each Lagrange polynomial of one panel."""
    low, high = panel
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    out = np.empty((len(targets), len(node)))
    far = np.abs(targets - middle) > 3.0 * half
    s, weight = middle + half * _GAUSS[0], half * _GAUSS[1]
    basis = _lagrange(node, _GAUSS[0])
    out[far] = (weight * _kernel(targets[far, None], s)) @ basis.T
    for i in np.flatnonzero(~far):
        s, weight = _graded(low, high, targets[i])
        out[i] = _lagrange(node, (s - middle) / half) @ (weight * _kernel(targets[i], s))
    return out


def _kernel(r: float | np.ndarray, s: np.ndarray) -> np.ndarray:
    return 4.0 / np.pi * s / (r + s) * ellipkm1(((r - s) / (r + s)) ** 2)


_GAUSS = np.polynomial.legendre.leggauss(14)


def _graded(low: float, high: float, target: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on [low, high], graded towards a logarithm at ``target``."""
    nearest = min(max(target, low), high)
    width = high - low
    steps = width * 0.2 ** np.arange(0, 14)
    ends = np.concatenate([[low, nearest, high], nearest - steps, nearest + steps])
    ends = np.unique(np.clip(ends, low, high))
    half = 0.5 * np.diff(ends)[:, None]
    s = (0.5 * (ends[:-1] + ends[1:]))[:, None] + half * _GAUSS[0]
    return s.ravel(), (half * _GAUSS[1]).ravel()


def _lagrange(node: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Lagrange polynomials on ``node`` at ``x``, shape (node, x)."""
    gap = node[:, None] - node[None, :] + np.eye(len(node))
    scale = np.prod(gap, axis=1)
    away = x[None, :] - node[:, None]
    return np.array(
        [np.prod(np.delete(away, k, axis=0), axis=0) / scale[k] for k in range(len(node))]
    )
