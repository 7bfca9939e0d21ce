"""The table [viscoelasticity]: from a file to a run, and what cannot stand beside it."""

import math
import threading

import numpy as np
import pytest

import asperity
from asperity import solver
from asperity.config import load
from asperity.config.bodies import solids_of
from asperity.config.resolve import resolve
from asperity.errors import Outcome
from asperity.materials.solids import contact_modulus
from asperity.model import build
from asperity.results import colours
from asperity.results.colours import COLOURS
from case_texts import LATE, ROUGH, WATER
from refused_input import refusal

CREEPS = """
[viscoelasticity]
model = "standard-linear-solid"
relaxed_modulus_ratio = 0.4
relaxation_time = "500 ns"
"""
SMOOTH = """
[body]
radius = "20 um"
youngs_modulus = "3 GPa"
poisson = 0.34
density = "1050 kg/m^3"
[counterface]
material = "silica"
[impact]
release_separation = "5 um"
[numerics]
max_impacts = 3
"""
ADHESION = '[adhesion]\nmodel = "dmt"\nwork = "20 mJ/m^2"\nequilibrium_spacing = "0.2 nm"\n'
FILM = '[gas]\nviscosity = "18 uPa s"\nslip_length = "75 nm"\ncutoff_separation = "1 nm"\n'
RIGID = SMOOTH.replace("[counterface]\n", '[counterface]\ndeformation = "rigid"\n')


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (CREEPS.replace("0.4", "0"), "`relaxed_modulus_ratio` must lie in [0.001, 1]; got 0"),
        (CREEPS.replace("0.4", "1.5"), "[0.001, 1]; got 1.5"),
        (CREEPS.replace('"500 ns"', '"0 s"'), "`relaxation_time` must be positive; got '0 s'"),
        (CREEPS.replace('"500 ns"', "5e-7"), "`relaxation_time` must be text with a number"),
        (CREEPS.replace("relaxed_modulus_ratio = 0.4\n", ""), "modulus_ratio` must be given"),
        (CREEPS.replace('relaxation_time = "500 ns"\n', ""), "`relaxation_time` must be given"),
        (CREEPS.replace("standard-linear-solid", "maxwell"), "linear-solid'; got 'maxwell'"),
        (CREEPS + ADHESION, "adhesion.model (line"),
        (CREEPS + WATER, "capillary.model (line"),
        (CREEPS + '[plasticity]\nmodel = "thornton-ning"\n', "plasticity.model (line"),
        (CREEPS + FILM, "gas (line"),
        (CREEPS + '[waves]\nmodel = "hunter"\n', "waves.model (line"),
        (CREEPS + ROUGH + "[publication]\n", "publication"),
        (CREEPS + ROUGH + WATER + LATE, "formation_time"),
    ],
)
def test_what_cannot_creep_is_refused_in_one_line(text, said):
    assert said in str(refusal(load, SMOOTH + text))


def test_a_rigid_bulk_does_not_creep():
    assert "counterface.deformation (line" in str(refusal(load, RIGID + CREEPS + ROUGH))


def test_without_a_model_the_bulk_is_elastic():
    case = load(SMOOTH + '[viscoelasticity]\nmodel = "none"\n')
    assert build(resolve(case)).relaxation is None
    assert build(resolve(load(SMOOTH))).relaxation is None


def test_a_case_with_creep_reads_back_and_knows_both_moduli():
    case = load(SMOOTH + CREEPS)
    assert load(case.toml()) == case
    problem = build(resolve(case))
    modulus = contact_modulus(*solids_of(case))
    assert problem.body.mechanisms == ("viscous",)
    assert float(problem.contact.law.modulus) == pytest.approx(0.4 * modulus)
    assert float(problem.relaxation.contact.law.modulus) == pytest.approx(modulus)
    assert problem.inputs.modulus == pytest.approx(modulus)


@pytest.fixture(scope="module")
def smooth():
    return solver.solve(load(SMOOTH + CREEPS), critical=False)


def test_a_smooth_sphere_loses_to_creep_alone_and_says_so(smooth):
    assert smooth.outcome is Outcome.MAX_IMPACTS
    assert smooth.ledger["energy_balance_error"] < 1e-8
    assert set(smooth.ledger["lost"]) == {"viscous"}
    assert all(0.3 < e < 0.9 for e in smooth.measures["restitution"])
    assert "lost to viscous" in smooth.summary()


def test_its_record_reads_back_and_draws_its_pictures(smooth, tmp_path):
    smooth.save(tmp_path / "out")
    files = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"record.nc", "summary.txt", "motion.png", "forces.png", "energy.png"} <= files
    again = asperity.read(tmp_path / "out" / "record.nc")
    assert again.case == smooth.case
    assert again.measures == smooth.measures


def test_colours_of_creep_and_of_what_users_add_are_no_others():
    others = [colour for name, colour in COLOURS.items() if name != "lost_viscous"]
    assert COLOURS["lost_viscous"] not in others
    assert not set(colours._SPARE) & set(COLOURS.values())


def test_the_curve_is_that_of_the_relaxed_bulk():
    case = load(SMOOTH + CREEPS)
    found = solver.curve(case)
    modulus = 0.4 * resolve(case).modulus
    overlap = np.maximum(-found.rigid_separation, 0.0)
    hertz = 4.0 / 3.0 * modulus * math.sqrt(case.body.radius) * overlap**1.5
    np.testing.assert_allclose(found.force_loading, hertz, atol=1e-8 * hertz.max())
    assert found.loss == 0.0


def test_a_smooth_case_may_be_assessed():
    assert solver.assess(load(SMOOTH + CREEPS)).regime


def test_a_rough_sphere_with_adhesion_and_menisci_runs():
    case = load(SMOOTH + CREEPS + ROUGH + ADHESION + WATER)
    few = {"numerics.rings": 24, "numerics.max_impacts": 1}
    result = solver.solve(case.replace(few), critical=False)
    assert result.ledger["energy_balance_error"] < 1e-6
    lost = result.ledger["lost"]
    assert lost["viscous"] > 0.0
    assert lost["capillary"] > 0.0
    assert 0.3 < result.measures["restitution"][0] < 0.98
    total = sum(result.energies.values())
    kinetic = np.max(result.energies["kinetic"])
    assert np.max(np.abs(total - result.ledger["initial"])) < 1e-6 * kinetic
    assert {"elastic", "adhesion", "capillary", "contact"} <= set(result.forces)
    assert not any("ledger" in line for line in result.warnings)


def test_it_may_be_stopped():
    stop = threading.Event()

    def watch(fraction, text):
        if text == "impact 1":
            stop.set()

    result = solver.solve(load(SMOOTH + CREEPS), stop=stop, progress=watch, critical=False)
    assert result.outcome is Outcome.INTERRUPTED
    assert len(result.measures["restitution"]) == 1


@pytest.mark.long
def test_body_and_edge_that_turn_together_are_one_turn():
    """Where rounding puts the edge first the turn must not be lost: two impacts would be one."""
    case = load(SMOOTH.replace("= 3\n", "= 6\n") + CREEPS.replace("0.4", "0.03"))
    result = asperity.solve(
        case.replace({"viscoelasticity.relaxation_time": "5 ns"}), critical=False
    )
    restitution = np.asarray(result.measures["restitution"], float)
    assert np.all(np.diff(restitution) > 0.0)  # slower and slower, by less and less
    assert 0.7 < restitution[0] < restitution[-1] < 0.85
