"""Bodies on summits of their own, launched together."""

from __future__ import annotations

import os
import threading
from concurrent.futures import ThreadPoolExecutor
from math import ceil

import numpy as np

from .._jax import jax, jnp
from ..contact.asperity_table import Asperities, asperity_table
from ..contact.delayed_formation import LATE
from ..contact.elastic import ElasticContact
from ..contact.rough import RoughContact
from ..dynamics.coupled_impact import Bulk, coupled_impacts
from ..dynamics.damped_summits import flights
from ..dynamics.delayed_path import Delay
from ..dynamics.problem import Problem
from ..dynamics.record import Body
from ..dynamics.single_impact import SingleImpact, Yielding, single_impacts
from ..dynamics.summit_path import Launch
from ..errors import InputError, SimulationError
from ..inputs import Placement
from ..interface.plastic_interface import PLASTIC
from ..interface.rough_planes import RoughPlanes
from ..interface.summit_field import WIDTH, MeasuredField
from ..laws.law import as_float64, terms
from ..numerics.compilation import AT_ONCE, Program
from ..numerics.trees import stacked
from .placement import Placed, place_summits, refuse_inside

MOST_SUMMITS = 1 << 15
"""Summits under one body that are followed one by one, on a rigid bulk."""

MOST_UNASKED = 2048
"""Beside a mean, where no single bodies were asked for: more take minutes."""

MOST_COUPLED = 128
"""On a half-space, where each feels all others."""

MOST_DELAYED = 512
"""With menisci that take time: each that forms is a step of its own."""

_BELOW = 5.0  # rms heights that the turning point of a body may lie below that of the mean
_FIRST = 16  # summits of each body, at least
_SCATTER = 4.0  # standard deviations that their number may lie above the expected one
_FEWER = 8  # times as few are within range where fewer are taken from then on
_SHARES = np.linspace(0.0, 1.0, 33)  # of a fall: where a spring may have given most
_DEEPER = 2.0  # times the energy that a body brings, to which an asperity is tabulated


def _lengths_of(interface: RoughPlanes) -> tuple[jax.Array, jax.Array]:
    """Rms height and interaction range [m]."""
    return interface.scale.rms, jnp.asarray(interface.interaction_range)


_lengths = Program(_lengths_of, AT_ONCE)


class SingleBodies:
    """Bodies that fall on summits of their own.

    Parameters
    ----------
    problem
        What was built from a case with single bodies.
    turning_point
        Separation [m] of the turning point of the mean over all bodies.

    Raises
    ------
    InputError
        If a map is too small for bodies that come so deep, or most have no summit under them.
    """

    def __init__(self, problem: Problem, turning_point: float) -> None:
        inputs, contact = problem.inputs, problem.contact
        assert inputs.placement is not None
        assert isinstance(contact, RoughContact)
        self._inputs, lengths = inputs, _lengths(contact.interface)
        self._rms, self._range = map(float, lengths)
        self._lowest = turning_point - self._range - _BELOW * self._rms
        self.note = ""
        self.field, self._tips, self._laws, self._contacts = self._place(inputs.placement)
        self._modulus = contact.modulus if isinstance(contact, ElasticContact) else None
        rigid = MOST_SUMMITS if inputs.placement.required else min(MOST_SUMMITS, MOST_UNASKED)
        self._most = rigid if self._modulus is None else MOST_COUPLED
        self._turning_point, self._count = turning_point, 0
        laws = terms(self._laws[0])
        names = [one.mechanism for one in laws if one.hysteretic]
        if self._contacts:
            assert all(one.radius_power == 1.0 for one in laws)  # see PressedSummits
            names.append(PLASTIC)
        body = problem.body
        # Without what a motion of the mean starts from, and where: one program serves all.
        self._body = Body(body.mass, body.gravity, 0.0, drags=body.drags, forces=body.forces)
        self.mechanisms = (*names, *self._body.mechanisms)
        self._delay: Delay | None = None
        if inputs.formation_time and LATE in names:
            self._delay = Delay(as_float64(inputs.formation_time), names.index(LATE))
            self._most = min(self._most, MOST_DELAYED)
        self._seed = inputs.placement.seed
        self._table: tuple[float, Asperities] | None = None
        self._felt = self._range

    def _place(self, placed: Placement) -> Placed:
        """The summits: at random places where a map is too small that need not be large enough."""
        try:
            return place_summits(self._inputs, placed, self._lowest)
        except InputError as error:
            if placed.required:
                raise
            self.note = f"single bodies stand on summits at random places: {error}"
        return place_summits(self._inputs, placed._replace(measured=False), self._lowest)

    def impacts(
        self,
        launches: Launch,
        stop: threading.Event | None = None,
        *,
        with_pull_off: bool = True,
        before: np.ndarray | None = None,
    ) -> SingleImpact:
        """Their first impacts, each on the summits of its number.

        Parameters
        ----------
        launches
            How they come, arrays of shape (bodies,).
        stop
            Set from another thread, it ends them early.
        with_pull_off
            Whether their pull-off forces are wanted too, which takes twice as long.
        before
            Their closest approach [m] at earlier impacts, shape (bodies,), which tips that yield
            remember; none without it.

        Returns
        -------
        Arrays of shape (bodies, ...).

        Raises
        ------
        InputError
            If one feels more than `MOST_SUMMITS`, on a half-space `MOST_COUPLED` or with menisci
            that take time `MOST_DELAYED`, or it is released on a summit.
        SimulationError
            If they were stopped.
        """
        table = self._tabulated(launches)
        self._count = self._count or self._summits_for(self._turning_point)
        if before is None:
            before = np.full(np.shape(launches.kinetic), np.inf)
        while True:
            found = self._all(table, launches, before, stop, with_pull_off=with_pull_off)
            lowest = float(np.nanmin(found.closest_approach)) - self._range
            if lowest >= self._lowest or not isinstance(self.field, MeasuredField):
                return found
            # So deep, summits beyond the edges of the map would have been within range.
            self._lowest = lowest - self._rms
            assert self._inputs.placement is not None
            self.field = place_summits(self._inputs, self._inputs.placement, self._lowest).field

    def _all(
        self,
        table: Asperities,
        launches: Launch,
        before: np.ndarray,
        stop: threading.Event | None,
        *,
        with_pull_off: bool,
    ) -> SingleImpact:
        bodies = np.size(launches.kinetic)

        def block(number: int) -> SingleImpact:
            if stop is not None and stop.is_set():
                raise SimulationError("stopped before all first impacts of single bodies")
            # The last block is filled up with bodies that stay away.
            numbers = np.arange(WIDTH) + number * WIDTH
            some = np.minimum(numbers, bodies - 1)
            chosen = Launch(*(np.asarray(x)[some] for x in launches))
            kinetic = np.where(numbers < bodies, chosen.kinetic, np.nan)
            chosen = chosen._replace(kinetic=kinetic)
            return self._block(table, chosen, before[some], number, with_pull_off)

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            found = list(pool.map(block, range(-(-bodies // WIDTH))))
        # Bodies that follow are likely to meet about as many. Each number is compiled.
        numbers = [int(np.max(some.within_range)) for some in found if np.any(some.within_range)]
        most = int(np.median(numbers or [self._count - 1]))
        if not self._count / _FEWER <= most < self._count:
            self._count = _power_of_two(most + 1)
        joined: SingleImpact = jax.tree_util.tree_map(
            lambda *leaves: np.concatenate(leaves)[:bodies], *found
        )
        return joined

    def flights(self, starts: np.ndarray, kinetic: np.ndarray) -> tuple[Launch, np.ndarray]:
        """Bodies that leave their summits, until they come back.

        Parameters
        ----------
        starts
            Where forces end [m], shape (bodies,).
        kinetic
            Kinetic energies there [J].

        Returns
        -------
        How they come again, and times [s] until they are there: kinetic energies are NaN and
        times infinite for those that do not come back. Menisci that take time are followed from
        the apex on, others from where forces end.
        """
        body = self._body.plain
        if self._body.damped or self._body.forces:
            found = flights(self._body, as_float64(starts), as_float64(kinetic))
            back, time, apex = map(np.asarray, found)
        elif not body.weight > 0.0:
            back, time = np.full(kinetic.shape, np.nan), np.full(kinetic.shape, np.inf)
            apex = starts
        else:
            back, time = kinetic, 2.0 * np.sqrt(2.0 * kinetic * body.mass) / body.weight
            apex = starts + kinetic / body.weight
        if self._delay is not None:
            return Launch(0.0 * back, apex), time
        return Launch(back, starts), time

    def first(self, found: SingleImpact) -> dict[str, np.ndarray]:
        """The first body on its summits, as in :class:`Realisations`; ``found`` for all."""
        turning_point, count = float(np.asarray(found.closest_approach)[0]), self._count
        gaps = turning_point - self.field.summits(self._seed, 0, count)[0][0]
        while gaps[-1] <= self._range and count < MOST_SUMMITS:
            count *= 2
            gaps = turning_point - self.field.summits(self._seed, 0, count)[0][0]
        x, y = self.field.positions(self._seed, 0, count)[0].T
        within = gaps <= max(self._range, gaps[0])
        return {"x": x[within], "y": y[within], "gap": gaps[within]}

    def _tabulated(self, launches: Launch) -> Asperities:
        """The table of an asperity, deep enough for the energy of such bodies."""
        lowest = min(self._turning_point, 0.0) - _BELOW * self._rms
        above = self._turning_point + self._range + _BELOW * self._rms
        begin = np.where(np.isfinite(launches.release), launches.release, above)
        falls = (lowest - begin) * _SHARES[:, None]
        gained = np.max(-self._body.plain.load.potential_gain(begin, falls), axis=0)
        energy = _DEEPER * float(np.nanmax(launches.kinetic + gained))
        if self._table is None or self._table[0] < energy:
            self._table = energy, asperity_table(self._laws, energy, self._contacts)
            self._felt = float(np.max(np.asarray(self._table[1].approach_range)))
        return self._table[1]

    def _block(
        self,
        table: Asperities,
        launches: Launch,
        before: np.ndarray,
        number: int,
        with_pull_off: bool,
    ) -> SingleImpact:
        """WIDTH bodies, each with as many summits as the one that has most within range."""
        count = self._count
        yielding = None
        if self._contacts:
            yielding = Yielding(stacked(self._contacts), as_float64(before))
        while True:
            offsets, classes = self.field.summits(self._seed, number, count)
            if np.all(np.isinf(before)):
                refuse_inside(launches.release, offsets[:, 0])
            summits = launches, as_float64(offsets), jnp.asarray(classes)
            # With menisci that take time one program serves all, which takes long to compile.
            wanted = with_pull_off or self._delay is not None
            if self._modulus is None:
                found = single_impacts(table, self._body, *summits, wanted, yielding, self._delay)
            else:
                found = coupled_impacts(table, self._body, *summits, self._bulk(number, count))
            found = jax.tree_util.tree_map(np.asarray, found)
            most = int(np.max(found.within_range))
            if most < count:
                if not np.all(np.isfinite(found.closest_approach) | np.isnan(launches.kinetic)):
                    raise SimulationError("the path of a single body was not found")
                return found
            self._refuse_above(count)
            count = max(2 * count, self._summits_for(float(np.nanmin(found.closest_approach))))

    def _bulk(self, number: int, count: int) -> Bulk:
        """The half-space that the summits of WIDTH bodies stand on."""
        positions = self.field.positions(self._seed, number, count)
        modulus = np.asarray(self._modulus)
        return Bulk(as_float64(positions), as_float64(self._tips), as_float64(modulus))

    def _summits_for(self, turning_point: float) -> int:
        """Summits that a body has within range at its turning point [m], and seldom more.

        On a half-space these are fewer, since it gives way: too many are refused as they are met.

        Raises
        ------
        InputError
            If these are too many.
        """
        expected = float(self.field.expected_above(turning_point - self._felt))
        if self._modulus is None:
            self._refuse_above(expected - 1.0)
        likely = _power_of_two(ceil(expected + _SCATTER * expected**0.5 + _SCATTER))
        return min(likely, self._most)

    def _refuse_above(self, number: float) -> None:
        """Refuse bodies with more summits than that, if they are too many to be followed."""
        if number >= self._most:
            raise InputError(
                f"single bodies (`placement`) are followed on up to {self._most} summits each that "
                f"feel a force; here {number:.3g} or more do",
                key="roughness.placement",
            )


def _power_of_two(number: int) -> int:
    """The first that is no less, or `_FIRST`."""
    return max(_FIRST, 1 << (number - 1).bit_length())
