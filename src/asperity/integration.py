"""The motion of a built problem: curves within the tolerance, the release check, the impacts."""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Callable

import numpy as np

from ._jax import jax, jnp
from .contact import Contact, ElasticContact, RigidContact
from .contact.delayed_formation import DelayedContact
from .contact.resolution import in_steps
from .contact.viscoelastic import Relaxation, RelaxedContact
from .dynamics import Body, Impacts, Limits, Motion, Table, integrate_impacts, prepare, start
from .dynamics.curve_table import FORCE, read_row
from .dynamics.problem import CLEARANCE, Problem
from .dynamics.record import ENDS, IN_MOTION
from .dynamics.release import TRIES, at_release, farther, negligible_force
from .dynamics.static_equilibrium import Reference
from .dynamics.stepped_motion import integrate_stepped
from .dynamics.stepped_phase import Ended
from .errors import InputError, Outcome, SimulationError
from .numerics.compilation import AT_ONCE, Program
from .results.conversion import Solution

Report = Callable[[float, str], None]

COMPILATION = "compilation"
"""What is told once all is traced, and the compiler is waited for where it is not through."""

_CHUNK, _QUICK = 20, 100  # impacts a compiled call: short enough for Ctrl-C, where all is quick
_REFINEMENTS = (1, 2, 4, 8)  # of the panels, until the curves meet the tolerance
_GAIN = 0.9  # of the error is left by four times the panels: where more is, no more would help
_RESIDUAL = 1e-6  # relative force error of a contact that counts as solved


def silently(fraction: float, text: str) -> None:
    """Report nothing."""


def cut_in_steps(problem: Problem) -> Problem:
    """The problem with its curves cut in one of a few ways, each at least as fine as its own."""
    relaxation = problem.relaxation
    if relaxation is not None:
        relaxation = dataclasses.replace(relaxation, contact=_in_steps(relaxation.contact))
    return problem._replace(contact=_in_steps(problem.contact), relaxation=relaxation)


def _in_steps(contact: Contact) -> Contact:
    if isinstance(contact, RelaxedContact):
        return RelaxedContact(_in_steps(contact.base))
    if not isinstance(contact, RigidContact | ElasticContact):
        return contact
    resolved = in_steps(contact.resolved, deforms=isinstance(contact, ElasticContact))
    return dataclasses.replace(contact, resolved=resolved)


def integrate(
    problem: Problem,
    report: Report,
    stop: threading.Event | None,
    *,
    many: bool = False,
) -> Solution:
    """The motion of what was built from a case.

    Parameters
    ----------
    problem
        What was built from a case.
    report
        Called with a fraction done and a line of text, now and then.
    stop
        Set from another thread, it ends the motion early.
    many
        Whether the scanning curves are tabulated first: that compiles longer, and pays where
        many cases follow.

    Raises
    ------
    InputError
        If the release lies inside contact.
    SimulationError
        If the curves miss the tolerance, or the motion is stopped before its first impact.
    """
    limits = Limits.of(problem.inputs.tolerance)
    problem, (contact, table, reference) = _released(problem, limits, report, many=many)
    return integrate_prepared(problem, contact, (table, reference), limits, report, stop)


def integrate_prepared(
    problem: Problem,
    contact: Contact,
    curves: tuple[Table, Reference],
    limits: Limits,
    report: Report,
    stop: threading.Event | None,
) -> Solution:
    """The motion of a body whose force curves are there already; see :func:`integrate`."""
    if problem.delayed is None and problem.relaxation is None:
        solution = _integrate_in_chunks(problem.body, contact, *curves, limits, report, stop)
    else:
        solution = _integrate_in_time(problem, contact, curves, limits, report, stop)
    return solution._replace(body=problem.body)


def prepared(contact: Contact, body: Body, *, many: bool = False) -> tuple[Table, Reference]:
    """Force curves over all that a body can reach, and the static equilibrium.

    Parameters
    ----------
    contact, body
        What moves on what.
    many
        As for :func:`integrate`.
    """
    return _preparing(contact, many)(contact, body, many)


def first_impact(problem: Problem, report: Report = silently) -> tuple[Contact, Motion]:
    """The contact with its curves, and the motion as far as the first impact.

    Parameters
    ----------
    problem
        What was built from a case.
    report
        As ``progress`` of :func:`solve`.

    Raises
    ------
    InputError, SimulationError
        As :func:`solve`.
    """
    limits = Limits.of(dataclasses.replace(problem.inputs.tolerance, max_impacts=1))
    problem = problem._replace(delayed=None, relaxation=None)  # it has all the time that it needs
    problem, (contact, table, reference) = _released(problem, limits, report)
    body = problem.body
    report(0.3, "first impact")
    first, origin = _start(contact, body, table)
    progress, rows = _integrate_some(
        contact, body, table, reference, origin, first, limits, _at_once(contact, body)
    )
    impacts = jax.tree_util.tree_map(np.asarray, rows)
    return contact, Motion(impacts, progress, table, reference, origin)


def _released(
    problem: Problem, limits: Limits, report: Report, *, many: bool = False
) -> tuple[Problem, tuple[Contact, Table, Reference]]:
    """A problem whose body is released outside contact, and its curves.

    Where the case gives a speed alone, the release lies as far out as its forces ask for. A case
    without an [impact] table is not released by its user.
    """
    chosen = problem.inputs.chosen_release
    for _ in range(TRIES):
        curves = _prepared(problem, limits, report, many=many)
        if not chosen:
            break
        body, table = problem.body, curves[1]
        force, power, largest, load = (np.asarray(x) for x in _at_release(table, body))
        limit = negligible_force(load, largest, chosen=True)
        if force <= limit:
            break
        release = farther(np.asarray(body.release), force, power, limit)
        problem = problem._replace(body=dataclasses.replace(body, release=jnp.asarray(release)))
    if problem.inputs.release is not None:
        _check_release(problem, curves[1], chosen=chosen, many=many)
    return problem, curves


def _prepared(
    problem: Problem, limits: Limits, report: Report, *, many: bool = False
) -> tuple[Contact, Table, Reference]:
    """Tables whose interpolation error meets the tolerance, by more panels where needed.

    Meanwhile the impacts compile.
    """
    tolerance = problem.inputs.tolerance.relative
    allowed, errors = tolerance, [np.inf, np.inf]
    for factor in _REFINEMENTS:
        report(0.02, "tracing")
        contact = problem.contact.refined(factor)
        preparing = _preparing(contact, many)
        shapes = preparing.ahead(contact, problem.body, many)
        if problem.delayed is None and problem.relaxation is None:
            _compile_impacts(contact, problem.body, shapes, limits)
        report(0.04, COMPILATION)
        prepared = preparing.ready(contact, problem.body, many)
        report(0.06, "force curves")
        table, reference = prepared()
        error, allowed = float(table.error), max(tolerance, contact.error_floor)
        if error <= allowed or error > _GAIN * errors[-2]:
            break
        errors.append(error)
    if not error <= allowed:
        raise SimulationError(
            f"force curves reach a relative error of {error:.1e}, "
            f"not `numerics.tolerance` = {tolerance:.1e}"
        )
    if not float(table.residual) <= _RESIDUAL:
        raise SimulationError(
            "pressure and deformation do not agree: relative force error "
            f"{float(table.residual):.1e}. The contact has no equilibrium that follows "
            "from the one before (strong adhesion on soft bodies folds it)"
        )
    return contact, table, reference


def _compile_impacts(
    contact: Contact, body: Body, curves: tuple[Table, Reference], limits: Limits
) -> None:
    """Compile the loop over impacts in a thread, for curves or their shapes."""
    progress, origin = _start.ahead(contact, body, curves[0])
    _integrate_some.ahead(contact, body, *curves, origin, progress, limits, _at_once(contact, body))


def _preparing(contact: Contact, many: bool) -> Program[..., tuple[Table, Reference]]:
    """The program of the curves: 10 ms slower and compiled 2 s sooner for one that deforms."""
    return _prepare_at_once if isinstance(contact, ElasticContact) and not many else _prepare


def _at_once(contact: Contact, body: Body) -> int:
    """Impacts in one compiled call."""
    if isinstance(contact, RigidContact) and not body.damped:
        return _QUICK if getattr(contact.interface, "closed", False) else _CHUNK
    return _CHUNK


_prepare = Program(prepare)
_prepare_at_once = Program(prepare, AT_ONCE)
_start = Program(start, AT_ONCE)
_at_release = Program(at_release, AT_ONCE)
_integrate_some = Program(
    integrate_impacts, AT_ONCE
)  # 0.8 s sooner at first, and then 1 to 9 ms later


def _check_release(problem: Problem, table: Table, *, chosen: bool, many: bool) -> None:
    """A release within contact is refused: it would not be a fall."""
    body = problem.body
    release, load = float(body.release), float(body.mass) * float(body.gravity)
    force = abs(float(read_row(table, 0, release)[FORCE]))
    largest = float(np.max(np.abs(np.asarray(table.values)[..., 0, FORCE])))
    if body.forces:
        load, chosen = float(_at_release(table, body).load), True
    limit = float(negligible_force(np.asarray(load), np.asarray(largest), chosen=chosen))
    if force <= limit:
        return
    share = "1e-3 of the weight" if load > 0.0 else "1e-6 of its peak"
    share = "1e-3 of the spring's force" if body.forces else share
    at_rest = _at_rest(problem, many)
    raise InputError(
        "`release_separation` must lie outside contact: the contact force there must be below "
        f"{share} ({limit:.3g} N), and is {force:.3g} N; {at_rest}got {release * 1e9:.6g} nm",
        key="impact.release_separation",
    )


def _at_rest(problem: Problem, many: bool) -> str:
    """Where the body would rest, seen from outside contact; empty where nothing holds it."""
    body = problem.body
    release = float(problem.contact.interaction_range) + CLEARANCE
    clear = dataclasses.replace(body, release=release, drags=())
    prepared = _preparing(problem.contact, many)(problem.contact, clear, many)
    place = float(prepared[1].equilibrium)
    return f"at rest the separation is {place * 1e9:.4g} nm; " if np.isfinite(place) else ""


def _integrate_in_chunks(
    body: Body,
    contact: Contact,
    table: Table,
    reference: Reference,
    limits: Limits,
    report: Report,
    stop: threading.Event | None,
) -> Solution:
    """The motion in chunks of impacts, so that it can be watched and stopped."""
    progress, origin = _start(contact, body, table)
    chunks: list[Impacts] = []
    while int(progress.outcome) == IN_MOTION and not (stop is not None and stop.is_set()):
        given = (contact, body, table, reference, origin, progress, limits, _at_once(contact, body))
        if not chunks:
            report(0.08, COMPILATION)
        go_on = _integrate_some.ready(*given)
        if not chunks:
            report(0.1, "motion")
        progress, rows = go_on()
        chunks.append(jax.tree_util.tree_map(np.asarray, rows))
        count = int(progress.made)
        report(0.1 + 0.75 * min(count / int(limits.impacts), 1.0), f"impact {count}")
    if not chunks:
        raise SimulationError("stopped before the first impact")
    impacts = jax.tree_util.tree_map(lambda *parts: np.concatenate(parts), *chunks)
    code = int(progress.outcome)
    outcome = Outcome.INTERRUPTED if code == IN_MOTION else ENDS[code]
    return Solution(Motion(impacts, progress, table, reference, origin), contact, outcome)


def _integrate_in_time(
    problem: Problem,
    contact: Contact,
    prepared: tuple[Table, Reference],
    limits: Limits,
    report: Report,
    stop: threading.Event | None,
) -> Solution:
    """The motion on a bulk that creeps, or with menisci that take time to form, step by step."""
    mechanism: Relaxation | DelayedContact | None = problem.relaxation or problem.delayed
    if isinstance(mechanism, DelayedContact) and isinstance(contact, ElasticContact):
        mechanism = Relaxation.none(mechanism)
    assert mechanism is not None
    report(0.1, "motion")

    def made(count: int) -> None:
        report(0.1 + 0.75 * min(count / int(limits.impacts), 1.0), f"impact {count}")

    try:
        motion, trajectory, outcome = integrate_stepped(
            contact, mechanism, problem.body, prepared, limits, made, stop
        )
    except Ended as error:
        raise SimulationError("stopped before the first impact") from error
    return Solution(motion, contact, outcome, trajectory)
