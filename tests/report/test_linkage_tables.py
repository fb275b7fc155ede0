"""Tables of linkages beside what the sources print, statuses told, checks that fail where a motion is wrong."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.errors import Status
from centrode.kinematics.rigid_body_checks import rigid_body_checks
from centrode.render.document.blocks import ChapterBlocks, CheckBlock, ParagraphBlock, TableBlock
from centrode.render.document.numbers import NARROW
from centrode.report.document import report
from centrode.report.study import ReportOptions, ReportStudy, moments_of, settle_options
from centrode.views.columns import rows_shown
from centrode.views.motion_tables import ROWS, WIDE
from samples import examples_at_hand

REFERENCE = Path(__file__).parents[1] / "reference"
EPS = float(np.finfo(float).eps)


def made(key: str, mechanism: ct.Mechanism, **wishes: object) -> ChapterBlocks:
    (found,) = report(mechanism, ReportOptions(chapters=(key,), **wishes), language="en").chapters  # type: ignore[arg-type]
    assert not found.missing
    return found


def tables(found: ChapterBlocks, section: str | None = None) -> list[TableBlock]:
    return [
        block
        for each in found.sections
        if section is None or each.title == section
        for block in each.blocks
        if isinstance(block, TableBlock)
    ]


def number(text: str) -> float:
    return float(text.replace("−", "-").replace(",", "."))


def study_of(mechanism: ct.Mechanism, **wishes: object) -> ReportStudy:
    return ReportStudy(mechanism, settle_options(mechanism, ReportOptions(**wishes), ["tables"]))  # type: ignore[arg-type]


def test_the_assignment_s_table_is_that_of_the_report() -> None:
    with (REFERENCE / "planar-slider-rocker-table.csv").open(encoding="utf-8") as file:
        printed = {round(float(row["t_s"]), 4): row for row in csv.DictReader(file)}
    columns: dict[str, dict[float, float]] = {}
    for table in tables(made("tables", ct.example("slider-between-cranks")), "The whole motion"):
        for k, head in enumerate(table.head):
            columns.setdefault(head, {}).update({number(row[0]): number(row[k]) for row in table.rows})
    compared = 0
    for time in columns["$t$, s"]:
        row = next((r for at, r in printed.items() if abs(at - time) < 1e-4), None)
        if row is None:
            continue
        for k in (2, 3, 4):
            # half a unit of the last printed digit, and of the report's own
            off = columns[f"$phi_({k})$, rad"][time] - float(row[f"phi{k}_rad"])
            assert abs(off) <= 0.0005 + 0.00005
            off = columns[f"$omega_({k})$, rad/s"][time] - float(row[f"omega{k}_rad_s"])
            assert abs(off) <= 0.0005 + 0.00005
        assert abs(columns["$v_(C x)$, m/s"][time] - float(row["v_C_m_s"])) <= 0.0005 + 0.00005
        compared += 1
    assert compared >= 10


def test_the_coursework_s_instant() -> None:
    found = made("tables", ct.example("six-bar-press"))
    links, places, *_others = tables(found, "OA = 120°")
    (analogs,) = (
        block
        for section in found.sections
        for block in section.blocks
        if isinstance(block, TableBlock) and block.caption.startswith("Kinematic coefficients of the points")
    )
    rows = {row[1]: row for row in links.rows}
    # the source's phi2, phi3 at 120 deg, and its phi4, which it measures from H to D
    assert [round(number(rows[link][2]), 2) for link in ("AB", "CD")] == [22.17, 95.76]
    points = {row[0]: row for row in places.rows}
    assert number(points["H"][1]) == pytest.approx(2.584, abs=5e-4 + 5e-5)
    coefficients = {row[0]: row for row in analogs.rows}
    # the source's drive turns backwards: first derivatives have the other sign
    assert number(coefficients["H"][1]) == pytest.approx(-0.675, abs=5e-4 + 5e-6)
    assert number(coefficients["H"][3]) == pytest.approx(0.331, abs=5e-4 + 5e-6)


def test_tables_of_a_mechanism_that_locks_have_the_rows_it_reaches() -> None:
    mechanism = ct.example("slider-between-cranks-locked")
    found = made("tables", mechanism)
    shown = tables(found, "The part of the motion that is reached")
    assert shown and not tables(found, "The whole motion")
    for table in shown:
        assert "status" not in table.head
        times = [number(row[0]) for row in table.rows]
        assert times[0] == 0.0 and times[-1] <= 1.79991241652444
        assert not any(cell == "—" for row in table.rows for cell in row)
    said = [b.text for s in found.sections for b in s.blocks if isinstance(b, ParagraphBlock)]
    assert any("locks" in text and "1.7999 rad" in text for text in said)
    part = "0 rad to 1.7999 rad (103.13°) (dead position of group CB-BD (point B))"
    assert any(
        f"Tables and plots cover what is reached: {part}." == text.replace(NARROW, " ") for text in said
    )


def test_rows_are_even_with_both_ends() -> None:
    for samples in (1, 2, 36, 101, 361, 362, 360, 1000):
        rows = rows_shown(samples, ROWS)
        assert rows[0] == 0 and rows[-1] == samples - 1 and 1 <= len(rows) <= max(ROWS, 1)
        assert max(np.diff(rows), default=1) - min(np.diff(rows), default=1) <= 1


def test_no_table_is_wider_than_a_page() -> None:
    for name in ("jansen-leg", "andrews-squeezer", "excavator-arm", "slider-between-cranks-locked"):
        for table in tables(made("tables", ct.example(name)), "The whole motion"):
            assert len(table.head) <= WIDE
            assert {len(row) for row in table.rows} == {len(table.head)} == {len(table.numbers)}


def test_what_stays_the_same_is_a_sentence() -> None:
    mechanism = ct.example("six-bar-press")
    found = made("tables", mechanism)
    said = " ".join(b.text for s in found.sections for b in s.blocks if isinstance(b, ParagraphBlock))
    assert "$y_(H)$ = 0.9" in said and "$phi_(5)$ = 0°" in said
    heads = {head for table in tables(found, "The whole motion") for head in table.head}
    assert not any("y_(H)" in head or "_(5)" in head for head in heads)


@pytest.mark.parametrize("name", ["six-bar-press", "jansen-leg", "planetary-gear-train", "kite"])
def test_identities_notice_a_wrong_rate(name: str) -> None:
    mechanism = ct.example(name)
    right = ct.motion(mechanism)
    checks = rigid_body_checks(mechanism, right)
    assert all(one.difference <= one.bound * one.size for one in checks)
    reached = right.isel(sample=np.flatnonzero(right["status"].to_numpy() == Status.OK))
    assert {one.identity for one in checks} == {"velocity", "acceleration"}
    for variable in ("velocity", "acceleration"):
        point = mechanism.moving_points[-1]
        size = float(np.nanmax(np.abs(reached[variable])))
        pushed = reached[variable].copy()
        pushed.loc[{"point": point, "axis": "x"}] += 1e-4 * size
        pushed_rates = reached.assign({variable: pushed})
        wrong = {one.identity: one for one in rigid_body_checks(mechanism, pushed_rates)}[variable]  # type: ignore[index]
        assert wrong.difference > 1e-5 * wrong.size


def test_moments_are_exact_and_told() -> None:
    mechanism = ct.example("six-bar-press")
    (only,) = moments_of(study_of(mechanism))
    assert only.title == "OA = 120°" and only.is_reached
    assert float(only.data["drive_value"][0, 0]) == pytest.approx(np.radians(120), abs=4 * EPS)
    (start,) = moments_of(study_of(ct.example("crank-rocker"), instants=()))
    assert start.is_reached
    driven = moments_of(study_of(ct.example("five-bar-two-drives"), instants=(0.1,)))
    assert driven[0].title.startswith("t = 0.1") and driven[0].at == 0.1


def test_an_instant_of_a_law_is_a_time() -> None:
    """The law passes a value twice: only the time says which way the mechanism goes."""
    mechanism = ct.example("wiper")
    course = ct.motion(mechanism)
    sample = course.sizes["sample"] // 3
    (moment,) = moments_of(study_of(mechanism, instants=(float(course["time"][sample]),)))
    for name in ("drive_value", "velocity"):
        there, here = course[name].values[sample], moment.data[name].values[0]
        np.testing.assert_allclose(here, there, atol=1e-9 * np.nanmax(np.abs(course[name].values)))


def test_checks_of_all_chapters_hold() -> None:
    names = (
        "geared-five-bar",
        "rolling-wheel-rod",
        "scissor-lift-cylinder",
        "five-bar-two-drives",
        "two-link-arm",
    )
    for name in examples_at_hand(names):
        mechanism = ct.example(name)
        keys = ("structure", "equations", "derivation", "tables")
        for chapter in report(mechanism, ReportOptions(chapters=keys), language="en").chapters:
            checks = [b for s in chapter.sections for b in s.blocks if isinstance(b, CheckBlock)]
            no_loop = name == "two-link-arm" and chapter.name in ("equations", "derivation")  # nothing closes
            assert checks or no_loop, (name, chapter.name)
            assert all(check.holds for check in checks), (name, [c.text for c in checks if not c.holds])


def test_numbers_of_all_tables_have_the_language_s_mark() -> None:
    for chapter in report(
        ct.example("six-bar-press"), ReportOptions(chapters=("data", "tables")), language="uk"
    ).chapters:
        for table in tables(chapter):
            cells = [cell for row in table.rows for cell in row]
            assert not any(re.search(r"\d\.\d", cell) for cell in cells)
