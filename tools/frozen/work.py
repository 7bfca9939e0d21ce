"""Structures computed, a few at a time in processes of their own."""

from __future__ import annotations

import multiprocessing
import tempfile
import time
import warnings
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from .kinds import Structure
from .rules import response_of
from .structures import structures

DRAWS = 2
"""Changes of all inputs by which a response is found."""

_FIRST = (
    "study-",
    "rough-bulk-",
    "rough-creep-",
    "smooth-creep",
)
"""Beginnings of the names of what takes longest, and starts first."""


def names() -> list[str]:
    """Names of all structures."""
    return [each.name for each in structures()]


def of_all(
    job: Callable[..., Any], jobs: list[tuple[Any, ...]], processes: int
) -> Iterator[tuple[str, Any, float]]:
    """Name, answer and time [s] of jobs as they end; a job's first argument is its name."""
    order = sorted(jobs, key=lambda each: not each[0].startswith(_FIRST))
    context = multiprocessing.get_context("spawn")
    with context.Pool(processes, maxtasksperchild=12) as pool:
        yield from pool.imap_unordered(_timed, [(job, each) for each in order])


def frozen(name: str) -> dict[str, Any]:
    """Inputs and answers of a structure, each value with its response.

    Returns
    -------
    "inputs" as `drawn` gives them, and "cases": answers by their case's name, whose "values" are
    pairs of a value and its response.
    """
    structure = _named(name)
    inputs = drawn(structure)
    cases = _answers(structure, inputs, None)
    others = [_answers(structure, inputs, seed) for seed in range(DRAWS)]
    for case, answer in cases.items():
        answers = [other.get(case, {"values": {}})["values"] for other in others]
        answer["values"] = {
            key: [value, response_of(value, [each.get(key) for each in answers])]
            for key, value in answer["values"].items()
        }
    return {"inputs": inputs, "cases": cases}


def again(name: str, inputs: dict[str, Any]) -> dict[str, Any]:
    """Answers of a structure's stored inputs."""
    return _answers(_named(name), inputs, None)


def drawn(structure: Structure) -> dict[str, Any]:
    """Inputs of a structure's cases: of each "run-N" and of the "study", by dotted keys."""
    draws = np.random.default_rng(zlib.crc32(structure.name.encode()))

    def draw(key: str) -> float:
        low, high = structure.ranges[key]
        return float(np.exp(draws.uniform(np.log(low), np.log(high))))

    out: dict[str, Any] = {}
    for i in range(structure.runs):
        out[f"run-{i}"] = {key: draw(key) for key in sorted(structure.ranges)}
    if structure.study:
        axes = sorted(structure.ranges)[: structure.study]
        out["study"] = {
            key: [draw(key), draw(key)] if key in axes else draw(key)
            for key in sorted(structure.ranges)
        }
    return out


def _named(name: str) -> Structure:
    return next(each for each in structures() if each.name == name)


def _answers(structure: Structure, inputs: dict[str, Any], seed: int | None) -> dict[str, Any]:
    """Answers of a structure's cases, by their names; with changed inputs where there is a seed."""
    from . import asking  # here, where the process is that of the work
    from .changing import Change

    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        change = Change(seed, Path(folder))
        if structure.base == "publication":
            return {"tables": asking.publication(change)}
        out = {}
        for name, values in inputs.items():
            try:
                case = _case(structure, values)
            except asking.FAILURES as error:
                out[name] = {**asking.failed(error), "sentences": {"error": str(error)[:90]}}
                continue
            if name == "study":
                axes = {
                    key: [change.number(each) for each in value]
                    for key, value in values.items()
                    if isinstance(value, list)
                }
                out |= asking.sweep(change.case(case), axes, critical=structure.critical)
            else:
                out[name] = asking.run(change.case(case), critical=structure.critical)
        return out


def _case(structure: Structure, values: dict[str, Any]) -> Any:
    """A case of a structure; of a study its first."""
    import asperity

    case = asperity.load(structure.base)
    first = {key: v[0] if isinstance(v, list) else v for key, v in values.items()}
    return case.replace({**structure.changes, **first})


def _timed(job: tuple[Callable[..., Any], tuple[Any, ...]]) -> tuple[str, Any, float]:
    """A job's name, answer and time [s]."""
    start = time.monotonic()
    return job[1][0], job[0](*job[1]), time.monotonic() - start
