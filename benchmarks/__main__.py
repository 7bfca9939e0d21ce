"""Run all benchmarks: ``make bench`` or ``python -m benchmarks``."""

from __future__ import annotations

import dataclasses
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import equinox as eqx
import numpy as np

import asperity
from asperity._jax import jax, jnp
from asperity.config.resolve import resolve
from asperity.dynamics import simulate
from asperity.dynamics.problem import Problem
from asperity.errors import Tolerance
from asperity.model import build
from asperity.publication.evidence import PRINTED
from asperity.results.measures import measure

from . import laws, published_method, single_bodies, surfaces, sweeps, web
from .plain_scipy import Drop, integrate

PROGRAM = Path(sys.executable).with_name("asperity")
BATCH = 1000  # a thread; two threads
HALF_SPACE_BATCH = 8
IMPACTS = 20
"""More than the wet drop makes before it rests."""


def main() -> None:
    """Print every figure beside its goal."""
    print(f"two threads at most; {os.cpu_count()} cores here\n")
    _programs()
    wet = _wet()
    _accuracy(wet)
    _one_motion(wet)
    _batch(wet)
    _half_space()
    _laws()
    for what, figure, goal in surfaces.rows():
        _line(what, figure, goal)
    for what, figure, goal in single_bodies.rows():
        _line(what, figure, goal)
    _publication()
    for what, figure, goal in sweeps.rows():
        _line(what, figure, goal)
    for what, figure, goal in web.rows():
        _line(what, figure, goal)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    _line("peak memory of this run", f"{peak:.2f} GB", "1.5 GB")


def _line(what: str, value: str, goal: str = "") -> None:
    print(f"{what:<62}{value:>16}" + (f"   goal {goal}" if goal else ""), flush=True)


def _best(action: Callable[[], Any], repeats: int = 5) -> float:
    times = []
    for _ in range(repeats):
        begun = time.perf_counter()
        action()
        times.append(time.perf_counter() - begun)
    return float(np.median(times))


def _programs() -> None:
    with tempfile.TemporaryDirectory() as folder:
        cache = {**os.environ, "JAX_COMPILATION_CACHE_DIR": str(Path(folder) / "cache")}
        options = ["-q", "--force", "-o", f"{folder}/out"]

        def call(command: list[str]) -> None:
            subprocess.run(command, env=cache, check=True, capture_output=True)

        for case in ("glass-bead", "published-exact"):
            run = [str(PROGRAM), "run", case, *options]
            first, later = _best(lambda: call(run), 1), _best(lambda: call(run), 3)  # noqa: B023
            _line(f"asperity run {case}, nothing compiled", f"{first:.1f} s", "10 s")
            _line(f"asperity run {case}, after that", f"{later:.1f} s", "5 s")
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 2**20
        _line("  its peak memory", f"{peak:.2f} GB", "1.5 GB")
        help_ = _best(lambda: call([str(PROGRAM), "--help"]), 5)
        _line("asperity --help", f"{help_:.2f} s", "0.3 s")


def _wet(**changes: object) -> Problem:
    """The wet drop on finer asperities: it comes to rest after thirteen impacts."""
    drop = asperity.load(str(Path(__file__).parents[1] / "examples" / "wet-drop.toml"))
    finer = {
        "roughness.asperity_density": "2e14 1/m^2",
        "roughness.asperity_radius": "25 nm",
        "roughness.rms_height": "1 nm",
        "adhesion.work": "30 mJ/m^2",
        "adhesion.equilibrium_spacing": "0.2 nm",
    }
    return build(resolve(drop.replace({**finer, **changes})))


def _drop(problem: Problem) -> Drop:
    contact, body = problem.contact, problem.body
    interface = contact.interface
    hertz, dmt, meniscus = interface.law.parts
    return Drop(
        radius=float(contact.shape.radius),
        modulus=float(hertz.modulus),
        density=float(interface.density),
        summit_radius=float(hertz.radius),
        rms=float(interface.heights.rms),
        work=float(dmt.work_of_adhesion),
        pull=float(meniscus.pull),
        interaction_range=float(meniscus.interaction_range),
        mass=float(body.mass),
        gravity=float(body.gravity),
        release=float(body.release),
    )


def _flight(impacts: int) -> Callable[..., Any]:
    tolerance = Tolerance(max_impacts=impacts)

    @eqx.filter_jit
    def go(contact: Any, body: Any) -> Any:
        motion = simulate(contact, body, tolerance=tolerance)
        found = measure(motion, body)
        return motion.impacts.apex, motion.end.made, found.log_decrement

    return go


def _accuracy(problem: Problem) -> None:
    apex, made, _ = _flight(IMPACTS)(problem.contact, problem.body)
    count = min(int(made), 5)
    other = np.array(integrate(_drop(problem), count, tolerance=1e-11))
    off = float(np.max(np.abs(np.asarray(apex)[:count] - other)) / problem.body.release)
    _line(f"largest relative difference of {count} apexes from the SciPy script", f"{off:.1e}")


def _one_motion(problem: Problem) -> None:
    go = _flight(IMPACTS)
    made = int(jax.block_until_ready(go(problem.contact, problem.body))[1])
    ours = _best(lambda: jax.block_until_ready(go(problem.contact, problem.body)), 20)
    theirs = _best(lambda: integrate(_drop(problem), made), 1)
    _line(f"one warm rigid motion of {2 * made} phases", f"{ours * 1e3:.2f} ms", "10 ms")
    _line("  the SciPy script on the same motion", f"{theirs * 1e3:.0f} ms")
    _line("  ratio", f"{theirs / ours:.0f}")
    exact = build(
        resolve(asperity.load("published-exact").replace({"counterface.deformation": "rigid"}))
    )
    go = _flight(200)
    jax.block_until_ready(go(exact.contact, exact.body))
    whole = _best(lambda: jax.block_until_ready(go(exact.contact, exact.body)), 10)
    _line("one warm rigid motion of published-exact, 400 phases", f"{whole * 1e3:.2f} ms", "10 ms")


def _batch(problem: Problem) -> None:
    rms = problem.contact.interface.heights.rms * jnp.linspace(0.95, 1.05, 2 * BATCH)
    tolerance = Tolerance(max_impacts=IMPACTS)

    @jax.jit
    def go(heights: jax.Array) -> tuple[jax.Array, jax.Array]:
        def one(height: jax.Array) -> tuple[jax.Array, jax.Array]:
            contact = eqx.tree_at(lambda c: c.interface.heights.rms_height, problem.contact, height)
            motion = simulate(contact, problem.body, tolerance=tolerance)
            return motion.impacts.apex[0], motion.end.made

        # Batches of 50: their intermediate arrays stay in the cache.
        return jax.lax.map(one, heights, batch_size=50)

    halves = jnp.split(rms, 2)
    made = np.asarray(go(halves[0])[1])

    def both() -> None:
        with ThreadPoolExecutor(2) as pool:
            list(pool.map(lambda half: jax.block_until_ready(go(half)), halves))

    rate = 2 * BATCH / _best(both, 3)
    phases = 2 * float(np.mean(made))
    _line(
        f"rigid motions a second, {2 * BATCH} of {phases:.0f} phases, two threads",
        f"{rate:.0f}",
        "2000",
    )


def _half_space() -> None:
    problem = _wet(**{"counterface.deformation": "half-space", "numerics.rings": 48})
    tolerance = Tolerance(max_impacts=IMPACTS)

    @jax.jit
    def go(heights: jax.Array) -> jax.Array:
        def one(height: jax.Array) -> jax.Array:
            contact = eqx.tree_at(lambda c: c.interface.heights.rms_height, problem.contact, height)
            return simulate(contact, problem.body, tolerance=tolerance).end.made

        return jax.lax.map(one, heights)

    rms = problem.contact.interface.heights.rms_height * jnp.linspace(0.95, 1.05, HALF_SPACE_BATCH)
    halves = jnp.split(rms, 2)
    made = jax.block_until_ready(go(halves[0]))

    def both() -> None:
        with ThreadPoolExecutor(2) as pool:
            list(pool.map(lambda half: jax.block_until_ready(go(half)), halves))

    rate = HALF_SPACE_BATCH / _best(both, 3)
    phases = 2 * float(np.mean(made))
    _line(
        f"half-space motions a second, {phases:.0f} phases, 48 rings, two threads",
        f"{rate:.1f}",
        "50",
    )


def _laws() -> None:
    """Each law over Hertz with DMT."""
    for what, ratios in laws.rows():
        _line(what, ratios, "2.00")


def _publication() -> None:
    """The published case beside the publication's own method, on the same assumptions."""
    case = asperity.load("published")
    problem = build(resolve(case))
    go = _flight(16)
    _, made, decrements = jax.block_until_ready(go(problem.contact, problem.body))
    impacts = int(made)
    ours = _best(lambda: jax.block_until_ready(go(problem.contact, problem.body)), 50)
    _line(f"the published case, one warm motion of {2 * impacts} phases", f"{ours * 1e3:.2f} ms")
    theirs, took = _by_method(problem, impacts, points=64, deforms=True, tolerance=0.1)
    _line("  the publication's method, 64x64, eq. 22 met to 0.1", f"{took:.1f} s")
    _line("  ratio", f"{took / ours:.0f}", "1000")
    rigid, quick = _by_method(problem, impacts, points=64, deforms=False)
    _line("  the same without deformation, as the published case", f"{quick:.2f} s")
    batch = _published_batch(problem)
    _line(
        "  ratio, and to one of a batch of 500 here",
        f"{quick / ours:.0f}, {quick / batch:.0f}",
        "1000",
    )
    _line("  its decrement with deformation over that without", f"{theirs / rigid:.3f}")
    resolved = problem.contact.resolved
    finer = dataclasses.replace(
        problem.contact, resolved=resolved._replace(panels=8 * resolved.panels)
    )
    converged = float(go(finer, problem.body)[2][0])
    # To 1e-8 an integration in time agrees, in the tests.
    our_error = max(abs(float(decrements[0]) / converged - 1.0), 1e-8)
    their_error = abs(rigid / converged - 1.0)
    _line("  relative error of the decrement: ours, at most", f"{our_error:.0e}")
    _line("  that of the method without deformation, 64x64", f"{their_error:.1e}")
    _line("  ratio", f"{their_error / our_error:.0e}", "100")
    _convergence("fitted polynomials", problem, converged)
    printed = build(resolve(PRINTED.within(case).replace({"publication.polynomials": "printed"})))
    decrement = float(go(printed.contact, printed.body)[2][0])
    functions = {"f0": published_method.PRINTED_F0, "f32": published_method.PRINTED_F32}
    _convergence("printed polynomials", printed, decrement, **functions)


def _published_batch(problem: Problem) -> float:
    """Time of one motion in a batch over rms heights [s], on one thread."""
    heights = problem.contact.pressure.rms_height * jnp.linspace(0.98, 1.02, 500)
    tolerance = Tolerance(max_impacts=16)

    @jax.jit
    def go(heights: jax.Array) -> jax.Array:
        def one(height: jax.Array) -> jax.Array:
            contact = eqx.tree_at(lambda c: c.pressure.rms_height, problem.contact, height)
            return simulate(contact, problem.body, tolerance=tolerance).end.time

        return jax.lax.map(one, heights, batch_size=50)

    jax.block_until_ready(go(heights))
    return _best(lambda: jax.block_until_ready(go(heights)), 3) / heights.size


def _by_method(problem: Problem, impacts: int, **options: Any) -> tuple[float, float]:
    """First decrement by the publication's method, and how long its motion took [s]."""
    method = published_method.of_problem(problem, **options)
    begun = time.perf_counter()
    apexes, _ = published_method.integrate(method, impacts)
    took = time.perf_counter() - begun
    edge = method.edge * method.rms
    return float(np.log((method.release - edge) / (apexes[0] - edge))), took


def _convergence(name: str, problem: Problem, converged: float, **functions: Any) -> None:
    """How the method tends to the chain's decrement with its grid and its step in time."""
    errors = []
    for points, step in ((64, 1e-7), (192, 2.5e-8)):
        options = {"points": points, "step": step, "deforms": False, **functions}
        errors.append(abs(_by_method(problem, 1, **options)[0] / converged - 1.0))
    _line(f"  its error, {name}, 64x64; 192x192, step/4",
          f"{errors[0]:.1e}, {errors[1]:.1e}")  # fmt: skip


if __name__ == "__main__":
    main()
