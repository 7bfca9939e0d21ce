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

TEMPLATE = template()
SMALL = """
[body]
radius = "10 um"
material = "silica"
[counterface]
material = "silicon"
[impact]
speed = "0.1 m/s"
"""


def refusal(text, file="drop.toml"):
    """The message of the error that a text gives: always one line that begins with the file."""
    with pytest.raises(InputError) as caught:
        load(text, file=file)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    assert message.startswith(f"{file}: ")
    assert caught.value.file == file
    return message.removeprefix(f"{file}: ")


def altered(old, new):
    """The template with one thing replaced."""
    assert old in TEMPLATE
    return TEMPLATE.replace(old, new, 1)


# --- what is refused ---------------------------------------------------------------------------

BAD = [
    ('radius = "50 um"', "radius = 50", "body.radius (line 8): `radius` must be text with a number"
     " and a unit, such as '50 um'; got 50"),
    ('radius = "50 um"', 'radius = "50"', "must have a unit, such as '50 um'; got '50'"),
    ('radius = "50 um"', 'radius = "50 kg"', "must be a length, such as '50 um'; got '50 kg'"),
    ('radius = "50 um"', 'radius = "50 smoot"', "in a known unit; got '50 smoot'"),
    ('radius = "50 um"', 'radius = "-50 um"', "`radius` must be positive; got '-50 um'"),
    ('radius = "50 um"', 'radius = "0 um"', "`radius` must be positive; got '0 um'"),
    ('radius = "50 um"', 'radius = "2 km"', "`radius` must lie in [1e-15, 1] m; got '2 km'"),
    ('radius = "50 um"', 'radius = "nan m"', "`radius` must be finite; got 'nan m'"),
    ('radius = "50 um"', "radius = nan", "must be text with a number and a unit"),
    ('radius = "50 um"', "radius = true", "must be text with a number and a unit"),
    ('radius = "50 um"', "", "body.radius (line 6): `radius` is missing"),
    ('radius = "50 um"', 'raduis = "50 um"', "body.raduis (line 8): `raduis` is not a key of "
     "[body]; got '50 um' - did you mean 'radius'?"),
    ("rms_height", "rms_hight", "- did you mean 'rms_height'?"),
    ("[roughness]", "[rougness]", "`rougness` is not a key or table of a case - did you mean "
     "'roughness'?"),
    ("gravity", "humidity", "is not a key of [impact]; got '9.81 m/s^2' - it belongs in "
     "[capillary]"),
    ("schema = 1", "qqqq = 1", "`qqqq` is not a key or table of a case; got 1"),
    ("schema = 1", "schema = 2", "`schema` must be 1, the only version that there is; got 2"),
    ("schema = 1", "schema = true", "`schema` must be 1"),
    ('shape = "sphere"', 'shape = "cylinder"', "`shape` must be 'sphere'; got 'cylinder'"),
    ('material = "soda-lime glass"', "", "body.material (line 6): `material`, or all of "
     "`youngs_modulus`, `poisson`, `density`, must be given"),
    ('material = "soda-lime glass"', "poisson = 0.2", "body.youngs_modulus"),
    ('material = "soda-lime glass"', 'material = "silca"', "got 'silca' - did you mean 'silica'?"),
    ("# poisson = 0.25 ", "poisson = 0.25 ", "`poisson` and `material` exclude each other"),
    ("# poisson = 0.25 ", "poisson = 0.7 ", "body.poisson (line 11): `poisson` must lie in "
     "(-1, 0.5]; got 0.7"),
    ("# poisson = 0.25 ", "poisson = -1 ", "`poisson` must lie in (-1, 0.5]; got -1"),
    ("# poisson = 0.25 ", 'poisson = "0.25" ', "`poisson` must be a number in (-1, 0.5]"),
    ('deformation = "rigid"', 'deformation = "rigit"', "must be one of 'half-space' or "
     "'rigid'; got 'rigit' - did you mean 'rigid'?"),
    ('model = "auto"', "", "adhesion.model"),
    ('model = "auto"', 'model = "dtm"', "`model` must be one of 'none', 'auto', 'bradley', 'dmt', "
     "'maugis', 'jkr' or 'lennard-jones'; got 'dtm' - did you mean 'dmt'?"),
    ('model = "auto"', 'model = "dmt+jkr"', "would count it twice; got 'dmt+jkr'"),
    ('model = "auto"', 'model = ["jkr", "dmt"]', "would count it twice; got ['jkr', 'dmt']"),
    ('model = "auto"', 'model = "hertz"', "would count twice: take 'none'; got 'hertz'"),
    ('work = "60 mJ/m^2"', "", "adhesion.work (line 58): `work` must be given with model = 'auto'"),
    ('equilibrium_spacing = "0.2 nm"', "",
     "`equilibrium_spacing` must be given with model = 'auto'"),
    ("humidity = 0.6", "humidity = 1.2", "capillary.humidity (line 74): `humidity` must lie in "
     "[0, 1]; got 1.2"),
    ("# [gas]", '[gas]\nname = "argom"\npressure = "1 bar"\ntemperature = "20 degC"',
     "got 'argom' - did you mean 'argon'?"),
    ("# [gas]", '[gas]\nviscosity = "18 uPa s"', "`slip_length` must be given with `viscosity`"),
    ("# [gas]", '[gas]\nname = "air"\nviscosity = "18 uPa s"',
     "`viscosity` must not be given beside `name`"),
    ("# [gas]", '[gas]\nname = "air"\npressure = "1 bar"\ntemperature = "50 K"',
     "gas.temperature"),
    ("# [gas]", '[gas]\nviscosity = "1 Pa s"\nslip_length = "0 m"\ncutoff_separation = "1 um"',
     "`cutoff_separation` must be smaller than `release_separation` (1000 nm)"),
    ("humidity = 0.6", "humidity = 1", "at 1 the Kelvin radius is infinite"),
    ('deformation = "rigid"', 'deformation = "half-space"\n[publication]',
     "counterface.deformation (line 20): `deformation` must be 'rigid' with a [publication] table, "
     "which replaces the other models; got 'half-space'"),
    ("humidity = 0.6", "humidity = -0.1", "`humidity` must lie in [0, 1]; got -0.1"),
    ("humidity = 0.6", "humidity = nan", "`humidity` must be finite; got nan"),
    ("humidity = 0.6", 'humidity = "60 %"', "`humidity` must be a number in [0, 1]; got '60 %'"),
    ("humidity = 0.6", "humidity = true", "`humidity` must be a number in [0, 1]; got True"),
    ("humidity = 0.6", "", "`humidity` must be given with model = 'equilibrium'"),
    ('"30 deg"', '"120 deg"', "capillary.contact_angle (line 76): `contact_angle` must lie in "
     "[0, 90) deg with menisci"),
    ('"30 deg"', '"300 deg"', "`contact_angle` must lie in [0, 180] deg; got '300 deg'"),
    ('"30 deg"', '"-1 deg"', "`contact_angle` must lie in [0, 180] deg; got '-1 deg'"),
    ('liquid = "water"', 'liquid = "watr"', "got 'watr' - did you mean 'water'?"),
    ('"20 degC"', '"200 degC"', "capillary.temperature (line 75): `temperature` must lie in "
     "[273.15 K, 373.15 K]"),
    ('"20 degC"', '"-300 degC"', "`temperature` must lie in [1, 10000] K; got '-300 degC'"),
    ('release_separation = "1 um"', "",
     "`release_separation` or `speed` must be given; got neither"),
    ('"9.81 m/s^2"', '"0 m/s^2"', "the body would never fall; got 0 m/s^2"),
    ('"9.81 m/s^2"', '"-9.81 m/s^2"', "`gravity` must not be negative; got '-9.81 m/s^2'"),
    ('# speed = "0.1 m/s"', 'speed = "0 m/s"', "`speed` must be positive; got '0 m/s'"),
    ("tolerance = 1e-08", "tolerance = 1", "`tolerance` must lie in [1e-12, 1e-3]; got 1"),
    ("rings = 80", "rings = 96.5", "`rings` must be a whole number in [16, 400]; got 96.5"),
    ("rings = 80", "rings = 8", "`rings` must lie in [16, 400]; got 8"),
    ("rings = 80", f"rings = 0x{'f' * 900}", "`rings` must lie in [16, 400]; got 510486"),
    ("rings = 80", "max_impact = 3", "did you mean 'max_impacts'?"),
    ("motion = true", 'motion = "yes"', "`motion` must be true or false; got 'yes'"),
    ('# directory = "drop-out"', 'directory = ""', "`directory` must be a folder's path; got ''"),
    ('# directory = "drop-out"', "directory = 3", "`directory` must be text in quotes; got 3"),
    ("schema = 1", "materials = 3", "`materials` must be a table of tables; got 3"),
    ("schema = 1", "materials.glass = 3", "`glass` must be a table; got 3"),
    ("schema = 1", "[materials.glass]\npoison = 0.7", "not a key of [materials.glass]; got 0.7 - "
     "did you mean 'poisson'?"),
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
    assert rule in refusal(altered(old, new))


@pytest.mark.parametrize("table", ["body", "counterface"])
def test_a_missing_table_is_named(table):
    others = [part for part in SMALL.split("[")[1:] if not part.startswith(table)]
    assert f"the table [{table}] is missing" in refusal("".join(f"[{part}" for part in others))


def test_a_smooth_rigid_body_is_refused():
    rule = "`deformation` must be 'half-space' without a [roughness] table"
    assert rule in refusal(SMALL.replace("[impact]", 'deformation = "rigid"\n[impact]'))


def test_a_misspelt_key_is_reported_before_the_key_that_it_leaves_missing():
    assert "did you mean 'radius'" in refusal(SMALL.replace("radius", "radus"))


def test_the_key_of_an_error_is_dotted():
    with pytest.raises(InputError) as caught:
        load(SMALL.replace("10 um", "-10 um"))
    assert caught.value.key == "body.radius"
    assert caught.value.file is None
    assert str(caught.value).startswith("body.radius (line 3): ")


def test_the_line_of_a_dotted_or_quoted_key_is_found():
    text = 'body.radius = "x"\nbody."material" = "silica"\n'
    assert refusal(text).startswith("body.radius (line 1)")
    text = text.replace("radius", '"radius"')
    assert refusal(text).startswith("body.radius (line 1)")


@pytest.mark.parametrize("text", ["", " \n\t\n", "\0", "a\0b", "[body", "=", "\r", "x" * 5000])
def test_text_that_is_no_case_is_refused(text):
    assert refusal(text)


def test_text_beyond_a_mebibyte_is_refused():
    assert "at most 1 MiB" in refusal("#\n" * (SIZE_LIMIT // 2 + 1))
    assert "at most 1 MiB" in refusal("ä\n" * (SIZE_LIMIT // 3 + 1))


def test_a_text_of_very_many_or_very_deep_keys_is_refused():
    lines = "\n".join(f"k{number} = 1" for number in range(20_000))
    assert "`k0` is not a key" in refusal(lines)
    nested = "\n".join(f"{'a.' * 490}k{number} = 1" for number in range(100))
    assert "`a` is not a key" in refusal(nested)


# --- files -------------------------------------------------------------------------------------


def file_refusal(path):
    with pytest.raises(InputError) as caught:
        load_file(path)
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


def test_a_missing_file_is_named(tmp_path):
    path = tmp_path / "none.toml"
    assert file_refusal(path) == f"{path}: cannot be read: No such file or directory"


def test_a_folder_is_no_case(tmp_path):
    assert "got a folder" in file_refusal(tmp_path)


def test_a_pipe_is_not_opened(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    assert "got a device, pipe or socket" in file_refusal(pipe)
    assert "got a device, pipe or socket" in file_refusal("/dev/zero")


@pytest.mark.parametrize(
    ("content", "rule"),
    [
        (b"", "got an empty file"),
        (b"\n\n", "got an empty file"),
        (b"\x7fELF\x02\x01\x01\x00", "got a binary file"),
        (b"\x89PNG\r\n\x1a\n", "got a binary file (byte 1)"),
        (b"\xff\xfes\x00", "got a binary file"),
        (b"CDF\x01\x00", "got a binary file"),
    ],
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
    refusal(text)


@settings(max_examples=400)
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


@settings(max_examples=300)
@given(st.dictionaries(keys, toml_values, max_size=4))
def test_any_value_at_any_key_is_read_or_refused(changes):
    case = read_or_refused(lambda: builtin("published-exact").replace(changes))
    assert case is None or load(case.toml()) == case
