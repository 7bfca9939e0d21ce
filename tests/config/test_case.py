"""Case files: what is read is what was written, and what is wrong is said in one line."""

import importlib.resources
import math
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from asperity.config import BUILTINS, FIRST, Case, builtin, load, load_file, template
from asperity.config.base_table import Table
from asperity.config.bodies import Body
from asperity.config.gas import Gas
from asperity.config.problems import tables_of
from asperity.config.resolve import resolve
from asperity.config.roughness import NUMBERS
from asperity.errors import InputError, Tolerance
from asperity.materials.liquids import LIQUIDS, kelvin_radius
from asperity.materials.solids import SOLIDS
from asperity.units import quantity
from case_texts import SMALL

TEMPLATE = template()


def altered(old, new):
    """The template with one thing replaced."""
    assert old in TEMPLATE
    return TEMPLATE.replace(old, new, 1)


# --- what is read ------------------------------------------------------------------------------


def test_the_published_case_is_the_one_of_the_publication():
    case = builtin("published-exact")
    rough, water, impact = case.roughness, case.capillary, case.impact
    assert case.body.radius == 50e-6
    assert (rough.asperity_density, rough.asperity_radius) == (1.69e16, 0.25e-9)
    assert rough.rms_height == 10.5e-9
    assert (case.adhesion.model, case.adhesion.work) == ("dmt", 0.03)
    assert case.adhesion.equilibrium_spacing == 2e-10
    assert (water.model, water.formation) == ("equilibrium", "on-contact")
    assert (water.humidity, water.temperature) == (0.6, 293.15)
    assert water.contact_angle == math.radians(73)
    assert (impact.release_separation, impact.speed, impact.gravity) == (60e-9, None, 9.81)
    assert case.counterface.deformation == "half-space"
    assert resolve(case).body == SOLIDS["silica"]
    assert resolve(case).counterface == SOLIDS["silicon carbide"]
    assert resolve(case).body.density == 2200.0
    assert resolve(case).tolerance == Tolerance()


def test_a_case_needs_little_and_has_neither_roughness_nor_adhesion_nor_water_by_default():
    case = load(SMALL)
    assert case.roughness is None
    assert case.adhesion.model == "none"
    assert case.capillary.model == "none"
    assert resolve(case).liquid is None
    assert case.output.motion
    assert case.output.pictures
    assert case.output.directory is None


def test_the_liquid_has_the_tension_of_the_cases_temperature():
    case = load(altered('"20 degC"', '"40 degC"'))
    assert resolve(case).liquid == LIQUIDS["water"].at(313.15)
    assert resolve(case).kelvin_radius == kelvin_radius(resolve(case).liquid, 0.6, 313.15)


def test_the_case_can_set_its_own_tension_and_molar_volume():
    own = TEMPLATE.replace("# tension", "tension")
    assert resolve(load(own)).liquid.tension == 0.075
    assert resolve(load(own)).liquid.molar_volume == LIQUIDS["water"].molar_volume
    own = own.replace("# molar_volume", "molar_volume").replace('"20 degC"', '"-10 degC"')
    assert resolve(load(own)).liquid.molar_volume == 1.805e-5
    assert resolve(load(own)).liquid.molecule_size == LIQUIDS["water"].molecule_size
    other = resolve(load(own.replace('"water"', '"my oil"'))).liquid
    assert (other.name, other.tension) == ("my oil", 0.075)


def test_a_material_of_ones_own_by_table_or_in_place():
    table = 'youngs_modulus = "70 GPa"\npoisson = 0.2\ndensity = "2.5 g/cc"\n'
    case = load(SMALL.replace('"silica"', '"my glass"') + f'[materials."my glass"]\n{table}')
    assert resolve(case).body.name == "my glass"
    assert (resolve(case).body.youngs_modulus, resolve(case).body.density) == (70e9, 2500.0)
    # It comes before one of the catalogue.
    assert resolve(load(f"{SMALL}[materials.silica]\n{table}")).body.youngs_modulus == 70e9
    in_place = 'youngs_modulus = "1 GPa"\npoisson = 0.3'
    case = load(SMALL.replace('material = "silicon"', in_place))
    assert resolve(case).counterface.youngs_modulus == 1e9
    assert resolve(case).counterface.density is None


def test_jkr_needs_no_range_and_a_body_with_a_speed_no_gravity():
    case = load(SMALL + 'gravity = "0 m/s^2"\n[adhesion]\nmodel = "jkr"\nwork = "50 mJ/m^2"')
    assert case.adhesion.equilibrium_spacing is None
    assert case.impact.gravity == 0.0


def test_a_byte_order_mark_and_windows_line_ends_do_no_harm(tmp_path):
    file = tmp_path / "case.toml"
    file.write_bytes(b"\xef\xbb\xbf" + SMALL.replace("\n", "\r\n").encode())
    assert load_file(file) == load(SMALL)


# --- what is written ---------------------------------------------------------------------------


def test_the_template_loads_and_is_the_first_case():
    assert load(TEMPLATE) == builtin(FIRST)


def every_key(model, place=()):
    for name, field in model.model_fields.items():
        inside = tables_of(field.annotation)
        for table in inside:
            yield from every_key(table, (*place, name))
        if not inside:
            yield place, name, field


KEYS = list(every_key(Case))


@pytest.mark.parametrize(("place", "name", "field"), KEYS, ids=lambda value: str(value)[:40])
def test_every_key_has_a_unit_a_meaning_an_example_and_a_line_in_the_template(place, name, field):
    assert field.description.endswith(".")
    assert isinstance(field.json_schema_extra["unit"], str)
    assert field.examples[0] is not None
    assert re.search(rf"^(# )?{field.alias or name} = ", TEMPLATE, re.MULTILINE)


NUMBERED = {"asperity_density": "1 1/um^2", "asperity_radius": "1 nm", "rms_height": "1 nm"}
SOLID = {"youngs_modulus": "1 GPa", "poisson": 0.2, "density": "1 g/cc"}
NEEDED = {
    "adhesion": {"model": "none"},
    "capillary": {"model": "none"},
    "plasticity": {"model": "thornton-ning"},
    "publication": {},
    "suspension": {"stiffness": "1 N/m", "rest_gap": "50 nm"},
    "viscoelasticity": {"model": "standard-linear-solid", "relaxed_modulus_ratio": 0.1,
                        "relaxation_time": "1 s"},
    "gas": {"name": "argon", "pressure": "1 kPa", "temperature": "300 K"},
}  # fmt: skip
"""What each table needs beside any key of it."""
NOT_ALONE = {("adhesion", "model"), ("capillary", "model")}
"""Keys whose examples need more of their table."""


def around(table, name):
    """The tables of a case in which a key of one of them may be given."""
    case = {"body": {"radius": "1 um", "material": "gold"}, "counterface": {"material": "gold"},
            "impact": {"speed": "1 m/s"}}  # fmt: skip
    case |= {table: NEEDED.get(table, case.get(table, {}))}
    if table in ("body", "counterface") and name in (*SOLID, "hardness", "yield_strength"):
        case[table] = {"radius": "1 um"} | SOLID if table == "body" else SOLID
    if table == "publication" or name in ("placement", "realisations", "seed"):
        case["counterface"] = {"material": "gold", "deformation": "rigid"}
    if table in ("roughness", "publication") or name == "deformation":
        case["roughness"] = NUMBERED
    if name in ("realisations", "seed"):
        case["roughness"] = NUMBERED | {"placement": "random"}
    elif table == "roughness" and name not in (*NUMBERS, "placement"):
        case["roughness"] = {"files": ["surface.csv"], "source": "summits"}
    if name in ("viscosity", "slip_length"):
        case["gas"] = {"viscosity": "18 uPa s", "slip_length": "0 nm"}
    if table in ("gas", "suspension"):
        case["impact"]["release_separation"] = "1 um"
    if table == "gas":
        case["gas"] = case["gas"] | {"cutoff_separation": "2 nm"}
    return case


EXAMPLES = [
    (*place, name, field)
    for place, name, field in KEYS
    if place not in ((), ("materials",)) and (*place, name) not in NOT_ALONE
]


@pytest.mark.parametrize(("table", "name", "field"), EXAMPLES, ids=lambda value: str(value)[:40])
def test_the_example_of_every_key_is_read(table, name, field):
    tables = around(table, name)
    tables[table] = tables.get(table, {}) | {name: field.examples[0]}
    value = getattr(getattr(Case.model_validate(tables), table), name)
    unit, example = field.json_schema_extra["unit"], field.examples[0]
    assert value == (example if unit in ("", "1") else quantity(example, unit))


names = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=12)
radii = st.floats(1e-6, 0.9)
numbers = st.floats(1e-12, 0.9, allow_subnormal=False)


@given(name=names, radius=radii, angle=st.floats(0, 1.5), gap=numbers, humidity=numbers)
def test_a_case_reads_back_exactly_from_its_own_text(name, radius, angle, gap, humidity):
    case = load(TEMPLATE).replace(
        {
            "body.radius": f"{radius!r} m",
            "capillary.contact_angle": f"{angle!r} rad" if angle > 1e-9 else "0 rad",
            "capillary.humidity": humidity,
            "impact.release_separation": f"{gap!r} m",
            "impact.speed": "0.1 m/s",
            "numerics.time_limit": "1 ms",
            "output.directory": name.replace("\0", "0") + "x",
            "materials": {name: {"youngs_modulus": "1 MPa", "poisson": 0.5, "density": "1 kg/m^3"}},
            "counterface.material": name,
        }
    )
    assert case.body.radius == radius
    assert list(case.materials) == [name]
    assert load(case.toml()) == case
    assert load(case.toml()).toml() == case.toml()


@pytest.mark.parametrize("text", [SMALL, TEMPLATE])
def test_the_text_of_a_case_states_its_defaults(text):
    tables = tomllib.loads(load(text).toml())
    assert tables["schema"] == 1
    assert tables["numerics"]["rings"] == 80
    assert tables["impact"]["gravity"] == "9.81 m/s^2"
    assert tables["adhesion"]["model"]


def test_replacing_values_checks_them():
    case = builtin("published-exact")
    dry = case.replace({"capillary": None, "body.radius": "20 um", "adhesion.model": "none"})
    assert (dry.capillary.model, dry.body.radius) == ("none", 20e-6)
    assert case.body.radius == 50e-6
    with pytest.raises(InputError, match=r"body\.radius: `radius` must be positive"):
        case.replace({"body.radius": "-1 um"})
    with pytest.raises(InputError, match="did you mean 'radius'"):
        case.replace({"body.raduis": "1 um"})
    with pytest.raises(InputError, match="`radius` is no table"):
        case.replace({"body.radius.x": 1})
    glass = {"youngs_modulus": "70 GPa", "poisson": 0.2, "density": "2500 kg/m^3"}
    own = case.replace({"materials": {"no. 5": glass}, "materials.no. 5.density": 2600.0})
    assert own.materials["no. 5"].density == 2600.0


# --- built-in cases ----------------------------------------------------------------------------


def test_the_built_in_cases_are_those_of_the_package():
    files = (importlib.resources.files("asperity.config") / "cases").iterdir()
    assert sorted(BUILTINS) == sorted(Path(file.name).stem for file in files)
    assert "published-exact" in BUILTINS


@pytest.mark.parametrize("name", BUILTINS)
def test_every_built_in_case_loads_and_reads_back(name):
    assert load(builtin(name).toml()) == builtin(name)


def test_importing_cases_is_light():
    code = (
        "import sys, asperity.config; "
        "print([name for name in ('jax', 'pint', 'numpy') if name in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert run.stdout.strip() == "[]"


def test_every_model_is_frozen_refuses_unknown_keys_and_checks_its_defaults():
    models = [Table]
    for model in models:
        models += model.__subclasses__()
        config = model.model_config
        assert config["frozen"]
        assert config["extra"] == "forbid"
        assert config["validate_default"]
    assert {Body, Gas} < set(models)
