"""Stores of studies that were never computed: a law anyone can check in place of the physics."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from asperity.errors import ENDS, Outcome
from asperity.sweeps.store.store import Store
from asperity.sweeps.store.variables import drawn
from asperity.sweeps.study.study import Study, parse

REST, FAILED = ENDS.index(Outcome.REST), ENDS.index(Outcome.FAILED)
LEAST_SPEED = 0.1
"""Speed [m/s] below which a body of `law` sticks."""

KEEP = """schema = 1
base = "published"
keep = ["captured", "impact_speed", "restitution", "time_to_rest"]
"""
GRID = (
    KEEP
    + """[axes]
"roughness.rms_height" = {from = "8 nm", to = "12 nm", steps = 41, scale = "log"}
"capillary.humidity" = {from = 0.1, to = 0.5, steps = 21}
"""
)
SPEEDS = KEEP + '[axes]\n"impact.speed" = {from = "0.05 m/s", to = "0.5 m/s", steps = 19}\n'
SAMPLE = (
    KEEP
    + """[axes]
"roughness.rms_height" = {from = "8 nm", to = "12 nm", scale = "log"}
"capillary.humidity" = {from = 0.1, to = 0.5}
"adhesion.model" = {values = ["dmt", "none"]}
[sample]
method = "sobol"
size = 256
seed = 1
"""
)


def law(values: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Impact speed [m/s] and restitution of cases: faster and rougher bounces, wetter sticks."""
    size = next(iter(values.values())).size
    speed = values.get("impact.speed", np.full(size, 0.2))
    rough = values.get("roughness.rms_height", np.full(size, 1e-8)) / 1e-8
    humid = values.get("capillary.humidity", np.full(size, 0.2))
    dry = np.array([1.0 if model == "none" else 0.0 for model in values.get("adhesion.model", [0])])
    energy = 1.0 - (LEAST_SPEED / speed) ** 2 * (humid / 0.2) / rough**4 + 0.1 * dry
    return speed, np.sqrt(np.clip(energy, 0.0, 1.0))


def columns_of(study: Study, cases: range, failed: frozenset[int]) -> dict[str, np.ndarray]:
    """The columns of some cases by `law`; those of failed ones are empty, with a reason."""
    speed, bounce = law(study.values(cases.start, cases.stop))
    lost = np.array([case in failed for case in cases])
    found = {
        "outcome": np.where(lost, FAILED, REST),
        "impacts": np.full(len(cases), 3),
        "energy_balance_error": np.full(len(cases), 1e-15),
        "captured": np.where(lost, -1, bounce == 0.0),
        "impact_speed": np.where(lost, np.nan, speed),
        "restitution": np.where(lost, np.nan, bounce),
        "time_to_rest": np.where(lost, np.nan, 1e-3 * (1.0 + bounce)),
    }
    out = {}
    for column in study.columns:
        shape = (len(cases), study.width(column.along)) if column.along else (len(cases),)
        values = np.full(shape, column.fill, column.dtype)
        if column.name == "reason":
            text = "the contact folds: é".encode()
            values[lost, : len(text)] = np.frombuffer(text, "u1")
        elif column.along:
            values[:, 0] = found[column.name]
        else:
            values[...] = found[column.name]
        out[column.name] = values
    return out


def stored(
    folder: Path, text: str, failed: frozenset[int] = frozenset(), tasks: int | None = None
) -> Path:
    """A store of a study's text with `law` in it; of its first tasks alone where asked."""
    study = parse(text)
    store = Store.create(folder / "study.zarr", study)
    for number in range(study.tasks if tasks is None else tasks):
        cases = study.task(number)
        store.write(number, columns_of(study, cases, failed) | drawn(study, cases))
    store.finish()
    return store.path
