"""Units of the display: angles, angular velocities and angular accelerations each have their own."""

from __future__ import annotations

import math

import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.model.settings import Display, shown_as
from centrode.render.document.numbers import Numbers
from centrode.render.files import header
from centrode.render.spelling import FigureSpelling, PlainSpelling
from centrode.sheets.plots import AxisLabel
from centrode.sheets.sheet import Column
from centrode.sheets.texts import Sentence
from centrode.views.linkage_data import data_chapter
from centrode.views.words import sheet

RADIANS_BESIDE_DEGREES = Display(angle="deg", angular_velocity="rad/s", angular_acceleration="rad/s^2")
DEGREE = 180 / math.pi


@pytest.mark.parametrize(
    ("display", "unit", "factor", "label"),
    [
        (RADIANS_BESIDE_DEGREES, "rad", DEGREE, "deg"),
        (RADIANS_BESIDE_DEGREES, "rad/s", 1.0, "rad/s"),
        (RADIANS_BESIDE_DEGREES, "rad/s^2", 1.0, "rad/s^2"),
        (RADIANS_BESIDE_DEGREES, "rad/s^3", 1.0, "rad/s^3"),
        (RADIANS_BESIDE_DEGREES, "rad/m", DEGREE, "deg/m"),
        (RADIANS_BESIDE_DEGREES, "m/rad", 1.0, "m/rad"),
        (Display(angle="deg"), "rad/s", DEGREE, "deg/s"),
        (Display(angle="deg"), "rad/s^2", DEGREE, "deg/s^2"),
        (Display(angle="deg", angular_velocity="rpm"), "rad/s", 30 / math.pi, "rpm"),
        (Display(angle="deg", angular_velocity="rad/s"), "rad/s^2", DEGREE, "deg/s^2"),
        (Display(angular_acceleration="turn/s^2"), "rad/s^2", 0.5 / math.pi, "turn/s^2"),
    ],
)
def test_units_that_are_shown(display: Display, unit: str, factor: float, label: str) -> None:
    assert shown_as(unit, display) == (pytest.approx(factor, rel=1e-15), label)


def test_documents_figures_files_and_terminals_follow() -> None:
    display, column = RADIANS_BESIDE_DEGREES, Column("omega", (1.0,), "rad/s")
    assert Numbers(display).with_unit(2.0, "rad/s^2") == "2\u202frad/s²"
    assert Numbers(display).with_unit(math.pi, "rad") == "180°"
    assert header(column, display) == "omega [rad/s]"
    label = AxisLabel(Sentence("angular velocity"), unit="rad/s")
    assert FigureSpelling(display).label(label)[1:] == ("angular velocity, rad/s", "rad/s")


def test_unknown_units_are_refused() -> None:
    with pytest.raises(
        InputError, match=r"\[display\] angular_velocity: expected one of \"rad/s\", \"deg/s\""
    ):
        ct.parse_mechanism('display = { angular_velocity = "1/s" }\n[links.OA]\nlength = 1\n')


# A speed that is given in turns per minute is named so in sentences.

FILE = """
display = { angle = "deg" }
[frame.points]
O = [0, 0]
D = [4, 0]
[links.OA]
length = 1
[links.AB]
length = 3.5
mass = 2
inertia = 0.1
[links.DB]
length = 3
[[drives]]
link = "OA"
start = 0
speed = "SPEED"
[assembly]
sides = { B = "left" }
[machine]
mean_speed = "65 rpm"
"""


def texts(speed: str) -> tuple[str, str]:
    """How the mechanism works, and the law of its drive in the table of its data."""
    mechanism = ct.parse_mechanism(FILE.replace("SPEED", speed).partition("[machine]")[0])
    spelling = PlainSpelling(mechanism.display)
    words = " ".join(spelling.text(one.text) for one in sheet(ct.principle_of_operation(mechanism)).printed)
    tables = [block for part in data_chapter(mechanism).sections for block in part.blocks]
    laws = [column for table in tables for column in getattr(table, "columns", ()) if column.name == "law"]
    return words, spelling.text(laws[0].values[0])


@pytest.mark.parametrize(
    ("speed", "words", "law"),
    [
        ("-75 rpm", "at a constant 75 rpm", "constant -75 rpm (-450 deg/s)"),
        ("2 rad/s", "at a constant 114.6 deg/s", "constant 114.592 deg/s"),
    ],
)
def test_speeds_as_they_are_given(speed: str, words: str, law: str) -> None:
    told, shown = texts(speed)
    assert words in told
    assert shown == law


def test_a_speed_in_turns_per_minute_is_the_number_that_it_was() -> None:
    mechanism = ct.parse_mechanism(FILE.replace("SPEED", "75 rpm"))
    assert mechanism.drives[0].speed == 75 * math.pi / 30
    assert mechanism.machine is not None
    assert f"{mechanism.machine.mean_speed:.5f}" == "6.80678"
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
