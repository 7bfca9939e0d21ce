"""First impacts of single bodies, each on summits of its own, beside the mean over all."""

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
from .inputs import Inputs
from .integration import Report, silently
from .interface.radius_classes import members
from .interface.summit_field import (
    WIDTH,
    GaussianField,
    MeasuredField,
    SampledField,
    SummitField,
)
from .laws.law import Law, as_float64, terms
from .model import asperity_law
from .results.conversion import Solution
from .results.realisations import KINDS, Realisations

MOST_SUMMITS = 2048
"""Summits under one body that are followed one by one."""

REBOUNDS = 20
"""Rebounds of a single body that are followed until it is captured."""

_BELOW = 5.0  # rms heights that a body may turn below the mean over all
_FIRST = 16  # summits that are tried, and twice as many until all within reach are among them
_DEEPER = 2.0  # times the energy at the release, to which the table of an asperity reaches


class SingleBodies:
    """Bodies that fall on summits of their own.

    Parameters
    ----------
    problem
        What was built from a case with single bodies.
    turn
        Separation [m] at which the mean over all bodies turns.

    Raises
    ------
    InputError
        If a map is too small for bodies that turn there.
    """

    def __init__(self, problem: Problem, turn: float) -> None:
        inputs, contact = problem.inputs, problem.contact
        assert inputs.placement is not None
        assert isinstance(contact, RigidContact)
        self._inputs, self._rms = inputs, float(contact.interface.scale.rms)
        self._lowest = turn - float(contact.interface.interaction_range) - _BELOW * self._rms
        self.field, self._laws = _field(inputs, self._lowest)
        every = [one for one in terms(self._laws[0]) if one.hysteretic]
        self.mechanisms = tuple(one.mechanism for one in every)
        self._seed, self._count = inputs.placement.seed, _FIRST
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
        table = self._reaching(launches)
        while True:
            found = self._all(table, launches, stop, pulls=pulls)
            lowest = float(np.min(found.closest_approach)) - float(np.max(table.reach))
            if lowest >= self._lowest or not isinstance(self.field, MeasuredField):
                return found
            # They came so deep that summits beyond the edges of the map would have been in reach.
            self._lowest = lowest - self._rms
            self.field, _ = _field(self._inputs, self._lowest)

    def _all(
        self,
        table: AsperityTable,
        launches: Launch,
        stop: threading.Event | None,
        *,
        pulls: bool,
    ) -> SingleImpact:
        bodies = np.size(launches.kinetic)

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
            self._table = energy, asperity_table(self._laws, energy)
        return self._table[1]

    def _block(
        self, table: AsperityTable, launches: Launch, number: int, pulls: bool
    ) -> SingleImpact:
        """WIDTH bodies, each with as many summits as are in reach of the one that meets most."""
        count = self._count
        while True:
            offsets, kinds = self.field.summits(self._seed, number, count)
            found = single_impacts(table, launches, as_float64(offsets), jnp.asarray(kinds), pulls)
            if not np.all(np.isfinite(found.closest_approach)):
                raise SimulationError("a single body came deeper than its summits are tabulated")
            most = int(np.max(found.within_reach))
            if most < count:
                return found
            self._refuse_many(table, float(np.min(found.closest_approach)))
            count *= 2

    def _refuse_many(self, table: AsperityTable, turn: float) -> None:
        """Refuse a body that has too many summits within reach where it turns [m]."""
        reach = float(np.max(table.reach))
        expected = float(self.field.expected_above(turn - reach))
        if expected > MOST_SUMMITS:
            raise InputError(
                f"single bodies (`placement`) have up to {MOST_SUMMITS} summits in reach; some "
                f"{expected:.3g} lie within the {reach * 1e9:.3g} nm that their forces reach: take "
                "'mean'",
                key="roughness.placement",
            )


def _field(inputs: Inputs, lowest: float) -> tuple[SummitField, list[Law]]:
    """The summits of a case, those with offsets above the lowest [m], and their laws by class."""
    rough, placed = inputs.asperities, inputs.placement
    assert rough is not None
    assert placed is not None
    radius, density = inputs.radius, rough.asperity_density
    if rough.summits is None or not (placed.measured or inputs.structure.heights == "summits"):
        law = asperity_law(inputs, rough.asperity_radius)
        return GaussianField(radius, density, rough.rms_height, rough.mean_height), [law]
    found = rough.summits
    order = np.argsort(-found.heights, kind="stable")
    classes = np.zeros(found.count, np.int32)
    laws = []
    for number, chosen in enumerate(members(found.radii, inputs.radius_classes)):
        classes[chosen] = number
        mean = float(found.radii[chosen].mean())
        laws.append(asperity_law(inputs, mean, float(found.radii.min())))
    heights, classes = found.heights[order], classes[order]
    if not placed.measured:
        return SampledField(radius, density, heights, classes), laws
    rows, columns = found.positions[order].T
    positions = np.stack([columns * found.pixel_size[0], rows * found.pixel_size[1]], axis=1)
    assert rough.surface is not None
    within = _places(rough.surface.physical_size, (2.0 * radius * (heights[0] - lowest)) ** 0.5)
    return MeasuredField(radius, density, heights, classes, positions, within), laws


def _places(size: tuple[float, float], away: float) -> np.ndarray:
    """Where a body can be put down on a map [m]: as far from its edges as forces reach.

    Raises
    ------
    InputError
        If there is no such place.
    """
    if min(size) <= 2.0 * away:
        raise InputError(
            "`placement` must be 'random' where the map is smaller than the summits in reach of a "
            f"body spread, {2e6 * away:.3g} um; got one of {size[0] * 1e6:.3g} um x "
            f"{size[1] * 1e6:.3g} um",
            key="roughness.placement",
        )
    return np.array([[away, away], [size[0] - away, size[1] - away]])


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
        What was built from a case with single bodies.
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
    turn = float(np.asarray(mean.motion.impacts.closest_approach)[0])
    bodies = SingleBodies(problem, turn)
    launch = Launch(*(np.asarray(x) for x in (body.kinetic, body.release, body.weight)))
    bodies.refuse_many(launch, turn)
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
