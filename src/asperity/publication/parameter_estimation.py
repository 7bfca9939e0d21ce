"""The inputs that the publication does not name, found from its tables."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..config import Case
from ..config.resolve import resolve
from ..contact import PublishedContact
from ..dynamics import Body, simulate
from ..errors import Tolerance
from ..model import build
from ..numerics.compilation import Program
from ..results.measures import measure
from .published_tables import Entry

WITHIN = {"log_decrement": 0.03, "time_to_rest": 0.05}
"""Relative difference up to which a published number counts as met."""

_IMPACTS = 96
"""A motion of more impacts counts as one that does not rest."""

_EDGES = (2.4, 2.6, 2.8, 3.0, 3.2, 3.4)
"""Ends of the conjunction for which the other two inputs are fitted."""

_CLEARANCES = (2e-9, 5e-9, 12e-9)
_FACTORS = 10.0 ** np.linspace(-1.5, 2.0, 8)
_LOWEST_EDGE, _HIGHEST_EDGE, _LARGEST_FACTOR = 0.2, 7.9, np.log(999.0)  # those of a case
_LEAST_CLEARANCE = np.log(1e-11)
_MISSED = 3.0  # residual of a motion that does not rest


class Unknowns(NamedTuple):
    """What is not in the publication's text.

    Attributes
    ----------
    conjunction_ends
        Stribeck parameter at which the conjunction ends.
    release_separation
        Separation at the release [m].
    capillary_factor
        Factor on the menisci.
    """

    conjunction_ends: float
    release_separation: float
    capillary_factor: float

    @classmethod
    def of(cls, case: Case) -> Unknowns:
        """Those of a case."""
        assumed, gap = case.publication, case.launch.release_separation
        assert assumed is not None
        assert gap is not None
        return cls(assumed.conjunction_ends, gap, assumed.capillary_factor)

    def within(self, case: Case) -> Case:
        """A case with these inputs."""
        return case.replace(
            {
                "publication.conjunction_ends": float(self.conjunction_ends),
                "impact.release_separation": f"{float(self.release_separation)!r} m",
                "publication.capillary_factor": float(self.capillary_factor),
            }
        )


@dataclass(frozen=True)
class Refit:
    """The inputs that fit tables best, and how well they are known.

    Parameters
    ----------
    unknowns
        What the text leaves open.
    rms
        Root mean square of the relative differences.
    uncertainty
        One standard deviation of each input, from the scatter of the differences; NaN where
        there are no more numbers than inputs.
    correlation
        Of the inputs, shape (3, 3).
    profile
        Best inputs and their rms for each of several ends of the conjunction.
    """

    unknowns: Unknowns
    rms: float
    uncertainty: Unknowns
    correlation: np.ndarray
    profile: list[tuple[Unknowns, float]]


class _Target(NamedTuple):
    """One published number: which surface, which quantity, its value."""

    surface: int
    quantity: int
    value: float


def refit(
    case: Case,
    entries: Sequence[Entry],
    *,
    report: Callable[[float, str], None],
    stop: threading.Event,
) -> Refit | None:
    """Least squares of relative differences over decrements and stiction times.

    Parameters
    ----------
    case
        The case with a [publication] table; its three unknown inputs are a first guess.
    entries
        The tables.
    report, stop
        As for :func:`asperity.solve`.

    Returns
    -------
    None where fewer than three numbers are there, or where it was stopped.
    """
    problem = _Problem(case, entries)
    if len(problem.targets) < len(Unknowns._fields):
        return None
    first = problem.start(Unknowns.of(case))
    if stop.is_set():
        return None
    report(0.1, "two inputs at each end of the conjunction")
    inner = [edge for edge in reversed(_EDGES) if edge <= first[0]]
    outer = [edge for edge in _EDGES if edge > first[0]]
    with ThreadPoolExecutor(2) as pool:
        both = list(pool.map(lambda edges: _chain(problem, first, edges, stop), (inner, outer)))
    found = sorted([*both[0], *both[1]], key=lambda x: x[0])
    if stop.is_set():
        return None
    report(0.7, "all three inputs")
    best = min([first, *found], key=problem.rms)
    best = min(best, _descended(problem, best, slice(None), 200), key=problem.rms)
    profile = [(problem.unknowns(x), problem.rms(x)) for x in found]
    report(1.0, "refitted")
    return Refit(problem.unknowns(best), problem.rms(best), *problem.spread(best), profile)


def _chain(
    problem: _Problem, first: np.ndarray, edges: list[float], stop: threading.Event
) -> list[np.ndarray]:
    """Fits for ends of the conjunction one after the other, each a guess for the next."""
    found: list[np.ndarray] = []
    for edge in edges:
        if stop.is_set():
            break
        near = found[-1] if found else first
        # The pull at the edge falls with its pressure, by some e^-3.7 per rms height.
        guess = np.array([edge, near[1], near[2] - 3.7 * (edge - near[0])])
        found.append(_descended(problem, guess, slice(1, None), 60))
    return found


def _descended(problem: _Problem, start: np.ndarray, free: slice, most: int) -> np.ndarray:
    """Least squares in some of the variables, then a simplex over the steps in time."""
    from scipy.optimize import least_squares, minimize

    def at(values: np.ndarray) -> np.ndarray:
        whole = start.copy()
        whole[free] = values
        return problem.residuals(whole)

    first = least_squares(at, start[free], diff_step=3e-3, max_nfev=30).x
    options = {"xatol": 1e-5, "fatol": 1e-9, "maxfev": most}
    last = minimize(
        lambda v: float(np.sum(at(v) ** 2)), first, method="Nelder-Mead", options=options
    )
    out = start.copy()
    out[free] = last.x
    return out


class _Problem:
    """Residuals of all published numbers, over (edge, log clearance, log factor).

    The clearance is what the release lies above the highest edge.
    """

    def __init__(self, case: Case, entries: Sequence[Entry]) -> None:
        plain = Unknowns(*Unknowns.of(case)[:2], 1.0).within(case)
        problem = build(resolve(plain))
        assert isinstance(problem.contact, PublishedContact)
        self._contact, self._body = problem.contact, problem.body
        self._rest = plain.numerics.rest_height_ratio
        surfaces = sorted({entry.surface for entry in entries})
        self._surfaces = jnp.asarray(surfaces)
        self._highest = max(height for _, height in surfaces)
        found = {
            _Target(surfaces.index(entry.surface), number, value)
            for entry in entries
            for number, quantity in enumerate(WITHIN)
            if (value := entry.values[quantity]) is not None
        }
        self.targets = sorted(found)  # the row that both tables share counts once

    def unknowns(self, x: np.ndarray) -> Unknowns:
        gap = x[0] * self._highest + np.exp(x[1])
        return Unknowns(float(x[0]), float(gap), float(np.exp(x[2])))

    def residuals(self, x: np.ndarray) -> np.ndarray:
        allowed = _LOWEST_EDGE < x[0] < _HIGHEST_EDGE and x[2] < _LARGEST_FACTOR
        if not (allowed and x[1] > _LEAST_CLEARANCE):
            return np.full(len(self.targets), _MISSED)
        found = np.asarray(
            _integrate(self._contact, self._body, self._surfaces, jnp.asarray(self.unknowns(x)),
                     jnp.asarray(self._rest))
        )  # fmt: skip
        out = np.array([found[t.surface, t.quantity] / t.value - 1.0 for t in self.targets])
        return np.where(np.isfinite(out), out, _MISSED)

    def rms(self, x: np.ndarray) -> float:
        return float(np.sqrt(np.mean(self.residuals(x) ** 2)))

    def start(self, given: Unknowns) -> np.ndarray:
        """The best of the inputs given and of a coarse net at their end of the conjunction."""
        edge = given.conjunction_ends
        clearance = max(given.release_separation - edge * self._highest, 1e-10)
        net = [np.array([edge, np.log(c), np.log(f)]) for c in _CLEARANCES for f in _FACTORS]
        here = np.array([edge, np.log(clearance), np.log(given.capillary_factor)])
        return min([here, *net], key=self.rms)

    def spread(self, x: np.ndarray) -> tuple[Unknowns, np.ndarray]:
        """Standard deviations of the inputs and their correlation, from central differences."""
        step = 0.01  # wide: a stiction time steps where an impact is added
        columns = []
        for k in range(3):
            move = np.zeros(3)
            move[k] = step
            columns.append((self.residuals(x + move) - self.residuals(x - move)) / (2.0 * step))
        jacobian = np.stack(columns, axis=1)
        spare = len(self.targets) - 3
        scatter = np.sum(self.residuals(x) ** 2) / spare if spare > 0 else np.nan
        covariance = scatter * np.linalg.pinv(jacobian.T @ jacobian)
        # To the inputs themselves: the gap moves with the edge and with the clearance.
        edge, gap, factor = self.unknowns(x)
        change = np.array(
            [[1.0, 0.0, 0.0], [self._highest, gap - edge * self._highest, 0.0], [0.0, 0.0, factor]]
        )
        covariance = change @ covariance @ change.T
        sigma = np.sqrt(np.diag(covariance))
        sigma = np.where(sigma > 0.0, sigma, np.nan)  # where no number depends on an input
        return Unknowns(*map(float, sigma)), covariance / np.outer(sigma, sigma)


def _motion_of(
    contact: PublishedContact,
    body: Body,
    surfaces: jax.Array,
    inputs: jax.Array,
    rest: jax.Array,
) -> jax.Array:
    """Decrement of the first rebound and stiction time [s] on each surface."""
    edge, gap, factor = inputs

    def one(surface: jax.Array) -> jax.Array:
        pressure = replace(
            contact.pressure,
            radius=surface[0],
            rms_height=surface[1],
            edge=edge,
            tension=contact.pressure.tension * factor,
        )
        released = Body(body.mass, body.gravity, gap, body.speed, rebounds_from=pressure.end)
        tolerance = Tolerance(rest=rest, max_impacts=_IMPACTS)  # type: ignore[arg-type]
        motion = simulate(replace(contact, pressure=pressure), released, tolerance=tolerance)
        found = measure(motion, released)
        return jnp.stack([found.log_decrement[0], found.time_to_rest])

    return jax.vmap(one)(surfaces)


_integrate = Program(_motion_of)
