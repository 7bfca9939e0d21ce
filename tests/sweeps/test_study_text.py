"""The keys that a study can vary, and the text that stands for a study."""

import hashlib
import json
import re
import tomllib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asperity.config import Case, builtin, load
from asperity.config.case_text import unit_of
from asperity.config.problems import tables_of
from asperity.sweeps.study import keys
from asperity.sweeps.study.study import parse, read
from study_texts import HUMIDITY, RMS, study


def fields():
    """Keys of a case with their fields, from the schema, but lists and what a run writes."""
    return {
        f"{table}.{key}": inner
        for table, field in Case.model_fields.items()
        for model in tables_of(field.annotation)
        for key, inner in model.model_fields.items()
        if table not in ("output", "materials") and key != "files"
    }


def test_every_key_of_a_case_is_an_axis_but_lists_and_what_a_run_writes():
    assert set(keys.known()) == set(fields())
    assert [keys.find(name).key for name in keys.known()] == keys.known()


def test_example_of_every_key_is_read_and_written_back_exactly():
    """A value in SI is written so that it reads back as the same float."""
    for name, field in fields().items():
        key = keys.find(name)
        assert key.unit == unit_of(field)
        value = key.read(field.examples[0])
        assert key.read(key.written(value)) == value
        if key.unit not in ("", "1"):
            for scaled in (value * (1 + 1e-15), value * 1.1, value / 3.0):
                assert key.read(key.written(scaled)) == scaled


def test_labels_say_which_key_in_words():
    labels = [keys.find(name).label for name in keys.known()]
    assert len(set(labels)) == len(labels)
    assert keys.find(RMS).label == "rms height"
    assert keys.find(HUMIDITY).label == "relative humidity"
    assert keys.find("body.density").label == "density of the body"


RANGES = {
    RMS: ('"1e-10 m"', '"1e-7 m"'),
    "body.radius": ('"1e-6 m"', '"1e-4 m"'),
    HUMIDITY: (0.05, 0.95),
    "adhesion.work": ('"1 mJ/m^2"', '"90 mJ/m^2"'),
    "capillary.contact_angle": ('"1 deg"', '"80 deg"'),
    "capillary.temperature": ('"1 degC"', '"60 degC"'),
}


@st.composite
def studies(draw):
    """Texts of studies of any kind."""
    chosen = draw(st.lists(st.sampled_from(sorted(RANGES)), min_size=1, max_size=4, unique=True))
    sampled = draw(st.booleans())
    lines = []
    for key in chosen:
        low, high = RANGES[key]
        if draw(st.booleans()):
            lines.append(f'"{key}" = {{values = [{high}, {low}]}}')
            continue
        steps = "" if sampled else f", steps = {draw(st.integers(2, 5000))}"
        scale = draw(st.sampled_from(["", ', scale = "log"', ', scale = "linear"']))
        lines.append(f'"{key}" = {{from = {low}, to = {high}{steps}{scale}}}')
    if draw(st.booleans()):
        lines.append('"adhesion.model" = {values = ["none", "dmt"]}')
    head = [f'base = "{draw(st.sampled_from(["published", "published-exact"]))}"']
    if draw(st.booleans()):
        head += ['keep = ["restitution", "captured"]', f"keep_impacts = {draw(st.integers(1, 9))}"]
    if draw(st.booleans()):
        head.append("motions = true")
    tail = []
    if sampled:
        method = draw(st.sampled_from(["sobol", "latin"]))
        size, seed = draw(st.integers(1, 1000)), draw(st.integers(0, 2**32 - 1))
        tail = ["[sample]", f'method = "{method}"', f"size = {size}", f"seed = {seed}"]
    return parse("\n".join([*head, "[axes]", *lines, *tail]))


@given(studies())
@settings(max_examples=60)
def test_canonical_text_reads_back_as_the_study(found):
    again = parse(found.canonical)
    assert again == found
    assert again.canonical == found.canonical
    stop = min(found.size, 50)
    one, other = found.values(0, stop), again.values(0, stop)
    assert {k: v.tolist() for k, v in one.items()} == {k: v.tolist() for k, v in other.items()}
    assert found.fingerprint == hashlib.sha256(found.canonical.encode()).hexdigest()


def based_on(folder, base):
    """The study of a file beside its base."""
    (folder / "drop.toml").write_text(base)
    text = 'base = "drop.toml"\n[axes]\n"impact.speed" = {values=["1 m/s"]}'
    (folder / "map.toml").write_text(text)
    return read(str(folder / "map.toml"))


def test_canonical_text_needs_no_other_file(tmp_path):
    found = based_on(tmp_path, builtin("published-exact").toml())
    (tmp_path / "drop.toml").unlink()
    assert parse(found.canonical) == found
    tables = tomllib.loads(found.canonical)
    assert tables["schema"] == 1
    assert tables["base"]["body"]["radius"] == "5e-05 m"
    assert found.base == builtin("published-exact")
    assert found.base_name == "drop"


def test_surface_files_of_the_base_are_found_from_any_folder(tmp_path, monkeypatch):
    rough = {"roughness": {"files": ["surface.csv"], "size": "1 um x 1 um", "unit": "nm"}}
    found = based_on(tmp_path, builtin("published-exact").replace(rough).toml())
    monkeypatch.chdir("/")
    wanted = [str(tmp_path / "surface.csv")]
    assert parse(found.canonical).base.roughness.files == wanted
    assert found.case(0).roughness.files == wanted


def test_where_a_run_writes_is_nothing_of_a_study(tmp_path):
    base = builtin("published").toml()
    elsewhere = base.replace("pictures = true", 'pictures = false\ndirectory = "x"')
    assert elsewhere != base
    one, other = (based_on(tmp_path, text) for text in (base, elsewhere))
    assert one.fingerprint == other.fingerprint


def test_keys_without_quotes_are_the_same_axes():
    quoted = study(f'"{RMS}" = {{values = ["8 nm"]}}\n"{HUMIDITY}" = {{values = [0.3]}}')
    assert study(f"{RMS} = {{values = ['8 nm']}}\n{HUMIDITY} = {{values = [0.3]}}") == quoted
    tables = "[axes.roughness]\nrms_height.values = ['8 nm']\n[axes.capillary.humidity]\n"
    assert parse(f"base = 'published'\n{tables}values = [0.3]") == quoted


def test_text_of_any_alphabet_is_kept(tmp_path):
    """Unicode has more line breaks than TOML, and control characters that only TOML escapes."""
    odd = 'gl\u00e4s \u2028 \u0085 " \\\\ \x7f [x]'
    material = {"youngs_modulus": "70 GPa", "poisson": 0.2, "density": "2500 kg/m^3"}
    base = builtin("published-exact").replace({"body.material": odd, "materials": {odd: material}})
    (tmp_path / "drop.toml").write_text(base.toml(), encoding="utf-8")
    text = study('"body.material" = {values = ["silica"]}').canonical
    text = text.replace('"silica",', f"{json.dumps(odd)},".replace("\x7f", "\\u007f"))
    named = parse('base = "drop.toml"\n' + text[: text.index("[base]")], folder=tmp_path)
    assert named.axes[0].listed == (odd,)
    assert parse(named.canonical) == named
    assert named.case(0) == base


# --- examples -----------------------------------------------------------------------------------

EXAMPLES = sorted((Path(__file__).parents[2] / "examples" / "studies").glob("*.toml"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_of_a_study_can_be_computed_and_says_first_what_to_expect(path):
    found = read(str(path))
    assert found.warnings == []
    assert parse(found.canonical) == found
    assert path.read_text(encoding="utf-8").startswith("# Expect")
    for number in (0, found.size // 2, found.size - 1):
        assert load(found.case(number).toml()) == found.case(number)


def test_example_studies_hold_as_many_cases_as_they_say():
    sizes = {path.stem: read(str(path)).size for path in EXAMPLES}
    assert sizes == {
        "humidity-and-roughness": 10_000,
        "safe-humidity": 54,
        "what-matters": 1024,
    }


def test_examples_of_the_page_on_studies_are_read_as_it_says():
    page = Path(__file__).parents[2] / "docs" / "studies.md"
    texts = re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert texts
    for text in texts:
        head = "" if "base =" in text else 'base = "published-exact"\n'
        axes = "" if "[axes]" in text else f'[axes]\n"{RMS}" = {{from = "8 nm", to = "9 nm"}}\n'
        assert parse(head + axes + text, folder=page.parents[1] / "examples").size > 0
