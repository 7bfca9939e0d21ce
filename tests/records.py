"""What holds of the record of every motion."""

import numpy as np


def never_goes_back(result):
    """The clock never runs back, what is lost stays lost, and each turn is a drawn sample."""
    assert np.min(np.diff(result.time)) >= 0.0
    energy = np.max(result.energies["kinetic"])
    for key, lost in result.energies.items():
        if key.startswith("lost_"):
            assert np.min(np.diff(lost)) >= 0.0, key
            # What is drawn ends where the ledger does.
            assert abs(lost[-1] - result.ledger["lost"][key[5:]]) <= 1e-6 * energy
    for what in ("closest_approach", "apex"):
        times, places = result.events[f"{what}_time"], result.events[f"{what}_separation"]
        for time, place in zip(times, places, strict=True):
            here = np.flatnonzero(np.abs(result.time - time) <= 1e-9 * result.time[-1])
            scale = abs(place) + 1e-3 * np.ptp(result.separation)
            assert np.min(np.abs(result.separation[here] - place)) <= 1e-9 * scale
