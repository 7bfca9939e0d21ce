"""What a run says of contacts that yield: which solid was taken for the softer one."""

import pytest

import asperity
from asperity import solver
from asperity.config import load
from asperity.config.resolve import resolve
from asperity.regimes.plastic_validity import yielded

CASE = """
[body]
radius = "20 um"
material = "silica"
[counterface]
material = "ceramic"
deformation = "rigid"
[roughness]
asperity_density = "1e14 1/m^2"
asperity_radius = "200 nm"
rms_height = "5 nm"
[impact]
speed = "30 mm/s"
[materials.ceramic]
youngs_modulus = "161 GPa"
poisson = 0.23
density = "3160 kg/m^3"
[materials.metal]
youngs_modulus = "70 GPa"
poisson = 0.33
density = "2700 kg/m^3"
"""
OWN = CASE[CASE.index("[materials.ceramic]") :]
YIELDS = '[plasticity]\nmodel = "kogut-etsion"\n'
TAKEN = (
    "silica is taken to be the softer solid, which yields: neither hardness nor yield strength of "
    "ceramic is known, and were it softer the contact would yield sooner"
)
NEAR, FAR = 0.0, 40e-9  # separation at closest approach [m]


def lines(text, central=NEAR):
    """What is said of a case whose bodies came as close as this."""
    return yielded(resolve(load(text)), central)


def between(body, counterface):
    """The case with other solids."""
    first, second = CASE.split("[counterface]")
    second = second.replace('"ceramic"', f'"{counterface}"')
    return first.replace('"silica"', f'"{body}"') + "[counterface]" + second


@pytest.mark.parametrize("central", [NEAR, FAR])
def test_a_contact_that_yields_says_whose_strength_is_unknown(central):
    for text in (CASE, between("ceramic", "silica")):
        assert lines(text + YIELDS, central)[-1] == TAKEN
    smooth = CASE.split("deformation")[0] + f'[impact]\nspeed = "30 mm/s"\n{OWN}'
    assert lines(smooth + YIELDS, central) == [TAKEN]


def test_elastic_asperities_say_it_where_they_are_beyond_yield():
    share, taken = lines(CASE)
    assert "are beyond yield at closest approach" in share
    assert taken == TAKEN
    assert lines(CASE, FAR) == [
        "yielding was judged by silica alone: no hardness or yield strength of ceramic is known"
    ]


def numbered(text):
    """The case with a body of numbers, of no known strength."""
    numbers = 'youngs_modulus = "70 GPa"\npoisson = 0.2\ndensity = "2500 kg/m^3"'
    return text.replace('material = "silica"', numbers, 1)


@pytest.mark.parametrize("smooth", [False, True])
@pytest.mark.parametrize(
    ("text", "unknown"),
    [
        (between("metal", "ceramic"), "metal and ceramic"),
        (between("metal", "metal"), "metal"),
        (numbered(CASE), "the body and ceramic"),
    ],
)
def test_yielding_that_cannot_be_judged_is_said(text, unknown, smooth):
    """However hard the impact: bodies that touch over all their heights."""
    if smooth:
        text = text.split("deformation")[0] + f'[impact]\nspeed = "5 m/s"\n{OWN}'
    expected = f"yielding not judged: no hardness or yield strength of {unknown} is known"
    assert lines(text) == [expected]
    assert lines(text + YIELDS + 'hardness = "2 GPa"') != [expected]


def test_a_metal_bead_shot_at_a_ceramic_says_that_yielding_was_not_judged():
    """Issued by `run` and `regime` alike, once."""
    smooth = between("metal", "ceramic").split("deformation")[0]
    case = load(smooth + f'[impact]\nspeed = "3000 m/s"\n{OWN}[numerics]\nmax_impacts = 1\n')
    for found in (asperity.solve(case, critical=False), solver.assess(case)):
        assert sum("yielding not judged" in line for line in found.warnings) == 1


@pytest.mark.parametrize("other", ["PDMS", "silica"])
@pytest.mark.parametrize("central", [NEAR, FAR])
def test_an_elastomer_never_yields_and_leaves_nothing_to_judge(other, central):
    """Nor is the solid that meets it said to be taken for the softer one."""
    found = lines(between("PDMS", other), central)
    assert not any("judged" in line or "taken" in line for line in found)
    assert not any("taken" in line for line in lines(between("silica", "PDMS") + YIELDS, central))


def test_beside_an_elastomer_only_the_other_solid_is_missing_a_strength():
    assert lines(between("PDMS", "metal")) == [
        "yielding not judged: no hardness or yield strength of metal is known"
    ]
    assert lines(between("silica", "sapphire"), 2.0 * FAR) == []  # where both are known


@pytest.mark.parametrize(
    "text",
    [
        between("silica", "sapphire") + YIELDS,
        between("silica", "steel") + YIELDS,
        CASE + YIELDS + 'hardness = "2 GPa"',
        CASE + YIELDS + 'yield_strength = "1 GPa"',
        CASE + YIELDS.replace("kogut-etsion", "thornton-ning") + 'yield_pressure = "2 GPa"',
        between("metal", "ceramic"),
    ],
    ids=["both hard", "one strong", "hardness", "yield strength", "yield pressure", "none known"],
)
def test_nothing_is_said_where_both_are_known_or_the_case_names_the_strength(text):
    assert not any("softer" in line for line in lines(text))
