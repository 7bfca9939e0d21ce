"""The equation of motion of one body that falls, touches and rebounds.

`problem`: what moves. `record`: what is kept of a motion. `motion`: the loop over impacts.
`motion_end`: when and how a motion ends.
`external_forces`: what acts on the body besides its contact; `gas_film`, `wave_radiation`,
`suspension`: one mechanism each.
`phase`, `turning_point`, `phase_time`: one phase by the energy integral; `drag`, `damped_phase`,
`damped_turning_point`, `resolved_pieces`, `overdamped`: the same with drag.
`stepped_motion`: the loop over impacts of motions in time, of `delayed_bounce` (by
`time_stepping`, `time_collocation`) and on `viscoelastic` half-spaces.
`stepped_phase`, `stepped_record`: the records of such motions.
`curve_table`, `scanning_table`: force curves as Chebyshev polynomials.
`single_impact` (by `summit_path`, with drag `damped_summits`), `coupled_impact`, `coupled_path`:
first impacts of single bodies, on a rigid bulk and on a half-space.
`static_equilibrium`, `release`, `unloading`, `quasi_static`, `jumps`, `capture_edges`: single
questions to the curves.
"""

from .curve_table import Table, tabulate
from .motion import integrate_impacts, prepare, simulate, start
from .record import Begun, Body, Impacts, Limits, Motion, Progress

__all__ = [
    "Begun",
    "Body",
    "Impacts",
    "Limits",
    "Motion",
    "Progress",
    "Table",
    "integrate_impacts",
    "prepare",
    "simulate",
    "start",
    "tabulate",
]
