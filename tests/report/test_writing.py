"""Reports as files: whole or not at all, the same bytes, and refusals."""

from __future__ import annotations

import importlib
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.render.document.blocks import Report
from centrode.report import files

REPORT = Report("a", "b", "en", ())


def test_documents_are_written_and_replaced(tmp_path: Path) -> None:
    said: list[str] = []
    files = ct.write_report(REPORT, tmp_path / "new" / "folder", ("pdf", "pdf"), "one", said.append)
    assert [file.name for file in files] == said == ["one.pdf"]
    first = files[0].read_bytes()
    assert first.startswith(b"%PDF-")
    files[0].write_bytes(b"old")
    assert ct.write_report(REPORT, files[0].parent, ("pdf",), "one")[0].read_bytes() == first
    assert [file.name for file in files[0].parent.iterdir()] == ["one.pdf"]


def test_documents_beside_each_other_are_those_made_alone(tmp_path: Path) -> None:
    chosen = ct.ReportOptions(chapters=("structure", "equations"))
    report = ct.report(ct.example("crank-rocker"), chosen, language="ru")
    beside = ct.write_report(report, tmp_path / "beside", ("html", "pdf"))
    alone = [ct.write_report(report, tmp_path / "alone", (kind,))[0] for kind in ("html", "pdf")]
    assert [file.read_bytes() for file in beside] == [file.read_bytes() for file in alone]
    page = beside[0].read_text("utf-8")
    assert 'lang="ru"' in page
    assert page.count("<math") > 10


@pytest.mark.parametrize("moment", ["making the page", "waiting for the PDF"])
def test_what_is_interrupted_waits_for_no_document(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moment: str
) -> None:
    """Typst cannot be stopped: it is left alone with its document, and nothing is written."""
    go_on, finished = threading.Event(), threading.Event()

    def interrupted(*_anything: object) -> dict[str, bytes]:
        raise KeyboardInterrupt

    def typesetting(report: Report) -> Callable[[], bytes]:
        return lambda: (go_on.wait(60), finished.set(), b"%PDF-")[-1]

    monkeypatch.setattr(importlib.import_module("centrode.report.pdf_document"), "typesetting", typesetting)
    formats = {"pdf": files.FORMATS["pdf"]}
    if moment == "making the page":
        formats["html"] = interrupted
    else:
        monkeypatch.setattr(threading.Thread, "join", interrupted)
    monkeypatch.setattr(files, "FORMATS", formats)
    with pytest.raises(KeyboardInterrupt):
        ct.write_report(REPORT, tmp_path, tuple(formats))
    assert not finished.is_set()
    go_on.set()
    assert finished.wait(60)
    assert list(tmp_path.iterdir()) == []


def test_one_document_that_fails_leaves_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(report: Report, name: str) -> dict[str, bytes]:
        raise KeyboardInterrupt

    monkeypatch.setattr(files, "FORMATS", {"pdf": files.FORMATS["pdf"], "html": interrupted})
    with pytest.raises(KeyboardInterrupt):
        ct.write_report(REPORT, tmp_path, ("pdf", "html"))
    assert list(tmp_path.iterdir()) == []


def test_an_interrupted_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "report.pdf").write_bytes(b"old")

    def refuse(*names: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("os.replace", refuse)
    with pytest.raises(KeyboardInterrupt):
        ct.write_report(REPORT, tmp_path, ("pdf",))
    assert [(file.name, file.read_bytes()) for file in tmp_path.iterdir()] == [("report.pdf", b"old")]


def test_without_typst_nothing_is_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "find_spec", lambda name: None)
    with pytest.raises(InputError, match="reports need typst, which is not installed"):
        files.check_formats(("pdf",))


@pytest.mark.parametrize(
    ("formats", "message"),
    [
        (("odt",), 'format: "odt" is not a format of a report; known are: html, pdf, docx, tex, ipynb'),
        ((), "no format is named"),
    ],
)
def test_wrong_formats(tmp_path: Path, formats: tuple[str, ...], message: str) -> None:
    with pytest.raises(InputError, match=message):
        ct.write_report(REPORT, tmp_path / "x", formats)
    assert not (tmp_path / "x").exists()


def test_a_folder_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(InputError, match="cannot be written"):
        ct.write_report(REPORT, tmp_path / "file", ("pdf",))


def test_a_library_that_is_missing_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(report: Report, name: str) -> dict[str, bytes]:
        raise ModuleNotFoundError("No module named 'typst'", name="typst")

    monkeypatch.setattr(files, "FORMATS", {"pdf": missing})
    with pytest.raises(InputError, match=r'reports need typst, .* pip install -e "\.\[documents,figures\]"'):
        ct.write_report(REPORT, tmp_path, ("pdf",))


@pytest.mark.parametrize("library", ["matplotlib", "fontTools"])  # matplotlib needs fontTools itself
def test_what_figures_need_is_told(library: str) -> None:
    program = (
        f"import sys; sys.modules[{library!r}] = None\n"
        "from centrode.cli.main import main\n"
        "sys.argv = ['centrode', 'report', 'crank-rocker', '--chapters', 'data', '--out', sys.argv[1]]\n"
        "sys.exit(main())\n"
    )
    done = subprocess.run([sys.executable, "-c", program, "never"], capture_output=True, text=True)
    assert done.returncode == 2
    assert f"reports need {library}, which is not installed" in done.stderr
    assert 'pip install -e ".[documents,figures]"' in done.stderr
