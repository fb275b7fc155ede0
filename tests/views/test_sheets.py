"""Sheets hold numbers as numbers and names as names, whatever a user has called things; renderers show them so."""

from __future__ import annotations

import ast
import csv
import dataclasses
import functools
import inspect
import math
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.analysis.instant_centres.results import centre_results
from centrode.dynamics.reduction_results import reduction_results
from centrode.dynamics.steady_motion.machine import machine_results
from centrode.locale import _, choose_language
from centrode.model.examples import example_text
from centrode.model.settings import Display
from centrode.quantities import UNIT_SYMBOLS
from centrode.render.document import blocks
from centrode.render.document.chapters import document_chapter
from centrode.render.document.numbers import Numbers
from centrode.render.document.spelling import DocumentSpelling
from centrode.render.document.typst import quote
from centrode.render.files import write_table
from centrode.render.plain_table import listing
from centrode.render.spelling import FigureSpelling, PlainSpelling
from centrode.render.table_files import TableSpelling
from centrode.render.terminal import sheet_text, table_text
from centrode.sheets.players import CamPlayer, MotionPlayer, WheelPlayer
from centrode.sheets.plots import Abscissa, AxisLabel
from centrode.sheets.sheet import Column, Illustration, Sheet, Table
from centrode.sheets.texts import Counted, Name, Number, Part, Place, Sentence, Title, Unit
from centrode.topics.kinematics import CENTRES, DIAGRAMS
from centrode.topics.order import in_order
from centrode.topics.registry import TOPICS
from centrode.topics.topic import Command, Lazily, Topic, ValueOption
from report.texts import texts_of
from samples import few

SOURCE = Path(ct.__file__).parent
HOSTILE = ("No 1.23456", "run 30 deg", "2.50 kg", "$x_1$", "<b>", "#a")
SAYING_MOST = (
    "six-bar-press", "five-bar-two-drives", "spherical-crank-guide", "cam-from-curvature", "indexing-cam",
    "valve-cam", "walking-wheel-four-legs",
)  # fmt: skip
"""The other cams and presses say nothing that these do not."""
MATHEMATICS = re.compile(r"[${}_\\]")
"""What marks mathematics in a text of a figure."""
UNITS = {"rad", "deg", "mm", "kg", "J", "N", "Nm", "Pa", "MPa", "m/s", "rad/s", "kg m²", "Hz", "kW", "%", "°"}


def leaves(value: Any) -> Iterator[Any]:
    """Everything that a sheet is made of."""
    yield value
    if isinstance(value, Mapping):
        for part in value.values():
            yield from leaves(part)
    elif isinstance(value, tuple | list):
        for part in value:
            yield from leaves(part)
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            yield from leaves(getattr(value, field.name))


def lazy_functions(value: object) -> Iterator[Lazily]:
    """All functions that a topic names."""
    if isinstance(value, Lazily):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from lazy_functions(part)
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            yield from lazy_functions(getattr(value, field.name))


def required_options(topic: Topic) -> list[ValueOption]:
    """Options without which a command does not begin."""
    options = () if topic.command is None else topic.command.options
    return [option for option in options if isinstance(option, ValueOption) and option.required]


def sheets(names: tuple[str, ...]) -> Iterator[tuple[str, Sheet]]:
    """The sheets of all topics on the examples that have what they are about."""
    for name in names:
        description = ct.example(name)
        subject = "mechanism" if isinstance(description, ct.Mechanism) else "cam"
        for topic in TOPICS:
            # what is on request alone may refuse loads that others take; an improvement needs what to improve
            if topic.document.on_request or topic.name == "improve":
                continue
            if topic.subject == subject and (topic.concerns is None or topic.concerns(description)):
                yield f"{topic.name} of {name}", topic.view(result(topic.name, name))


@functools.cache
def result(topic_name: str, name: str) -> Any:
    """What a topic computes of an example, with few samples; the same in every language."""
    (topic,) = [topic for topic in TOPICS if topic.name == topic_name]
    description = ct.example(name)
    command = Command("") if topic.command is None else topic.command
    takes_samples = "samples" in inspect.signature(topic.compute.load()).parameters
    given: dict[str, Any] = {"samples": 9} if takes_samples else {}
    if command.complete:
        given[command.complete] = False  # what only files hold may take long
    # what has to be named is a link; instants have a default of their own
    given |= {
        option.name: description.link_names[1] for option in required_options(topic) if option.read is None
    }
    computed = topic.compute(description, **given)
    if topic.document.add_instants is None or not topic.document.wished:
        return computed
    # chapters at instants belong to documents
    return topic.document.add_instants(computed, description.study.instants, description.moving_points)


def test_no_sentence_holds_a_number_or_a_unit() -> None:
    """Every sentence of the views, in each language: only holes and words; mathematics stands between dollar signs."""
    seen: dict[
        str, str
    ] = {}  # a sheet is the same in every language: its sentences are translated by who shows it
    for where, sheet in sheets(
        few(SAYING_MOST, (*SAYING_MOST, "six-bar-press-printed", *ct.example_names("cam")))
    ):
        for leaf in leaves(dataclasses.replace(sheet, datasets={})):
            messages = [leaf.message] if isinstance(leaf, Sentence) else []
            if isinstance(leaf, Counted):
                messages = [leaf.singular, leaf.plural]
            seen |= {message: where for message in messages}
    for language in ("en", "ru", "uk"):
        choose_language(language)
        for message, where in seen.items():
            words = "".join(_(message).split("$")[::2])
            assert not re.search(r"\d", words), (where, message)
            assert not UNITS & set(re.split(r"[\s,;()]+", words)), (where, message)
    choose_language("en")
    assert len(seen) > 100


LATIN_UNIT = "|".join(
    unit for unit, (_english, russian, _ukrainian) in UNIT_SYMBOLS.items() if unit != russian
)
UNIT_BEHIND = re.compile(
    rf"""(?:[\d°][ \u202f]|,[ ]|[\[(·/]|thin[ ]")(?:{LATIN_UNIT}|deg)[²³⁴]?(?=[\s·/,;.)"\]]|$)"""
)
"""A unit in Latin letters behind a number, in the head of a column or in brackets, in text or in mathematics."""
PICTURED = (Illustration, MotionPlayer, CamPlayer, WheelPlayer)


def texts_for_readers(sheet: Sheet, display: Display) -> Iterator[str]:
    """What terminals, documents and the axes of figures show of a sheet; formulas by their numbers with units alone."""
    yield from sheet_text(sheet, display).splitlines()
    for name, chapter in sheet.chapters.items():
        sections = tuple(
            dataclasses.replace(
                section, blocks=tuple(one for one in section.blocks if not isinstance(one, PICTURED))
            )
            for section in chapter.sections
        )
        words = dataclasses.replace(sheet, chapters={name: dataclasses.replace(chapter, sections=sections)})
        for section in document_chapter(name, words, Numbers(display)).sections:
            for block in section.blocks:
                of_formula = isinstance(block, blocks.FormulaBlock | blocks.SystemBlock)
                for text in texts_of(block):
                    yield from re.findall(r'thin "[^"]*"', text) if of_formula else text.split("$")[::2]
    for leaf in leaves(sheet.pictures):
        if isinstance(leaf, AxisLabel):
            yield FigureSpelling(display).label(leaf)[1]


def test_no_unit_is_spelled_in_latin_letters() -> None:
    """Every sheet of every topic, in the units of a drawing and in SI; in English units stand in those places."""
    found = 0
    for where, sheet in sheets(few(SAYING_MOST, (*SAYING_MOST, *ct.example_names("cam")))):
        for display in (Display(length="mm", angle="deg"), Display()):
            for language in ("ru", "uk"):
                choose_language(language)
                for text in texts_for_readers(sheet, display):
                    assert not UNIT_BEHIND.search(text), (where, text)
            choose_language("en")
        found += sum(bool(UNIT_BEHIND.search(text)) for text in texts_for_readers(sheet, display))
    assert found > 1000


def test_tables_of_data_are_the_same_in_every_language(tmp_path: Path) -> None:
    """Bytes of CSV: SI names in the heads and in the cells of what has a unit of its own."""
    units = 0
    for where, sheet in sheets(("six-bar-press", "valve-cam")):
        for table in sheet.tables.values():
            written = []
            for language in ("en", "ru", "uk"):
                choose_language(language)
                write_table(table, tmp_path / "t.csv", Display(length="mm", angle="deg"))
                written.append((tmp_path / "t.csv").read_bytes())
            choose_language("en")
            assert len(set(written)) == 1, (where, table.columns[0].name)
            units += b" [mm" in written[0] or b"kg m^2" in written[0]
    assert units > 5


def test_every_literal_of_a_sentence_is_in_the_catalogues() -> None:
    """Sentences stand within each other: none of them is lost on the way to the translators."""
    text = (SOURCE / "locale" / "ru" / "LC_MESSAGES" / "centrode.po").read_text(encoding="utf-8")
    known = re.sub(r'"\n"', "", text)
    found = 0
    for file in sorted((SOURCE / "views").glob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            named = isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
            if named and node.func.id in ("Sentence", "Counted"):  # type: ignore[attr-defined]
                first = node.args[0]  # type: ignore[attr-defined]
                if isinstance(first, ast.Attribute) and first.attr in ("long_name", "word", "title"):
                    continue  # of a vocabulary that marks its own: quantities, statuses, measures
                if isinstance(first, ast.Subscript) and ast.unparse(first.value) == "STATUS_WORDS":
                    continue  # of the vocabulary as well
                if isinstance(first, ast.Name) and first.id == "reason":
                    continue  # why it is this executor: marked where it is decided
                assert isinstance(first, ast.Constant), f"{file}:{first.lineno}: a sentence is a literal"
                escaped = str(first.value).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
                assert f'"{escaped}"' in known, first.value
                found += 1
    assert found > 50


@pytest.mark.parametrize("hostile", HOSTILE)
@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_names_come_out_character_by_character(hostile: str, language: str, tmp_path: Path) -> None:
    """In tables with decimal commas, on a terminal, in figures and in documents."""
    choose_language(language)
    display = ct.example("crank-rocker").display
    text = Sentence("{value} ({remark})", value=Number(1.5, "kg"), remark=Name(hostile))
    assert f"({hostile})" in PlainSpelling(display).text(text)
    assert FigureSpelling(display).text(Name(hostile)).replace(r"\$", "$") == hostile
    document = DocumentSpelling(Numbers(display)).text(text)
    assert f"({hostile})" in document.replace(r"\$", "$")
    mark = "." if language == "en" else ","
    assert document.startswith(f"1{mark}5 {'kg' if language == 'en' else 'кг'}")
    table = Table(
        (Column("name", (Name(hostile), Title(hostile))), Column("mass", np.array([2.5, np.nan]), "kg"))
    )
    write_table(table, tmp_path / "t.csv", display, TableSpelling(comma=True))
    with (tmp_path / "t.csv").open(encoding="utf-8-sig", newline="") as file:
        assert list(csv.reader(file, delimiter=";")) == [
            ["name", "mass [kg]"],
            [hostile, "2,5"],
            [hostile, ""],
        ]
    choose_language("en")


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_places_units_and_parts_are_spelled(language: str) -> None:
    """A place has the unit of the display, a unit on its own stays SI, both by their names in the language."""
    choose_language(language)
    display = ct.example("crank-rocker").display.model_copy(update={"length": "mm"})
    plain, document = PlainSpelling(display), DocumentSpelling(Numbers(display))
    mark = "." if language == "en" else ","
    place = Place((0.0125, -0.5), "m")
    unit, inertia = ("mm", "kg·m²") if language == "en" else ("мм", "кг·м²")
    assert plain.text(place) == f"(12.5, -500) {unit}"
    between = "," if language == "en" else ";"
    assert document.text(place) == f"(12{mark}5{between} \u2212500) {unit}"
    assert plain.text(Unit("kg m^2")) == document.text(Unit("kg m^2")) == inertia
    part = Part(Name("No 1.23456"))
    assert (plain.text(part), document.text(part)) == ("  No 1.23456", "– No 1.23456")
    many = Counted("{n} turn of the drive", "{n} turns of the drive", 1_234_567)
    assert "1234567" in plain.text(many) and "1234567" in document.text(many)
    choose_language("en")


@pytest.mark.parametrize("hostile", ["2.50 kg", "$x_1$", "50 %"])
def test_loads_of_any_name_are_named_by_it(hostile: str) -> None:
    """A load's own name is shown as it is; one without has a word of the language before its link."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 2, "shape": "rod"}},
        drives=[{"link": "OA", "speed": 1}],
        loads=[{"kind": "torque", "link": "OA", "value": 3, "name": hostile}],
        gravity=[0, -10],
    )
    results = reduction_results(mechanism, 5)
    assert f"  {hostile}  " in ct.summary(results) and "  weight OA  " in ct.summary(results)
    legend = ct.figures(results)["reduced-moment"].axes[0].get_legend()
    assert legend is not None
    assert [text.get_text().replace(r"\$", "$") for text in legend.get_texts()] == [
        hostile,
        "weight OA",
        "sum",
    ]


def test_every_entry_of_the_registry_is_there() -> None:
    for topic in TOPICS:
        for lazily in lazy_functions(topic):
            assert callable(lazily.load())


def test_what_is_no_result_is_refused() -> None:
    with pytest.raises(ct.InputError, match="is not a result that can be shown"):
        ct.summary(3.0)


def test_a_result_is_written_as_the_command_writes_it(tmp_path: Path) -> None:
    results = machine_results(ct.example("six-bar-press"), 9)
    ct.write(results, tmp_path / "out")
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"machine.csv", "machine.nc", "machine-instants.csv", "summary.json", "works.svg"} <= names
    assert "1456.73 kg·m²" in ct.summary(results)
    assert ct.tables(results)["machine"].columns[0].name == "time"


def test_an_abscissa_without_gaps() -> None:
    """The parts of an abscissa that most plots do without are empty, not missing."""
    plots = [
        leaf
        for _where, sheet in sheets(("six-bar-press",))
        for leaf in leaves(sheet.pictures)
        if isinstance(leaf, Abscissa)
    ]
    assert plots and all(len(one.values) == len(one.order) for one in plots)


def test_entries_stand_in_their_order_and_new_ones_behind() -> None:
    entries = {"new": 0, "d": 4, "a": 1, "b": 2}
    assert list(in_order(entries, ("a", "b", "c", "d")).items()) == [("a", 1), ("b", 2), ("d", 4), ("new", 0)]


def test_a_table_of_a_terminal_aligns_its_numbers() -> None:
    names = Column("name", (Name("AB"), Name("long one")), head=Sentence("group"))
    values = Column("angle", (Number(9.5, digits=".1f"), Number(10.25, digits=".1f")), "deg")
    assert table_text(
        Table((names, values)), PlainSpelling(ct.example("crank-rocker").display)
    ).splitlines() == [
        "group     angle, deg",
        "AB               9.5",
        "long one        10.2",
    ]


def test_radians_have_degrees_behind_them() -> None:
    """A place on a path can be asked for again by either."""
    radians, degrees = Display(), Display(angle="deg")
    number = Number(math.pi / 6, "rad", ".9g", degrees_too=True)
    assert PlainSpelling(radians).text(number) == "0.523598776 rad (30 deg)"
    assert PlainSpelling(degrees).text(number) == "30 deg"
    assert PlainSpelling(radians).text(Number(0.25, "m", ".9g", degrees_too=True)) == "0.25 m"


def test_nothing_has_no_exponent() -> None:
    """An exact zero is spelled so by terminals as by documents; rounding errors keep their power of ten."""
    plain, document = PlainSpelling(Display()), DocumentSpelling(Numbers(Display()))
    zeros = [Number(0.0, digits=".1e"), Number(-0.0, digits=".1e")]
    assert {spelling.text(zero) for spelling in (plain, document) for zero in zeros} == {"0"}
    assert plain.text(Number(5.6e-17, digits=".1e")) == "5.6e-17"


def test_fixed_columns_stay_in_si(tmp_path: Path) -> None:
    columns = (Column("a", np.array([1.0]), "rad", unit_fixed=True), Column("b", np.array([math.pi]), "rad"))
    write_table(Table(columns), tmp_path / "t.csv", Display(angle="deg"))
    assert (tmp_path / "t.csv").read_text(encoding="utf-8") == "a [rad],b [deg]\n1.0,180.0\n"


def test_no_item_of_a_listing_is_broken() -> None:
    """A line holds a hundred columns; what is longer stands alone."""
    assert listing("bodies", ["0 frame", "1 OA"]) == "bodies: 0 frame, 1 OA"
    items = [f"{number} link of many words" for number in range(20)] + ["x" * 120]
    heading, *lines = listing("bodies", items).splitlines()
    assert heading == "bodies:"
    assert max(map(len, lines[:-1])) <= 100
    assert ", ".join(line.strip().rstrip(",") for line in lines) == ", ".join(items)


@pytest.mark.parametrize("hostile", HOSTILE)
def test_names_in_a_scene_come_out_character_by_character(hostile: str) -> None:
    """A link of any name: in the printed table, the file, the drawing and the chapter of its centres."""
    coupler = f'[links."{hostile}"]\npoints = ["A", "B"]'
    mechanism = ct.parse_mechanism(example_text("crank-rocker").replace("[links.AB]", coupler))
    assert hostile in mechanism.link_names
    results = centre_results(mechanism)
    assert f"{hostile} relative to the frame" in ct.summary(results)
    assert Name(hostile) in ct.tables(results)["centres"].columns[2].values
    axes = ct.figures(results)["centres"].axes
    key = [label.get_text() for one in axes if one.get_legend() for label in one.get_legend().get_texts()]
    assert any(label.replace(r"\$", "$").endswith(f" {hostile}") for label in key)
    sheet = CENTRES.view(results)
    document = document_chapter("centres", sheet, Numbers(mechanism.display))
    (table,) = [block for block in document.sections[1].blocks if isinstance(block, blocks.TableBlock)]
    assert f"{hostile} – frame" in [row[1].replace(r"\$", "$") for row in table.rows]


@pytest.mark.parametrize("hostile", [*HOSTILE, "{angle}"])
def test_names_in_a_graphic_check_come_out_character_by_character(hostile: str) -> None:
    """A link of any name: in the printed rows, the file, the pages and the chapter; braces are no holes."""
    coupler = f'[links."{hostile}"]\npoints = ["A", "B"]'
    mechanism = ct.parse_mechanism(example_text("crank-rocker").replace("[links.AB]", coupler))
    results = ct.graphic_analysis(mechanism, instants=[1.0])
    printed = ct.summary(results)
    assert f"\nω_{hostile} " in printed and f"circle of {hostile} about A" in printed
    assert Name(hostile) in ct.tables(results)["check"].columns[1].values
    pages = ct.figures(results)
    assert set(pages) == {"mechanism", "velocity", "acceleration"}
    # a page sets symbols as mathematics: without its marks, no letter of the name is lost
    texts = [MATHEMATICS.sub("", text.get_text()) for text in pages["mechanism"].axes[0].texts]
    assert any(MATHEMATICS.sub("", hostile) in text for text in texts)
    chapter = document_chapter("graphic", DIAGRAMS.view(results), Numbers(mechanism.display))
    (table,) = [
        block
        for section in chapter.sections
        for block in section.blocks
        if isinstance(block, blocks.TableBlock) and len(block.head) == 6
    ]
    assert any(quote(hostile) in row[0] for row in table.rows)
