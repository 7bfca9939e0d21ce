"""The table [plasticity]: what yields, and what cannot stand beside a contact that yields."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from asperity.cli import app
from asperity.config import builtin, load
from asperity.config.plasticity import Plasticity, Yielding, yielding_of
from asperity.config.resolve import resolve
from asperity.errors import InputError
from asperity.materials.solids import SOLIDS, Solid
from asperity.model import build
from case_texts import LATE, ROUGH, SMALL, WATER
from refused_input import refusal

MODELS = ("kogut-etsion", "jackson-green", "thornton-ning")
NOTHING = '[plasticity]\nmodel = "none"\n'
YIELDS = '[plasticity]\nmodel = "kogut-etsion"\n'
UNKNOWN = SMALL.replace('"silica"', '"soft"').replace('"silicon"', '"stiff"')
NO_STRENGTH = """
[materials.soft]
youngs_modulus = "70 GPa"
poisson = 0.3
density = "2 g/cc"
[materials.stiff]
youngs_modulus = "300 GPa"
poisson = 0.3
density = "3 g/cc"
"""
ELASTIC = Solid("elastic", 100e9, 0.1)
SOFT = Solid("soft", 200e9, 0.4, hardness=1e9)
HARD = Solid("hard", 50e9, 0.2, hardness=5e9)

UNUSED = Plasticity(model="none")

stresses = st.floats(1e6, 1e10)


def refused(text):
    return str(refusal(load, text))


def with_key(table, line):
    """The smooth case with a line more in one of its tables."""
    return SMALL.replace(f"[{table}]\n", f"[{table}]\n{line}\n")


def rigid():
    """The smooth case's bodies on a counterface that does not deform, for a rough one."""
    return with_key("counterface", 'deformation = "rigid"')


def in_numbers(table, line):
    """The smooth case with a solid by its numbers, and a line more."""
    numbers = 'youngs_modulus = "70 GPa"\npoisson = 0.3\ndensity = "2 g/cc"'
    material = "silica" if table == "body" else "silicon"
    return with_key(table, line).replace(f'material = "{material}"', numbers)


# --- what yields -------------------------------------------------------------------------------


def test_without_the_table_nothing_yields():
    assert resolve(builtin("published-exact")).structure.plasticity == "none"
    assert resolve(load(SMALL + NOTHING)).structure.plasticity == "none"


@pytest.mark.parametrize("model", MODELS)
def test_a_law_is_named_and_what_yields_is_known(model):
    case = load(SMALL + YIELDS.replace("kogut-etsion", model))
    assert resolve(case).structure.plasticity == model
    strength = 9e9 / 2.8
    wanted = Yielding(9e9, strength, 1.61 * strength, SOLIDS["silica"].poisson)
    assert resolve(case).yielding == wanted


@pytest.mark.parametrize("solids", [(SOFT, HARD), (HARD, SOFT), (SOFT, ELASTIC), (ELASTIC, SOFT)])
def test_the_softer_solid_yields_whatever_its_modulus_and_its_place(solids):
    found = yielding_of(UNUSED, solids)
    assert (found.hardness, found.poisson) == (SOFT.hardness, SOFT.poisson)


def test_a_yield_strength_alone_says_how_soft_a_solid_is():
    softest = Solid("softest", 300e9, 0.35, yield_strength=0.3e9)
    found = yielding_of(UNUSED, (SOFT, softest))
    assert found == Yielding(2.8 * 0.3e9, 0.3e9, 1.61 * 0.3e9, 0.35)


@given(stresses)
def test_hardness_and_yield_strength_follow_from_each_other(stress):
    by_strength = yielding_of(UNUSED, (Solid("a", 1e11, 0.3, yield_strength=stress), ELASTIC))
    hardness = by_strength.hardness
    by_hardness = yielding_of(UNUSED, (ELASTIC, Solid("a", 1e11, 0.3, hardness=hardness)))
    assert by_hardness.yield_strength == pytest.approx(stress)
    assert by_hardness.yield_pressure == pytest.approx(by_strength.yield_pressure)


def test_the_tables_values_come_first_and_one_stands_for_both():
    both = Solid("both", 1e11, 0.3, hardness=3e9, yield_strength=1e9)
    for line, solids, wanted in (
        ('hardness = "8 GPa"', (both, HARD), Yielding(8e9, 8e9 / 2.8, 1.61 * (8e9 / 2.8), 0.3)),
        ('yield_strength = "2 GPa"', (both, HARD), Yielding(5.6e9, 2e9, 3.22e9, 0.3)),
        ('yield_strength = "2 GPa"\nhardness = "4 GPa"', (both, HARD),
         Yielding(4e9, 2e9, 3.22e9, 0.3)),
        # Where neither has a strength the less stiff one yields.
        ('yield_strength = "1 GPa"', (Solid("stiff", 300e9, 0.2), ELASTIC),
         Yielding(2.8e9, 1e9, 1.61e9, ELASTIC.poisson)),
    ):  # fmt: skip
        assert yielding_of(load(SMALL + NOTHING + line).plasticity, solids) == wanted


def test_a_yield_pressure_is_enough_for_thornton_and_ning():
    text = f'{UNKNOWN}{NO_STRENGTH}[plasticity]\nmodel = "thornton-ning"\n'
    found = resolve(load(text + 'yield_pressure = "1.61 GPa"')).yielding
    assert found.yield_pressure == 1.61e9
    assert found.yield_strength == pytest.approx(1e9)
    assert found.hardness == pytest.approx(2.8e9)
    own = resolve(load(text + 'yield_pressure = "1 GPa"\nyield_strength = "700 MPa"')).yielding
    assert (own.yield_pressure, own.yield_strength) == (1e9, 700e6)


@pytest.mark.parametrize("table", ["body", "counterface"])
def test_a_body_and_a_counterface_take_a_yield_strength(table):
    case = load(in_numbers(table, 'yield_strength = "1 GPa"\nhardness = "4 GPa"'))
    solid = resolve(case).body if table == "body" else resolve(case).counterface
    assert (solid.yield_strength, solid.hardness) == (1e9, 4e9)
    assert resolve(case).yielding == Yielding(4e9, 1e9, 1.61e9, 0.3)


# --- what is written ---------------------------------------------------------------------------


def test_a_case_that_yields_reads_back_from_its_own_text():
    own = YIELDS.replace("kogut-etsion", "thornton-ning") + (
        'hardness = "3 GPa"\nyield_strength = "1.1 GPa"\nyield_pressure = "1.7 GPa"\n'
    )
    case = load(SMALL + own)
    assert load(case.toml()) == case
    assert load(load(SMALL).toml()).plasticity is None
    assert case.replace({"plasticity": None}) == load(SMALL)
    assert case.replace({"plasticity.yield_pressure": None, "plasticity.model": "none"})


def test_the_catalogue_lists_yield_strengths():
    text = CliRunner().invoke(app, ["materials"]).stdout
    assert "hardness, yield strength" in text
    row = next(line for line in text.splitlines() if line.startswith("steel "))
    assert row.split()[-2:] == ["295", "MPa"]
    assert SOLIDS["steel"].yield_strength == 295e6


# --- what is refused ---------------------------------------------------------------------------

PRESSURE = 'yield_pressure = "2 GPa"'
DRAWN = WATER.replace('"equilibrium"', '"constant-volume"')
ADHESION = '[adhesion]\nmodel = "{}"\nwork = "50 mJ/m^2"\nequilibrium_spacing = "0.2 nm"\n'
FILES = '[roughness]\nfiles = ["surface.csv"]\nsource = "summits"\n'
TWO = 'hardness = "1 GPa"\nyield_strength = "2 GPa"'
BELOW = "`hardness` must be at least the yield strength (2000 MPa)"
OWN = '[materials.glass]\nyoungs_modulus = "1 GPa"\npoisson = 0.4\ndensity = "1 g/cc"\n'
NONE = 'yield_strength = "0 Pa"'

BAD = [
    (UNKNOWN + YIELDS + NO_STRENGTH, "plasticity.hardness (line 9)", "must be given with model"),
    (SMALL + NOTHING + TWO, "plasticity.hardness (line 11)", "got 1000 MPa"),
    (in_numbers("body", TWO), "body.hardness (line 3)", BELOW),
    (in_numbers("counterface", TWO), "counterface.hardness", BELOW),
    (SMALL + OWN + TWO, "materials.glass.hardness", BELOW),
    (SMALL + YIELDS + 'hardness = "0 Pa"', "plasticity.hardness", "must be positive; got '0 Pa'"),
    (SMALL + YIELDS + NONE, "plasticity.yield_strength", "must be positive; got '0 Pa'"),
    (in_numbers("body", NONE), "body.yield_strength", "must be positive; got '0 Pa'"),
    (in_numbers("counterface", NONE), "counterface.yield_strength", "must be positive; got '0 Pa'"),
    (SMALL + OWN + NONE, "materials.glass.yield_strength", "must be positive; got '0 Pa'"),
    (
        with_key("body", NONE.replace("0", "1")),
        "body.yield_strength (line 3)",
        "exclude each other",
    ),
    (SMALL + YIELDS + "yield_strength = 3e8", "plasticity.yield_strength", "text with a number"),
    (SMALL + YIELDS + PRESSURE, "plasticity.yield_pressure (line 11)", "absent without model"),
    (SMALL + NOTHING + PRESSURE, "plasticity.yield_pressure", "absent"),
    (SMALL + '[plasticity]\nmodel = "kogut"', "plasticity.model (line 10)", "got 'kogut'"),
    (SMALL + YIELDS + FILES, "roughness.source (line 13)", "must be 'gaussian' with [plasticity]"),
    (SMALL + YIELDS + DRAWN, "capillary.model (line 13)", "got 'constant-volume'"),
    (SMALL + YIELDS + WATER + LATE, "capillary.formation_time (line 18)", "must be absent"),
    (rigid() + YIELDS + ROUGH + "[publication]", "plasticity.model (line 11)", "[publication]"),
]


@pytest.mark.parametrize(("text", "key", "rule"), BAD, ids=range(len(BAD)))
def test_what_cannot_be_is_one_line_with_key_rule_and_value(text, key, rule):
    line = refused(text)
    assert key in line
    assert rule in line


@pytest.mark.parametrize("adhesion", ["auto", "bradley", "jkr", "maugis"])
@pytest.mark.parametrize("surface", ["", ROUGH], ids=["smooth", "rough"])
@pytest.mark.parametrize("model", MODELS)
def test_an_adhesion_that_changes_the_contact_is_refused(model, surface, adhesion):
    text = SMALL + YIELDS.replace("kogut-etsion", model) + surface + ADHESION.format(adhesion)
    if (model, surface, adhesion) == ("thornton-ning", "", "jkr"):
        assert load(text).adhesion.model == "jkr"
        return
    line = refused(text)
    allowed = "'jkr', 'dmt' or 'none'" if model == "thornton-ning" and not surface else "'dmt' or "
    assert f"`model` must be {allowed}" in line
    assert "adhesion.model (line " in line
    assert f"[plasticity] model = '{model}'" in line
    assert line.endswith(f"an adhesion that acts beside contact; got '{adhesion}'")


@pytest.mark.parametrize("adhesion", ["dmt", "none"])
@pytest.mark.parametrize("surface", ["", ROUGH], ids=["smooth", "rough"])
def test_an_adhesion_beside_contact_is_taken(surface, adhesion):
    bodies = rigid() if surface else SMALL
    text = bodies + YIELDS + surface + ADHESION.format(adhesion)
    assert load(text).adhesion.model == adhesion


def test_the_model_none_refuses_nothing_and_liquid_that_is_off_is_no_liquid():
    assert load(SMALL + NOTHING + FILES + ADHESION.format("jkr")).plasticity.model == "none"
    assert load(SMALL + NOTHING + DRAWN + LATE)
    off = WATER.replace('"equilibrium"', '"none"')
    assert resolve(load(SMALL + YIELDS + off + LATE)).structure.plasticity == "kogut-etsion"
    gaussian = FILES.replace('"summits"', '"gaussian"')
    assert load(rigid() + YIELDS + gaussian).roughness.source == "gaussian"


def test_a_sphere_that_adhesion_alone_makes_yield_is_refused_with_the_least_pressure():
    """Its JKR pressure reaches the yield pressure before any load does."""
    soft = YIELDS.replace('model = "kogut-etsion"', 'model = "thornton-ning"')
    case = load(SMALL + soft + ADHESION.format("jkr"))
    early = {"plasticity.yield_pressure": "1 MPa", "adhesion.work": "0.2 J/m^2"}
    with pytest.raises(InputError, match=r"at least .* MPa, or the body yields by adhesion alone"):
        build(resolve(case.replace(early)))
    assert build(resolve(case)).contact.mechanisms[:2] == ("plastic", "adhesion")


@pytest.mark.parametrize(
    "table", ['[plasticity]\nhardness = "1 GPa"\n', "[waves]\n", "[viscoelasticity]\n"]
)
def test_a_table_of_losses_must_say_which_model(table):
    """A table without one would be read and left unused."""
    with pytest.raises(InputError, match="`model` is missing"):
        load(SMALL + table)
