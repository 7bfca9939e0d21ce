"""The motion of what was built: curves within the tolerance, the release, the loop over impacts.

`batch_motion`: the one driver. It takes cases of one structure from their release to their end, can
be stopped between compiled calls, and fills up a batch whose cases have ended.
`steps`: what it compiles. `batch_records`: what it works on.
`single_case`: one case as a batch of one, or stepped in time. `jumping`: where its equilibria fold.
`refinements`: what is run again, and how. `finer_scanning`: scanning curves of more pieces, where
energies do not add up.
`clock`: reports, the stop, and the time in compiled code.
"""

from .clock import COMPILATION, Report, silently
from .jumping import over_folds
from .single_case import cut_in_steps, first_impact, integrate, launch, prepared

__all__ = [
    "COMPILATION",
    "Report",
    "cut_in_steps",
    "first_impact",
    "integrate",
    "launch",
    "over_folds",
    "prepared",
    "silently",
]
