"""Bad input: whatever a case file holds, it is read or refused in one line that says why."""

import os
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asperity.config import Case, builtin, load, load_file, template
from asperity.config.case_file import SIZE_LIMIT
from asperity.config.problems import tables_of
from asperity.errors import InputError
from case_texts import SMALL
from refused_input import refusal

TEMPLATE = template()


def said(text, file="drop.toml"):
    """What the error of a text says after the name of the file, with which it begins."""
    error = refusal(load, text, file=file)
    assert error.file == file
    assert str(error).startswith(f"{file}: ")
    return str(error).removeprefix(f"{file}: ")


def altered(old, new):
    """The template with one thing replaced."""
    assert old in TEMPLATE
    return TEMPLATE.replace(old, new, 1)


# --- what is refused ---------------------------------------------------------------------------

GLASS, HUMID = 'material = "soda-lime glass"', "humidity = 0.6"
AIR = '[gas]\nname = "air"\npressure = "1 bar"\ntemperature = "20 degC"\n'
BAD = [
    ('"50 um"', "50", "body.radius (line 8): `radius` must be text with a number and a unit"),
    ('"50 um"', '"50 kg"', "must be a length, such as '50 um'; got '50 kg'"),
    ('"50 um"', '"-50 um"', "`radius` must be positive; got '-50 um'"),
    ('"50 um"', '"0 um"', "`radius` must be positive; got '0 um'"),
    ('"50 um"', '"2 km"', "`radius` must lie in [1e-15, 1] m; got '2 km'"),
    ('radius = "50 um"', "", "body.radius (line 6): `radius` is missing"),
    ("radius", "raduis", "(line 8): `raduis` is not a key of [body]; got '50 um' - did you mean"),
    ("[roughness]", "[rougness]", "`rougness` is not a key or table of a case - did you mean"),
    ("gravity", "humidity", "not a key of [impact]; got '9.81 m/s^2' - it belongs in [capillary]"),
    ("schema = 1", "qqqq = 1", "`qqqq` is not a key or table of a case; got 1"),
    ("schema = 1", "schema = 2", "`schema` must be 1, the only version that there is; got 2"),
    ("schema = 1", "schema = true", "`schema` must be 1"),
    ('shape = "sphere"', 'shape = "cylinder"', "`shape` must be 'sphere'; got 'cylinder'"),
    (GLASS, "", "body.material (line 6): `material`, or all of `youngs_modulus`"),
    (GLASS, "poisson = 0.2", "body.youngs_modulus"),
    (GLASS, 'material = "silca"', "got 'silca' - did you mean 'silica'?"),
    ("# poisson = 0.25 ", "poisson = 0.25 ", "`poisson` and `material` exclude each other"),
    ("# poisson = 0.25 ", "poisson = 0.7 ", "body.poisson (line 11): `poisson` must lie in"),
    ("# poisson = 0.25 ", "poisson = -1 ", "`poisson` must lie in (-1, 0.5]; got -1"),
    ('"rigid"', '"rigit"', "must be one of 'half-space' or 'rigid'; got 'rigit' - did you"),
    ('model = "auto"', "", "adhesion.model"),
    ('"auto"', '"dmt+jkr"', "would count it twice; got 'dmt+jkr'"),
    ('"auto"', '["jkr", "dmt"]', "would count it twice; got ['jkr', 'dmt']"),
    ('"auto"', '"hertz"', "would count twice: take 'none'; got 'hertz'"),
    ('work = "60 mJ/m^2"', "", "adhesion.work (line 58): `work` must be given with model = 'auto'"),
    ('equilibrium_spacing = "0.2 nm"', "", "`equilibrium_spacing` must be given with"),
    ("# [gas]", AIR.replace("air", "argom"), "got 'argom' - did you mean 'argon'?"),
    ("# [gas]", AIR.replace("20 degC", "50 K"), "gas.temperature"),
    ("# [gas]", f"{AIR}viscosity = '1 Pa s'", "`viscosity` must not be given beside `name`"),
    ("# [gas]", "[gas]\nviscosity = '1 Pa s'", "`slip_length` must be given with `viscosity`"),
    ("# [gas]", f"{AIR}cutoff_separation = '1 um'", "must be smaller than `release_separation`"),
    ('"rigid"', '"half-space"\n[publication]', "counterface.deformation (line 20)"),
    (HUMID, "humidity = 1.2", "capillary.humidity (line 74): `humidity` must lie in [0, 1]"),
    (HUMID, "humidity = 1", "at 1 the Kelvin radius is infinite"),
    (HUMID, "humidity = nan", "`humidity` must be finite; got nan"),
    (HUMID, 'humidity = "60 %"', "`humidity` must be a number in [0, 1]; got '60 %'"),
    (HUMID, "humidity = true", "`humidity` must be a number in [0, 1]; got True"),
    (HUMID, "", "`humidity` must be given with model = 'equilibrium'"),
    ('"30 deg"', '"120 deg"', "capillary.contact_angle (line 76): `contact_angle` must lie in"),
    ('"30 deg"', '"300 deg"', "`contact_angle` must lie in [0, 180] deg; got '300 deg'"),
    ('liquid = "water"', 'liquid = "watr"', "got 'watr' - did you mean 'water'?"),
    ('"20 degC"', '"200 degC"', "(line 75): `temperature` must lie in [273.15 K, 373.15 K]"),
    ('"20 degC"', '"-300 degC"', "`temperature` must lie in [1, 10000] K; got '-300 degC'"),
    ('release_separation = "1 um"', "", "`release_separation` or `speed` must be given"),
    ('"9.81 m/s^2"', '"0 m/s^2"', "the body would never fall; got 0 m/s^2"),
    ('"9.81 m/s^2"', '"-9.81 m/s^2"', "`gravity` must not be negative; got '-9.81 m/s^2'"),
    ('# speed = "0.1 m/s"', 'speed = "0 m/s"', "`speed` must be positive; got '0 m/s'"),
    ("tolerance = 1e-08", "tolerance = 1", "`tolerance` must lie in [1e-12, 1e-3]; got 1"),
    ("rings = 80", "rings = 96.5", "`rings` must be a whole number in [16, 400]; got 96.5"),
    ("rings = 80", f"rings = 0x{'f' * 900}", "`rings` must lie in [16, 400]; got 510486"),
    ("motion = true", 'motion = "yes"', "`motion` must be true or false; got 'yes'"),
    ('# directory = "drop-out"', 'directory = ""', "`directory` must be a folder's path; got ''"),
    ('# directory = "drop-out"', "directory = 3", "`directory` must be text in quotes; got 3"),
    ("schema = 1", "materials = 3", "`materials` must be a table of tables; got 3"),
    ("schema = 1", "materials.glass = 3", "`glass` must be a table; got 3"),
    ("schema = 1", "[materials.glass]\npoison = 0.7", "not a key of [materials.glass]; got 0.7"),
    ("[body]", "[[body]]", "`body` must be a table"),
    ("[body]", "[body", "not TOML (line 6, column 6)"),
    ("schema = 1", "schema = 1\nschema = 1", "not TOML (line 4, column 11): Cannot overwrite"),
    ("schema = 1", f"schema = {'[' * 900}", "not TOML: values nested too deeply"),
    ("schema = 1", "schema = " + "[\n" * 5000, "not TOML: values nested too deeply"),
    ("rings = 80", f"rings = 9_{'9' * 1000}", "a line must be at most 1000 characters"),
    ("schema = 1", f"{'a.' * 9999}a = 1", "a line must be at most 1000 characters"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "rule"), BAD, ids=range(len(BAD)))
def test_bad_input_is_one_line_that_names_file_key_rule_and_value(old, new, rule):
    assert rule in said(altered(old, new))


@pytest.mark.parametrize("table", ["body", "counterface"])
def test_a_missing_table_is_named(table):
    others = [part for part in SMALL.split("[")[1:] if not part.startswith(table)]
    assert f"the table [{table}] is missing" in said("".join(f"[{part}" for part in others))


def test_a_smooth_rigid_body_is_refused():
    rule = "`deformation` must be 'half-space' without a [roughness] table"
    assert rule in said(SMALL.replace("[impact]", 'deformation = "rigid"\n[impact]'))


def test_the_key_of_an_error_is_dotted():
    error = refusal(load, SMALL.replace("10 um", "-10 um"))
    assert (error.key, error.file) == ("body.radius", None)
    assert str(error).startswith("body.radius (line 3): ")


def test_the_line_of_a_dotted_or_quoted_key_is_found():
    text = 'body.radius = "x"\nbody."material" = "silica"\n'
    assert said(text).startswith("body.radius (line 1)")
    text = text.replace("radius", '"radius"')
    assert said(text).startswith("body.radius (line 1)")


@pytest.mark.parametrize("text", ["", " \n\t\n", "\0", "a\0b", "[body", "=", "\r", "x" * 5000])
def test_text_that_is_no_case_is_refused(text):
    assert said(text)


def test_text_beyond_a_mebibyte_is_refused():
    assert "at most 1 MiB" in said("#\n" * (SIZE_LIMIT // 2 + 1))
    assert "at most 1 MiB" in said("ä\n" * (SIZE_LIMIT // 3 + 1))


def test_a_text_of_very_many_or_very_deep_keys_is_refused():
    lines = "\n".join(f"k{number} = 1" for number in range(5_000))
    assert "`k0` is not a key" in said(lines)
    nested = "\n".join(f"{'a.' * 490}k{number} = 1" for number in range(100))
    assert "`a` is not a key" in said(nested)


# --- files -------------------------------------------------------------------------------------


def file_refusal(path):
    return str(refusal(load_file, path))


def test_what_is_no_file_is_named(tmp_path):
    path = tmp_path / "none.toml"
    assert file_refusal(path) == f"{path}: cannot be read: No such file or directory"
    assert "got a folder" in file_refusal(tmp_path)
    os.mkfifo(tmp_path / "pipe")
    for opened in (tmp_path / "pipe", "/dev/zero"):
        assert "got a device, pipe or socket" in file_refusal(opened)


@pytest.mark.parametrize(
    ("content", "rule"),
    [(b"\n\n", "got an empty file"), (b"\x89PNG\r\n\x1a\n", "got a binary file (byte 1)")],
)
def test_an_empty_or_binary_file_is_refused(tmp_path, content, rule):
    path = tmp_path / "case.toml"
    path.write_bytes(content)
    assert rule in file_refusal(path)


def test_a_file_above_a_mebibyte_is_refused_unread(tmp_path, monkeypatch):
    path = tmp_path / "large.toml"
    with path.open("wb") as stream:
        stream.truncate(SIZE_LIMIT + 1)
    monkeypatch.setattr(Path, "open", lambda *_: pytest.fail("it was opened"))
    assert f"at most 1 MiB; got {SIZE_LIMIT + 1} bytes" in file_refusal(path)


def test_a_file_without_permission_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "secret.toml"
    path.write_text(SMALL)

    def refuse(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refuse)
    assert "cannot be read: Permission denied" in file_refusal(path)


@pytest.mark.parametrize("path", ["a\0b.toml", "x" * 5000, "line\nbreak.toml"])
def test_an_odd_path_is_refused(path):
    assert "cannot be read" in file_refusal(path)


# --- anything ----------------------------------------------------------------------------------


def read_or_refused(read):
    """What ``read`` gives; None where it refuses, in one line."""
    try:
        return read()
    except InputError as error:
        return None if len(str(error).splitlines()) == 1 else pytest.fail(str(error))


@given(st.binary(max_size=300))
def test_random_bytes_are_refused(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("bytes") / "case.toml"
    path.write_bytes(content)
    file_refusal(path)


@given(st.text(max_size=300))
def test_random_text_is_refused(text):
    said(text)


@settings(max_examples=200)
@given(st.data())
def test_a_mutated_case_is_read_or_refused(data):
    text = data.draw(st.sampled_from([TEMPLATE, SMALL]))
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        end = min(len(text), start + data.draw(st.integers(0, 12)))
        text = text[:start] + data.draw(st.text(max_size=8)) + text[end:]
    read_or_refused(lambda: load(text, file="drop.toml"))


toml_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=10)
    | st.sampled_from(["1 m", "1 um", "20 degC", "1 GPa", "silica", "dmt", "none", "water"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner),
    max_leaves=5,
)  # fmt: skip
keys = st.sampled_from(
    [
        f"{name}.{key}"
        for name, field in Case.model_fields.items()
        for table in tables_of(field.annotation)
        for key in table.model_fields
    ]
    + ["schema", "body", "roughness", "materials", "materials.glass.poisson"]
)


@settings(max_examples=150)
@given(st.dictionaries(keys, toml_values, max_size=4))
def test_any_value_at_any_key_is_read_or_refused(changes):
    case = read_or_refused(lambda: builtin("published-exact").replace(changes))
    assert case is None or load(case.toml()) == case
