"""Bad studies: whatever a study file holds, it is read or refused in one line that says why."""

import os

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asperity.config.case_file import LINE_LIMIT, SIZE_LIMIT
from asperity.errors import InputError
from asperity.sweeps.study.axis_text import LIST_LIMIT
from asperity.sweeps.study.study import parse, read
from study_texts import GRID, HUMIDITY, RMS

HEAD = 'base = "published"\n'
RANGE = f'"{RMS}" = {{from = "8 nm", to = "9 nm"}}'
TOO_MANY = "0.1,\n" * (LIST_LIMIT + 1)
SAMPLE = '\n[sample]\nmethod = "sobol"\nsize = 8\nseed = 1\n'


def refusal(text, file="map.toml"):
    """The message of the error that a text gives: always one line that begins with the file."""
    with pytest.raises(InputError) as caught:
        parse(text, file=file)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    assert message.startswith(f"{file}: ")
    assert caught.value.file == file
    return message.removeprefix(f"{file}: ")


def ranged(key, low, high, steps, more=""):
    return f'"{key}" = {{from = {low}, to = {high}, steps = {steps}{more}}}'


def listed(key, values):
    return f'"{key}" = {{values = {values}}}'


MODEL, RINGS, IMPACTS = "adhesion.model", "numerics.rings", "numerics.max_impacts"
ALWAYS = "publication.attraction_during_retraction_only"
AXES = [
    (listed("roughness.rms_heigth", '["8 nm"]'), '"roughness.rms_heigth" (line 3): must go over a '
     "key of a case, such as 'body.radius'; got 'roughness.rms_heigth' - did you mean "),
    ("humidity = {values = [0.3]}", "did you mean 'capillary.humidity'?"),
    (listed("roughness", "[0.3]"), "must go over a key; `roughness` is a table of a case"),
    (listed("output.directory", '["a"]'), "must not go over `output.directory`: it is what a run"),
    ("schema = {values = [1]}", "must not go over `schema`: it is the version"),
    (listed("roughness.files", '[["a.csv"]]'), "whose value is a list"),
    (listed("materials.glass.density", '["2 g/cm^3"]'), "which has no [materials.glass]"),
    (f'"{RMS}" = 3', "(line 3): must be a table, {values = [..]} or {from = .., to = .., steps ="),
    (f'"{RMS}" = {{}}', "`from` must be given, or `values` in place of `from` and `to`"),
    (f'"{RMS}" = {{from = "8 nm", steps = 3}}', "`to` must be given, or `values`"),
    (f'"{RMS}" = {{values = ["8 nm"], stpes = 3}}', "`stpes` is not a key of an axis; got 3 - did"),
    (f'"{RMS}" = {{values = ["8 nm"], from = "8 nm"}}', "`from` and `values` exclude each other"),
    (f'"{RMS}" = {{values = ["8 nm"], scale = "log"}}', "`scale` and `values` exclude each other"),
    (f'"{RMS}" = {{values = ["8 nm"], steps = 3}}', "`steps` and `values` exclude each other"),
    (listed(RMS, "[]"), f"`values` must be a list of 1 to {LIST_LIMIT} values; got []"),
    (listed(RMS, '"8 nm"'), "must be a list of 1 to 10000 values; got '8 nm'"),
    (listed(HUMIDITY, f"[{TOO_MANY}]"), "got 10001 of them"),
    (listed(RMS, '["8 nm", "8 nm"]'), "`values` must differ; got '8 nm' twice"),
    (listed(RMS, '["8 nm", "0.008 um"]'), "must differ; got '8 nm' and '0.008 um'"),
    (listed(HUMIDITY, "[0, 0.0]"), "`values` must differ; got 0 and 0.0"),
    (RANGE, "`steps`, the number of values, must be given"),
    (ranged(RMS, '"8 nm"', '"9 nm"', 1), "`steps` must lie in [2, 1000000000]; got 1"),
    (ranged(RMS, '"8 nm"', '"9 nm"', 2.5), "`steps` must be a whole number"),
    (ranged(RMS, '"8 nm"', '"9 nm"', "true"), "`steps` must be a whole number"),
    (ranged(RMS, '"8 nm"', '"0.008 um"', 3), "`to` must be larger than `from` ('8 nm'); got '0.00"),
    (ranged(RMS, '"8 nm"', '"7 nm"', 3), "`to` must be larger than `from`"),
    (ranged(HUMIDITY, 0, 1, 3, ', scale = "log"'), "`from` must be positive with scale = 'log'; g"),
    (ranged(HUMIDITY, 0, 1, 3, ', scale = "loga"'), "`scale` must be one of 'linear' or 'log'; go"),
    (listed(RMS, '["8 parsecs"]'), "`rms_height` must lie in [1e-15, 1] m"),
    (listed(RMS, "[8]"), "`rms_height` must be text with a number and a unit"),
    (ranged(RMS, '"8 kg"', '"9 nm"', 3), "`from`: `rms_height` must be a length, such as '50 um';"),
    (ranged(RMS, '"8 nm"', '"9 m"', 3), "`to`: `rms_height` must lie in"),
    (listed(HUMIDITY, "[nan]"), "`humidity` must be finite; got nan"),
    (listed(HUMIDITY, "[1.2]"), "`humidity` must lie in [0, 1]; got 1.2"),
    (ranged(MODEL, '"dmt"', '"jkr"', 3), "`values` must be given for `model`, which is no number"),
    (listed(MODEL, '["dmt", "jrk"]'), "got 'jrk' - did you mean 'jkr'?"),
    (listed(MODEL, "[3]"), "`model` must be one of 'none', 'auto'"),
    (listed(ALWAYS, '["true"]'), "must be true or false"),
    (listed("roughness.channel", "[1.5]"), "`channel` must be text or a whole number; got 1.5"),
    (listed(RINGS, "[16.5]"), "`rings` must be a whole number in [16, 400]"),
    (ranged(RINGS, 16, 20, 6), "to be a whole number of its own (from 16 to 20, linear); got 6"),
    (ranged(IMPACTS, 1, 1000, 100, ', scale = "log"'), "got 100"),
    (f'{RMS} = {{values = ["8 nm"]}}\n"{RMS}" = {{values = ["8 nm"]}}', "must be given once"),
    (ranged(RMS, '"8 nm"', '"9 nm"', 10**9) + "\n" + ranged(HUMIDITY, 0, 1, 10**9),
     "at most 2^53 cases; got at least 10^18"),
]  # fmt: skip


@pytest.mark.parametrize(("line", "rule"), AXES, ids=range(len(AXES)))
def test_bad_axis_is_named_with_its_rule_and_value(line, rule):
    message = refusal(f"{HEAD}[axes]\n{line}")
    assert rule in message
    assert message.startswith(('axes."', "[axes]"))


AXIS = f"[axes]\n{RANGE}{SAMPLE}"
WHOLE = [
    ("", "a study must have tables; got an empty file"),
    ("a = 1\0", "a study must be text; got a binary file"),
    ("base = \n", "not TOML (line 1"),
    (f"{HEAD}[axes]\na = {'9' * (LINE_LIMIT - 10)}", 'axes."a"'),
    (f"a = {'9' * LINE_LIMIT}", f"a line must be at most {LINE_LIMIT} characters"),
    ("a = " + "[\n" * 5000, "not TOML: values nested too deeply"),
    ("#\n" * SIZE_LIMIT, "a study must be at most 1 MiB"),
    (AXIS, "`base`, a built-in case or a case file, must be given"),
    (HEAD, "the table [axes] is missing"),
    (f"{HEAD}[axes]", "[axes] must have at least one axis; got none"),
    (f"{HEAD}axes = 3", "`axes` must be a table"),
    (f"kep = 1\n{HEAD}{AXIS}", "`kep` is not a key or table of a study; got 1 - did you mean 'kee"),
    (f"{HEAD}[axes]\n{RANGE}\n[smaple]\nsize = 3", "did you mean 'sample'?"),
    (f"schema = 2\n{HEAD}{AXIS}", "`schema` must be 1, the only version of a study that this prog"),
    (f"schema = 1.0\n{HEAD}{AXIS}", "`schema` must be 1"),
    (f'base = "publishd"\n{AXIS}', "`base` must be a built-in case (glass-bead, published, "
     "published-exact) or a case file beside the study, such as 'drop.toml'; got 'publishd' - did"),
    (f"base = 3\n{AXIS}", "`base` must be a built-in case or a case file"),
    (f'base = ""\n{AXIS}', "`base` must be a built-in case or a case file"),
    (f'base = "no-such.toml"\n{AXIS}', "base: no-such.toml: cannot be read"),
    (f'[base.body]\nradius = "5 u"\n{AXIS}', "base.body.radius: `radius` must be"),
    (f"[base.bod]\n{AXIS}", "base.bod: `bod` is not a key or table of a case - did you mean 'body"),
    (f'keep = ["restition"]\n{HEAD}{AXIS}', "got 'restition' - did you mean 'restitution'?"),
    (f'keep = ["captured", "captured"]\n{HEAD}{AXIS}', "got 'captured' twice"),
    (f'keep = "captured"\n{HEAD}{AXIS}', "`keep` must be a list"),
    (f"keep = [[1]]\n{HEAD}{AXIS}", "`keep` must be a list of measures' names"),
    (f"keep_impacts = 0\n{HEAD}{AXIS}", "`keep_impacts` must lie in [1, 100000]"),
    (f"motions = 1\n{HEAD}{AXIS}", "`motions` must be true or false; got 1"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "rule"), WHOLE, ids=range(len(WHOLE)))
def test_bad_study_is_refused_with_its_rule(text, rule):
    assert rule in refusal(text)


@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ("size = 8", "size = 0", "sample.size (line 6): `size` must lie in [1, 1073741824]; got 0"),
        ("size = 8", "size = -4", "`size` must lie in"),
        ("size = 8", "size = 4.5", "`size` must be a whole number in [1, 1073741824]; got 4.5"),
        ("size = 8", "size = 2_000_000_000", "`size` must lie in [1, 1073741824]"),
        ("size = 8", "", "`size` is missing"),
        ("seed = 1", "seed = -1", "`seed` must lie in [0, 4294967295]; got -1"),
        ("seed = 1", "seed = 1.5", "`seed` must be a whole number"),
        ('"sobol"', '"soboll"', "must be one of 'sobol' or 'latin'; got 'soboll' - did you mean"),
        ('"sobol"', '"random"', "`method` must be one of 'sobol' or 'latin'; got 'random'"),
        ('"sobol"', '"latin"\nsizes = 3', "`sizes` is not a key of [sample]"),
        ('"sobol"\nsize = 8', '"latin"\nsize = 200_000_000', "all drawn at once; take 'sobol'"),
        ('"9 nm"', '"9 nm", steps = 3', "`steps` must be absent with a [sample] table"),
    ],
)
def test_bad_sample_is_refused_with_its_rule(old, new, rule):
    text = HEAD + AXIS
    assert parse(text).size == 8
    assert old in text
    assert rule in refusal(text.replace(old, new))


def test_file_that_is_no_study_is_refused(tmp_path):
    def said(path):
        with pytest.raises(InputError) as caught:
            read(str(path))
        assert str(caught.value).startswith(f"{path}: ")
        return str(caught.value)

    binary, large = tmp_path / "binary.toml", tmp_path / "large.toml"
    binary.write_bytes(b"a\xff\x00")
    large.write_bytes(b"#" * (SIZE_LIMIT + 1))
    assert "cannot be read: No such file or directory" in said(tmp_path / "none.toml")
    assert "got a folder" in said(tmp_path)
    assert "got a binary file (byte 2)" in said(binary)
    assert "a study must be at most 1 MiB" in said(large)
    if os.path.exists("/dev/zero"):  # noqa: PTH110
        assert "got a device, pipe or socket" in said("/dev/zero")


def test_mistake_in_the_base_file_names_both_files(tmp_path):
    (tmp_path / "drop.toml").write_text('[body]\nradius = "50 kg"\n')
    (tmp_path / "map.toml").write_text(f'base = "drop.toml"\n{AXIS}')
    with pytest.raises(InputError) as caught:
        read(str(tmp_path / "map.toml"))
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'map.toml'}: base: {tmp_path / 'drop.toml'}: ")
    assert "body.radius (line 2): `radius` must be a length" in message


def test_study_that_no_store_could_hold_is_refused():
    """A text that fits its file is longer with its base and a line for each value."""
    values = [f'"{number:0100d}",' for number in range(9990)]
    rows = "\n".join("".join(values[i : i + 9]) for i in range(0, len(values), 9))
    text = f'{HEAD}[axes]\n"body.material" = {{values = [\n{rows}\n]}}'
    assert len(text) < SIZE_LIMIT
    assert "a study must be at most 1 MiB" in refusal(text)


@given(st.data())
@settings(max_examples=150)
def test_any_change_of_a_study_is_read_or_refused_in_one_line(data):
    text = f'{HEAD}keep = ["captured"]\n[axes]\n{GRID}'
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text)))
        end = data.draw(st.integers(at, min(len(text), at + 8)))
        new = data.draw(st.text(st.sampled_from("01.e-\"[]{}=, nm\nlog'#_"), max_size=5))
        text = text[:at] + new + text[end:]
    try:
        found = parse(text, file="map.toml")
    except InputError as error:
        message = str(error)
    else:
        message = "map.toml: read"
        assert parse(found.canonical) == found
    assert message.startswith("map.toml: ")
    assert len(message.splitlines()) == 1
