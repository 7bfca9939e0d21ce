"""Every table and every key of a case has a name in words."""

from asperity.config import Case
from asperity.config.key_labels import LABELS, label
from asperity.config.problems import tables_of


def keys() -> set[str]:
    """Every table of a case and every key, as one writes them."""
    found = set()
    for name, field in Case.model_fields.items():
        found.add(field.alias or name)
        for table in tables_of(field.annotation):
            found |= {f"{name}.{key}" for key in table.model_fields}
    return found


def test_a_name_is_given_to_keys_of_a_case_alone_and_only_where_they_do_not_say_it():
    assert set(LABELS) <= keys()
    for key, name in LABELS.items():
        assert name != key.rpartition(".")[2].replace("_", " "), key


def test_names_are_words_that_no_two_keys_share():
    names = [label(key) for key in sorted(keys())]
    for name in names:
        assert "_" not in name
        assert name == name.strip()
        assert len(name) <= 45, name
    assert len(set(names)) == len(names)


def test_a_key_of_a_material_of_ones_own_is_named_with_the_material():
    assert label("capillary.humidity") == "relative humidity"
    assert label("materials.my glass.density") == "density of my glass"
    assert label("materials.no. 5 glass.youngs_modulus") == "Young's modulus of no. 5 glass"
    assert label("wear.worn_depth") == "worn depth"
