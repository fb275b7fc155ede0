"""The public face: few names, each with an example that runs; what left it is where the changelog says."""

from __future__ import annotations

import doctest
import importlib
import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import centrode as ct
from blank_canvas import blank_pictures
from centrode.locale import choose_language_of_process

CHANGELOG = (Path(__file__).parents[2] / "CHANGELOG.md").read_text(encoding="utf-8")
LEFT = CHANGELOG.partition("### Names that left the public face")[2].partition("\n### ")[0]
ROWS = re.findall(r"^\| (`.*?) \| (.*) \|$", LEFT, re.MULTILINE)
GONE = sorted({name for row, _place in ROWS for name in re.findall(r"`ct\.(\w+)`", row)})
PLACES = sorted({place for _row, there in ROWS for place in re.findall(r"centrode(?:\.\w+)+", there)})
STILL_PUBLIC = sorted({name for _row, there in ROWS for name in re.findall(r"\bct\.(\w+)", there)})


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A folder of its own; pictures are blank, and the language is English before and after."""
    monkeypatch.chdir(tmp_path)
    choose_language_of_process("en")
    with blank_pictures():
        yield
    choose_language_of_process("en")


def at_place(place: str) -> object:
    """What stands at a dotted place: a module, or a name within one."""
    parts = place.split(".")
    for count in range(len(parts), 0, -1):
        try:
            found: object = importlib.import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        for name in parts[count:]:
            found = getattr(found, name)
        return found
    raise AssertionError(place)


def run_examples(name: str, documented: object) -> int:
    """Run the examples of a docstring, which have to print what they say; how many there are."""
    test = doctest.DocTestParser().get_doctest(inspect.getdoc(documented) or "", {}, name, None, 0)
    said: list[str] = []
    failed, _tried = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(
        test, out=said.append
    )
    assert not failed, "".join(said)
    return len(test.examples)


def test_it_reads_like_a_table_of_contents() -> None:
    assert 60 <= len(dir(ct)) <= 96


@pytest.mark.parametrize("name", sorted(dir(ct)))
def test_every_name_has_an_example_that_runs(name: str, folder: None) -> None:
    assert run_examples(name, getattr(ct, name)) > 0


def test_no_name_that_left_is_public() -> None:
    assert not set(GONE) & set(dir(ct))
    assert set(STILL_PUBLIC) <= set(dir(ct))


def test_every_name_that_left_has_a_place() -> None:
    assert len(GONE) > 200
    assert [row for row, there in ROWS if not re.search(r"`(?:ct|centrode)[. ]", there)] == []


@pytest.mark.parametrize("place", PLACES)
def test_what_left_is_where_the_changelog_says(place: str, folder: None) -> None:
    found = at_place(place)
    assert inspect.ismodule(found) or found.__doc__ or not callable(found)
    if callable(found):
        run_examples(place, found)
