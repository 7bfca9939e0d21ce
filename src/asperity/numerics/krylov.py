"""Linear systems: by which rings settle, and of derivatives of what is solved."""

from __future__ import annotations

import numpy as np
from equinox.internal import unvmap_any
from jax.scipy.sparse.linalg import bicgstab

from .._jax import jax, jnp

CLOSE = 1e-6
"""What is left of a system, over its right side: then Newton's method gains all that it can."""

_MOST = 20  # steps, which take as long as factors


def nearly_solved(rows: np.ndarray, slope: jax.Array, right: jax.Array) -> jax.Array:
    """``x`` with ``x - rows @ (slope * x)`` equal to ``right`` to :data:`CLOSE` of its norm.

    The displacement of a half-space smooths what presses it, so that the matrix is the unit but
    for a few directions: a handful of steps, each of two products, where factors cost as much
    as fifty products. Where the bulk is so soft that there are many, it is factorized.
    """

    def pushed(x: jax.Array) -> jax.Array:
        return x - rows @ (slope * x)

    answer, _ = bicgstab(pushed, right, tol=CLOSE, maxiter=_MOST)
    left = pushed(answer) - right
    lost = ~(left @ left <= 4.0 * CLOSE**2 * (right @ right))

    def factorized() -> jax.Array:
        exact = dense_solve(jnp.eye(len(slope)) - rows * slope, right)
        return jnp.where(lost, exact, answer)

    # In a batch none is factorized where all have arrived.
    return jax.lax.cond(unvmap_any(lost), factorized, lambda: answer)


@jax.custom_batching.sequential_vmap
def dense_solve(matrix: jax.Array, right: jax.Array) -> jax.Array:
    """Solution of a linear system, one of a batch after the other.

    XLA's batched calls are slower within a loop.
    """
    return jnp.linalg.solve(matrix, right[:, None])[:, 0]


def implicit_solve(matrix: jax.Array, right: jax.Array) -> jax.Array:
    """The same where a derivative asks for it, forward or in reverse."""
    return jax.lax.custom_linear_solve(
        lambda x: matrix @ x,
        right,
        lambda _, right: dense_solve(matrix, right),
        lambda _, right: dense_solve(matrix.T, right),
    )
