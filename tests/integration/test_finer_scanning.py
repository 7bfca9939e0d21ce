"""Scanning curves that are cut finer where the energies of a motion do not add up."""

import dataclasses

import numpy as np
import pytest
from tools.valid_cases import drawn, text_of

from asperity import solve
from asperity.config import builtin, load
from asperity.config.resolve import resolve
from asperity.dynamics.curve_table import STORED
from asperity.errors import Outcome, SimulationError
from asperity.integration import refinements
from asperity.integration.finer_scanning import balanced, with_finer_scanning
from asperity.integration.single_case import cut_in_steps, integrate
from asperity.model import build
from asperity.regimes.accuracy import CLOSED, balance_error, branches_miss_it, ledger_warnings
from records import never_goes_back


def case(solid, deformation, **tables):
    """A sphere of a solid of modulus and density, on the same solid."""
    solid = {"youngs_modulus": solid[0], "poisson": 0.25, "density": solid[1]}
    body = {"radius": tables.pop("radius"), **solid}
    counterface = {**solid, "deformation": deformation}
    tables = {"body": body, "counterface": counterface, "capillary": None, **tables}
    return builtin("published-exact").replace(tables)


def roughness(density, radius, rms):
    return {"asperity_density": density, "asperity_radius": radius, "rms_height": rms}


SOFT = case(
    ("1.67 MPa", "4800 kg/m^3"),
    "half-space",
    radius="38 um",
    impact={"speed": "0.06 m/s"},
    numerics={"max_impacts": 1, "rings": 32},
    roughness=roughness("3.76e14 1/m^2", "1.92 nm", "26.9 nm"),
    adhesion={"model": "jkr", "work": "0.0191 J/m^2"},
)


def test_a_soft_bulk_that_adhesion_draws_out_has_scanning_curves_as_fine_as_it_asks_for(
    monkeypatch,
):
    """Bonds stretch by 1/20 of the rms height; the innermost pass between branches over 50."""
    problem = cut_in_steps(build(resolve(SOFT)))
    runs, told = [], []

    def recorded(problem, run, report):
        def kept(problem, report):
            runs.append(run(problem, report))
            return runs[-1]

        def noted(*line):
            told.append(line)
            report(*line)

        return balanced(problem, kept, noted)

    monkeypatch.setattr(refinements, "balanced", recorded)
    never_goes_back(solve(SOFT, critical=False))
    before, found = runs
    assert found.contact.resolved.later > 0
    # The second run is a small share of the progress, which does not go back to its begin.
    begin = [text for _, text in told].index("finer scanning curves")
    assert len(told) > begin + 1
    assert all(0.85 <= share <= 0.9 for share, _ in told[begin:])
    # 6.6e-4 and 5e-5 with 32 rings; with 80 one impact closes to 2e-3 and 1e-7.
    assert balance_error(found.motion) < 0.1 * balance_error(before.motion)
    assert balance_error(found.motion) < 100.0 * CLOSED
    # What it loses is counted in bonds, whatever scanning curves are read.
    lost = [float(one.motion.impacts.lost[0, 0]) for one in runs]
    assert lost[0] == pytest.approx(lost[1], rel=1e-4)
    # Where the branches alone miss as much, scanning curves are not why.
    first = before.motion
    assert with_finer_scanning(problem, first) is not None
    values = np.array(first.table.values)
    values[..., STORED] *= 1.1
    off = first._replace(table=first.table._replace(values=values))
    assert not branches_miss_it(first)
    assert branches_miss_it(off)
    assert "or the deformation on 32 rings" in ledger_warnings(problem, first)[0]
    assert "the deformation on 32 rings is" in ledger_warnings(problem, off)[0]
    assert with_finer_scanning(problem, off) is None
    # Once is enough: finer ones are not cut again, nor those of a balance that closes.
    assert with_finer_scanning(problem._replace(contact=found.contact), found.motion) is None
    coarse = dataclasses.replace(found.contact, resolved=problem.contact.resolved)
    impacts = found.motion.impacts
    closed = found.motion._replace(
        impacts=impacts._replace(energy_balance_error=0.0 * impacts.lost[:, 0])
    )
    assert with_finer_scanning(problem._replace(contact=coarse), closed) is None
    # A second run that is stopped, or fails, leaves the first answer as it is.
    impacts = impacts._replace(energy_balance_error=1e-3 * impacts.maximum_kinetic)
    first = found._replace(motion=found.motion._replace(impacts=impacts))
    stopped = found._replace(outcome=Outcome.INTERRUPTED)
    for second in (stopped, SimulationError("stopped before the first impact")):
        answers = iter((first, second))

        def run(problem, report, answers=answers):
            answer = next(answers)
            if isinstance(answer, SimulationError):
                raise answer
            return answer

        assert balanced(problem._replace(contact=coarse), run, lambda *_: None) is first


WET = case(
    ("222 GPa", "6015 kg/m^3"),
    "rigid",
    radius="11.4 um",
    impact={"speed": "0.12 mm/s", "gravity": "0 m/s^2"},
    numerics={"max_impacts": 1},
    roughness=roughness("7.7e15 1/m^2", "13 nm", "0.166 nm"),
    adhesion={"model": "jkr", "work": "0.2137 mJ/m^2"},
    capillary={
        "model": "constant-volume",
        "formation": "capillary-condensation",
        "liquid": "water",
        "humidity": 0.667,
        "temperature": "321 K",
        "contact_angle": "66.4 degrees",
    },
)


@pytest.mark.long
def test_menisci_that_stretch_far_are_read_on_as_many_pieces_as_their_force_bends():
    problem = cut_in_steps(build(resolve(WET)))
    found = integrate(problem, drawn=False)
    resolved = found.contact.resolved
    assert resolved.pieces - resolved.later == 4 * problem.contact.resolved.pieces
    assert balance_error(found.motion) < 1e-10


@pytest.mark.long
def test_menisci_that_stay_bonded_ask_for_finer_scanning_curves_too():
    """They lose nothing, and curves on even pieces miss 7e-4; what is left is the table's."""
    drawn_case = drawn(401, 21)
    drawn_case.pop("waves")
    found = integrate(cut_in_steps(build(resolve(load(text_of(drawn_case))))), drawn=False)
    assert found.contact.resolved.later > 0
    assert balance_error(found.motion) < 3e-6
