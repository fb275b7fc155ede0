"""Instant centres: two independent routes agree, Kennedy's theorem holds, joints and textbooks are met."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import centrode as ct
from centrode.analysis.instant_centres.bodies import ROUNDED, bodies_of
from centrode.analysis.instant_centres.centres import Case
from centrode.analysis.instant_centres.kennedy import construct_centres
from growing import KINDS, descriptions, grown, mechanism_of
from growing_higher import grown_higher, higher_descriptions
from mechanisms import EPS, conditioning, moved, point, solved_at
from samples import few

WORTH = 1e5
"""Positions whose condition is worse than this prove nothing about centres and are passed over."""


def at_start(parts: dict[str, Any]) -> tuple[Any, float]:
    """The motion in the initial position, and what rounding may do to its velocities."""
    mechanism = mechanism_of(parts)
    start = parts["drives"][0]["start"]
    motion = ct.motion(mechanism, at=[start])
    assume(motion.status[0] == ct.Status.OK)
    (solved,) = solved_at(mechanism, start)
    condition = conditioning(solved, tries=4)
    assume(condition[1, 0] < WORTH)
    return motion, 16 * EPS * float(condition[0, 0] + condition[1, 0])


def places(centres: Any, sample: int = 0) -> dict[tuple[str, str], complex]:
    """Finite centres by their bodies."""
    names = [tuple(str(label).split(",")) for label in centres["pair"].values]
    values = centres["centre"].to_numpy()[sample]
    return {name: complex(*at) for name, at in zip(names, values, strict=True) if np.isfinite(at).all()}


@settings(max_examples=few(12, 40))
@given(descriptions())
def test_the_constructed_centres_have_no_relative_velocity(parts: dict[str, Any]) -> None:
    motion, rounding = at_start(parts)
    made = construct_centres(motion)
    assert len(made.steps) == len(made.bodies) * (len(made.bodies) - 1) // 2
    for step in made.steps:
        assert made.mismatch[step.pair] <= step.error + rounding, step


@settings(max_examples=few(3, 6))
@given(higher_descriptions())
def test_groups_of_higher_class_too(parts: dict[str, Any]) -> None:
    try:
        mechanism = mechanism_of(parts)
        motion = ct.motion(mechanism, at=[parts["drives"][0]["start"]])
    except ct.InputError:
        assume(False)  # a plate on the frame alone: nothing drives it
    assume(motion.status[0] == ct.Status.OK)
    made = construct_centres(motion)
    residual = float(motion.residual[0])
    for step in made.steps:
        # positions that close to the residual: so do the velocities, over the conditioning that the step knows
        assert made.mismatch[step.pair] <= 64 * (step.error + residual), step


@settings(max_examples=few(10, 30))
@given(descriptions())
def test_three_centres_lie_on_a_line(parts: dict[str, Any]) -> None:
    """Kennedy's theorem for every triple, those at infinity included."""
    motion, rounding = at_start(parts)
    bodies = bodies_of(motion)
    size = max(bodies.scale, float(np.abs(bodies.place).max()))
    spots, errors = homogeneous(motion, size, rounding)
    for triple in combinations(range(len(bodies.names)), 3):
        pairs = [(b, a) for a, b in combinations(triple, 2)]
        if all(pair in spots for pair in pairs):
            volume = abs(np.linalg.det([spots[pair] for pair in pairs]))
            assert volume <= sum(errors[pair] for pair in pairs), triple


def homogeneous(motion: Any, size: float, rounding: float) -> tuple[dict[Any, Any], dict[Any, float]]:
    """Unit vectors of the centres with their errors: of the velocities, over the velocity field's own size."""
    bodies, centres = bodies_of(motion), ct.instant_centres(motion)
    spots, errors = {}, {}
    for column, label in enumerate(map(str, centres["pair"].values)):
        first, second = (bodies.names.index(name) for name in label.split(","))
        at, way = (centres[name].to_numpy()[0, column] / unit for name, unit in
                   (("centre", size), ("centre_direction", 1.0)))  # fmt: skip
        if np.isfinite(at).all():
            vector = np.append(at, 1.0)
        elif np.isfinite(way).all():
            vector = np.append(way, 0.0)
        else:
            continue
        moving, spin = bodies.relative((first, second))
        arm = bodies.place[0, first] / size
        field = abs(spin[0]) * np.hypot(abs(arm + 1j * moving[0] / size / (spin[0] or 1.0)), 1.0)
        field = max(float(field), abs(moving[0]) / size) * size / float(bodies.rate[0])
        spots[first, second] = vector / np.linalg.norm(vector)
        # a spin that counts as none is one of up to ROUNDED
        errors[first, second] = (8 * rounding + (0.0 if vector[2] else ROUNDED * size / bodies.scale)) / field
    return spots, errors


def test_four_bar_by_its_lines() -> None:
    """P20 is where the cranks meet, P31 where coupler and frame do."""
    motion = ct.motion(ct.four_bar(1, 3.5, 3, 4, side="left"), at=np.linspace(0.3, 6.0, 7))
    centres = ct.instant_centres(motion, [("coupler", "frame"), ("crank", "rocker")])
    o, a, b, d = (point(motion, name) for name in "OABD")

    def meeting(p: Any, q: Any, r: Any, s: Any) -> Any:
        share = np.imag(np.conj(s - r) * (r - p)) / np.imag(np.conj(s - r) * (q - p))
        return p + share * (q - p), 1.0 / np.abs(np.sin(np.angle((q - p) / (s - r))))

    for column, lines in enumerate(((o, a, d, b), (a, b, o, d))):
        found = centres["centre"].to_numpy()[:, column]
        expected, worse = meeting(*lines)
        allowed = 64 * EPS * worse**2 * np.maximum(np.abs(expected), 4.0)
        assert (np.abs(found[:, 0] + 1j * found[:, 1] - expected) <= allowed).all()
    assert (centres["centre_case"] == Case.DIRECTIONS).all()


def test_the_worked_mechanism_translates_at_a_quarter_turn() -> None:
    """Link 2 of the assignment: its centre is at infinity; link 3 turns about a place above C."""
    motion = ct.motion(ct.example("slider-between-cranks"), at=[np.pi / 2])
    centres = ct.instant_centres(motion, [("AC", "frame"), ("CB", "frame")])
    second, third = (centres.isel(sample=0, pair=k) for k in (0, 1))
    assert int(second.centre_case) == Case.TRANSLATION
    assert np.isnan(second.centre).all()
    np.testing.assert_allclose(second.centre_direction, [0.0, 1.0], atol=4 * EPS)
    # A stands at (0, 0.5), C on the line y = sin 0.5 with AC = 1; D closes the chain of the initial angles
    c = np.sqrt(1.0 - (np.sin(0.5) - 0.5) ** 2) + 1j * np.sin(0.5)
    d = 0.5 + np.exp(0.5j) + 1.2 * np.exp(1.9j) + 0.8 * np.exp(3.5j)
    b = point(motion, "B")[0]
    above = d + (b - d) * (c - d).real / (b - d).real  # on the line DB, perpendicular to the guide
    np.testing.assert_allclose(third.centre, [above.real, above.imag], rtol=1e-13)
    distance = above.imag - c.imag
    assert abs(float(motion.velocity.sel(point="C", axis="x")[0]) / distance) == pytest.approx(
        0.411, abs=5e-4
    )
    made = construct_centres(motion)
    assert made.step("AC", "frame").direction == pytest.approx((0.0, 1.0), abs=1e-13)
    np.testing.assert_allclose(made.step("CB", "frame").place, third.centre, rtol=1e-12)


@pytest.mark.parametrize("name", ["rolling-wheel-rod", "rack-and-pinion", "planetary-hypocycloid"])
def test_a_rolling_wheel_turns_about_its_contact(name: str) -> None:
    mechanism = ct.example(name)
    motion = ct.motion(mechanism, samples=7)
    wheel = mechanism.rolling[0]
    centres = ct.instant_centres(motion, [(wheel.link, wheel.on)])
    scale = float(np.abs(motion.position).max())
    moving = motion["status"].to_numpy() == ct.Status.OK
    np.testing.assert_allclose(
        centres["centre"].to_numpy()[moving, 0],
        motion["contact"].to_numpy()[moving, 0],
        atol=64 * EPS * scale,
    )
    assert (centres["centre_case"][moving] == Case.ROLLING).all()
    step = construct_centres(motion, 2).step(wheel.link, wheel.on)
    assert (step.how, step.name) == ("rolling", wheel.id)
    np.testing.assert_allclose(step.place, motion["contact"].to_numpy()[2, 0], atol=64 * EPS * scale)


def test_gears_meet_in_their_pitch_point() -> None:
    """Sun 24, planet 18, ring 60 mm: the pitch points lie on the arm, 24 and 60 mm from O."""
    motion = ct.motion(ct.example("planetary-gear-train"), at=np.linspace(0.0, 5.0, 6))
    centres = ct.instant_centres(motion, [("sun", "planet"), ("planet", "frame")])
    arm = np.exp(2j / 7 * np.linspace(0.0, 5.0, 6))
    for column, radius in enumerate((0.024, 0.060)):
        found = centres["centre"].to_numpy()[:, column]
        np.testing.assert_allclose(found[:, 0] + 1j * found[:, 1], radius * arm, atol=64 * EPS * 0.06)
    assert (centres["centre_case"] == Case.ROLLING).all()
    step = construct_centres(motion, 3).step("planet", "sun")
    assert (step.how, step.name) == ("gear", "sun-planet")
    assert complex(*step.place) == pytest.approx(0.024 * arm[3], abs=64 * EPS)


TRAIN = """
[frame.points]
O = [0, 0]
[links.sun]
points = { O = [0, 0] }
[links.OA]
length = 42
[links.planet]
points = { A = [0, 0], M = [18, 0] }
angle = 0
[[gears]]
links = ["sun", "planet"]
carrier = "OA"
ratio = "-24/18"
[[drives]]
link = "OA"
start = 0
speed = 1
[[drives]]
link = "sun"
start = 0
speed = SUN
"""


@pytest.mark.parametrize(
    ("planet", "case"),
    [
        (1.0, Case.SAME_SENSE),
        (-4.0, Case.OPPOSITE_SENSE),
        (0.0, Case.TRANSLATION),
        (-42 / 18, Case.STANDSTILL),
    ],
)
def test_parallel_velocities_are_told_apart(planet: float, case: Case) -> None:
    """A planet that turns at `planet`: its points A and M on the line of the arm move upright to it."""
    sun = 1.0 + (1.0 - planet) * 18 / 24
    motion = ct.motion(ct.parse_mechanism(TRAIN.replace("SUN", repr(sun))), at=[0.0])
    centre = ct.instant_centres(motion, [("planet", "frame")]).isel(sample=0, pair=0)
    assert int(centre.centre_case) == case
    if case is Case.TRANSLATION:
        np.testing.assert_allclose(centre.centre_direction, [1.0, 0.0], atol=4 * EPS)
    else:
        np.testing.assert_allclose(centre.centre, [42 - 42 / planet, 0.0], atol=64 * EPS * 60)
    made = construct_centres(motion)  # two drives: the theorem is not enough, and it says so
    assert [step.how for step in made.steps] == ["hinge"] * 4 + ["gear", "field"]
    assert max(made.mismatch.values()) <= 64 * EPS


def test_every_case_has_its_word() -> None:
    assert len({case.word for case in Case}) == len(Case) == len({case.sentence for case in Case})
    motion = ct.motion(ct.example("slider-between-cranks"), at=[np.pi / 2])
    flags = ct.instant_centres(motion)["centre_case"].attrs
    assert flags["flag_meanings"].split() == [case.name.lower() for case in Case]


def test_a_point_that_slides_has_a_body_of_its_own() -> None:
    motion = ct.motion(ct.example("slider-between-cranks"), at=[1.0])
    centres = ct.instant_centres(motion)
    assert centres.sizes["pair"] == 15  # frame, four links and the slider
    found = centres.sel(pair="slider C,frame")
    assert int(found.centre_case[0]) == Case.TRANSLATION
    np.testing.assert_allclose(found.centre_direction[0], [0.0, 1.0], atol=4 * EPS)
    np.testing.assert_allclose(places(centres)["slider C", "CB"], point(motion, "C")[0], rtol=16 * EPS)


def test_bodies_at_rest_against_each_other_have_no_centre() -> None:
    """Two links that share two points are one body; the rest of the construction goes on."""
    parts = {
        "frame": {"points": {"O": [0, 0], "D": [4, 0]}},
        "links": {
            "OA": {"length": 1},
            "AB": {"points": {"A": [0, 0], "B": [3.5, 0]}},
            "bar": {"points": {"A": [0, 0], "B": [3.5, 0]}},
            "DB": {"length": 3},
        },
        "drives": [{"link": "OA", "start": 1, "speed": 1}],
        "assembly": {"sides": {"B": "left"}},
    }
    motion = ct.motion(ct.Mechanism(**parts), at=[1.0])
    assert int(ct.instant_centres(motion, [("bar", "AB")]).centre_case[0, 0]) == Case.REST
    made = construct_centres(motion)
    assert made.step("bar", "AB").how == "rest"
    assert max(made.mismatch.values()) <= 1e-13


def test_a_triangle_of_links_is_rigid() -> None:
    """Two rods between two points of a crank stand still against it: their centres are not on a line."""
    parts = {
        "frame": {"points": {"O": [0, 0]}},
        "links": {
            "crank": {"points": {"O": [0, 0], "A": [1, 0], "B": [0, 1]}},
            "AC": {"length": 1.2},
            "BC": {"length": 1.1},
        },
        "drives": [{"link": "crank", "start": 0.3, "speed": 1}],
        "assembly": {"sides": {"C": "left"}},
    }
    made = construct_centres(ct.motion(ct.Mechanism(**parts), at=[0.3]))
    for pair in (("AC", "crank"), ("BC", "crank"), ("BC", "AC")):
        assert made.step(*pair).how == "rest"
    for link in ("AC", "BC"):
        assert made.step(link, "frame").how == "together"
        assert made.step(link, "frame").place == pytest.approx((0.0, 0.0), abs=16 * EPS)


@pytest.mark.parametrize("group", ["triad", "four sides"])
def test_where_no_two_lines_tell_one_centre_comes_from_the_velocities(group: str) -> None:
    """Groups of the third and the fourth class on moving bodies: the theorem alone stops, and the step says so."""
    parts = grown_higher([group], 3)
    motion = ct.motion(mechanism_of(parts), at=[parts["drives"][0]["start"]])
    made = construct_centres(motion)
    assert [step.how for step in made.steps].count("field") == 1
    assert all(made.mismatch[step.pair] <= step.error for step in made.steps)


@settings(max_examples=few(8, 20))
@given(st.sampled_from(KINDS), st.integers(0, 2**16))
def test_a_turned_and_moved_mechanism_has_its_centres_turned_and_moved(kind: str, seed: int) -> None:
    parts = grown([kind], seed)
    motion, rounding = at_start(parts)
    turn, shift = 0.7, (3.0, -2.0)
    other = moved(parts, turn=turn, shift=shift)
    for name, link in other["links"].items():
        assert link["angle"] == parts["links"][name]["angle"] + turn
    again = ct.motion(mechanism_of(other), at=[other["drives"][0]["start"]])
    before, after = places(ct.instant_centres(motion)), places(ct.instant_centres(again))
    for pair in before.keys() & after.keys():
        expected = before[pair] * np.exp(1j * turn) + complex(*shift)
        far = 1.0 + abs(before[pair]) ** 2  # the relative spin is small where the centre is far
        assert abs(after[pair] - expected) <= 256 * rounding * far * spread(motion, pair)


def spread(motion: Any, pair: tuple[str, str]) -> float:
    """Greatest velocity over the velocity field of a pair: how its centre answers to the velocities."""
    bodies = bodies_of(motion)
    moving, spin = bodies.relative((bodies.number(pair[0]), bodies.number(pair[1])))
    return float(bodies.rate[0] / (abs(spin[0]) * bodies.scale + abs(moving[0])))
