"""A speed alone: the body is released where no force is felt, whatever the law."""

from math import pi

import numpy as np
import pytest

import asperity
from asperity._jax import jnp
from asperity.config.case_file import load
from asperity.config.resolve import resolve
from asperity.model import build
from asperity.sweeps.compute.batch import evaluate
from asperity.sweeps.study.study import parse

WORK, SPACING, TIP, DENSITY, RMS = 0.03, 0.2e-9, 10e-9, 1e15, 2e-9
WATER = """
[{}capillary]
model = "{}"
liquid = "water"
humidity = 0.6
temperature = "20 degC"
contact_angle = "40 deg"
"""


def text(adhesion, *, rough, gravity, radius="1 um", speed="0.1 m/s", menisci="none", at=""):
    asperities = f"""
[{at}roughness]
asperity_density = "{DENSITY} 1/m^2"
asperity_radius = "{TIP} m"
rms_height = "{RMS} m"
"""
    water = "" if menisci == "none" else WATER.format(at, menisci)
    if rough and menisci == "kelvin-filling":
        water += f'surface_rms_height = "{RMS} m"\n'
    return f"""
[{at}body]
shape = "sphere"
radius = "{radius}"
material = "silica"
[{at}counterface]
material = "silicon carbide"
{'deformation = "rigid"' if rough else ""}
{asperities if rough else ""}
[{at}adhesion]
model = "{adhesion}"
{"" if adhesion == "none" else f'work = "{WORK} J/m^2"'}
{"" if adhesion == "none" else f'equilibrium_spacing = "{SPACING} m"'}
{water}
[{at}impact]
speed = "{speed}"
gravity = "{gravity} m/s^2"
[{at}numerics]
max_impacts = 1
"""


def pull_far_out(separation, radius, *, rough):
    """Bradley's tail: (4/3) (eps/g)^2 of a tip's pull, over all tips of a paraboloid."""
    share = 4.0 / 3.0 * SPACING**2
    if not rough:
        return 2.0 * pi * radius * WORK * share / separation**2
    return 2.0 * pi * radius * DENSITY * 2.0 * pi * TIP * WORK * share / separation


@pytest.mark.parametrize("gravity", [0.0, 9.81])
@pytest.mark.parametrize("rough", [False, True], ids=["smooth", "rough"])
def test_a_launched_body_starts_out_of_the_tail_of_bradleys_law(rough, gravity):
    case = load("schema = 1\n" + text("bradley", rough=rough, gravity=gravity))
    result = asperity.solve(case, critical=False)
    released, body = result.separation[0], build(resolve(case)).body
    peak = max(abs(result.forces["contact"]))
    limit = max(1e-3 * float(body.weight), 1e-6 * peak)
    assert pull_far_out(released, 1e-6, rough=rough) <= 1.05 * limit
    assert result.measures["restitution"][0] == pytest.approx(1.0, abs=1e-9)
    assert result.ledger["energy_balance_error"] < 1e-9
    # What falls further than was asked for is told so.
    hastened = 2.0 * gravity * released > 0.02 * 0.1**2
    assert (
        any("adds" in line and "release_separation" in line for line in result.warnings) == hastened
    )


def test_studies_release_a_launched_body_where_a_single_run_does():
    study = parse(
        'schema = 1\nkeep = ["restitution", "impact_speed"]\n'
        + text("bradley", rough=False, gravity=9.81, at="base.")
        + '\n[axes]\n"impact.speed" = {values = ["0.1 m/s", "0.2 m/s", "0.4 m/s"]}\n',
    )
    speeds = np.array([0.1, 0.2, 0.4])
    columns = evaluate(study, {"impact.speed": speeds})
    assert np.all(np.isfinite(columns["impact_speed"]))
    one = asperity.solve(
        load("schema = 1\n" + text("bradley", rough=False, gravity=9.81)), critical=False
    )
    first = np.ravel(columns["restitution"][0])[0]
    assert first == pytest.approx(one.measures["restitution"][0], rel=1e-9)
    assert columns["impact_speed"][0] == pytest.approx(one.measures["impact_speed"], rel=1e-6)
    assert np.all(np.diff(columns["impact_speed"]) > 0.0)


@pytest.mark.parametrize(
    ("adhesion", "menisci"),
    [*((adhesion, "none") for adhesion in ("none", "dmt", "jkr", "maugis")),
     *(("none", menisci) for menisci in ("equilibrium", "kelvin-filling", "constant-volume"))],
)  # fmt: skip
@pytest.mark.parametrize("rough", [False, True], ids=["smooth", "rough"])
def test_other_laws_end_before_the_first_release(rough, adhesion, menisci):
    """So that no more than one is tried, and a body is launched as near as it can be.

    Each law alone: forces of several are added.
    """
    problem = build(
        resolve(load("schema = 1\n" + text(adhesion, rough=rough, gravity=9.81, menisci=menisci)))
    )
    contact, release = problem.contact, jnp.asarray(problem.body.release)
    force = abs(float(contact.state(release, contact.initial_memory()).force))
    assert force <= 1e-3 * float(problem.body.weight)
    # Nothing to speak of against the pull of one tip's dry contact, either.
    assert force <= 1e-9 * 2.0 * pi * TIP * WORK
