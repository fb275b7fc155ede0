"""Changes of texts touch nothing else: what was there before is there to the byte."""

from __future__ import annotations

import difflib
import tomllib

import pytest

from centrode.app.text_changes import TextChanges, spelled_key, spelled_value
from centrode.app.text_places import TextPlaces
from centrode.errors import InputError
from centrode.model.examples import example_names, example_text

NAMES = (*example_names(), *example_names("cam"))


def leaves(value, place=()):
    """Every key with a value that is no table."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves(inner, (*place, key))
    elif isinstance(value, list):
        for k, inner in enumerate(value):
            yield from leaves(inner, (*place, k))
    else:
        yield place, value


@pytest.mark.parametrize("name", NAMES)
def test_a_value_that_is_set_and_set_back_leaves_every_byte(name):
    text = example_text(name)
    for place, value in [*leaves(tomllib.loads(text))][::3]:
        changes = TextChanges(text)
        changes.set(place, "another value")
        assert changes.text != text
        # the line of the value alone differs
        old, new = text.split("\n"), changes.text.split("\n")
        assert len(old) == len(new)
        assert sum(one != other for one, other in zip(old, new, strict=True)) == 1
        changes.set(place, value)
        # numbers may be spelled otherwise: 1.0 and 1
        assert tomllib.loads(changes.text) == tomllib.loads(text)


@pytest.mark.parametrize("name", NAMES)
def test_a_section_that_is_added_and_removed_leaves_every_byte(name):
    text = example_text(name)
    changes = TextChanges(text)
    changes.add_table(("links", "added one"), {"points": ["A", "B"], "length": 0.25})
    lines = [
        line[2:] for line in difflib.ndiff(text.splitlines(), changes.text.splitlines()) if line[0] != " "
    ]
    assert [line for line in lines if line.strip()] == [
        '[links."added one"]', 'points = ["A", "B"]', "length = 0.25",
    ]  # fmt: skip
    changes.remove(("links", "added one"))
    assert changes.text == text


@pytest.mark.parametrize("name", NAMES)
def test_an_entry_of_a_list_that_is_added_and_removed_leaves_every_byte(name):
    text = example_text(name)
    changes = TextChanges(text)
    changes.add_entry("loads", {"kind": "force", "point": "Q", "vector": [0, -1]})
    count = len(changes.tables["loads"])
    changes.remove(("loads", count - 1))
    assert changes.text == text


def test_texts_of_windows_keep_their_ends_of_lines():
    text = example_text("crank-rocker").replace("\n", "\r\n")
    changes = TextChanges(text)
    changes.set(("links", "OA", "mass"), 2.5)
    changes.add_table(("links", "XY"), {"length": 1})
    assert "\n" not in changes.text.replace("\r\n", "")
    assert changes.tables["links"]["OA"] == {"length": 1.0, "mass": 2.5}


def test_dotted_keys_and_tables_in_one_line_are_changed_where_they_stand():
    text = (
        'links.OA.length = 1 # crank\nlinks.AB = { length = 3, "mass" = 2 } # coupler\n'
        "\n[frame.points]\nO = [0, 0]\n"
    )
    changes = TextChanges(text)
    changes.set(("links", "OA", "length"), 2)
    changes.set(("links", "AB", "mass"), 4)
    changes.set(("links", "OA", "mass"), 1)
    assert changes.text == (
        'links.OA.length = 2 # crank\nlinks.OA.mass = 1\nlinks.AB = { length = 3, "mass" = 4 } # coupler\n'
        "\n[frame.points]\nO = [0, 0]\n"
    )


def test_what_cannot_be_changed_is_refused_and_nothing_is_lost():
    text = 'title = "a"\nlinks = { OA = { length = 1 } }\n'
    changes = TextChanges(text)
    with pytest.raises((InputError, KeyError)):
        changes.remove(("links", "XY"))
    assert changes.text == text


@pytest.mark.parametrize(
    "value", [1, -2.5, 1e300, True, 'a "quoted" text', [0, [1, 2]], {"a b": 1, "c": "ü"}]
)
def test_values_are_spelled_as_toml(value):
    assert tomllib.loads(f"{spelled_key('some key')} = {spelled_value(value)}") == {"some key": value}


def test_places_have_lines_and_columns():
    text = 'title = "x"\n# a comment\n[[guides]]\npoint = "A"\n[[guides]]\npoint = "B"\nthrough = [0,\n  1]\n'
    places = TextPlaces(text)
    assert places.position(("guides", 1, "point")) == (6, 9)
    assert places.position(("guides", 1, "through")) == (7, 11)
    assert places.position(("guides", 0, "missing")) == (3, 1)
    assert places.position(("title",)) == (1, 9)
