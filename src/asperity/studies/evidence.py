"""What the audit and the figures stand on: the published case, its variants, the exact model."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..case import Case, builtin
from ..case.build import build
from ..contact import Contact, PublishedContact, RigidContact
from ..program import Program, kept
from ..result import Result
from ..solver import solve

_FEW = 6
"""Impacts of a variant of which the first ones say all."""


@kept
class FirstTouch(NamedTuple):
    """A contact of bodies that never touched: forces [N], and asperities that touch."""

    force: jax.Array
    elastic: jax.Array
    pull: jax.Array
    touching: jax.Array


@dataclass(frozen=True)
class Evidence:
    """Motions and contacts that the publication's claims are held against.

    Parameters
    ----------
    case
        The published case with the inputs in use, on its own surface.
    wet
        Its motion.
    surfaces
        The motion on each surface of the tables, by asperity radius and rms height [m].
    dry, both_ways, printed
        The case without menisci; with pulls on the way in too; with the polynomials as printed.
    exact
        The built-in case ``published-exact`` on a rigid plane: 60 % relative humidity.
    contact, exact_contact
        The contacts of ``case`` and of ``exact``.
    rows, power
        As in :class:`~asperity.studies.Reproduction`.
    """

    case: Case
    wet: Result
    surfaces: Mapping[tuple[float, float], Result]
    dry: Result
    both_ways: Result
    printed: Result
    exact: Result
    contact: PublishedContact
    exact_contact: RigidContact
    rows: list[dict[str, Any]]
    power: list[dict[str, float | None]]

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
        few = {"numerics.max_impacts": _FEW}
        exact = builtin("published-exact").replace(
            {"counterface.deformation": "rigid", "numerics.max_impacts": _FEW}
        )
        variants = {
            "exact": exact,
            "printed": case.replace({"publication.polynomials": "printed"}),
            "wet": case,
            "dry": case.replace({"capillary.model": "none", **few}),
            "both_ways": case.replace({"publication.pull_while_parting_only": False}),
        }
        with ThreadPoolExecutor(2) as pool:
            motions = {
                name: pool.submit(solve, variant, name=name, stop=stop)
                for name, variant in variants.items()
            }
        contact, exact_contact = build(case).contact, build(exact).contact
        assert isinstance(contact, PublishedContact)
        assert isinstance(exact_contact, RigidContact)
        return cls(
            case=case,
            surfaces=surfaces,
            contact=contact,
            exact_contact=exact_contact,
            rows=rows,
            power=power,
            **{name: motion.result() for name, motion in motions.items()},
        )

    @property
    def rms_height(self) -> float:
        """Of the case [m]."""
        assert self.case.roughness is not None
        return self.case.roughness.rms_height

    @property
    def weight(self) -> float:
        """Of the sphere [N]."""
        return float(build(self.case).body.weight)

    @property
    def exact_rest(self) -> float:
        """Static equilibrium by the exact model [m]."""
        heights = self.exact.measures["rebound_height"]
        return float(self.exact.events["apex_separation"][0] - heights[0])

    @property
    def wet_touching(self) -> float:
        """Asperities of the conjunction that touch at the first closest approach."""
        closest = jnp.asarray(self.wet.events["deepest_separation"][0])
        return float(_fresh(self.contact, closest).touching)

    def parting_forces(self, separations: np.ndarray) -> np.ndarray:
        """Elastic force, adhesion and menisci [N] of bodies that begin to part at separations."""
        return np.asarray(_parting(self.contact, jnp.asarray(separations)))

    def exact_state(self, separation: float) -> FirstTouch:
        """Contact of bodies that never touched, by the exact model."""
        return _fresh(self.exact_contact, jnp.asarray(separation))


def _fresh_state(contact: Contact, separation: jax.Array) -> FirstTouch:
    state = contact.state(separation, contact.fresh())
    return FirstTouch(state.force, state.elastic, state.force - state.elastic, state.touching)


_fresh = Program(_fresh_state)


def _parting_parts(contact: PublishedContact, separations: jax.Array) -> jax.Array:
    memory = jnp.ones(())
    return jax.vmap(lambda separation: contact.state(separation, memory).parts)(separations)


_parting = Program(_parting_parts)


def first(values: list[float | None]) -> float:
    """The first of a motion's measures, NaN where there is none."""
    return float(values[0]) if values and values[0] is not None else float(np.nan)
