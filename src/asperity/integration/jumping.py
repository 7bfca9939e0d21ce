"""From a problem whose contact has no equilibrium somewhere to one that jumps there."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from .._jax import jax
from ..contact import Contact, ElasticContact
from ..contact.folding import folding
from ..contact.plane_adhesion import FOLDS, tabor_number_of_planes, tabor_numbers_of_planes
from ..dynamics import Body
from ..dynamics.instability import INSTABILITY
from ..dynamics.problem import Problem
from ..errors import InputError, SimulationError
from ..numerics.compilation import AT_ONCE, Program
from .batch_records import slices, taken
from .clock import Report, silently
from .panel_cuts import PATIENCE, Unsolved

Answer = TypeVar("Answer")

_TOGETHER = 8  # contacts of a compiled call


def _lower_bound(contact: ElasticContact, body: Body) -> jax.Array:
    return contact.lower_bound(body.release, body.kinetic, body.load.potential)


_lowest = Program(_lower_bound, AT_ONCE)


def over_folds(
    problem: Problem, run: Callable[[Problem, int], Answer], report: Report = silently
) -> Answer:
    """What a run of a problem gives, whose body jumps where its equilibria fold.

    Folds are looked for first where the planes' Tabor number says that they are likely, else
    where the curves without them have no equilibrium.

    Parameters
    ----------
    problem
        The problem.
    run
        What runs a problem, with the tries without an equilibrium before that counts.
    report
        Called with a fraction done and a line of text.

    Raises
    ------
    InputError
        If the rough surfaces adhere as smooth ones do, or equilibria fold, as is likely, under a
        body that is stepped in time.
    SimulationError
        If the curves miss the tolerance; where folds were sought in vain, why.
    """
    contact = problem.contact  # of a bulk that relaxes, once it has
    number = tabor_number_of_planes(contact) if isinstance(contact, ElasticContact) else 0.0
    if not may_jump(problem):
        try:
            return run(problem, PATIENCE)
        except Unsolved as error:
            if problem.in_time and number > FOLDS:
                raise _not_in_time(problem, number) from error
            raise
    if number <= FOLDS:
        try:
            return run(problem, 0)
        except Unsolved:
            pass  # it is run again, with its folds
    report(0.02, "where equilibria fold")
    try:
        folded, sharp = jumping(problem), None
    except SimulationError as error:  # the body may not come so near
        folded, sharp = problem, error
    try:
        return run(folded, PATIENCE)
    except Unsolved:
        if sharp is None:
            raise
        raise sharp from None


def _not_in_time(problem: Problem, number: float) -> InputError:
    """Why a body that is stepped in time has no answer where it would jump."""
    relaxes = problem.relaxation is not None
    slow = "the bulk creeps" if relaxes else "menisci take time to form"
    soft = "of the bulk once it has relaxed " if relaxes else ""
    return InputError(
        f"adhesion folds the equilibria {soft}(the Tabor number of the rough surfaces is "
        f"{number:.3g}; they may fold above {FOLDS:g}): a body that jumps there while {slow} is "
        "not known here. Less adhesion, a stiffer bulk or higher asperities have no fold",
        key="viscoelasticity.relaxed_modulus_ratio" if relaxes else "capillary.formation_time",
    )


def may_jump(problem: Problem) -> bool:
    """Whether the body may jump: not where its contact is solved as it moves."""
    return type(problem.contact) is ElasticContact and not problem.in_time


def likely_to_jump(contacts: Contact, count: int) -> np.ndarray:
    """Which of a batch of contacts are likely to jump, or are refused, shape (count,).

    Parameters
    ----------
    contacts
        Contacts whose arrays have an axis more, the first one.
    count
        Their number.
    """
    found = np.zeros(count, bool)
    if type(contacts) is not ElasticContact:
        return found
    for some in slices(np.arange(count), _TOGETHER if count > 1 else 1):
        numbers = tabor_numbers_of_planes(taken(contacts, some))
        found[some[some >= 0]] = ~(numbers <= FOLDS)[some >= 0]
    return found


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
