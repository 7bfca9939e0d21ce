"""The equation of motion of one body that falls, touches and rebounds."""

from .history import Body, Impacts, Limits, Motion, Progress
from .motion import fly, prepare, simulate, start
from .table import Table, tabulate

__all__ = [
    "Body",
    "Impacts",
    "Limits",
    "Motion",
    "Progress",
    "Table",
    "fly",
    "prepare",
    "simulate",
    "start",
    "tabulate",
]
