"""The page on the design names the modules that are there, and no others."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "centrode"
BY_THEIR_TOPIC = ("cli", "views", "render", "report")
"""Rooms whose modules are called as their topics, commands or pictures: the page does not repeat all of them."""


def _rooms() -> str:
    page = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
    return page[page.index("## Rooms") : page.index("**Where a new thing goes.**")]


def test_every_module_has_its_place_in_the_design() -> None:
    named = set(re.findall(r"\w+", _rooms()))
    modules = [path.relative_to(SOURCE) for path in SOURCE.rglob("*.py") if not path.name.startswith("__")]
    assert len(modules) > 500
    lacking = [
        str(path) for path in modules if path.parts[0] not in BY_THEIR_TOPIC and path.stem not in named
    ]
    assert not lacking, f"docs/design.md, Rooms: name {', '.join(sorted(lacking))}"


def test_every_module_that_the_design_names_is_there() -> None:
    there = {path.stem for path in SOURCE.rglob("*")} | {"_chapters", "_data"}
    # words with an underscore are names of modules: nothing else in the section has one
    named = set(re.findall(r"\w*_\w*", _rooms()))
    assert len(named) > 200
    assert not named - there
