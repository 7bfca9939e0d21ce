"""First impacts of single bodies on summits at random places, beside their mean."""

from __future__ import annotations

import os
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ._jax import jax, jnp
from .contact.asperity_table import AsperityTable, asperity_table
from .contact.rigid import RigidContact
from .dynamics.problem import Problem
from .dynamics.single_impact import Launch, SingleImpact, single_impacts
from .errors import InputError, SimulationError
from .integration import Report, silently
from .interface.interface import Interface
from .interface.summit_field import WIDTH, SummitField
from .laws.law import as_float64, terms
from .results.conversion import Solution
from .results.realisations import KINDS, Realisations
from .surfaces.heights.distribution import Gaussian

MOST_SUMMITS = 2048
"""Summits under one body that are followed one by one."""

_FIRST = 16  # summits that are tried, and twice as many until all within reach are among them
_DEEPER = 4.0  # times the energy at the release, to which the table of an asperity reaches


class SingleBodies:
    """Bodies that fall on summits of their own.

    Parameters
    ----------
    problem
        A rigid contact with Gaussian heights and one tip radius, and the body.
    seed
        Of the draw.

    Raises
    ------
    InputError
        Where the contact is another, or has no asperity within reach.
    """

    def __init__(self, problem: Problem, seed: int) -> None:
        contact = problem.contact
        assert isinstance(contact, RigidContact)
        interface = contact.interface
        assert isinstance(interface, Interface)
        assert isinstance(interface.heights, Gaussian)
        self._law, heights = interface.law, interface.heights
        self.mechanisms = tuple(one.mechanism for one in terms(self._law) if one.hysteretic)
        self.field = SummitField(
            float(contact.shape.radius), float(interface.density),
            float(heights.rms_height), float(heights.mean_height),
        )  # fmt: skip
        self._seed, self._count = seed, _FIRST
        self._table: tuple[float, AsperityTable] | None = None

    def impacts(
        self, launches: Launch, stop: threading.Event | None = None, *, pulls: bool = True
    ) -> SingleImpact:
        """Their first impacts, each on the summits of its number.

        Parameters
        ----------
        launches
            How they come, arrays of shape (bodies,).
        stop
            Set from another thread, it ends them early.
        pulls
            Whether their pull-off forces are wanted too, which takes twice as long.

        Returns
        -------
        Arrays of shape (bodies, ...).

        Raises
        ------
        InputError
            If more than `MOST_SUMMITS` stand within reach of one.
        SimulationError
            If they were stopped.
        """
        bodies = np.size(launches.kinetic)
        table = self._reaching(launches)

        def block(number: int) -> SingleImpact:
            if stop is not None and stop.is_set():
                raise SimulationError("stopped before all first impacts of single bodies")
            # The last block is filled up with bodies that are left out again.
            some = np.minimum(np.arange(WIDTH) + number * WIDTH, bodies - 1)
            chosen = Launch(*(np.asarray(x)[some] for x in launches))
            return self._block(table, chosen, number, pulls)

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            found = list(pool.map(block, range(-(-bodies // WIDTH))))
        # Bodies that follow are likely to meet about as many.
        most = int(np.median([np.max(some.within_reach) for some in found]))
        self._count = max(_FIRST, 1 << most.bit_length())
        joined: SingleImpact = jax.tree_util.tree_map(
            lambda *leaves: np.concatenate(leaves)[:bodies], *found
        )
        return joined

    def refuse_many(self, launch: Launch, turn: float) -> None:
        """Refuse a body that has too many summits in reach of it, at once.

        Parameters
        ----------
        launch
            How it comes.
        turn
            Separation [m] at which it turns, or at which the mean over all does.

        Raises
        ------
        InputError
            With their number.
        """
        self._refuse_many(self._reaching(launch), turn)

    def _reaching(self, launches: Launch) -> AsperityTable:
        """The table of an asperity, deep enough for the energy of such bodies."""
        fall = np.where(np.isfinite(launches.release), launches.release, 0.0)
        energy = _DEEPER * float(np.max(launches.kinetic + launches.weight * np.abs(fall)))
        if self._table is None or self._table[0] < energy:
            self._table = energy, asperity_table(self._law, as_float64(energy))
        return self._table[1]

    def _block(
        self, table: AsperityTable, launches: Launch, number: int, pulls: bool
    ) -> SingleImpact:
        """WIDTH bodies, each with as many summits as are in reach of the one that meets most."""
        count = self._count
        while True:
            offsets = self.field.offsets(self._seed, number, count)
            found = single_impacts(table, launches, jnp.asarray(offsets), pulls)
            most = int(np.max(found.within_reach))
            if most < count:
                return found
            self._refuse_many(table, float(np.min(found.closest_approach)))
            count *= 2

    def _refuse_many(self, table: AsperityTable, turn: float) -> None:
        """Refuse a body that has too many summits within reach where it turns [m]."""
        reach = float(table.reach)
        expected = float(self.field.expected_above(turn - reach))
        if expected > MOST_SUMMITS:
            raise InputError(
                f"`placement` = 'random' is for up to {MOST_SUMMITS} summits under a body; some "
                f"{expected:.3g} lie within the {reach * 1e9:.3g} nm that their forces reach: take "
                "'mean'",
                key="roughness.placement",
            )


def realised(
    problem: Problem,
    mean: Solution,
    report: Report = silently,
    stop: threading.Event | None = None,
) -> Realisations:
    """First impacts of the single bodies of a case.

    Parameters
    ----------
    problem
        What was built from a case with ``placement = "random"``.
    mean
        Its motion under the mean over all bodies.
    report, stop
        As for :func:`asperity.integration.integrate`.

    Raises
    ------
    InputError, SimulationError
        As :meth:`SingleBodies.impacts`.
    """
    placed, body = problem.inputs.placement, mean.body or problem.body
    assert placed is not None
    report(0.9, f"{placed.realisations} single bodies")
    bodies = SingleBodies(problem, placed.seed)
    launch = Launch(*(np.asarray(x) for x in (body.kinetic, body.release, body.weight)))
    bodies.refuse_many(launch, float(np.asarray(mean.motion.impacts.closest_approach)[0]))
    launches = Launch(*(np.full(placed.realisations, value) for value in launch))
    return realisations_of(bodies, bodies.impacts(launches, stop))


def realisations_of(bodies: SingleBodies, found: SingleImpact) -> Realisations:
    """Their first impacts, as a user reads them."""
    lost: dict[str, np.ndarray] = {}
    for name, energy in zip(bodies.mechanisms, np.asarray(found.lost).T, strict=True):
        lost[name] = lost.get(name, 0.0) + energy
    values = {name: np.asarray(getattr(found, name)) for name in KINDS}
    return Realisations(np.asarray(found.captured), values, lost)
