"""The generalised coordinate with the zero and the sense that an author chooses."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.errors import InputError
from centrode.render.spelling import PlainSpelling
from centrode.views.abscissa import motion_abscissa
from centrode.views.instants import instant_title

REFERENCE = Path(__file__).parents[1] / "reference" / "six-bar-printed-values.csv"
AT = "99.1 deg"
"""Of the coursework's coordinate, at which it prints its numbers."""
EPS = float(np.finfo(float).eps)


def with_coordinate(name: str, coordinate: str) -> ct.Mechanism:
    """A built-in mechanism whose study has no range and instants of its own, with a coordinate."""
    made = ct.example(name)
    text = ct.mechanism_text(made.model_copy(update={"study": ct.Study()}))
    return ct.parse_mechanism(f"{text}\n[study]\ncoordinate = {coordinate}\n", "chosen.toml")


@pytest.fixture(scope="module")
def coursework() -> ct.Mechanism:
    """The press as printed, in the source's coordinate."""
    return with_coordinate(
        "six-bar-press-printed", '{ link = "OA", zero = "219.1 deg", sense = "clockwise" }'
    )


def printed(quantity: str) -> dict[str, tuple[float, float]]:
    """Symbol -> printed value and half a unit of its last digit."""
    with REFERENCE.open(encoding="utf-8") as file:
        return {
            row["symbol"]: (float(row["printed"]), float(row["half_unit"]))
            for row in csv.DictReader(file)
            if row["quantity"].startswith(quantity)
        }


LINKS = {"phi2": "AB", "phi3": "CD", "phi4": "DH"}


def test_the_coursework_prints_these_analogs_with_their_signs(coursework: ct.Mechanism) -> None:
    motion = ct.motion(coursework, at=[AT]).isel(sample=0)
    assert abs(math.degrees(float(motion.angle.sel(link="OA"))) - 120.0) <= 1e-12
    checked = 0
    for quantity, of_points, of_links in (
        ("velocity analog", "velocity_coefficient", ""),
        ("acceleration analog", "acceleration_coefficient", ""),
        ("angular velocity analog", "", "angular_velocity_coefficient"),
        ("angular acceleration analog", "", "angular_acceleration_coefficient"),
    ):
        for symbol, (value, half) in printed(quantity).items():
            found = (
                motion[of_links].sel(link=LINKS[symbol])
                if of_links
                else motion[of_points].sel(point=symbol[1:], axis=symbol[0].lower())
            )
            # 0.1735 m/rad is printed as 0.173
            assert abs(float(found) - value) <= half + 4 * EPS, (quantity, symbol)
            checked += 1
    assert checked == 11 + 11 + 3 + 3


def test_the_coursework_prints_this_reduction_with_its_signs(coursework: ct.Mechanism) -> None:
    reduction = ct.reduce(coursework, at=[AT]).isel(sample=0)
    inertia, moment = float(reduction.reduced_inertia), float(reduction.reduced_moment)
    for value, name in ((inertia, "reduced inertia of group II"), (moment, "reduced resisting")):
        ((shown, half),) = printed(name).values()
        assert abs(value - shown) <= half
    # epsilon = (M + M_d) / (J_I + J_II) - omega^2 J_II' / (2 (J_I + J_II)), of the printed numbers but J_II' and M
    (driving, of_driving), (shafts, of_shafts) = (
        printed(name)[symbol] for name, symbol in (("reduced driving", "M_d"), ("reduced inertia", "J1"))
    )
    (omega, of_omega), (epsilon, half) = (
        printed("crank speed")["omega"],
        printed("crank angular acceleration")["epsilon"],
    )
    whole, slope = shafts + inertia, float(reduction.reduced_inertia_slope)
    found = (moment + driving) / whole - omega**2 * slope / (2.0 * whole)
    room = (of_driving + abs(epsilon) * of_shafts + omega * abs(slope) * of_omega) / whole + half
    assert abs(found - epsilon) <= room
    # with the other sign of J_II' it would be -2.46
    assert room < 0.01


def test_the_moment_has_one_sign_in_all_chapters(coursework: ct.Mechanism) -> None:
    """Reduction, flywheel, reactions and force polygons."""
    phi = np.radians([10.0, 99.1, 250.0])
    reduced = ct.reduce(coursework, at=phi)
    machine = ct.steady_motion(coursework, at=phi)
    scale = float(np.abs(reduced.reduced_moment).max())
    assert np.allclose(machine.moment_of_loads, reduced.reduced_moment, rtol=0, atol=1e-12 * scale)
    slopes = machine.inertia_slope_of_links, reduced.reduced_inertia_slope
    assert np.allclose(*slopes, rtol=0, atol=1e-12 * float(np.abs(slopes[1]).max()))
    reactions = ct.reactions(coursework, at=[AT])
    polygons = ct.force_polygons(coursework, at=AT)
    given = float(reactions.balancing[0, 0])
    assert given > 0.0 > float(reduced.reduced_moment[1])
    for value in (polygons.balancing["OA"], polygons.work["OA"], polygons.levers[0].balancing):
        assert abs(value - given) <= 1e-9 * given


# The motion stays what it is: mirrored senses of an angle, a displacement, a distance, of an angle on the sphere.

ODD = ("reduced_inertia_slope", "reduced_moment", "reduced_moment_part", "drive_rate")
ODD_MOTION = (
    "velocity_coefficient",
    "angular_velocity_coefficient",
    "slide_velocity_coefficient",
    "joint_velocity_coefficient",
)
MIRRORED = [
    ("six-bar-press", '{ zero = "100 deg", sense = "clockwise" }', "rad"),
    ("elliptic-trammel", '{ zero = "0.3 m", sense = "against" }', "m"),
    ("spherical-crank-rocker", '{ link = "AB", zero = "-20 deg", sense = "clockwise" }', "rad"),
    ("third-class-triad", '{ zero = "1 rad", sense = "clockwise" }', "rad"),
    ("cam-driven-linkage", '{ zero = "1 rad", sense = "clockwise" }', "rad"),
]


def same_but_for_signs(one: xr.Dataset, other: xr.Dataset, odd: tuple[str, ...]) -> None:
    """Every number of one is that of the other, with the other sign where the coordinate has an odd power in it."""
    for name, values in one.data_vars.items():
        if values.dtype.kind != "f" or name in ("residual", "jumps", "event_value"):
            continue
        mirrored = (-1.0 if name in odd else 1.0) * other[name]
        scale = max(1.0, float(np.abs(values).max())) if values.size else 1.0
        assert np.allclose(values, mirrored, rtol=0, atol=1e-10 * scale, equal_nan=True), name


@pytest.mark.parametrize(("name", "coordinate", "unit"), MIRRORED, ids=[row[0] for row in MIRRORED])
def test_a_mirrored_coordinate_changes_signs_and_not_the_motion(
    name: str, coordinate: str, unit: str
) -> None:
    plain, chosen = ct.example(name), with_coordinate(name, coordinate)
    plain = plain.model_copy(update={"study": ct.Study()})
    one, other = (ct.motion(mechanism, samples=7, stop=None) for mechanism in (plain, chosen))
    drive = chosen.motion_parameter.drives[0]
    assert drive.unit == unit
    assert np.allclose(other.drive_value, drive.zero - one.drive_value, rtol=0, atol=1e-12)
    same_but_for_signs(one, other, ODD_MOTION)


@pytest.mark.parametrize(("name", "coordinate"), [MIRRORED[0][:2], MIRRORED[2][:2]], ids=["plane", "sphere"])
def test_moments_and_first_derivatives_change_their_signs(name: str, coordinate: str) -> None:
    plain, chosen = ct.example(name), with_coordinate(name, coordinate)
    zero = chosen.motion_parameter.drives[0].zero
    at = np.array([0.3, 1.1, 2.9])
    one, other = ct.reduce(plain, at=at), ct.reduce(chosen, at=zero - at)
    same_but_for_signs(one, other, (*ODD, "reduced_inertia_slope_part"))
    # so power is that of the mechanism, whatever the coordinate
    power = [data.reduced_moment * data.drive_rate for data in (one, other)]
    assert np.allclose(*power, rtol=1e-10, atol=0)


def test_a_slider_that_drives_itself() -> None:
    """A mass on a line: s = 0.5 m - x, so x' = -1, J = m and M = -F."""
    slider = ct.parse_mechanism(
        """
        [frame.points]
        O = [0, 0]
        [links.slider]
        points = { A = [0, 0] }
        mass = 2
        [[guides]]
        point = "A"
        through = "O"
        direction = [1, 0]
        link = "slider"
        [[drives]]
        guide = "A"
        speed = 0.4
        [[loads]]
        kind = "force"
        point = "A"
        vector = [3, 0]
        [study]
        coordinate = { guide = "A", zero = "500 mm", sense = "against" }
        """
    )
    at = [0.1, 0.5]
    motion, reduction = ct.motion(slider, at=at), ct.reduce(slider, at=at)
    assert np.allclose(motion.position.sel(point="A", axis="x"), [0.4, 0.0], rtol=0, atol=4 * EPS)
    assert np.allclose(motion.velocity_coefficient.sel(point="A", axis="x"), -1.0, rtol=0, atol=0)
    assert np.allclose(motion.velocity.sel(point="A", axis="x"), 0.4, rtol=0, atol=EPS)
    assert np.allclose(motion.time, [1.0, 0.0], rtol=0, atol=4 * EPS)
    assert np.allclose(reduction.reduced_inertia, 2.0, rtol=0, atol=0)
    assert np.allclose(reduction.reduced_moment, -3.0, rtol=0, atol=0)


CRANK_DRIVEN_BY_ITS_SLIDER = """
[frame.points]
O = [0, 0]
[links.OA]
length = 1
mass = 1
centre = [0.5, 0]
inertia = 0.1
[links.AB]
length = 3
mass = 2
centre = [1.5, 0]
inertia = 0.3
[links.slider]
points = { B = [0, 0] }
mass = 3
[[guides]]
point = "B"
through = "O"
direction = [1, 0]
link = "slider"
[[drives]]
guide = "B"
start = 3
speed = -0.5
[assembly]
sides = { A = "left" }
[[loads]]
kind = "torque"
link = "OA"
value = 5
"""


def test_a_slider_that_drives_gives_the_same_power_by_all_routes() -> None:
    """Force polygons, lever, virtual work and reactions along s = 4 m - x; R01, R32 and the rest do not change."""
    plain = ct.parse_mechanism(CRANK_DRIVEN_BY_ITS_SLIDER)
    chosen = ct.parse_mechanism(
        CRANK_DRIVEN_BY_ITS_SLIDER + '[study]\ncoordinate = { guide = "B", zero = "4 m", sense = "against" }'
    )
    one, other = ct.force_polygons(plain, at=3.0), ct.force_polygons(chosen, at=1.0)
    given = -one.balancing["B"]
    assert other.speed == {"B": 0.5}
    forces = (other.balancing["B"], other.work["B"], other.levers[0].balancing)
    for value in (*forces, float(ct.reactions(chosen, at=[1.0]).balancing[0, 0])):
        assert abs(value - given) <= 1e-12 * abs(given)
    assert other.reactions == pytest.approx(one.reactions, abs=1e-12)


def test_a_cylinder_has_no_length_at_the_upper_end_of_a_mirrored_coordinate() -> None:
    bar = """
        [frame.points]
        O = [0, 0]
        D = [2, 0]
        [links.OA]
        length = 2
        angle = "40 deg"
        [[drives]]
        distance = ["D", "A"]
        speed = 0.1
        """
    plain = ct.parse_mechanism(bar)
    chosen = ct.parse_mechanism(bar + '[study]\ncoordinate = { zero = "5 m", sense = "against" }')
    low, high = ct.rotatability(plain).limits
    least, most = ct.rotatability(chosen).limits
    assert (low.end, high.end, least.end, most.end) == ("low", "high") * 2
    assert most.value == 5.0
    assert abs(least.value - 1.0) <= 4 * EPS
    assert (low.value, high.value) == pytest.approx((0.0, 4.0), abs=4 * EPS)
    assert str(most.condition) == str(low.condition)
    same_but_for_signs(ct.motion(plain, samples=5), ct.motion(chosen, samples=5), ODD_MOTION)


# What a choice does not touch, and what it is written and read as.


def test_the_quantity_itself_as_coordinate_gives_the_same_bits() -> None:
    plain = ct.example("six-bar-press").model_copy(update={"study": ct.Study()})
    chosen = with_coordinate("six-bar-press", '{ sense = "counter-clockwise" }')
    one, other = ct.motion(plain, samples=13), ct.motion(chosen, samples=13)
    assert all(values.equals(other[name]) for name, values in one.data_vars.items())
    assert np.array_equal(one.drive_value, other.drive_value)


def test_labels_name_the_coordinate(coursework: ct.Mechanism) -> None:
    motion, spelling = ct.motion(coursework, at=[AT]), PlainSpelling(coursework.display)
    assert spelling.text(instant_title(coursework, motion, 0)) == "φ = 99.1 deg"
    label = motion_abscissa(coursework, motion).label
    assert spelling.text(label.text) == "generalised coordinate φ"


def test_it_is_written_back_and_kept_with_a_range(coursework: ct.Mechanism) -> None:
    assert ct.parse_mechanism(ct.mechanism_text(coursework)) == coursework
    assert coursework.with_range("reachable").study.coordinate == coursework.study.coordinate


def test_load_formulas_have_the_coordinate_as_q() -> None:
    text = ct.mechanism_text(ct.example("crank-rocker"))
    load = '\n[[loads]]\nkind = "torque"\nlink = "OA"\nvalue = "2*q"\n'
    chosen = '\n[study]\ncoordinate = { zero = "1 rad", sense = "clockwise" }\n'
    head = text.split("[study]")[0]
    reduction = ct.reduce(ct.parse_mechanism(head + load + chosen), at=[0.25])
    # the torque acts on the link, counter-clockwise, and the coordinate turns the other way
    assert abs(float(reduction.reduced_moment_part.sel(load="torque OA")[0]) + 2 * 0.25) <= 4 * EPS


FILE = """
[frame.points]
O = [0, 0]
D = [4, 0]
[links.OA]
length = 1
[links.AB]
length = 3.5
[links.DB]
length = 3
[[drives]]
link = "OA"
start = 0
speed = 1
[assembly]
sides = { B = "left" }
[study]
coordinate = CHOSEN
"""


@pytest.mark.parametrize(
    ("chosen", "message"),
    [
        (
            '{ link = "OB" }',
            '[study.coordinate] link: unknown link "OB"; did you mean "OA"',
        ),
        (
            '{ link = "AB" }',
            '[study.coordinate] link: "AB" is not driven; the coordinate is that of the drive: name OA',
        ),
        ('{ guide = "B" }', '[study.coordinate] guide: unknown guide "B"'),
        ('{ sense = "left" }', '[study.coordinate] sense: expected one of "counter-clockwise"'),
        (
            '{ sense = "against" }',
            '[study.coordinate] sense: the sense "against" does not fit what is driven; '
            "use one of counter-clockwise, clockwise",
        ),
        ('{ zero = "2 mm" }', '[study.coordinate] zero: expected an angle (rad), got "2 mm"'),
        ('"clockwise"', "[study] coordinate: expected a table"),
        ('{ zeros = "2 rad" }', '[study] coordinate: unknown key "zeros"; did you mean "zero"?'),
    ],
)
def test_what_is_wrong_with_a_coordinate(chosen: str, message: str) -> None:
    with pytest.raises(InputError) as refused:
        ct.parse_mechanism(FILE.replace("CHOSEN", chosen), "")
    assert message in str(refused.value)


def test_a_bare_number_needs_its_unit_where_degrees_are_displayed() -> None:
    text = 'display = { angle = "deg" }\n' + FILE.replace("CHOSEN", "{ zero = 219.1 }")
    with pytest.raises(InputError, match=r"219.1 is an angle without a unit"):
        ct.parse_mechanism(text)


def test_several_drives_have_no_chosen_coordinate() -> None:
    with pytest.raises(InputError, match=r"a mechanism with one drive, and it has 2; remove the coordinate"):
        with_coordinate("five-bar-two-drives", '{ link = "OA" }')
