"""First impacts of single bodies on summits at random places, beside their mean."""

from __future__ import annotations

import os
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ._jax import jax, jnp
from .contact.asperity_table import AsperityTable, asperity_table
from .contact.rigid import RigidContact
from .dynamics import Body
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

REBOUNDS = 20
"""Rebounds of a single body that are followed until it is captured."""

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
    first = bodies.impacts(launches, stop)
    most = min(REBOUNDS, problem.inputs.tolerance.max_impacts - 1)
    report(0.9, "rebounds of single bodies")
    rebounds, flight = _until_captured(bodies, body, first, most, stop)
    lost: dict[str, np.ndarray] = {}
    for name, energy in zip(bodies.mechanisms, np.asarray(first.lost).T, strict=True):
        lost[name] = lost.get(name, 0.0) + energy
    values = {name: np.asarray(getattr(first, name)) for name in KINDS if hasattr(first, name)}
    values |= {"rebounds": rebounds, "flight_time": flight}
    return Realisations(np.asarray(first.captured), values, lost)


def _until_captured(
    bodies: SingleBodies,
    body: Body,
    first: SingleImpact,
    most: int,
    stop: threading.Event | None,
) -> tuple[np.ndarray, np.ndarray]:
    """Rebounds of each body before it is captured, and the time [s] that they take in flight.

    Infinite where that takes more than ``most`` rebounds, and without weight where it leaves. A
    rigid body falls on the same summits each time, and all their bonds are broken while it flies.
    """
    rebounds = np.where(first.captured, 0.0, np.inf)
    flight = np.zeros(rebounds.shape)
    weight, found = float(body.weight), first
    for made in range(1, most + 1 if weight > 0.0 else 1):
        flying = np.isinf(rebounds)
        if not np.any(flying):
            break
        kinetic = np.asarray(found.impact_energy) * np.asarray(found.restitution) ** 2
        speed = np.sqrt(2.0 * kinetic / float(body.mass))
        flight += np.where(flying, 2.0 * speed * float(body.mass) / weight, 0.0)
        # Those that were captured fall once more with what they had: they no longer count.
        kinetic = np.where(flying, kinetic, found.impact_energy)
        launches = Launch(kinetic, np.full(kinetic.shape, np.inf), np.full(kinetic.shape, weight))
        found = bodies.impacts(launches, stop, pulls=False)
        rebounds[flying & np.asarray(found.captured)] = made
    return rebounds, np.where(np.isinf(rebounds), np.inf, flight)
