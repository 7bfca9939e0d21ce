"""Text with a unit becomes the SI float that it names, or an error that says why not."""

import math
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from asperity import units
from asperity.errors import InputError
from asperity.units import example, quantity, shown

KNOWN = ["m", "1/m^2", "Pa", "kg/m^3", "J/m^2", "N/m", "m^3/mol", "K", "rad", "m/s", "m/s^2", "s"]


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("50 um", "m", 5e-05),
        ("0.25nm", "m", 2.5e-10),
        ("2.5 Å", "m", 2.5e-10),
        ("1.69e16 1/m^2", "1/m^2", 1.69e16),
        ("1.69e4 um^-2", "1/m^2", 1.69e16),
        ("80 GPa", "Pa", 80e9),
        ("2.2 g/cm^3", "kg/m^3", 2200.0),
        ("30 mJ/m^2", "J/m^2", 0.03),
        ("75 mJ/m^2", "N/m", 0.075),
        ("18.05 cm³ mol⁻¹", "m^3/mol", 1.805e-5),
        ("20 degC", "K", 293.15),
        ("-10 °C", "K", 263.15),
        ("68 degF", "K", 293.15),
        ("293 K", "K", 293.0),
        ("180 deg", "rad", math.pi),
        ("9.81 m s^-2", "m/s^2", 9.81),
        ("1 min", "s", 60.0),
        ("-3 m", "m", -3.0),
        ("  7 mm ", "m", 0.007),
    ],
)
def test_a_quantity_is_the_float_nearest_to_what_was_written(text, unit, value):
    assert quantity(text, unit) == value


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        (50, "must be text with a number and a unit, such as '50 um'; got 50"),
        (5e-5, "must be text with a number and a unit"),
        (True, "must be text with a number and a unit"),
        (None, "must be text with a number and a unit"),
        ("50", "must have a unit, such as '50 um'; got '50'"),
        ("um", "must be a number with a unit"),
        ("", "must be a number with a unit"),
        ("50 kg", "must be a length, such as '50 um'; got '50 kg'"),
        ("50 um^2", "must be a length"),
        ("50 smoot", "in a known unit; got '50 smoot'"),
        ("nan m", "must be finite"),
        ("-inf m", "must be finite"),
        ("1e999 m", "that a float can hold"),
        ("1e-400 m", "that a float can hold"),
        ("1,5 m", "in a known unit"),
        ("5 um 3", "in a known unit"),
        ("5 ** 3 m", "in a known unit"),
        ("1 m^999999999", "in a known unit"),
        ("1 m/0", "in a known unit"),
        ("__import__('os')", "must be a number with a unit"),
        ("1 m\0", "in a known unit"),
        ("٥ m", "must be a number with a unit"),
    ],
)
def test_what_is_no_length_is_refused_with_the_rule(text, rule):
    with pytest.raises(InputError) as caught:
        quantity(text, "m", "radius")
    assert str(caught.value).startswith("`radius` must")
    assert rule in str(caught.value)


@pytest.mark.parametrize("text", ["5 %", "3 count", "1 m/m"])
def test_other_dimensionless_units_are_no_angle(text):
    with pytest.raises(InputError, match="must be an angle"):
        quantity(text, "rad")


@pytest.mark.parametrize("text", ["20 delta_degC", "5 degC/m"])
def test_a_difference_of_temperatures_is_no_temperature(text):
    with pytest.raises(InputError, match="must be a temperature"):
        quantity(text, "K")


@given(st.floats(allow_nan=False, allow_infinity=False), st.sampled_from(KNOWN))
def test_a_float_with_its_si_unit_reads_back_exactly(value, unit):
    assert quantity(f"{value!r} {unit}", unit) == value


@given(st.integers(-(10**9), 10**9))
def test_the_result_does_not_depend_on_the_unit_chosen(count):
    nanometres = quantity(f"{count} nm", "m")
    assert nanometres == quantity(f"{count}e-3 um", "m")
    assert nanometres == quantity(f"{count}0 angstrom", "m")
    assert nanometres == quantity(f"{count}e-9 m", "m")


def finite_or_refused(text, unit):
    try:
        return math.isfinite(quantity(text, unit))
    except InputError as error:
        return "must" in str(error) and len(str(error).splitlines()) == 1


@given(st.text(), st.sampled_from(KNOWN))
def test_any_text_gives_a_finite_float_or_an_input_error(text, unit):
    assert finite_or_refused(text, unit)


@given(st.text("0123456789eE+-.^*/()· umnkgPaJKdC°%_⁻²³", max_size=20), st.sampled_from(KNOWN))
def test_text_that_resembles_a_quantity_is_one_or_an_input_error(text, unit):
    assert finite_or_refused(f"1{text}", unit)


@pytest.mark.parametrize("unit", KNOWN)
def test_the_example_of_a_unit_is_a_quantity_in_it(unit):
    assert quantity(example(unit), unit) > 0


def test_an_unlisted_unit_works_and_names_itself():
    assert quantity("2 kN", "N") == 2000.0
    assert example("N") == "1 N"
    with pytest.raises(InputError, match="a value in N"):
        quantity("2 m", "N")


@pytest.mark.parametrize(
    "value",
    [16**5000, "x" * 10**6, [[[[[1]]]]], {"a": {"b": {"c": 1}}}],
    ids=["digits", "letters", "lists", "tables"],
)
def test_a_value_is_shown_shortened(value):
    assert len(shown(value)) < 100


def test_pint_is_not_imported_before_the_first_conversion():
    code = "import sys, asperity.units; assert 'pint' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize(
    ("unit", "spelling"), [(unit, name) for unit, row in units._COMMON.items() for name in row]
)
@pytest.mark.parametrize("number", ["1", "0", "-3", "73", "0.1", "1.69e16", "5e-7", "89.99999999"])
def test_spellings_known_by_heart_are_read_as_pint_reads_them(number, unit, spelling):
    text = f"{number} {spelling}"
    assert quantity(text, unit) == units._by_pint(number, spelling, text, unit, "value")


def test_the_built_in_case_is_read_without_pint():
    program = "import sys, asperity; asperity.load('published-exact'); print('pint' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], check=True, capture_output=True, text=True
    )
    assert done.stdout.strip() == "False"
