"""Conclusions, rows of fixed steps, other rows and positions, reading steps: against printed numbers and geometry."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.motion_results import study
from centrode.dynamics.steady_motion.machine import closing_balance
from centrode.errors import InputError
from centrode.render.document.blocks import ItemsBlock, ParagraphBlock, Picture, Report, TableBlock

REFERENCE = Path(__file__).parents[1] / "reference"
WORKED = "slider-between-cranks"


def blocks_of(made: Report, kind: type) -> list[object]:
    return [
        block
        for chapter in made.chapters
        for section in chapter.sections
        for block in section.blocks
        if isinstance(block, kind)
    ]


def conclusions(name: str) -> Sequence[str]:
    made = ct.report(name, ct.ReportOptions(chapters=("conclusions",)), language="en")
    (items,) = blocks_of(made, ItemsBlock)
    assert isinstance(items, ItemsBlock)
    return items.texts


def stroke_of_the_press() -> float:
    """Stroke of H where O, A, B are in line, by circles alone."""
    places = []
    for reach in (1.445 + 0.347, 1.445 - 0.347):
        # B: distance `reach` from O, 0.85 from C; D beyond B on the ray from C; H on y = 0.9, right of D
        x = (reach**2 - 0.85**2 + 1.25**2) / (2 * 1.25)
        b = np.array([x, math.sqrt(reach**2 - x**2)])
        d = 2 * b - np.array([1.25, 0.0])
        places.append(d[0] + math.sqrt(1.7**2 - (0.9 - d[1]) ** 2))
    return abs(places[0] - places[1])


def test_the_conclusions_of_the_press_are_its_results() -> None:
    texts = conclusions("six-bar-press")
    assert texts[0].startswith("The drive OA turns fully")
    assert f"the stroke is {stroke_of_the_press():.4g} m" in texts[1]
    assert any("the flywheel has 1456.7 kg·m²" in text for text in texts)
    # the coursework's closing check, 6310.25 + 1459.23 x (-2.7735) = 2263.0 N m, where the crank turns against q
    assert texts[-1].endswith("−6310.2 + 1459.2 · 2.7735 = −2263 N·m.")


def test_the_machine_closes_by_two_routes() -> None:
    machine = study(ct.example("six-bar-press"), 37).machine
    assert machine is not None
    here = closing_balance(machine)
    assert float(here.moment_of_links) == pytest.approx(-6310.25, abs=5e-3)
    assert float(here.drive_acceleration) == pytest.approx(2.7735, abs=5e-5)
    assert float(here.driving_moment) == pytest.approx(-2263.0, abs=5e-2)
    assert here.attrs["driving_residual"] <= here.attrs["driving_error"] + float(here.reaction_loss) < 1e-9


def test_a_mechanism_that_locks_is_told_so() -> None:
    texts = conclusions("slider-between-cranks-locked")
    assert texts[0].startswith("The mechanism does not turn fully: its motion is bounded at 1.79")
    assert not any("velocity" in text for text in texts)


def spoken(name: str) -> Sequence[str]:
    """Conclusions with plain spaces before units."""
    return [re.sub(r"\s", " ", text) for text in conclusions(name)]


def test_the_conclusions_of_a_spherical_linkage_are_its_angles() -> None:
    """AB = 15, CB = 45 deg: cos CB = sin(psi +- AB) at beta = +-90 deg, sin gamma = sin AB / sin CB at 0 and 180."""
    texts = spoken("spherical-crank-rocker-rigid")
    least, greatest = (90 - 45) - 15, (90 - 45) + 15
    assert f"Link DC swings through {greatest - least}°: its angle is least at 90°, {least}°" in texts[1]
    assert f"and greatest at 270°, {greatest}°;" in texts[1]
    gamma = math.degrees(math.asin(math.sin(math.radians(15)) / math.sin(math.radians(45))))
    assert f"varies by {2 * gamma:.4g}°: it is least at 0°, {90 - gamma:.4g}°" in texts[2]
    assert f"and greatest at 180°, {90 + gamma:.4g}°" in texts[2]
    assert texts[3].startswith("The greatest reactions: ") and "balancing moment" in texts[4]
    # on a circle: C of a crank of 15 deg travels twice its arc
    assert "Point C on its guide: the stroke is 30°" in spoken("spherical-crank-guide")[1]


def test_the_conclusions_of_a_valve_cam_are_those_of_its_law() -> None:
    """C_v = 15/8 and C_a = 10/sqrt(3) of the 3-4-5 curve; where it ends the spring alone presses the flat tappet."""
    texts = spoken("valve-cam")
    lift, angle, speed = 8.0, math.radians(75), 50 * math.pi
    fastest, steepest = 15 / 8 * lift / angle * speed, 10 / math.sqrt(3) * lift / angle**2 * speed**2
    assert texts[0].startswith("The greatest lift is 8 mm, at 75°")
    assert f"at 37.5°, {fastest:.4g}".rstrip("0").rstrip(".") in texts[0]
    assert f"{steepest / 1e5:.4g}·10⁵ mm/s²" in texts[0]
    assert texts[1] == f"The base radius is 24 mm; the greatest radius of the profile is {24 + lift:.4g} mm."
    assert texts[2] == "The profile is not undercut."
    assert texts[3].startswith(f"The contact force is greatest at 75°, {180 + 25 * lift:.4g} N;")
    assert texts[4].endswith("; 900 MPa is admissible.")


def test_the_conclusions_of_a_path_by_curvature_are_those_that_its_source_prints() -> None:
    """The working arc of the wheel goes to 45 deg: eta' = 0 between 40 and 45 deg, eta the sine of the angle."""
    with (REFERENCE / "cam-curvature-table.csv").open() as file:
        rows = {float(row["phi_deg"]): row for row in csv.DictReader(file)}
    before, after = (float(rows[at]["eta_d1"]) for at in (40.0, 45.0))
    place = 40 + 5 * before / (before - after)
    texts = spoken("walking-wheel-four-legs")
    assert f"least at 0°, 50 mm, and greatest at ±45°, {float(rows[45.0]['rho_mm']):.2f} mm" in texts[0]
    found = re.search(r"greatest in magnitude at ±([0-9.]+)°, ([0-9.]+)°", texts[1])
    assert found is not None
    assert float(found[1]) == pytest.approx(place, abs=0.1)
    between = float(rows[45.0]["eta"]), float(rows[45.0]["eta"]) - after * math.radians(45 - place) / 2
    sine = math.sin(math.radians(float(found[2])))
    assert between[0] < sine and sine == pytest.approx(between[1], abs=1e-3)
    assert texts[2].endswith("more than the admissible 600 MPa.")


# Fixed steps


def fixed_rows(steps: int, rows: int) -> TableBlock:
    options = ct.ReportOptions(chapters=("integration",), rk4_steps=steps, rows=rows, digits=8)
    found = blocks_of(ct.report(WORKED, options, language="en"), TableBlock)
    tables = [one for one in found if isinstance(one, TableBlock) and "fixed steps" in one.caption]
    (table,) = tables
    return table


def number(cell: str) -> float:
    return float(cell.replace("\u2212", "-"))


def test_rows_of_fixed_steps_are_those_that_the_assignment_prints() -> None:
    with (REFERENCE / "planar-slider-rocker-table.csv").open() as file:
        printed = list(csv.DictReader(line for line in file if not line.startswith("#")))
    table = fixed_rows(100, 101)
    assert len(table.rows) == 101
    compared = 0
    for row in printed:
        sample = round(float(row["t_s"]) / (2 * math.pi / 100))
        for column, name in ((0, "t_s"), (2, "phi2_rad"), (3, "phi3_rad"), (4, "phi4_rad")):
            places = len(row[name].partition(".")[2])
            assert number(table.rows[sample][column]) == pytest.approx(
                float(row[name]), abs=0.51 * 10**-places
            )
            compared += 1
    assert compared > 100


def test_half_the_step_has_a_sixteenth_of_the_error() -> None:
    errors = []
    for steps in (50, 100, 200):
        found = ct.integrate(ct.example(WORKED), "rk4", steps)
        errors.append(float(np.abs(found["angle_difference"].values).max()))
    # of fourth order, up to terms of the next one
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.35)
    assert errors[1] / errors[2] == pytest.approx(16, rel=0.35)


def test_the_error_of_fixed_steps_is_drawn() -> None:
    options = ct.ReportOptions(chapters=("integration",), rk4_steps=20, full=False)
    made = ct.report(WORKED, options, language="en")
    captions = [one.caption for one in blocks_of(made, Picture) if isinstance(one, Picture)]
    assert captions == ["Drift and error of the fixed steps over the range"]


# Rows, positions, reading


@pytest.mark.parametrize("full", [True, False])
def test_a_table_over_the_motion_has_as_many_rows_as_wished(full: bool) -> None:
    for rows, there in ((11, 11), (21, 21), (1000, 101)):
        options = ct.ReportOptions(chapters=("tables",), rows=rows, full=full)
        tables = blocks_of(ct.report(WORKED, options, language="en"), TableBlock)
        over = [one for one in tables if isinstance(one, TableBlock) and one.head[0] == "$t$, s"]
        assert over
        assert {len(one.rows) for one in over} == {there}


def test_a_plan_has_as_many_positions_as_wished() -> None:
    options = ct.ReportOptions(chapters=("positions",), positions=8)
    tables = blocks_of(ct.report(WORKED, options, language="en"), TableBlock)
    assert isinstance(tables[-1], TableBlock)
    assert len(tables[-1].rows) == 8


def test_a_drawing_read_to_whole_degrees_gives_the_printed_numbers() -> None:
    options = ct.ReportOptions(chapters=("graphic",), instants="90 deg", angle_step="1 deg", full=False)
    made = ct.report(WORKED, options, language="en")
    table = blocks_of(made, TableBlock)[-1]
    assert isinstance(table, TableBlock)
    drawn = {row[0]: abs(number(row[2])) for row in table.rows}
    # the assignment prints |omega3| = 0.41, |omega4| = 0.024, |v_B| = 0.0191
    assert drawn['$ω_(upright("CB"))$'] == pytest.approx(0.41, abs=5e-3)
    assert drawn['$ω_(upright("BD"))$'] == pytest.approx(0.024, abs=5e-4)


def test_the_repaired_mechanism_keeps_the_angle_that_is_wished() -> None:
    """A four-bar of 60, 70, 50 and 90 mm: the angle between coupler and rocker by the law of cosines."""
    locked = ct.four_bar(0.06, 0.07, 0.05, 0.09)
    for chapters in (("rotatability",), ("repaired-mechanism",)):
        options = ct.ReportOptions(chapters=chapters, least_transmission_angle="30 deg", digits=9)
        made = ct.report(locked, options, language="en")
        texts = [block.text for block in blocks_of(made, ParagraphBlock) if isinstance(block, ParagraphBlock)]
        changed = re.search(r"link crank ([0-9.]+)\s*m long instead of 0.06\s*m", " ".join(texts))
        assert changed is not None, texts
        crank = float(changed[1])
        cosines = [
            (0.07**2 + 0.05**2 - reach**2) / (2 * 0.07 * 0.05) for reach in (0.09 - crank, 0.09 + crank)
        ]
        assert min(math.sqrt(1 - cosine**2) for cosine in cosines) >= math.sin(math.radians(30)) - 1e-9


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"rows": 1}, "1 is not a whole number between 2 and 1000"),
        ({"positions": 99}, "99 is not a whole number between 2 and 36"),
        ({"rk4_steps": 0}, "0 is not a whole number between 1 and 100000"),
        ({"standard": "gots"}, 'there is no standard "gots"'),
        ({"angle_step": "1 kg"}, "expected an angle"),
        ({"least_transmission_angle": "95 deg"}, "between 0 and 90 deg, got 95 deg"),
        ({"greatest_change": 1.0}, "between 0 and 1, got 1"),
    ],
)
def test_what_cannot_be_wished_is_refused(options: dict[str, object], what: str) -> None:
    with pytest.raises(InputError, match=what):
        ct.report(WORKED, ct.ReportOptions(chapters=("tables",), **options))  # type: ignore[arg-type]


def test_rows_are_those_of_linkages() -> None:
    with pytest.raises(InputError, match="those of linkages"):
        ct.report("valve-cam", ct.ReportOptions(chapters=("data",), rows=5))
