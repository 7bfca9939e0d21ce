"""From a case to a result: the one path that the command line, the page and studies use."""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from . import regimes
from ._jax import jax
from .case import Case
from .case.build import CLEARANCE, Problem, build
from .contact import Contact
from .errors import InputError, Outcome, SimulationError
from .impact import Body, Impacts, Limits, Motion, Table, fly, prepare, start
from .impact.datum import Datum
from .impact.motion import ENDS, FLYING
from .impact.sampling import Series, compile_ahead, sample, until
from .impact.table import CENTRAL, FORCE, STORED, quantities, read_row
from .measures import Measures, measure
from .program import Program
from .result import Curve, Result
from .trace import trace
from .validity import AtDepth, warnings_of

Report = Callable[[float, str], None]

_CHUNK = 10  # impacts a compiled call: short enough for Ctrl-C
_REFINEMENTS = (1, 2, 4, 8)  # of the panels, until the curves meet the tolerance
_RESIDUAL = 1e-6  # relative force error of a contact that counts as solved


class _Flight(NamedTuple):
    motion: Motion
    contact: Contact
    outcome: Outcome


def solve(
    case: Case,
    *,
    name: str = "case",
    progress: Report | None = None,
    stop: threading.Event | None = None,
    throw: bool = True,
) -> Result:
    """Motion of a case from its release to its end, with everything measured.

    Parameters
    ----------
    case
        A case; see :func:`asperity.load`.
    name
        What to call it.
    progress
        Called with a fraction done and a line of text, now and then.
    stop
        Set from another thread, it ends the motion early; what was computed is returned.
    throw
        Whether a numerical failure raises, or comes back as the result's outcome.

    Raises
    ------
    InputError
        If the release lies inside contact, or models count one force twice.
    SimulationError
        If the numerics fail; its ``partial`` is the result so far.
    """
    tell = progress or (lambda fraction, text: None)
    problem = build(case)
    tell(0.02, "force curves")
    limits = Limits.of(case.tolerance)
    contact, table, datum = _prepared(problem, case.numerics.tolerance, limits)
    _check_release(problem, table)
    flight = _fly(problem.body, contact, table, datum, limits, tell, stop)
    tell(0.9, "measures")
    result = _result(case, name, problem, flight)
    tell(1.0, "done")
    if flight.outcome is Outcome.FAILED and throw:
        raise SimulationError("the motion left the tabulated separations", result)
    return result


def curve(
    case: Case,
    *,
    name: str = "case",
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> Curve:
    """Force against separation, approaching to the depth of the case's first impact and back.

    Parameters
    ----------
    case, name, progress, stop
        As for :func:`solve`; a curve is too short to be stopped half-way.

    Raises
    ------
    InputError, SimulationError
        As :func:`solve`.
    """
    tell = progress or (lambda fraction, text: None)
    problem = build(case)
    tell(0.1, "force curves")
    limits = Limits.of(dataclasses.replace(case.tolerance, max_impacts=1))
    contact, table, datum = _prepared(problem, case.numerics.tolerance, limits)
    _check_release(problem, table)
    body = problem.body
    first, origin = _start(contact, body, table)
    _, impacts = _fly_some(contact, body, table, datum, origin, first, limits, _CHUNK)
    tell(0.6, "parting")
    drawn = trace(contact, table, impacts)
    tell(1.0, "done")
    return Curve(case, name, **drawn)


def _prepared(problem: Problem, tolerance: float, limits: Limits) -> tuple[Contact, Table, Datum]:
    """Tables whose interpolation error meets the tolerance, by more panels where needed.

    Meanwhile the motion compiles.
    """
    for factor in _REFINEMENTS:
        contact = problem.contact.refined(factor)
        _compile(contact, problem.body, limits)
        table, datum = _prepare(contact, problem.body)
        if float(table.error) <= tolerance:
            break
    else:
        raise SimulationError(
            f"force curves reach a relative error of {float(table.error):.1e}, "
            f"not `numerics.tolerance` = {tolerance:.1e}"
        )
    if not float(table.residual) <= _RESIDUAL:
        raise SimulationError(
            "pressure and deformation do not agree: relative force error "
            f"{float(table.residual):.1e}. The contact has no equilibrium that follows "
            "from the one before (strong adhesion on soft bodies folds it)"
        )
    return contact, table, datum


def _compile(contact: Contact, body: Body, limits: Limits) -> None:
    """Compile the curves, the motion and its drawing side by side."""
    table, datum = _prepare.ahead(contact, body)
    progress, origin = _start.ahead(contact, body, table)
    _, impacts = _fly_some.ahead(contact, body, table, datum, origin, progress, limits, _CHUNK)
    compile_ahead(body, table, impacts)


_prepare = Program(prepare)
_start = Program(start)
_fly_some = Program(fly)
_measure = Program(measure)


def _check_release(problem: Problem, table: Table) -> None:
    """A release within contact is refused: it would not be a fall."""
    body = problem.body
    release, weight = float(body.release), float(body.weight)
    force = abs(float(read_row(table, 0, release)[FORCE]))
    largest = float(np.max(np.abs(np.asarray(table.values)[..., 0, FORCE])))
    limit = 1e-3 * weight if weight > 0.0 else 1e-6 * largest
    if force <= limit:
        return
    share = "1e-3 of the weight" if weight > 0.0 else "1e-6 of its peak"
    raise InputError(
        f"`release_gap` must lie outside contact: the contact force there must be below {share} "
        f"({limit:.3g} N), and is {force:.3g} N; {_at_rest(problem)}got {release * 1e9:.6g} nm",
        key="impact.release_gap",
    )


def _at_rest(problem: Problem) -> str:
    """Where the body would rest, seen from outside contact; empty where nothing holds it."""
    body = problem.body
    clear = Body(body.mass, body.gravity, problem.contact.reach + CLEARANCE, body.speed)
    place = float(_prepare(problem.contact, clear)[1].equilibrium)
    return f"at rest the separation is {place * 1e9:.4g} nm; " if np.isfinite(place) else ""


def _fly(
    body: Body,
    contact: Contact,
    table: Table,
    datum: Datum,
    limits: Limits,
    tell: Report,
    stop: threading.Event | None,
) -> _Flight:
    """The motion in chunks of impacts, so that it can be watched and stopped."""
    progress, origin = _start(contact, body, table)
    chunks: list[Impacts] = []
    while int(progress.outcome) == FLYING and not (stop is not None and stop.is_set()):
        progress, rows = _fly_some(contact, body, table, datum, origin, progress, limits, _CHUNK)
        chunks.append(jax.tree_util.tree_map(np.asarray, rows))
        count = int(progress.made)
        tell(0.1 + 0.75 * min(count / int(limits.impacts), 1.0), f"impact {count}")
    if not chunks:
        raise SimulationError("stopped before the first impact")
    impacts = jax.tree_util.tree_map(lambda *parts: np.concatenate(parts), *chunks)
    code = int(progress.outcome)
    outcome = Outcome.INTERRUPTED if code == FLYING else ENDS[code]
    return _Flight(Motion(impacts, progress, table, datum, origin), contact, outcome)


def _padded(motion: Motion, body: Body) -> Measures:
    """Measures over a power of two of rows: few shapes, so few compilations."""
    rows = motion.impacts.made.shape[0]
    size = max(16, 1 << (rows - 1).bit_length())

    def pad(leaf: Any) -> Any:
        return np.concatenate([leaf, np.zeros((size - rows, *leaf.shape[1:]), leaf.dtype)])

    return _measure(motion._replace(impacts=jax.tree_util.tree_map(pad, motion.impacts)), body)


def _result(case: Case, name: str, problem: Problem, flight: _Flight) -> Result:
    motion, body = flight.motion, problem.body
    made = int(np.sum(motion.impacts.made))
    measures = _padded(motion, body)
    series = sample(body, motion.table, motion.impacts)
    if case.numerics.time_limit is not None:
        series = until(series, case.numerics.time_limit)
    at_depth = AtDepth.of(flight.contact, motion)
    regime = _regime(case, problem, at_depth)
    forces, energies = _histories(flight.contact, motion, body, series)
    impacts = motion.impacts
    return Result(
        case=case,
        name=name,
        outcome=flight.outcome,
        time=series.time,
        separation=series.separation,
        central_separation=series.rows[:, CENTRAL],
        speed=series.speed,
        forces=forces,
        energies=energies,
        regime=regime._asdict(),
        measures=_plain(measures, made),
        ledger=_ledger(flight.contact, motion, float(body.weight), made),
        warnings=warnings_of(case, problem, regime, at_depth, motion),
        events={
            name: np.asarray(values)[:made]
            for name, values in (
                ("deepest_time", impacts.deepest_time),
                ("apex_time", impacts.apex_time),
                ("deepest_separation", impacts.deepest),
                ("apex_separation", impacts.apex),
            )
        },
    )


def _regime(case: Case, problem: Problem, at_depth: AtDepth) -> regimes.Regime:
    adhesion, rough = case.adhesion, case.roughness
    work, spacing = adhesion.work, adhesion.range
    tabor = plasticity = load = None
    if work and spacing:
        tabor = regimes.tabor_number(problem.tip_radius, work, problem.modulus, spacing)
    solids = (case.body_solid, case.counterface_solid)
    hardness = [solid.hardness for solid in solids if solid.hardness]
    if rough is not None and hardness:
        plasticity = regimes.plasticity_index(
            problem.modulus, min(hardness), rough.rms_height, rough.asperity_radius
        )
    touching = at_depth.touching
    if work and touching > 0.0:
        elastic = at_depth.elastic
        load = regimes.load_parameter(elastic, touching, work, problem.tip_radius)
    elasticity = None if tabor is None else regimes.ELASTICITY_PER_TABOR * tabor
    return regimes.Regime(tabor, elasticity, plasticity, load, adhesion.model)


def _histories(
    contact: Contact, motion: Motion, body: Body, series: Series
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Forces and energies along the motion."""
    layout = quantities(contact)
    weight = float(body.weight)
    rows: np.ndarray = series.rows
    parts = rows[:, layout.components]
    forces: dict[str, np.ndarray] = {name: parts[:, k] for k, name in enumerate(contact.components)}
    forces["contact"] = rows[:, FORCE]
    forces["weight"] = np.full(len(rows), -weight)
    forces["total"] = rows[:, FORCE] - weight
    energies = {
        "kinetic": 0.5 * float(body.mass) * series.speed**2,
        "potential": weight * (series.separation - _zero_height(motion.datum)),
        "stored": rows[:, STORED],
    }
    for name, lost in _losses_along(contact, motion, series).items():
        energies[f"lost_{name}"] = lost
    return forces, energies


def _losses_along(contact: Contact, motion: Motion, series: Series) -> dict[str, np.ndarray]:
    """Energy lost by mechanism at every sample, from the bonds made and broken until then."""
    formation, rupture = (np.asarray(x) for x in contact.losses())
    bonds = series.rows[:, quantities(contact).bonds]
    impact, rising = series.phase // 2, series.phase % 2 == 1
    fall, rise = motion.impacts.fall, motion.impacts.rise
    begun = np.where(rising[:, None], rise.bonds[impact], fall.bonds[impact])
    lost = np.where(rising[:, None], rise.lost[impact], fall.lost[impact])
    change = bonds - begun
    lost = lost + np.maximum(change, 0.0) * formation + np.maximum(-change, 0.0) * rupture
    out: dict[str, np.ndarray] = {}
    for k, name in enumerate(contact.mechanisms):
        out[name] = out.get(name, 0.0) + lost[:, k]
    return out


def _zero_height(datum: Datum) -> float:
    """Separation at which the potential energy is 0: the static equilibrium, if any."""
    at_rest = float(datum.equilibrium)
    return at_rest if np.isfinite(at_rest) else 0.0


def _ledger(contact: Contact, motion: Motion, weight: float, made: int) -> dict[str, Any]:
    """Energy at the release, lost by mechanism, and how well all of it adds up."""
    lost: dict[str, float] = {}
    for name, value in zip(contact.mechanisms, motion.impacts.lost[made - 1], strict=True):
        lost[name] = lost.get(name, 0.0) + float(value)
    impact_energy = float(motion.impacts.fastest[0])
    closure = float(np.max(motion.impacts.closure[:made])) / impact_energy
    initial = float(motion.release) - weight * _zero_height(motion.datum)
    return {"initial": initial, "lost": lost, "closure": closure}


def _plain(measures: Measures, made: int) -> dict[str, Any]:
    """Measures as plain numbers and lists, None where one does not apply."""
    out: dict[str, Any] = {}
    for name, value in measures._asdict().items():
        if name == "reference":
            continue
        array = np.asarray(value)
        if array.ndim == 0:
            out[name] = bool(array) if array.dtype == bool else _number(array)
        else:
            out[name] = [_number(x) for x in array[:made]]
    return out


def _number(value: Any) -> float | None:
    return float(value) if np.isfinite(value) else None
