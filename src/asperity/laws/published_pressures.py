"""The publication's mean pressures as it prints them, apart from the physics of this package.

Nothing here is a law of one asperity: these are its eqs. 5-17, over a conjunction that ends at
a separation of a few rms heights. What is wrong with them is in ``docs/audit``.
"""

from __future__ import annotations

from math import pi

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..numerics.height_integrals import height_integral, height_integrals, normal_density
from .law import Real, quantity

EQ_10 = (0.5, -0.3912, -0.03592, 0.1275, -0.048, 0.006278, 0.00003763, -0.00004965)
"""Coefficients of F_0 as printed in eq. 10, of rising powers."""

EQ_17 = (0.43, -0.6167, 0.3215, -0.04654, -0.02193, 0.01106, -0.001913, 0.0001217)
"""Coefficients of F_3/2 as printed in eq. 17, of rising powers."""


FINE = 0.05
"""Width of a band, in rms heights, below which Euler and Maclaurin's sum is exact to 1e-13."""


class HeightFunctions(eqx.Module):
    """The two functions of the Stribeck parameter, lambda' = h/sigma, that everything rests on.

    Parameters
    ----------
    printed
        0 for the integrals themselves, eq. 7; 1 for the polynomials as printed, eqs. 10 and 17,
        which are fits for lambda' from 0 to about 3. Traced, so that both are one program.
    """

    printed: Real = quantity(0.0)

    def touching(self, reduced: jax.Array) -> jax.Array:
        """F_0, the share of asperities that touch."""
        return self._either(EQ_10, height_integral(0.0, reduced), reduced)

    def contact(self, reduced: jax.Array) -> jax.Array:
        """F_3/2."""
        return self._either(EQ_17, height_integral(1.5, reduced), reduced)

    def _either(self, rising: tuple[float, ...], exact: jax.Array, reduced: jax.Array) -> jax.Array:
        polynomial = jnp.polyval(jnp.asarray(rising[::-1]), reduced)
        return jnp.where(self.printed > 0.0, polynomial, exact)


class PublishedPressure(eqx.Module):
    """Mean pressures of contact, dry adhesion and menisci in a conjunction that ends.

    Parameters
    ----------
    functions
        F_0 and F_3/2: exact, or as printed.
    bands
        Number N_s of the bands of eq. 13 (static).
    interaction_range
        2 r_k cos(theta) [m], the gap at which a meniscus ends; None where it never does, at a
        relative humidity of 1.
    fine
        Whether bands are so narrow (:data:`FINE`) that their sum is taken as an integral and its
        corrections, in place of term by term (static).
    density
        Asperities per area N [1/m^2].
    radius
        Radius beta of a summit [m].
    rms_height
        Standard deviation sigma of their heights [m].
    modulus
        Contact modulus E* [Pa].
    work_of_adhesion
        w_a [J/m^2]; 0 for none.
    tension
        gamma cos(theta) times the factor on the menisci [N/m]; 0 for none.
    edge
        Stribeck parameter at which the conjunction ends: beyond it nothing acts.

    Notes
    -----
    All methods take separations h [m] of any shape and give pressures [Pa].
    """

    functions: HeightFunctions
    bands: int = eqx.field(static=True)
    interaction_range: Real | None
    density: Real = quantity()
    radius: Real = quantity()
    rms_height: Real = quantity()
    modulus: Real = quantity()
    work_of_adhesion: Real = quantity()
    tension: Real = quantity()
    edge: Real = quantity()
    fine: bool = eqx.field(static=True, default=False)

    @property
    def end(self) -> jax.Array:
        """Separation [m] at which the conjunction ends."""
        return self.edge * self.rms_height

    @property
    def kinks(self) -> tuple[jax.Array, ...]:
        """Separations [m] within the conjunction at which a pressure changes its form."""
        mean_plane = jnp.zeros(())
        return (
            (mean_plane,)
            if self.interaction_range is None
            else (mean_plane, jnp.asarray(self.interaction_range))
        )

    def contact(self, separation: jax.Array) -> jax.Array:
        """Pressure of elastic contact, positive apart: eq. 16 per area."""
        scale = 4.0 / 3.0 * self.density * jnp.sqrt(self.radius) * self.rms_height**1.5
        share = self.functions.contact(separation / self.rms_height)
        return self._inside(separation, self.modulus * scale * share)

    def adhesion(self, separation: jax.Array) -> jax.Array:
        """Dry adhesion, a pull being positive: eq. 9 per area."""
        scale = 2.0 * pi * self.density * self.radius * self.work_of_adhesion
        return self._inside(separation, scale * self._touching(separation))

    def capillary(self, separation: jax.Array) -> jax.Array:
        """Menisci of the asperities that do not touch, a pull being positive: eqs. 13-15 per area.

        Without the factor 1/(sqrt(2 pi) sigma) of eq. 14, which F_0 holds already. Eq. 12 as
        printed pushes beyond its range; here the bands end there.
        """
        scale = 4.0 * pi * self.density * self.radius * self.tension
        above_mean = jnp.maximum(separation, 0.0)
        if self.interaction_range is None:
            # Every meniscus pulls fully: the sum of eq. 15 telescopes, whatever the bands.
            sum_ = self._touching(jnp.zeros(())) - self._touching(above_mean)
        else:
            sum_ = self._banded(above_mean, jnp.asarray(self.interaction_range))
        return self._inside(separation, scale * sum_)

    def strongest_pull(self, separation: jax.Array) -> jax.Array:
        """Adhesion, and menisci that all pull as they do where they form: no pull is more."""
        scale = 4.0 * pi * self.density * self.radius * self.tension
        above_mean = jnp.maximum(separation, 0.0)
        near = (
            0.0
            if self.interaction_range is None
            else jnp.maximum(above_mean - self.interaction_range, 0.0)
        )
        bridged = self._touching(jnp.asarray(near)) - self._touching(above_mean)
        return self.adhesion(separation) + self._inside(separation, scale * bridged)

    def touching(self, separation: jax.Array) -> jax.Array:
        """Asperities that touch [1/m^2], eq. 8 with the exact F_0."""
        share = height_integral(0.0, separation / self.rms_height)
        return self._inside(separation, self.density * share)

    def _touching(self, separation: jax.Array) -> jax.Array:
        return self.functions.touching(separation / self.rms_height)

    def _inside(self, separation: jax.Array, value: jax.Array) -> jax.Array:
        return jnp.where(separation < self.end, value, 0.0)

    def _banded(self, separation: jax.Array, interaction_range: jax.Array) -> jax.Array:
        """Sum over the bands of their share of asperities times the force at their far gap."""
        span = jnp.minimum(separation, interaction_range)
        if self.fine:
            return self._summed(separation, span, interaction_range)
        gaps = span[..., None] * (np.arange(self.bands + 1.0) / self.bands)
        taller = self._touching(separation[..., None] - gaps)
        force = 1.0 - gaps[..., 1:] / interaction_range
        return jnp.sum(jnp.diff(taller, axis=-1) * force, axis=-1)

    def _summed(
        self, separation: jax.Array, span: jax.Array, interaction_range: jax.Array
    ) -> jax.Array:
        """The same sum by parts: shares at both ends, and Euler and Maclaurin's formula between.

        With the exact F_0, in heights over their rms: its integral is F_1, its derivatives are
        those of the Gaussian. The next term is the width of a band to the power 7 over 1.2e6.
        """
        near, far = separation / self.rms_height, (separation - span) / self.rms_height
        step = span / (self.bands * self.rms_height)
        shares = height_integrals((0.0, 0.0), jnp.stack([near, far]))
        # F_1 is the density less the separation times F_0.
        integral = normal_density(far) - far * shares[1] - normal_density(near) + near * shares[0]
        between = integral - 0.5 * step * (shares[0] + shares[1])
        for power, factor, order in (
            (2, 1.0 / 12.0, 0),
            (4, -1.0 / 720.0, 2),
            (6, 1.0 / 30240.0, 4),
        ):
            rise = _density_derivative(order, far) - _density_derivative(order, near)
            between = between + factor * step**power * rise
        # Each band pulls with its far gap's force, which falls by this from band to band.
        fall = span / (self.bands * interaction_range)
        ends = shares[1] * (1.0 - span / interaction_range) - shares[0] * (1.0 - fall)
        safe = jnp.where(step > 0.0, step, 1.0)
        return ends + fall * jnp.where(step > 0.0, between / safe, 0.0)


def _density_derivative(order: int, x: jax.Array) -> jax.Array:
    """Derivative of the Gaussian density, of order 0, 2 or 4."""
    square = x * x
    hermite = {0: jnp.ones_like(x), 2: square - 1.0, 4: (square - 6.0) * square + 3.0}[order]
    return hermite * normal_density(x)
