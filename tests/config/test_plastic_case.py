"""The table [plasticity]: what yields, and what cannot stand beside a contact that yields."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from asperity.cli import app
from asperity.config import builtin, load, template
from asperity.config.plasticity import Plasticity, Yielding, yielding_of
from asperity.config.resolve import resolve
from asperity.errors import InputError
from asperity.materials.solids import SOLIDS, Solid
from asperity.model import build

MODELS = ("kogut-etsion", "jackson-green", "thornton-ning")
SMOOTH = """
[body]
radius = "10 um"
material = "silica"
[counterface]
material = "silicon carbide"
[impact]
speed = "0.1 m/s"
"""
NOTHING = '[plasticity]\nmodel = "none"\n'
YIELDS = '[plasticity]\nmodel = "kogut-etsion"\n'
ROUGH = """
[roughness]
asperity_density = "1 1/um^2"
asperity_radius = "100 nm"
rms_height = "5 nm"
"""
WATER = """
[capillary]
liquid = "water"
humidity = 0.5
temperature = "20 degC"
contact_angle = "30 deg"
"""
UNKNOWN = SMOOTH.replace('"silica"', '"soft"').replace('"silicon carbide"', '"stiff"')
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


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def refusal(text):
    """The one line with which the command refuses a case; its exit code is 2."""
    Path("drop.toml").write_text(text)
    ran = CliRunner().invoke(app, ["regime", "drop.toml"])
    assert ran.exit_code == 2, ran.output
    assert ran.stdout == ""
    assert ran.stderr.count("\n") == 1
    assert "drop.toml" in ran.stderr
    return ran.stderr


def with_key(table, line):
    """The smooth case with a line more in one of its tables."""
    return SMOOTH.replace(f"[{table}]\n", f"[{table}]\n{line}\n")


def rigid():
    """The smooth case's bodies on a counterface that does not deform, for a rough one."""
    return with_key("counterface", 'deformation = "rigid"')


def in_numbers(table, line):
    """The smooth case with a solid by its numbers, and a line more."""
    numbers = 'youngs_modulus = "70 GPa"\npoisson = 0.3\ndensity = "2 g/cc"'
    material = "silica" if table == "body" else "silicon carbide"
    return with_key(table, line).replace(f'material = "{material}"', numbers)


# --- what yields -------------------------------------------------------------------------------


def test_without_the_table_nothing_yields():
    assert resolve(builtin("published-exact")).structure.plasticity == "none"
    assert resolve(load(SMOOTH + NOTHING)).structure.plasticity == "none"


@pytest.mark.parametrize("model", MODELS)
def test_a_law_is_named_and_what_yields_is_known(model):
    case = load(SMOOTH + YIELDS.replace("kogut-etsion", model))
    assert resolve(case).structure.plasticity == model
    strength = 9e9 / 2.8
    wanted = Yielding(9e9, strength, 1.61 * strength, SOLIDS["silica"].poisson)
    assert resolve(case).yielding == wanted


@pytest.mark.parametrize("solids", [(SOFT, HARD), (HARD, SOFT), (SOFT, ELASTIC), (ELASTIC, SOFT)])
def test_the_softer_solid_yields_whatever_its_modulus_and_its_place(solids):
    assert yielding_of(UNUSED, solids).hardness == SOFT.hardness
    assert yielding_of(UNUSED, solids).poisson == SOFT.poisson


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
    harder = yielding_of(load(SMOOTH + NOTHING + 'hardness = "8 GPa"').plasticity, (both, HARD))
    assert (harder.hardness, harder.yield_strength) == (8e9, 8e9 / 2.8)
    table = load(SMOOTH + NOTHING + 'yield_strength = "2 GPa"').plasticity
    assert yielding_of(table, (both, HARD)) == Yielding(5.6e9, 2e9, 3.22e9, 0.3)
    table = load(SMOOTH + NOTHING + 'yield_strength = "2 GPa"\nhardness = "4 GPa"').plasticity
    assert yielding_of(table, (both, HARD)) == Yielding(4e9, 2e9, 3.22e9, 0.3)


def test_the_table_is_enough_where_no_material_has_a_strength_and_the_less_stiff_yields():
    table = load(SMOOTH + NOTHING + 'yield_strength = "1 GPa"').plasticity
    stiff = Solid("stiff", 300e9, 0.2)
    assert yielding_of(table, (stiff, ELASTIC)) == Yielding(2.8e9, 1e9, 1.61e9, ELASTIC.poisson)


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


def test_a_material_of_ones_own_takes_a_yield_strength():
    own = '[materials.silica]\nyoungs_modulus = "1 GPa"\npoisson = 0.4\ndensity = "1 g/cc"\n'
    case = load(SMOOTH + own + 'yield_strength = "30 MPa"')
    assert resolve(case).body.yield_strength == 30e6
    assert resolve(case).yielding.poisson == 0.4


def test_nothing_known_is_refused_where_a_law_asks_for_it():
    assert resolve(load(UNKNOWN + NO_STRENGTH)).yielding is None
    with pytest.raises(InputError, match="`hardness` or `yield_strength` must be given"):
        load(UNKNOWN + NO_STRENGTH + YIELDS)


# --- what is written ---------------------------------------------------------------------------


def test_a_case_that_yields_reads_back_from_its_own_text():
    own = YIELDS.replace("kogut-etsion", "thornton-ning") + (
        'hardness = "3 GPa"\nyield_strength = "1.1 GPa"\nyield_pressure = "1.7 GPa"\n'
    )
    case = load(SMOOTH + own)
    assert load(case.toml()) == case
    assert load(load(SMOOTH).toml()).plasticity is None
    assert case.replace({"plasticity": None}) == load(SMOOTH)
    assert case.replace({"plasticity.yield_pressure": None, "plasticity.model": "none"})


def test_the_template_shows_the_table_behind_a_comment():
    text = template()
    for line in ("# [plasticity]", '# model = "kogut-etsion"', "# yield_strength = ", "# hardness"):
        assert f"\n{line}" in text
    assert load(text).plasticity is None


def test_the_catalogue_lists_yield_strengths_with_their_source():
    found = json.loads(CliRunner().invoke(app, ["materials", "--json"]).stdout)["solids"]
    assert found["steel"]["yield_strength"] == SOLIDS["steel"].yield_strength == 295e6
    assert found["silica"]["yield_strength"] is None
    for name, solid in found.items():
        for key in ("hardness", "yield_strength"):
            assert solid[key] is None or key.replace("_", " ") in solid["source"], name
    text = CliRunner().invoke(app, ["materials"]).stdout
    assert "hardness, yield strength" in text
    row = next(line for line in text.splitlines() if line.startswith("steel "))
    assert row.split()[-2:] == ["295", "MPa"]


# --- what is refused ---------------------------------------------------------------------------

ADHESION = '[adhesion]\nmodel = "{}"\nwork = "50 mJ/m^2"\nequilibrium_spacing = "0.2 nm"\n'
FILES = '[roughness]\nfiles = ["surface.csv"]\nsource = "summits"\n'
TWO = 'hardness = "1 GPa"\nyield_strength = "2 GPa"'
BELOW = "`hardness` must be at least the yield strength (2000 MPa)"
OWN = '[materials.glass]\nyoungs_modulus = "1 GPa"\npoisson = 0.4\ndensity = "1 g/cc"\n'

BAD = [
    (UNKNOWN + YIELDS + NO_STRENGTH, "plasticity.hardness (line 9): "
     "`hardness` or `yield_strength` must be given with model = 'kogut-etsion'", "got nothing"),
    (SMOOTH + NOTHING + TWO, "plasticity.hardness (line 11): `hardness` must be at least "
     "the yield strength (2000 MPa)", "got 1000 MPa"),
    (in_numbers("body", TWO), "body.hardness (line 3)", BELOW),
    (in_numbers("counterface", TWO), "counterface.hardness", BELOW),
    (SMOOTH + OWN + TWO, "materials.glass.hardness", BELOW),
    (SMOOTH + YIELDS + 'hardness = "0 Pa"', "plasticity.hardness", "`hardness` must be positive; "
     "got '0 Pa'"),
    (SMOOTH + YIELDS + 'yield_strength = "-1 GPa"', "plasticity.yield_strength", "`yield_strength` "
     "must be positive; got '-1 GPa'"),
    (in_numbers("body", 'yield_strength = "0 Pa"'), "body.yield_strength", "`yield_strength` must "
     "be positive; got '0 Pa'"),
    (in_numbers("counterface", 'yield_strength = "-1 Pa"'), "counterface.yield_strength",
     "`yield_strength` must be positive; got '-1 Pa'"),
    (SMOOTH + OWN + 'yield_strength = "0 GPa"', "materials.glass.yield_strength", "must be "
     "positive; got '0 GPa'"),
    (SMOOTH + OWN + 'hardness = "-3 GPa"', "materials.glass.hardness", "must be positive; got "
     "'-3 GPa'"),
    (with_key("body", 'yield_strength = "1 GPa"'), "body.yield_strength (line 3)",
     "`yield_strength` and `material` exclude each other"),
    (SMOOTH + YIELDS + "yield_strength = 3e8", "plasticity.yield_strength", "must be text with a "
     "number and a unit, such as"),
    (SMOOTH + YIELDS + 'yield_strength = "3 m"', "plasticity.yield_strength", "got '3 m'"),
    (SMOOTH + YIELDS + 'yield_pressure = "2 GPa"', "plasticity.yield_pressure (line 11): "
     "`yield_pressure` must be absent without model = 'thornton-ning'", "got 2000 MPa"),
    (SMOOTH + NOTHING + 'yield_pressure = "2 GPa"', "plasticity.yield_pressure", "absent"),
    (SMOOTH + '[plasticity]\nmodel = "kogut"', "plasticity.model (line 10): `model` must be one of "
     "'none', 'kogut-etsion', 'jackson-green' or 'thornton-ning'", "got 'kogut'"),
    (SMOOTH + YIELDS + 'yield_strenght = "1 GPa"', "plasticity.yield_strenght (line 11)",
     "did you mean 'yield_strength'?"),
    (SMOOTH + YIELDS.replace("plasticity", "plasticty"), "`plasticty` is not a key or table",
     "did you mean 'plasticity'?"),
    (SMOOTH + YIELDS + FILES, "roughness.source (line 13): `source` must be 'gaussian' with "
     "[plasticity] model = 'kogut-etsion'", "got 'summits'"),
    (SMOOTH + YIELDS + WATER + 'model = "constant-volume"', "capillary.model (line 17): `model` "
     "must be 'equilibrium', 'kelvin-filling' or 'none'", "got 'constant-volume'"),
    (SMOOTH + YIELDS + WATER + 'model = "equilibrium"\nformation_time = "1 us"',
     "capillary.formation_time (line 18): `formation_time` must be absent", "got '1e-06 s'"),
    (with_key("counterface", 'deformation = "rigid"') + YIELDS + ROUGH + "[publication]",
     "plasticity.model (line 11): [plasticity] must be absent with [publication]",
     "got 'kogut-etsion'"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "rule", "got"), BAD, ids=range(len(BAD)))
def test_what_cannot_be_is_one_line_with_key_rule_and_value(text, rule, got):
    line = refusal(text)
    assert rule in line
    assert got in line


@pytest.mark.parametrize("adhesion", ["auto", "bradley", "jkr", "maugis"])
@pytest.mark.parametrize("surface", ["", ROUGH], ids=["smooth", "rough"])
@pytest.mark.parametrize("model", MODELS)
def test_an_adhesion_that_changes_the_contact_is_refused(model, surface, adhesion):
    text = SMOOTH + YIELDS.replace("kogut-etsion", model) + surface + ADHESION.format(adhesion)
    if (model, surface, adhesion) == ("thornton-ning", "", "jkr"):
        assert load(text).adhesion.model == "jkr"
        return
    line = refusal(text)
    allowed = "'jkr', 'dmt' or 'none'" if model == "thornton-ning" and not surface else "'dmt' or "
    assert f"`model` must be {allowed}" in line
    assert "adhesion.model (line " in line
    assert f"[plasticity] model = '{model}'" in line
    assert line.endswith(f"an adhesion that acts beside contact; got '{adhesion}'\n")


@pytest.mark.parametrize("adhesion", ["dmt", "none"])
@pytest.mark.parametrize("surface", ["", ROUGH], ids=["smooth", "rough"])
def test_an_adhesion_beside_contact_is_taken(surface, adhesion):
    bodies = rigid() if surface else SMOOTH
    text = bodies + YIELDS + surface + ADHESION.format(adhesion)
    assert load(text).adhesion.model == adhesion


def test_the_model_none_refuses_nothing_and_liquid_that_is_off_is_no_liquid():
    off = YIELDS.replace("kogut-etsion", "none")
    late = WATER + 'formation_time = "1 us"\n'
    assert load(SMOOTH + off + FILES + ADHESION.format("jkr")).plasticity.model == "none"
    assert load(SMOOTH.replace("silica", "silicon") + off + late + 'model = "constant-volume"')
    wet = resolve(load(SMOOTH + YIELDS + late + 'model = "none"'))
    assert wet.structure.plasticity == "kogut-etsion"
    gaussian = FILES.replace('"summits"', '"gaussian"')
    assert load(rigid() + YIELDS + gaussian).roughness.source == "gaussian"


def test_a_sphere_that_adhesion_alone_makes_yield_is_refused_with_the_least_pressure():
    """Its JKR pressure reaches the yield pressure before any load does."""
    soft = YIELDS.replace('model = "kogut-etsion"', 'model = "thornton-ning"')
    case = load(SMOOTH + soft + ADHESION.format("jkr"))
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
        load(SMOOTH + table)
