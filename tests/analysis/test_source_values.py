"""The printed graph-analytic check of the worked mechanism: angles read to whole degrees."""

from __future__ import annotations

import math

import pytest
from tools.validation import literature
from tools.validation.rows import Row

import centrode as ct
from centrode.analysis.graphic.checks import GraphicCheck, graphic_check

DEGREE = math.radians(1)


@pytest.fixture(scope="module")
def read() -> GraphicCheck:
    return graphic_check(ct.example("slider-between-cranks"), math.pi / 2, angle_step=DEGREE)


def test_the_angles_of_its_triangle(read: GraphicCheck) -> None:
    """Printed: sin 2, sin 114 and sin 64 degrees, of the links at 92 and 206 degrees."""
    (triangle,) = [step.triangle for step in read.diagrams.velocity.steps if step.triangle is not None]
    assert [round(math.degrees(angle), 9) for angle in triangle.angles] == [114, 64, 2]
    assert triangle.names == ("v_C", "v_BC", "v_BD")


@pytest.mark.parametrize("row", literature.drawing().rows, ids=lambda row: row.symbol)
def test_its_printed_values(row: Row) -> None:
    assert row.agrees, row


def test_the_distance_to_the_instant_centre(read: GraphicCheck) -> None:
    """Printed 1.2196, with the sines rounded to 0.914 and 0.8988 on the way."""
    slack = 1.2196 * (0.0005 / 0.914 + 0.00005 / 0.8988)
    assert abs(read.diagrams.reach("CB", "C") - 1.2196) <= slack


def test_exact_values_stand_beside_them(read: GraphicCheck) -> None:
    """By the printed formulas of the angular velocities, at the exact angles."""
    data = ct.motion(ct.example("slider-between-cranks"), at=[math.pi / 2])
    phi2, phi3, phi4 = (float(data.angle.sel(link=name)[0]) for name in ("AC", "CB", "BD"))
    shared = math.sin(math.pi / 2 - phi2) / (math.cos(phi2) * math.sin(phi3 - phi4))
    for name, wanted in {
        "CB": -0.5 / 1.2 * math.cos(phi4) * shared,
        "BD": 0.5 / 0.8 * math.cos(phi3) * shared,
    }.items():
        row = read.row("angular_velocity", name)
        assert row.closed == pytest.approx(wanted, rel=64 * 2.0**-52 / abs(math.cos(phi3)))
        assert row.difference == row.graphic - row.closed
    with pytest.raises(KeyError):
        read.row("velocity", "Z")


def test_a_link_that_translates(read: GraphicCheck) -> None:
    assert read.diagrams.centres["AC"] is None
    assert abs(read.row("angular_velocity", "AC").graphic) <= 4 * 2.0**-52
