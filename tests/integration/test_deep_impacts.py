"""Impacts far deeper than the roughness, where places of a panel cannot share a quadrature."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

import asperity
from asperity.config import load
from asperity.contact import RigidContact
from asperity.errors import SimulationError
from asperity.integration.panel_cuts import Inaccurate
from asperity.sweeps.compute.building import built
from asperity.sweeps.compute.cases_alone import unfinished
from asperity.sweeps.compute.integrate_batch import BatchSolution
from asperity.sweeps.study.study import parse

TEXT = """
schema = 1
[body]
radius = "270 um"
youngs_modulus = "19.4 MPa"
poisson = 0.25
density = "3000 kg/m^3"
[counterface]
youngs_modulus = "19.4 MPa"
poisson = 0.25
density = "3000 kg/m^3"
deformation = "rigid"
[impact]
speed = "28 m/s"
[numerics]
max_impacts = 2
[roughness]
asperity_density = "7.9e16 1/m^2"
asperity_radius = "16.4 nm"
rms_height = "0.153 nm"
[adhesion]
model = "jkr"
work = "0.028 J/m^2"
"""


def test_a_body_that_comes_9000_rms_heights_deep_is_answered(monkeypatch: pytest.MonkeyPatch):
    found = asperity.solve(load(TEXT))
    deepest = float(found.events["closest_approach_separation"][0])
    assert deepest < -9e3 * 0.153e-9
    assert abs(found.ledger["energy_balance_error"]) < 1e-9
    # Dry JKR asperities lose their pull-off energy: the same on the way out of any depth.
    assert 0.999 < found.measures["restitution"][0] < 1.0
    critical = found.measures["critical_velocity"]
    for share, captured in ((0.99, True), (1.01, False)):
        slow = load(TEXT.replace("28 m/s", f"{share * critical} m/s"))
        assert asperity.solve(slow, critical=False).measures["captured"] is captured
    monkeypatch.setattr(RigidContact, "place_by_place", lambda contact: None)
    with pytest.raises(Inaccurate, match=r"tolerance"):
        asperity.solve(load(TEXT), critical=False)


def test_a_study_leaves_it_to_a_run_of_its_own():
    """Those whose curves miss the tolerance, and no others that failed."""
    head, *tables = TEXT.split("[")
    base = "".join(f"[base.{table}" for table in tables)
    axes = "[axes.'impact.speed']\nvalues = ['1 m/s', '20 m/s', '28 m/s']\n"
    study = parse(f'{head}keep = ["restitution"]\nkeep_impacts = 1\n{axes}{base}')
    values = {"impact.speed": np.array([1.0, 20.0, 28.0])}
    (group,) = built(study, values).groups
    why = {0: SimulationError("stopped"), 2: Inaccurate("force curves")}
    solution = SimpleNamespace(failures=dict(why))
    assert unfinished(group, cast("BatchSolution", solution)) == [2]
    assert list(solution.failures) == [0]
    contact = group.batch.contact.place_by_place()
    assert contact.resolved.shared == 0
    assert contact.place_by_place() is None
    own = group._replace(batch=group.batch._replace(contact=contact))
    assert unfinished(own, cast("BatchSolution", SimpleNamespace(failures=why))) == []
