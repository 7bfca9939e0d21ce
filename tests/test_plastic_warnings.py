"""What a run says of contacts that yield: which solid was taken for the softer one."""

import pytest

from asperity.case import load
from asperity.materials import contact_modulus
from asperity.yielding import yielded

CASE = """
[body]
radius = "20 um"
material = "silica"
[counterface]
material = "silicon carbide"
deformation = "rigid"
[roughness]
asperity_density = "1e14 1/m^2"
asperity_radius = "200 nm"
rms_height = "5 nm"
[impact]
speed = "30 mm/s"
"""
YIELDS = '[plasticity]\nmodel = "kogut-etsion"\n'
TAKEN = (
    "silica is taken to be the softer solid, which yields: neither hardness nor yield strength of "
    "silicon carbide is known, and were it softer the contact would yield sooner"
)
NEAR, FAR = 0.0, 40e-9  # separation at closest approach [m]


def lines(text, central=NEAR):
    """What is said of a case whose bodies came as close as this."""
    case = load(text)
    modulus = contact_modulus(case.body_solid, case.counterface_solid)
    return yielded(case, modulus, central)


def between(body, counterface):
    """The case with other solids."""
    first, second = CASE.split("[counterface]")
    second = second.replace('"silicon carbide"', f'"{counterface}"')
    return first.replace('"silica"', f'"{body}"') + "[counterface]" + second


@pytest.mark.parametrize("text", [CASE, between("silicon carbide", "silica")])
@pytest.mark.parametrize("central", [NEAR, FAR])
def test_a_contact_that_yields_says_whose_strength_is_unknown(text, central):
    assert lines(text + YIELDS, central)[-1] == TAKEN


def test_a_smooth_body_that_yields_says_so_too():
    smooth = CASE.split("deformation")[0] + '[impact]\nspeed = "30 mm/s"\n'
    assert lines(smooth + YIELDS) == [TAKEN]


def test_elastic_asperities_say_it_where_they_are_beyond_yield():
    share, taken = lines(CASE)
    assert "are beyond yield at closest approach" in share
    assert taken == TAKEN
    assert lines(CASE, FAR) == []


@pytest.mark.parametrize(
    "text",
    [
        between("silica", "sapphire") + YIELDS,
        between("silica", "steel") + YIELDS,
        CASE + YIELDS + 'hardness = "2 GPa"',
        CASE + YIELDS + 'yield_strength = "1 GPa"',
        CASE + YIELDS.replace("kogut-etsion", "thornton-ning") + 'yield_pressure = "2 GPa"',
        between("silicon", "silicon carbide"),
    ],
    ids=["both hard", "one strong", "hardness", "yield strength", "yield pressure", "none known"],
)
def test_nothing_is_said_where_both_are_known_or_the_case_names_the_strength(text):
    assert not any("softer" in line for line in lines(text))
