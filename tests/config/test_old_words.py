"""A key or a column that was renamed is refused, and the error names what it is called now."""

import pytest

import asperity
from asperity.config.old_words import RENAMED
from asperity.sweeps.study.columns import MEASURES, columns


@pytest.mark.parametrize(
    "key",
    [
        "adhesion.range", "gas.closest_gap", "capillary.film_thickness", "impact.release_gap",
        "numerics.rest", "publication.pull_while_parting_only", "roughness.short",
        "roughness.long", "roughness.remove", "roughness.align",
    ],
)  # fmt: skip
def test_an_old_key_names_the_new_one(key):
    table, _, old = key.partition(".")
    with pytest.raises(asperity.InputError, match=f"it is called '{RENAMED[old]}' now") as raised:
        asperity.load("published").replace({key: "1 nm"})
    assert raised.value.key == key
    assert RENAMED[old] in str(raised.value)
    assert table in str(raised.value)


@pytest.mark.parametrize("name", ["impact_time", "stiction_time", "end_time", "deepest"])
def test_an_old_column_names_the_new_one(name):
    with pytest.raises(asperity.InputError, match=f"it is called '{RENAMED[name]}' now"):
        columns([name], motions=False)
    assert RENAMED[name] in {column.name for column in MEASURES}
