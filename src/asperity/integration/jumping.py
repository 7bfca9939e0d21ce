"""From a problem whose contact has no equilibrium somewhere to one that jumps there."""

from __future__ import annotations

import dataclasses

from .._jax import jax
from ..contact import ElasticContact
from ..contact.folding import folding
from ..dynamics import Body
from ..dynamics.instability import INSTABILITY
from ..dynamics.problem import Problem
from ..numerics.compilation import AT_ONCE, Program


def _lower_bound(contact: ElasticContact, body: Body) -> jax.Array:
    return contact.lower_bound(body.release, body.kinetic, body.load.potential)


_lowest = Program(_lower_bound, AT_ONCE)


def may_jump(problem: Problem) -> bool:
    """Whether the body may jump: not where its contact is solved as it moves."""
    in_time = problem.delayed is not None or problem.relaxation is not None
    return type(problem.contact) is ElasticContact and not in_time


def jumping(problem: Problem) -> Problem:
    """The problem with a contact that jumps where its equilibria fold; itself where none does.

    Raises
    ------
    SimulationError
        As :func:`asperity.contact.folding.folding`.
    """
    contact, body = problem.contact, problem.body
    assert isinstance(contact, ElasticContact)
    folded = folding(contact, float(_lowest(contact, body)))
    if folded is None:
        return problem
    return problem._replace(contact=folded, body=dataclasses.replace(body, in_bulk=(INSTABILITY,)))
