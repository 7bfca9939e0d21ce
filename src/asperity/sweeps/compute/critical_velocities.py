"""Critical velocities of the cases of a study: many first impacts side by side."""

from __future__ import annotations

import dataclasses

import numpy as np

from asperity._jax import jax, jnp
from asperity.contact import YieldingContact
from asperity.critical_velocity import LAUNCH_ERROR, launch_separation
from asperity.dynamics import Body, Limits
from asperity.dynamics.capture_edges import FirstImpacts, capture_edges, speeds_about
from asperity.integration.batch_records import Batch, taken
from asperity.integration.clock import Clock
from asperity.integration.steps import FEW_CASES, Steps
from asperity.sweeps.compute.building import Group
from asperity.sweeps.compute.integrate_batch import BatchSolution, integrate_batch
from asperity.sweeps.study.columns import FAILED

_TOGETHER = 256  # cases whose impacts are launched in one go


def critical_velocities(group: Group, solution: BatchSolution, clock: Clock) -> np.ndarray:
    """Critical velocity of each case of a group [m/s]; NaN where there is none.

    Parameters
    ----------
    group, solution
        The cases, and what became of them.
    clock
        Told of the time in compiled code.
    """
    found = np.full(group.rows.size, np.nan)
    moved = np.flatnonzero(solution.made > 0)
    takes = group.batch.contact.mechanisms or group.batch.body.mechanisms
    for begin in range(0, moved.size if takes else 0, _TOGETHER):
        some = moved[begin : begin + _TOGETHER]
        found[some] = _of_some(group, solution, some, clock)
    return found


def _of_some(group: Group, solution: BatchSolution, some: np.ndarray, clock: Clock) -> np.ndarray:
    cases: Batch = taken(group.batch, some)
    mass = np.broadcast_to(np.asarray(cases.body.mass), some.shape)
    interaction_range = jax.vmap(lambda batch: jnp.asarray(batch.contact.interaction_range))(cases)
    release = launch_separation(
        np.asarray(interaction_range), solution.measures["outset"][some],
        np.asarray(cases.body.release), yields=isinstance(cases.contact, YieldingContact),
    )  # fmt: skip
    count = group.rows.size
    width = Steps.of_batch(group.batch, count).width if count <= FEW_CASES else None

    def launch(index: np.ndarray, speeds: np.ndarray) -> FirstImpacts:
        batch = taken(cases, index)
        body = dataclasses.replace(batch.body, release=release[index], speed=speeds)
        rest, none = batch.limits.rest, np.full(index.size, np.inf)
        batch = batch._replace(body=body, limits=Limits(rest, none, np.ones(index.size, int)))  # type: ignore[arg-type]
        launched = Group(np.arange(index.size), batch, np.full(index.size, LAUNCH_ERROR))
        # A small study launches in calls of its cases' own width: those are compiled already.
        made = integrate_batch(launched, clock, checked=False, width=width)
        return _first_impacts(made, mass[index], body)

    past = solution.history
    leaving, lost = past["leaving"][some, 0], np.sum(past["lost"][some, 0], axis=1)
    lost = np.where(np.isfinite(leaving), solution.release[some] - leaving, lost)
    edges = capture_edges(launch, *speeds_about(past["maximum_kinetic"][some, 0], lost, mass))
    return np.array([np.nan if each.critical is None else each.critical for each in edges])


def _first_impacts(made: BatchSolution, mass: np.ndarray, body: Body) -> FirstImpacts:
    """What became of bodies that were launched; those that were not integrated are not known."""
    contact_end = made.measures["contact_end"]
    known = (made.made > 0) & (made.outcome != FAILED) & np.isfinite(contact_end)
    speed = np.where(known, made.measures["impact_speed"], np.nan)
    excess = made.history["leaving"][:, 0] - body.plain.load.potential_gain(0.0, contact_end)
    captured = made.measures["captured"].astype(bool)
    margin = made.measures["margin"] if body.damped_apart else None
    return FirstImpacts.of(speed, captured, excess, mass, margin)
