"""A record in time: the clock never runs back, and what is lost stays lost."""

from pathlib import Path

import numpy as np
import pytest

import asperity
from asperity.config.case_file import load_file
from asperity.dynamics.phase_time import missed_time
from asperity.dynamics.time_series import ascending

EXAMPLES = Path(__file__).parents[2] / "examples"
BONDS = {
    "roughness.asperity_density": "1e14 1/m^2",
    "roughness.asperity_radius": "100 nm",
    "roughness.rms_height": "3 nm",
    "adhesion.model": "jkr",
    "adhesion.equilibrium_spacing": "0.2 nm",
    "counterface.deformation": "half-space",
    "numerics.rings": 32,
    "numerics.max_impacts": 3,
}
CASES = {
    "menisci on a glass bead": ("glass-bead", {}),
    "menisci, fast": ("fast-impact", {}),
    "a jkr sphere": ("jkr-bounce", {}),
    "bonds on a half-space": ("dry-drop", BONDS),
    "gas": ("drop-in-air", {"numerics.max_impacts": 4}),
    "gas that stops the body": (
        "jkr-bounce",
        {
            "adhesion": None,
            "gas.viscosity": "18.1 uPa s",
            "gas.slip_length": "0 m",
            "gas.cutoff_separation": "1 nm",
            "impact.release_separation": "1 um",
            "impact.speed": "1 mm/s",
        },
    ),
    "menisci that take time": (
        "wet-drop",
        {"capillary.formation_time": "1 us", "numerics.max_impacts": 4},
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_time_and_losses_never_go_back(name):
    example, changes = CASES[name]
    result = asperity.solve(
        load_file(EXAMPLES / f"{example}.toml").replace(changes), critical=False
    )
    assert np.min(np.diff(result.time)) >= 0.0
    energy = np.max(result.energies["kinetic"])
    for key, lost in result.energies.items():
        if key.startswith("lost_"):
            assert np.min(np.diff(lost)) >= 0.0, key
            # What is drawn ends where the ledger does.
            assert abs(lost[-1] - result.ledger["lost"][key[5:]]) <= 1e-6 * energy
    # The drawn turning points are those of the record, at the same times.
    for what in ("closest_approach", "apex"):
        times, places = result.events[f"{what}_time"], result.events[f"{what}_separation"]
        for time, place in zip(times, places, strict=True):
            here = np.flatnonzero(np.abs(result.time - time) <= 1e-9 * result.time[-1])
            scale = abs(place) + 1e-3 * np.ptp(result.separation)
            assert np.min(np.abs(result.separation[here] - place)) <= 1e-9 * scale


def test_a_fall_lasts_as_long_as_its_speeds_say():
    """Between samples that are close the speed changes evenly: dt = 2 dd / (v + v')."""
    result = asperity.solve(load_file(EXAMPLES / "glass-bead.toml"), critical=False)
    first, then = result.events["apex_time"][0], result.events["closest_approach_time"][1]
    inside = (result.time >= first * (1.0 - 1e-12)) & (result.time <= then * (1.0 + 1e-12))
    fall = np.flatnonzero(inside)
    place, speed = result.separation[fall], result.speed[fall]
    steps = 2.0 * np.diff(place) / (speed[1:] + speed[:-1])
    assert then - first == pytest.approx(np.sum(steps), rel=1e-5)


def test_the_time_of_a_body_that_was_just_at_rest_is_that_of_its_even_acceleration():
    """With what the quadrature misses: 2/(sqrt(e + 1) + sqrt(e)), for small e and large."""
    from asperity.dynamics.curve_table import RATE, TIME_NODES

    for energy in (0.0, 1e-12, 1e-8, 1e-6, 1e-4, 1e-3, 0.02, 0.3):
        found = np.sum(RATE / np.sqrt(energy + TIME_NODES))
        missed = float(missed_time(np.array([energy]), np.array([1.0]))[0])
        exact = 2.0 / (np.sqrt(1.0 + energy) + np.sqrt(energy))
        assert found + missed == pytest.approx(exact, rel=1e-9)


def test_only_a_fall_of_a_loss_within_what_is_known_is_taken_for_rounding():
    lost = np.array([[0.0, 0.0], [1.0, 1.0], [1.0 - 1e-7, 0.9], [2.0, 2.0]])
    kept = ascending(lost, 1e-6)
    np.testing.assert_array_equal(kept[:, 0], [0.0, 1.0, 1.0, 2.0])
    np.testing.assert_array_equal(kept[:, 1], lost[:, 1])
