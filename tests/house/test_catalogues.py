"""The tool that keeps the catalogues, on small catalogues of its own."""

from __future__ import annotations

import gettext
import importlib.util
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

TOOL = Path(__file__).parents[2] / "tools" / "catalogues.py"


@pytest.fixture
def tool(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    spec = importlib.util.spec_from_file_location("catalogues", TOOL)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    code = tmp_path / "centrode"
    code.mkdir()
    (code / "room.py").write_text('_("length {length} is wrong")\nngettext("{n} link", "{n} links", n)\n')
    (tmp_path / "click.py").write_text('_("Usage:")\n')
    monkeypatch.setattr(module, "ROOT", tmp_path)
    monkeypatch.setattr(module, "CODE", code)
    monkeypatch.setattr(module, "CLICK", tmp_path / "click.py")
    module.update()
    yield module


def translate(tool: ModuleType, *, length: str = "длина {length} не годится") -> None:
    texts = {
        "length {length} is wrong": length,
        "Usage:": "Вызов:",
        ("{n} link", "{n} links"): ("{n} звено", "{n} звена", "{n} звеньев"),
    }
    for language in tool.TRANSLATED:
        catalogue = tool.read(language)
        for message in tool.sentences(catalogue):
            message.string = texts[message.id]
        tool.write(language, catalogue)


def test_a_translation_that_repeats_itself_is_a_fault(tool: ModuleType) -> None:
    """A slip of the editor; a short word of two equal halves is none."""
    translate(tool, length="длина {length} не годится " * 2)
    assert tool.compile_all() == 0
    assert tool.check() == 1
    translate(tool, length="{length}{length}")
    assert tool.compile_all() == 0
    assert tool.check() == 0


def test_a_complete_catalogue_passes_and_speaks(tool: ModuleType) -> None:
    translate(tool)
    assert tool.compile_all() == 0
    assert tool.check() == 0
    with tool.mo_path("ru").open("rb") as file:
        spoken = gettext.GNUTranslations(file)
    assert spoken.gettext("Usage:") == "Вызов:"
    assert [spoken.ngettext("{n} link", "{n} links", n) for n in (1, 22, 5, 11)] == [
        "{n} звено",
        "{n} звена",
        "{n} звеньев",
        "{n} звеньев",
    ]


def test_updating_and_compiling_again_changes_no_byte(tool: ModuleType) -> None:
    translate(tool)
    tool.compile_all()
    before = {path: path.read_bytes() for path in tool.CODE.rglob("*o")}
    tool.update()
    tool.compile_all()
    assert {path: path.read_bytes() for path in tool.CODE.rglob("*o")} == before
    assert not any(b"Date" in text for text in before.values())


def test_reading_and_writing_again_keeps_the_order(tool: ModuleType) -> None:
    """Sentences are sorted by their files alone: the lines, by which they were found, stand in no catalogue."""
    (tool.CODE / "stairs.py").write_text('_("length {length} is wrong")\n')
    (tool.CODE / "room.py").write_text('_("length {length} is wrong")\n_("one room")\n')
    tool.update()
    before = {language: tool.po_path(language).read_bytes() for language in tool.TRANSLATED}
    for language in tool.TRANSLATED:
        tool.write(language, tool.read(language))
    assert {language: tool.po_path(language).read_bytes() for language in tool.TRANSLATED} == before


def complaints(tool: ModuleType, capsys: pytest.CaptureFixture[str]) -> str:
    capsys.readouterr()
    assert tool.check() == 1
    return capsys.readouterr().err


def test_untranslated_sentences_fail(tool: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    tool.compile_all()
    assert "untranslated: 'Usage:'" in complaints(tool, capsys)


def test_fuzzy_sentences_fail(tool: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    translate(tool)
    catalogue = tool.read("ru")
    catalogue.get("Usage:").flags.add("fuzzy")
    tool.write("ru", catalogue)
    tool.compile_all()
    assert "fuzzy: 'Usage:'" in complaints(tool, capsys)


def test_a_stale_mo_fails(tool: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    tool.compile_all()
    translate(tool)
    assert "the .mo file is not compiled from it" in complaints(tool, capsys)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("длина не годится", "field {length} is missing in the translation"),
        ("длина {length} у {link}", "field {link} is not in"),
    ],
)
def test_wrong_fields_fail(
    tool: ModuleType, capsys: pytest.CaptureFixture[str], text: str, complaint: str
) -> None:
    translate(tool, length=text)
    tool.compile_all()
    assert complaint in complaints(tool, capsys)


def test_sentences_new_and_gone_fail_until_updated(
    tool: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    translate(tool)
    tool.compile_all()
    (tool.CODE / "room.py").write_text('_("new")\nngettext("{n} link", "{n} links", n)\n')
    said = complaints(tool, capsys)
    assert "lacks 'new'" in said
    assert "no longer in the code: 'length {length} is wrong'" in said
    tool.update()
    assert [message.id for message in tool.sentences(tool.read("uk"))].count("new") == 1


def test_sentences_that_the_extraction_cannot_see_fail(
    tool: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    translate(tool)
    tool.compile_all()
    (tool.CODE / "hall.py").write_text("text = f\"{length} {_('m')}\"\n")
    assert "hall.py:1: a sentence inside an f-string is not found" in complaints(tool, capsys)
