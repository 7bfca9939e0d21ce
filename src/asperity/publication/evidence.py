"""What the audit and the figures stand on: the published case, its variants, the exact model."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from math import cos, exp, sqrt
from typing import Any, NamedTuple

import numpy as np

from .. import regimes
from .._jax import jax, jnp
from ..config import Case, builtin
from ..config.resolve import resolve
from ..contact import Contact, PublishedContact, RigidContact
from ..halfspace import ring_mesh
from ..inputs import Asperities, Inputs
from ..materials.liquids import kelvin_radius
from ..model import build
from ..numerics.compilation import Program, kept
from ..results.result import Result
from ..solver import solve
from .comparison import rows_of
from .parameter_estimation import WITHIN, Unknowns
from .published_tables import Entry, read_tables

PRINTED = Unknowns(2.6146, 37.335e-9, 9.380)
"""What a refit finds with the polynomials as printed: they meet the tables too."""

_FEW = 6
"""Impacts of a variant of which the first ones say all."""


@kept
class FirstTouch(NamedTuple):
    """A contact of bodies that never touched: forces [N], and asperities that touch."""

    force: jax.Array
    elastic: jax.Array
    contacting: jax.Array


@dataclass(frozen=True)
class Evidence:
    """Motions and contacts that the publication's claims are held against.

    Parameters
    ----------
    case
        The published case with the inputs in use, on its own surface.
    surfaces
        The motion on each surface of the tables, by asperity radius and rms height [m].
    rows, power
        As in :class:`~asperity.publication.reproduce.Reproduction`.
    published
        The publication's row for the surface of ``case``.
    wet
        The motion of ``case``.
    dry, both_ways, printed
        That without menisci; with pulls on the way in too; with the polynomials as printed.
    printed_off
        Largest relative difference from the publication's decrements and stiction times with
        the printed polynomials and the inputs :data:`PRINTED`.
    exact, exact_damp
        The built-in case ``published-exact`` on a rigid plane, at 60 % relative humidity, and
        at that at which the Kelvin radius is the asperities' spacing.
    """

    case: Case
    surfaces: Mapping[tuple[float, float], Result]
    rows: list[dict[str, Any]]
    power: list[dict[str, float | None]]
    published: Entry
    wet: Result
    dry: Result
    both_ways: Result
    printed: Result
    printed_off: dict[str, float]
    exact: Result
    exact_damp: Result

    @classmethod
    def gather(
        cls,
        case: Case,
        surfaces: Mapping[tuple[float, float], Result],
        rows: list[dict[str, Any]],
        power: list[dict[str, float | None]],
        stop: threading.Event,
    ) -> Evidence:
        """Compute the variants, two at a time: each kind of contact compiles anew."""
        with ThreadPoolExecutor(2) as pool:
            motions = {
                name: pool.submit(solve, variant, name=name, stop=stop, critical=False)
                for name, variant in _variants(case).items()
            }
            off = pool.submit(_printed_off, stop)
        own = {entry.surface: entry for entry in read_tables()}
        rough = resolve(builtin("published")).asperities
        assert rough is not None
        return cls(
            case=case,
            surfaces=surfaces,
            rows=rows,
            power=power,
            published=own[rough.asperity_radius, rough.rms_height],
            printed_off=off.result(),
            **{name: motion.result() for name, motion in motions.items()},
        )

    @cached_property
    def inputs(self) -> Inputs:
        """The quantities of ``case``."""
        return resolve(self.case)

    @property
    def rough(self) -> Asperities:
        """The case's asperities."""
        assert self.inputs.asperities is not None
        return self.inputs.asperities

    @property
    def gravity(self) -> float:
        """Acceleration towards the surface [m/s^2]."""
        assert self.inputs.release is not None
        return self.inputs.release.gravity

    @property
    def unknowns(self) -> Unknowns:
        """What the text leaves open, as it is in use."""
        return Unknowns.of(self.case)

    @cached_property
    def contact(self) -> PublishedContact:
        """The contact of ``case``."""
        contact = build(self.inputs).contact
        assert isinstance(contact, PublishedContact)
        return contact

    @cached_property
    def exact_contact(self) -> RigidContact:
        """The contact of ``exact``."""
        contact = build(resolve(self.exact.case)).contact
        assert isinstance(contact, RigidContact)
        return contact

    @cached_property
    def weight(self) -> float:
        """Of the sphere [N]."""
        return float(build(self.inputs).body.weight)

    @property
    def closest(self) -> float:
        """Rigid separation of the first closest approach [m]."""
        return float(self.wet.events["closest_approach_separation"][0])

    @property
    def contact_radius(self) -> float:
        """Radius of the conjunction there [m]."""
        depth = float(self.contact.pressure.end) - self.closest
        return sqrt(2.0 * self.inputs.radius * depth)

    @property
    def contact_time(self) -> float:
        """Duration of the first contact, from and to the edge of the conjunction [s].

        NaN where the body does not leave it again.
        """
        motion, gravity = self.wet, self.gravity
        rise = first(motion.measures["rebound_height"])
        fall = self.unknowns.release_separation - float(self.contact.pressure.end)
        if not rise > 0.0:
            return float(np.nan)
        flight = sqrt(2.0 * fall / gravity) + sqrt(2.0 * rise / gravity)
        return first(motion.measures["rebound_period"]) - flight

    @cached_property
    def conjunction(self) -> tuple[np.ndarray, ...]:
        """Radius and gap [m], displacement [m] and pressure of contact [Pa] there.

        The displacement is that of the pressure between rigid bodies, a first iterate.
        """
        mesh, size = ring_mesh(200), self.contact_radius
        place = mesh.radius * size
        gap = self.closest + place**2 / (2.0 * self.inputs.radius)
        pressure = np.asarray(self.contact.pressure.contact(jnp.asarray(gap)))
        displaced = mesh.compliance @ pressure * size / self.inputs.modulus
        return place, gap, displaced, pressure

    @property
    def wet_touching(self) -> float:
        """Asperities of the conjunction that touch at the first closest approach."""
        return float(_first_touch(self.contact, jnp.asarray(self.closest)).contacting)

    @property
    def exact_rest(self) -> float:
        """Static equilibrium by the exact model [m]."""
        heights = self.exact.measures["rebound_height"]
        return float(self.exact.events["apex_separation"][0] - heights[0])

    @property
    def load_at_rest(self) -> float:
        """Load parameter there."""
        rest = self.exact_state(self.exact_rest)
        elastic, contacting = float(rest.elastic), float(rest.contacting)
        work, tip = self.inputs.work_of_adhesion, self.inputs.tip_radius
        return regimes.load_parameter(elastic, contacting, work, tip)

    def exact_state(self, separation: float) -> FirstTouch:
        """Contact of bodies that never touched, by the exact model."""
        return _first_touch(self.exact_contact, jnp.asarray(separation))

    def retraction_forces(self, separations: np.ndarray) -> np.ndarray:
        """Elastic force, adhesion and menisci [N] of bodies that begin to part at separations."""
        return np.asarray(_retraction(self.contact, jnp.asarray(separations)))

    def kelvin_radius(self, humidity: float) -> float:
        """Kelvin radius [m] of the case's liquid at a relative humidity below 1."""
        return _kelvin_radius(self.inputs, humidity)

    def interaction_range(self, humidity: float) -> float:
        """Gap [m] at which its menisci end at such a humidity."""
        return 2.0 * self.kelvin_radius(humidity) * cos(self.inputs.contact_angle)


def _kelvin_radius(inputs: Inputs, humidity: float) -> float:
    liquid, temperature = inputs.liquid, inputs.liquid_temperature
    assert liquid is not None
    assert temperature is not None
    return kelvin_radius(liquid, humidity, temperature)


def _variants(case: Case) -> dict[str, Case]:
    """The cases to compute, those that compile longest first."""
    few = {"numerics.max_impacts": _FEW}
    exact = builtin("published-exact").replace({"counterface.deformation": "rigid", **few})
    inputs = resolve(exact)
    assert inputs.asperities is not None
    # The Kelvin radius goes with 1/ln(1/humidity).
    damp = exp(-_kelvin_radius(inputs, exp(-1.0)) / inputs.asperities.spacing)
    return {
        "exact": exact,
        "printed": case.replace({"publication.polynomials": "printed"}),
        "wet": case,
        "dry": case.replace({"capillary.model": "none", **few}),
        "both_ways": case.replace({"publication.attraction_during_retraction_only": False}),
        "exact_damp": exact.replace({"capillary.humidity": damp}),
    }


def _printed_off(stop: threading.Event) -> dict[str, float]:
    """How far the printed polynomials are from the publication's numbers, at the worst."""
    case = PRINTED.within(builtin("published")).replace({"publication.polynomials": "printed"})
    worst = dict.fromkeys(WITHIN, 0.0)
    for entry in read_tables():
        motion = solve(entry.within(case), name=entry.name, stop=stop, critical=False)
        for row in rows_of(entry, motion):
            name, off = row["quantity"], row["relative_difference"]
            if name in WITHIN and off is not None:
                worst[name] = max(worst[name], abs(off))
    return worst


def _fresh_state(contact: Contact, separation: jax.Array) -> FirstTouch:
    state = contact.state(separation, contact.initial_memory())
    return FirstTouch(state.force, state.elastic, state.contacting)


_first_touch = Program(_fresh_state)


def _retraction_parts(contact: PublishedContact, separations: jax.Array) -> jax.Array:
    memory = jnp.ones(())
    return jax.vmap(lambda separation: contact.state(separation, memory).parts)(separations)


_retraction = Program(_retraction_parts)


def first(values: list[float | None]) -> float:
    """The first of a motion's measures, NaN where there is none."""
    return float(values[0]) if values and values[0] is not None else float(np.nan)
