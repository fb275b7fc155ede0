"""The pages say what there is: every command, option, public name and key, and their links lead somewhere."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import click
import pytest

import centrode as ct
from centrode.cli.main import build_app
from centrode.dynamics import motion_results
from centrode.model.schema import cam_schema, mechanism_schema
from centrode.quantities import QUANTITIES
from centrode.topics.presentation import sheet_of
from centrode.topics.registry import TOPICS

ROOT = Path(__file__).parents[2]
MADE = ROOT / "docs" / "reference"
BUILT = ROOT / "docs" / "_build"
PAGES = [
    ROOT / "README.md",
    *(page for page in sorted((ROOT / "docs").rglob("*.md")) if BUILT not in page.parents),
]
TEXTS = {page: page.read_text(encoding="utf-8") for page in PAGES}
EVERYTHING = "\n".join(text for page, text in TEXTS.items() if page.parent != MADE)
"""What is written by hand: pages made from the program tell everything, and so prove nothing."""
LINK = re.compile(r"\]\(([^)\s]+)\)")
TREE = re.compile(r"^```\{toctree\}\n(?::.*\n)*((?:[\w/-]+\n|\n)*)```$", re.MULTILINE)
BLOCK = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
WIDTH = 140
FIRST_PAGES = (
    ROOT / "README.md",
    *(
        ROOT / "docs" / page
        for page in ("tutorial.md", "ru/start.md", "ru/tutorial.md", "uk/start.md", "uk/tutorial.md")
    ),
)
"""What a newcomer reads first, in each language."""
DESCRIPTION, RESULTS = (
    "\n".join(text for page, text in TEXTS.items() if page.stem.partition("-")[0] == name)
    for name in ("description", "results")
)
"""The pages of each, `description.md` and `description-drives.md` and so on."""
REFERENCE = [
    page for page in PAGES if page.parent == MADE or page.stem.partition("-")[0] in ("description", "results")
]
MOST_LINES = {ROOT / "README.md": 90, **{page: 420 for page in REFERENCE}}


def options(command: click.Command, path: str = "centrode") -> list[tuple[str, str]]:
    """(command, option) of a command and its subcommands."""
    found = [(path, name) for parameter in command.params for name in parameter.opts if name[:2] == "--"]
    found.append((path, "--help"))
    for name, child in getattr(command, "commands", {}).items():
        found += options(child, f"{path} {name}")
    return found


def keys(schema: dict[str, Any]) -> list[tuple[str, str]]:
    """(part, key) of the description and each of its parts."""
    parts = {"": schema, **schema["$defs"]}
    return [(part, key) for part, properties in parts.items() for key in properties.get("properties", ())]


def anchor(heading: str) -> str:
    """The anchor that code hosts give a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors(text: str) -> set[str]:
    return {anchor(line.lstrip("#")) for line in BLOCK.sub("", text).splitlines() if line.startswith("#")}


def links() -> list[tuple[Path, str]]:
    """(page, target) of every link inside the project."""
    found = [(page, target) for page, text in TEXTS.items() for target in LINK.findall(BLOCK.sub("", text))]
    found += [
        (page, f"{entry}.md")
        for page, text in TEXTS.items()
        for tree in TREE.findall(text)
        for entry in tree.split()
        if not (page.parent / f"{entry}.ipynb").exists()
    ]
    return [(page, target) for page, target in found if "://" not in target]


# Thousands of words are looked up: a test of a kind of them names all that are missing, and costs no test a word.


def test_commands_and_options_are_told() -> None:
    told = options(build_app())
    assert [command for command in dict(told) if command not in EVERYTHING] == []
    assert [
        option for option in {name for _, name in told} if not re.search(rf"{option}\b", EVERYTHING)
    ] == []


def test_public_names_are_told() -> None:
    assert [name for name in dir(ct) if not re.search(rf"\bct\.{name}\b", EVERYTHING)] == []


def test_keys_are_told() -> None:
    page = BLOCK.sub("", DESCRIPTION)
    asked = keys(mechanism_schema())
    told = {key: re.search(rf"`(?:\[*(?:\w+\.)?)?{key}(?:\.\w+)?\]*`", page) for _, key in asked}
    assert [f"{key} of {part or 'the file'}" for part, key in asked if not told[key]] == []


def test_variables_are_told() -> None:
    assert [name for name in QUANTITIES if f"`{name}`" not in RESULTS] == []


def test_statuses_are_told() -> None:
    rows = [f"| {status.value} | `{status.name}` | {status.word} |" for status in ct.Status]
    assert [row for row in rows if row not in RESULTS] == []


@pytest.mark.parametrize("name", ["slider-between-cranks-locked", "wiper", "parallelogram"])
def test_scalars_are_told(name: str) -> None:
    page = RESULTS
    study = motion_results.study(ct.example(name), samples=2)
    assert [scalar for scalar in sheet_of(study).scalars if f"`{scalar}`" not in page] == []


@pytest.mark.parametrize("name", ct.example_names("cam"))
def test_scalars_of_cams_are_told(name: str) -> None:
    cam = ct.example(name)
    topics = [
        topic
        for topic in TOPICS
        if topic.subject == "cam" and (topic.concerns is None or topic.concerns(cam))
    ]
    scalars = []
    for topic in topics:
        # what only files hold takes longest, and has no scalars
        files = topic.command.complete if topic.command is not None else ""
        result = topic.compute(cam, **({files: False} if files else {}))
        scalars += topic.view(result).scalars
    assert [one for one in scalars if not one.startswith("chosen.") and f"`{one}`" not in EVERYTHING] == []


def test_keys_of_cams_are_told() -> None:
    pages = "\n".join(text for page, text in TEXTS.items() if page.stem.startswith("cam"))
    asked = [(part, key) for part, key in keys(cam_schema()) if part != "Display"]
    assert [one for one in asked if f"`{one[1]}`" not in pages and f"`[{one[1]}]`" not in pages] == []


def test_the_site_has_every_page() -> None:
    listed = {(page.parent / target).resolve() for page, target in links() if page.name == "index.md"}
    assert set(PAGES[1:]) - {ROOT / "docs" / "index.md"} <= listed


def test_every_page_is_linked() -> None:
    reached = {(page.parent / target.partition("#")[0]).resolve() for page, target in links()}
    assert set(PAGES[1:]) <= reached


def test_links_lead_somewhere() -> None:
    places: dict[Path, set[str]] = {}
    lost = []
    for page, target in links():
        name, _sign, place = target.partition("#")
        file = page.parent / name if name else page
        if not file.is_file():
            lost.append((page.name, target))
        elif place:
            if file not in places:
                places[file] = anchors(file.read_text(encoding="utf-8"))
            if place not in places[file]:
                lost.append((page.name, target))
    assert lost == []


def test_pictures_are_pictures() -> None:
    shown = [
        page.parent / name
        for page, text in TEXTS.items()
        for name in re.findall(r"!\[[^\]]+\]\(([^)]+)\)", text)
    ]
    assert len(shown) > len(ct.example_names("linkage"))
    begins = {".png": b"\x89PNG\r\n\x1a\n", ".gif": b"GIF89a"}
    assert [picture for picture in shown if not picture.read_bytes().startswith(begins[picture.suffix])] == []


def test_lines_are_not_too_long() -> None:
    long = [
        (page.name, line)
        for page, text in TEXTS.items()
        for line in BLOCK.sub("", text).splitlines()
        if len(line) > WIDTH and not line.startswith("|")
    ]
    assert long == []


@pytest.mark.parametrize(
    "line", [". .venv/bin/activate", r".venv\Scripts\activate", "pip install -e '.[all]'"]
)
def test_first_pages_put_the_command_on_the_path(line: str) -> None:
    assert [page.name for page in FIRST_PAGES if line not in TEXTS[page]] == []


def test_pages_are_short_enough_to_be_read() -> None:
    long = {page.name: len(TEXTS[page].splitlines()) - most for page, most in MOST_LINES.items()}
    assert {name: more for name, more in long.items() if more > 0} == {}


def test_each_command_is_on_one_page_of_the_reference() -> None:
    app = build_app()
    assert isinstance(app, click.Group)
    headings = [
        line.removeprefix("## centrode ")
        for page in MADE.glob("commands-*.md")
        for line in TEXTS[page].splitlines()
        if line.startswith("## centrode ")
    ]
    assert sorted(headings) == sorted(app.commands)


def test_the_glossary_has_each_term_in_three_languages() -> None:
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in TEXTS[ROOT / "docs" / "glossary.md"].splitlines()
        if line.startswith("| ") and not line.startswith("| English")
    ]
    assert len(rows) > 80
    for english, russian, ukrainian, _place in rows:
        assert re.fullmatch(r"[A-Za-z' ,()-]+", english), english
        assert re.search(r"[а-яёА-Я]", russian) and not re.search(r"[іїєґ]", russian), russian
        assert re.search(r"[а-яіїєґА-Я]", ukrainian) and not re.search(r"[ыэъё]", ukrainian), ukrainian
    terms = [row[0] for row in rows]
    assert len(set(terms)) == len(terms)
