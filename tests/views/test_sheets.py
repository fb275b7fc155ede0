"""Sheets hold numbers as numbers and names as names, whatever a user has called things; renderers show them so."""

from __future__ import annotations

import ast
import csv
import dataclasses
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.locale import _, choose_language
from centrode.present.spelled_tables import TableSpelling
from centrode.render.document.numbers import Numbers
from centrode.render.document.spelling import DocumentSpelling
from centrode.render.files import write_table
from centrode.render.spelling import FigureSpelling, PlainSpelling
from centrode.sheets.plots import Abscissa
from centrode.sheets.sheet import Column, Sheet, Table
from centrode.sheets.texts import Counted, Name, Number, Sentence, Title
from centrode.topics.registry import TOPICS

SOURCE = Path(ct.__file__).parent
HOSTILE = ("No 1.23456", "run 30 deg", "2.50 kg", "$x_1$", "<b>", "#a")
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


def sheets(names: tuple[str, ...]) -> Iterator[tuple[str, Sheet]]:
    """The sheets of all topics on the examples that have what they are about."""
    for name in names:
        description = ct.example(name)
        subject = "mechanism" if isinstance(description, ct.Mechanism) else "cam"
        for topic in TOPICS:
            if topic.subject == subject and topic.concerns(description):
                yield f"{topic.name} of {name}", topic.view(topic.compute(description, 9))


def test_no_sentence_holds_a_number_or_a_unit() -> None:
    """Every sentence of the views, in each language: only holes and words; mathematics stands between dollar signs."""
    seen = 0
    for language in ("en", "ru", "uk"):
        choose_language(language)
        for where, sheet in sheets(("six-bar-press", "six-bar-press-printed", *ct.example_names("cam"))):
            for leaf in leaves(dataclasses.replace(sheet, datasets={})):
                messages = [leaf.message] if isinstance(leaf, Sentence) else []
                if isinstance(leaf, Counted):
                    messages = [leaf.singular, leaf.plural]
                for message in messages:
                    words = "".join(_(message).split("$")[::2])
                    assert not re.search(r"\d", words), (where, message)
                    assert not UNITS & set(re.split(r"[\s,;()]+", words)), (where, message)
                    seen += 1
    choose_language("en")
    assert seen > 100


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
                if isinstance(first, ast.Attribute) and first.attr == "long_name":
                    continue  # of the vocabulary of quantities, which marks its own
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
    assert document.startswith(f"1{mark}5 kg")
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


def test_every_entry_of_the_registry_is_there() -> None:
    for topic in TOPICS:
        for lazily in (topic.compute, topic.result, topic.view, topic.concerns, topic.needs):
            assert lazily is None or callable(lazily.load())


def test_what_is_no_result_is_refused() -> None:
    with pytest.raises(ct.InputError, match="is not a result that can be shown"):
        ct.summary(3.0)


def test_a_result_is_written_as_the_command_writes_it(tmp_path: Path) -> None:
    results = ct.machine_results(ct.example("six-bar-press"), 9)
    ct.write(results, tmp_path / "out")
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"machine.csv", "machine.nc", "machine-instants.csv", "summary.json", "works.svg"} <= names
    assert "1456.73 kg m²" in ct.summary(results)
    assert ct.tables(results)["machine"].columns[0].name == "time"


def test_an_abscissa_without_gaps() -> None:
    """The parts of an abscissa that most plots do without are empty, not missing."""
    for _where, sheet in sheets(("six-bar-press",)):
        plots = [leaf for leaf in leaves(sheet.pictures) if isinstance(leaf, Abscissa)]
        assert plots and all(len(one.values) == len(one.order) for one in plots)
