"""Integrals of cubic B-splines against powers, for heights that are laid on even nodes."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.interpolate import BSpline
from scipy.special import roots_jacobi


@cache
def kernels(nodes: int, orders: tuple[float, ...]) -> np.ndarray:
    """Kernels of orders and of their first two derivatives, shape (orders, 3, places)."""
    return np.array([[_kernel(order, k, nodes) for k in range(3)] for order in orders])


def _kernel(order: float, derivative: int, nodes: int) -> np.ndarray:
    """Integral of the spline's derivative times max(y + q, 0)^order, q from -nodes - 2 to 2 nodes.

    B(y - a) moves with a, so that derivatives in the place a are those of B. At order -1 the
    derivative itself.
    """
    q = np.arange(-nodes - 2, 2 * nodes + 1)
    if order == -1.0:
        return _spline(-q.astype(float), derivative)
    out = np.zeros(q.size)
    for low in range(-2, 2):
        start = low + q
        begun, begins = start > 0, start == 0
        # Where the power begins it is singular: Jacobi's weight takes it there.
        for chosen, power in ((begun, 0.0), (begins, order)):
            x, weight = roots_jacobi(24, 0.0, power)
            u = 0.5 * (x + 1.0)
            rest = (start[begun, None] + u) ** order if chosen is begun else 1.0
            parts = rest * weight * _spline(low + u, derivative) * 0.5 ** (power + 1.0)
            out[chosen] += np.sum(parts, axis=-1)
    return out


def _spline(y: np.ndarray, derivative: int = 0) -> np.ndarray:
    """Cubic B-spline of unit area on [-2, 2], or its first or second derivative."""
    spline = BSpline.basis_element(np.arange(-2.0, 3.0), extrapolate=False)
    return np.nan_to_num(spline(y, derivative))


@cache
def kernel_rule() -> tuple[np.ndarray, np.ndarray]:
    """Five places and weights with the moments of the cubic B-spline up to the ninth."""
    moment = [2.0 * sum(_half_moment(k)) if k % 2 == 0 else 0.0 for k in range(10)]
    hankel = np.array([[moment[i + j] for j in range(5)] for i in range(5)])
    last = np.array([moment[i + 5] for i in range(5)])
    places = np.sort(np.roots(np.append(-np.linalg.solve(hankel, last), 1.0)[::-1]).real)
    weights = np.linalg.solve(np.vander(places, 5, increasing=True).T, moment[:5])
    return places, weights


def _half_moment(k: int) -> tuple[float, float]:
    """Integrals of y^k B(y) over [0, 1] and [1, 2]."""
    x, w = np.polynomial.legendre.leggauss(12)
    u = 0.5 * (x + 1.0)
    return tuple(float(np.sum(0.5 * w * (a + u) ** k * _spline(a + u))) for a in (0.0, 1.0))  # type: ignore[return-value]
