"""Reports of variants: files, the sheet of answers beside the motion, going on after an interruption, refusals."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

import pytest

import centrode as ct
from centrode.analysis.rotatability.causes import Cause, CauseKind, Tracer
from centrode.assignments.answers import InstantAnswers, VariantAnswers, read_answers
from centrode.assignments.results import VariantRow, Variants, compute_variant, variants
from centrode.assignments.tables import read_variants
from centrode.errors import InputError
from centrode.render.document.blocks import ParagraphBlock, Report, TableBlock
from centrode.report.study import Wishes, settle_options
from centrode.report.topics import result_of
from centrode.report.variants import files
from centrode.report.variants.answers import answer_sheet
from centrode.report.variants.files import VariantReport, study_of_variant, write_variant_reports
from centrode.topics.equations import INTEGRATE

ROWS = [
    {"variant": "first", "l2": 1.0, "l3": 1.2},
    {"variant": "none", "l2": -1.0, "l3": 1.2},
]


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reports of one chapter: what variants add to a report is tested here."""

    def short(mechanism: ct.Mechanism, options: ct.ReportOptions, known: Iterable[str]) -> Wishes:
        return settle_options(mechanism, ct.ReportOptions(chapters=("structure",)), known)

    monkeypatch.setattr(files, "settle_options", short)


def test_each_variant_has_its_report_and_the_teacher_the_answers(quick: None, tmp_path: Path) -> None:
    topology = ct.example("slider-between-cranks")
    rows = write_variant_reports(topology, ROWS, tmp_path, formats=("html",)).rows
    assert [row.status for row in rows] == ["ok", "refused"]
    assert (tmp_path / "answers.html").is_file() and not (tmp_path / "answers.pdf").exists()
    folder = tmp_path / "variant-first"
    assert {"report.html", "answers.json"} <= {file.name for file in folder.iterdir()}
    assert not (tmp_path / "variant-none" / "report.html").exists()
    told = json.loads((folder / "answers.json").read_text(encoding="utf-8"))
    mechanism = read_variants(topology, ROWS[:1])[0].of(topology)
    at = mechanism.study.instants
    motion = ct.motion(mechanism, at=at)
    assert len(told["instants"]) == len(at)
    for k, instant in enumerate(told["instants"]):
        for link, (angle, rate, _bend) in instant["links"].items():
            assert angle == float(motion["angle"].sel(link=link)[k])
            assert rate == float(motion["angular_velocity"].sel(link=link)[k])


def test_what_is_finished_is_not_made_again(
    quick: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    topology = ct.example("slider-between-cranks")
    write_variant_reports(topology, ROWS[:1], tmp_path, formats=("html",), language="en")
    before = (tmp_path / "variant-first" / "report.html").read_bytes()
    sheet = (tmp_path / "answers.html").read_bytes()

    def never(*_arguments: object, **_more: object) -> Report:
        raise AssertionError("made again")

    monkeypatch.setattr(files, "report_of_study", never)
    write_variant_reports(topology, ROWS[:1], tmp_path, formats=("html",), language="en")
    assert (tmp_path / "variant-first" / "report.html").read_bytes() == before
    assert (tmp_path / "answers.html").read_bytes() == sheet
    rows = write_variant_reports(topology, ROWS[:1], tmp_path, formats=("html",), language="ru").rows
    assert [row.status for row in rows] == ["fault"]  # another language is another report: it was to be made


def answers_at(angle: float) -> VariantAnswers:
    """Answers at one instant, with rounding in one of the speeds."""
    links = {"AC": (angle, 1e-17, 2.0), "CB": (1.0, 1.0, 0.0)}
    instant = InstantAnswers("OA = 0", True, 0.0, (0.0,), links, {}, {})
    cause = Cause(
        CauseKind.RODS_IN_LINE, ((Tracer.LINK, "AC"), (Tracer.LINK, "CB")), ("A", "$B$"), True, 2.25
    )
    return VariantAnswers(True, None, "", "", "", (cause,), 1, "", "", (instant,))


def test_the_sheet_tells_every_variant() -> None:
    topology = ct.example("slider-between-cranks")
    given = read_variants(topology, [{"variant": "a", "l2": 1.0}, {"variant": "$b$", "l2": 1.5}])
    row = ct.variants(topology, [{"variant": "a", "l2": 1.0}]).rows[0]
    rows = (
        row,
        VariantRow("$b$", True, None, "", "", "", "ok"),
        VariantRow("c", None, None, "", "", "length 2.50000 is wrong", "refused"),
    )
    answers = {name: answers_at(angle) for name, angle in (("a", 0.5), ("$b$", 0.25))}
    sheet = answer_sheet(Variants(topology, given, rows, answers=answers))
    blocks = [block for chapter in sheet.chapters for section in chapter.sections for block in section.blocks]
    tables = [block for block in blocks if isinstance(block, TableBlock)]
    assert tables[0].rows == (("a", "1.0000"), (r"\$b\$", "1.5000"))
    assert [cells[0] for cells in tables[1].rows] == ["a", r"\$b\$", "c"]
    assert tables[1].rows[0][4].endswith(r"are collinear, extended (distance of A and \$B\$: 2.25 m)")
    assert tables[1].rows[2][4] == "length 2.50000 is wrong"  # as it was written
    assert tables[2].rows == (("a", "0.50000", "1.0000"), (r"\$b\$", "0.25000", "1.0000"))
    assert [cells[1] for cells in tables[3].rows] == ["0", "0"]  # rounding beside the rates of its kind
    assert any(isinstance(block, ParagraphBlock) and "c" in block.text for block in blocks)


def test_answers_read_back() -> None:
    answers = answers_at(1 / 3)
    assert read_answers(answers.json_text()) == answers


def test_a_variant_of_a_machine_has_the_forces_of_its_real_motion() -> None:
    press = ct.example("six-bar-press").model_copy(update={"study": ct.Study(samples=19)})
    [found] = variants(press, [{"variant": "heavy", "links.slider.mass": "5 kg"}]).results
    assert found.mechanism is not None and found.study is not None and found.study.reactions is not None
    assert found.study.reactions.reactions.attrs["rate_from"] == "machine"
    kept = study_of_variant(found.mechanism, found).study
    assert kept.reactions is not None
    assert kept.reactions.reactions.identical(ct.reactions(found.mechanism, motion="real"))


def test_files_depend_on_formats_and_language() -> None:
    keys = {
        VariantReport(formats, language).key for formats in (("html",), ("pdf",)) for language in ("en", "ru")
    }
    assert len(keys) == 4
    assert VariantReport(("html", "pdf"), "en").key == VariantReport(("pdf", "html"), "en").key


@pytest.mark.parametrize("formats", [(), ("odt",)])
def test_wrong_formats_are_refused_before_anything_is_computed(
    formats: tuple[str, ...], tmp_path: Path
) -> None:
    with pytest.raises(InputError):
        write_variant_reports(ct.example("crank-rocker"), ROWS, tmp_path / "new", formats=formats)
    assert not (tmp_path / "new").exists()


def test_the_integration_of_a_report_is_that_of_its_table() -> None:
    """What judges the fixed steps of a variant is what `integrate` gives by itself, to the last bit."""
    topology = ct.example("slider-between-cranks")
    found = compute_variant(topology, read_variants(topology, ROWS[:1])[0])
    assert found.mechanism is not None and found.integration is not None and found.adaptive is not None
    assert found.integration.identical(ct.integrate(found.mechanism))
    assert found.adaptive.identical(ct.integrate(found.mechanism, "adaptive"))
    kept = result_of(INTEGRATE, study_of_variant(found.mechanism, found))
    assert kept.integration is found.adaptive
