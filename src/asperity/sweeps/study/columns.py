"""What a study keeps of each case: names, kinds and units of the columns."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from asperity.config.base_table import Table
from asperity.config.problems import among, tables_of
from asperity.config.tables import CaseTables
from asperity.errors import ENDS, InputError, Outcome
from asperity.units import shown

REASON_SIZE = 160
"""Bytes kept of the reason why a case failed: UTF-8, ended by zeros."""

FAILED = ENDS.index(Outcome.FAILED)
"""Code of a case that failed, in the column ``outcome``."""


class Column(NamedTuple):
    """A column of a store: one row a case.

    Attributes
    ----------
    name
        Its name.
    dtype
        NumPy's name of its type: "float64", "int8" (-1 is none), "int32", "uint8".
    unit
        SI unit; "1" for numbers, "" for codes and text.
    meaning
        What it is, in a few words, for labels.
    along
        Dimension besides the cases: "" (none), "impact", "byte".
    """

    name: str
    dtype: str
    unit: str
    meaning: str
    along: str = ""

    @property
    def fill(self) -> float | int:
        """What stands where a measure does not apply."""
        return np.nan if self.dtype == "float64" else (0 if self.dtype == "uint8" else -1)


ALWAYS: tuple[Column, ...] = (
    Column("outcome", "int8", "", "how the motion ended"),
    Column("impacts", "int32", "1", "number of impacts"),
    Column(
        "energy_balance_error",
        "float64",
        "1",
        "largest error of the energy balance over the impact energy or that lost",
    ),
    Column("reason", "uint8", "", "why the case failed", "byte"),
)
"""Columns of every study."""

LOSSES = tuple(
    table.loss
    for field in CaseTables.model_fields.values()
    for table in tables_of(field.annotation)
    if issubclass(table, Table) and table.loss is not None
)
"""Mechanisms whose losses can be kept, as ``lost_NAME``."""

OF_BODIES: tuple[Column, ...] = (
    Column("capture_probability", "float64", "1", "captured share of single bodies"),
    Column("capture_probability_low", "float64", "1", "lower bound of the captured share"),
    Column("capture_probability_high", "float64", "1", "upper bound of the captured share"),
    Column("mean_restitution", "float64", "1", "mean restitution of single bodies"),
    Column("mean_restitution_error", "float64", "1", "standard error of that mean"),
    Column("median_restitution", "float64", "1", "median restitution of single bodies"),
    Column("median_contacting", "float64", "1", "median of contacting summits"),
    Column("median_loaded", "float64", "1", "median of effectively loaded summits"),
    Column("median_pull_off", "float64", "N", "median pull-off force of single bodies"),
)
"""Measures of the single bodies of a case; none where it has none."""

MEASURES: tuple[Column, ...] = (
    Column("impact_speed", "float64", "m/s", "impact speed"),
    Column("maximum_speed", "float64", "m/s", "largest speed on the first way in"),
    Column("captured", "int8", "", "whether the first impact captures"),
    Column("critical_velocity", "float64", "m/s", "critical velocity"),
    Column("capture_time", "float64", "s", "time of the impact that captures"),
    Column("time_to_rest", "float64", "s", "time from release to rest"),
    Column("last_apex_time", "float64", "s", "time of the last apex"),
    Column("minimum_separation", "float64", "m", "smallest rigid separation of the first impact"),
    Column("contact_time", "float64", "s", "time in contact at the first impact"),
    Column("maximum_force", "float64", "N", "largest contact force of the first impact"),
    Column("pull_off", "float64", "N", "pull-off force"),
    Column("pull_off_separation", "float64", "m", "rigid separation at pull-off"),
    Column("work_of_separation", "float64", "J", "work of separation"),
    Column("preload", "float64", "N", "load that pull-off and work depend on"),
    Column("energy_lost", "float64", "J", "energy lost in all"),
    *(Column(f"lost_{name}", "float64", "J", f"energy lost to {name}") for name in LOSSES),
    *OF_BODIES,
    Column("rebound_height", "float64", "m", "rebound height", "impact"),
    Column("restitution", "float64", "1", "coefficient of restitution", "impact"),
    Column("log_decrement", "float64", "1", "logarithmic decrement", "impact"),
    Column("rebound_period", "float64", "s", "time from apex to apex", "impact"),
    Column("power_loss", "float64", "W", "power lost from apex to apex", "impact"),
)
"""What ``keep`` can name; those along "impact" have one value for each impact kept."""

MOTION: tuple[Column, ...] = (
    Column("turning_separation", "float64", "m", "rigid separation at a turning point", "turn"),
    Column("turning_time", "float64", "s", "time of a turning point", "turn"),
)
"""What ``motions = true`` keeps: closest approach and apex of each impact, in order of time."""

DEFAULT_KEEP = ("captured", "impact_speed", "restitution", "time_to_rest", "energy_lost")
"""Measures of a study that names none."""


def columns(keep: Iterable[str], *, motions: bool) -> tuple[Column, ...]:
    """The columns of a study.

    Parameters
    ----------
    keep : iterable of str
        Names of measures, see `MEASURES`.
    motions : bool
        Whether the turning points of every impact are kept too.

    Raises
    ------
    InputError
        Where a name is no measure's, or stands twice.
    """
    known = {column.name: column for column in MEASURES}
    kept: dict[str, Column] = {}
    for name in keep:
        among(name, known, f"`keep` must name measures ({', '.join(known)})", key="keep")
        if name in kept:
            twice = f"`keep` must name a measure once; got {shown(name)} twice"
            raise InputError(twice, key="keep")
        kept[name] = known[name]
    return (*ALWAYS, *kept.values(), *(MOTION if motions else ()))


def reasons(texts: np.ndarray) -> np.ndarray:
    """Why cases failed, as text, from bytes of shape (cases, width); "" where they did not."""
    rows = np.ascontiguousarray(texts)
    joined = rows.view(f"S{rows.shape[1]}")[:, 0]
    return np.array([text.decode("utf-8", "ignore") for text in joined.tolist()], dtype=object)
