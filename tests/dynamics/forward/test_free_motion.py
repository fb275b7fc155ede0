"""Free motions against closed forms, laws of mechanics, and motions by other formulas."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from tools.campaigns.free_motions.references import position_of_squares

import centrode as ct
from centrode.dynamics.forward_dynamics.batches import integrate_many
from centrode.dynamics.forward_dynamics.free_loads import DriveEffort
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion, free_motion_of
from centrode.dynamics.forward_dynamics.motion_steps import MotionSteps
from centrode.dynamics.forward_dynamics.trajectory import Trajectory
from centrode.errors import InputError, NotComputedYet
from dynamics.forward.free_descriptions import (
    four_bar,
    mechanism,
    parallelogram,
    rod,
    slider_crank,
)
from free_motions import squares

TIGHT = 1e-12


def moved(
    parts: dict[str, object], duration: float, tolerance: float = TIGHT, **speeds: float
) -> tuple[FreeMotion, Trajectory]:
    free = free_motion_of(mechanism(parts))
    start = free.initial({path.replace("_", "."): speed for path, speed in speeds.items()})
    return free, free.integrate(start, duration, tolerance, samples=41)


# Closed forms.


def upright(loops: int) -> FreeMotion:
    """Squares of IFToMM's A02."""
    return free_motion_of(ct.parse_mechanism(squares(loops)))


def test_forty_squares_pass_their_change_points() -> None:
    """IFToMM's A02: with all squares flat mobility jumps by 40, twenty times; B0 within a millionth over 20 s."""
    free = upright(40)
    times = np.linspace(0.0, 20.0, 81)
    course = free.integrate(free.initial({"points.B0": (1.0, 0.0)}), 20.0, TIGHT, at=times)
    places = course.places[:, free.points.index("B0")]
    assert np.max(np.abs(places - position_of_squares(40, times))) <= 1e-6
    # the closed form at 20 s by elliptic functions of 25 digits
    assert math.dist(places[-1], (0.4109011537629452221452456, 0.9116799009719806516314131)) <= 1e-6
    assert course.ended == "duration" and {event.kind for event in course.events} == {"crossing"}
    # energy before and behind each of them, over the greatest kinetic energy there
    assert max(abs(event.detail) for event in course.events) <= 1e-9 * 9.81 * 81


def test_instants_inside_a_detour_lie_on_the_motion() -> None:
    """Around a change point positions come from Taylor's coefficients: against the energy of the turning squares."""
    free = upright(1)
    start = free.initial({"points.B0": (1.0, 0.0)})
    first = free.integrate(start, 1.0, TIGHT, at=[1.0]).events[0].time
    times = np.linspace(first - 0.15, first + 0.15, 31)
    course = free.integrate(start, 1.0, TIGHT, at=times)
    assert {0, 1} == set(course.statuses)
    # theta'^2 = 1 + 2 P/I (1 - cos theta), theta from the vertical
    inertia, weight = 2 / 3 + 1, (1 + 1) * 9.81
    theta = np.pi / 2 - course.angles[:, free.links.index("A0B0")]
    rate = np.sqrt(1.0 + 2.0 * weight / inertia * (1.0 - np.cos(theta)))
    assert np.max(np.abs(-course.angular_velocities[:, free.links.index("A0B0")] - rate)) <= 1e-9


# Laws of mechanics.


@pytest.mark.parametrize(
    "parts",
    [four_bar(), slider_crank(), parallelogram(2), parallelogram(3)],
    ids=["four-bar", "slider", "two", "three"],
)
def test_energy_stays(parts: dict[str, object]) -> None:
    free, course = moved(parts, 2.0, 1e-11)
    weight = 9.81 * sum(mass.mass for mass in free.equations.masses)
    assert course.ended == "duration"
    assert np.max(np.abs(course.energy_residual)) <= 1e-9 * weight * float(free.equations.numbers.scale)
    assert np.max(course.position_residual) <= 1e-13 and np.max(course.velocity_residual) <= 1e-11


def test_a_repeated_crank_changes_nothing() -> None:
    """Three cranks or two, the third without weight in the balance: its mass is put on the second."""
    one, other = parallelogram(3), parallelogram(2)
    other["links"]["bar"] = one["links"]["bar"]  # type: ignore[index]
    other["links"]["crank1"] |= {"mass": 1.0}  # type: ignore[index]
    first, found = moved(one, 1.5)
    second, expected = moved(other, 1.5)
    assert first.redundant == 1 and second.redundant == 0 and first.mobility == second.mobility == 1
    link = first.links.index("crank0"), second.links.index("crank0")
    assert np.max(np.abs(found.angles[:, link[0]] - expected.angles[:, link[1]])) <= 1e-10
    assert np.isnan(found.multipliers).any() and not np.isnan(expected.multipliers).any()


def test_momentum_about_a_free_axis_stays() -> None:
    """Two rods on a pivot, without gravity, joined by a spring: forces inside give no moment about the pivot."""
    parts = {
        "frame": {"points": {"O": [0.0, 0.0]}},
        "links": {"one": rod("O", "Q", 1.0, 0.3), "two": rod("Q", "R", 0.6, 1.2)},
        "loads": [
            {"kind": "spring", "link": "two", "relative_to": "one", "stiffness": 4.0, "free_angle": 0.4}
        ],
    }
    free = free_motion_of(mechanism(parts))
    course = free.integrate(free.initial({"links.one": 2.0, "links.two": -3.0}), 3.0, TIGHT, samples=31)
    angular = np.zeros(31)
    for mass, ends in zip(free.equations.masses, (("O", "Q"), ("Q", "R")), strict=True):
        both = [free.points.index(name) for name in ends]
        place, velocity = (np.mean(x[:, both], axis=1) for x in (course.places, course.velocities))
        angular += float(mass.mass) * (place[:, 0] * velocity[:, 1] - place[:, 1] * velocity[:, 0])
        angular += float(mass.moment_of_inertia) * course.angular_velocities[:, free.links.index(mass.link)]
    assert np.max(np.abs(angular - angular[0])) <= 1e-10
    assert np.max(np.abs(course.energy_residual)) <= 1e-10


def test_momentum_about_the_vertical_stays_on_the_sphere() -> None:
    """Two arcs on a vertical axis under their weights, which give no moment about it; sums over places of the arcs."""
    parts = {
        "space": "sphere",
        "gravity": [0.0, 0.0, -9.81],
        "frame": {"points": {"Z": [0, 0, 1], "X": [1, 0, 0]}},
        "links": {
            "ZA": {"length": 1.0, "reference": ["Z", "X"], "mass": 1.0, "shape": "arc", "angle": 0.3},
            "AB": {"length": 0.6, "reference": ["A", "Z"], "mass": 0.7, "shape": "arc", "angle": 0.8},
        },
    }
    free = free_motion_of(mechanism(parts))
    course = free.integrate(free.initial({"links.ZA": 2.0, "links.AB": -3.0}), 3.0, TIGHT, samples=31)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    momentum = np.zeros(31)
    for ends, length, mass in ((("Z", "A"), 1.0, 1.0), (("A", "B"), 0.6, 0.7)):
        first, last = (free.points.index(name) for name in ends)
        for share, weight in zip(0.5 + 0.5 * nodes, 0.5 * weights, strict=True):
            own = np.array([math.sin((1.0 - share) * length), math.sin(share * length)]) / math.sin(length)
            place, velocity = (
                own[0] * x[:, first] + own[1] * x[:, last] for x in (course.places, course.velocities)
            )
            momentum += mass * weight * (place[:, 0] * velocity[:, 1] - place[:, 1] * velocity[:, 0])
    assert np.max(np.abs(momentum - momentum[0])) <= 1e-10 * abs(momentum[0])
    assert np.ptp(course.speeds[:, 0]) > 1.0


def test_halved_steps_err_by_a_256th() -> None:
    """Steps of equal length, each closed: the scheme keeps its order 8 through the projections."""
    free = free_motion_of(mechanism(slider_crank()))
    start = free.initial({"links.OA": 3.0})
    best = free.integrate(start, 1.0, 1e-14, at=[1.0]).coordinates[0]
    errors = []
    for count in (16, 32, 64):
        row = np.concatenate([[0.0], free.integration.carried_values(start)])[:, None]
        for time in np.linspace(0.0, 1.0, count + 1)[1:]:
            steps = MotionSteps(row, "duration", None, 0)
            row = np.concatenate([[[time]], free.integration.states_at(steps, np.array([time]))])
        errors.append(float(np.max(np.abs(row[1 : 1 + free.equations.size, 0] - best))))
    orders = [math.log2(before / after) for before, after in itertools.pairwise(errors)]
    assert all(7.5 <= order <= 8.5 for order in orders), orders


def test_four_times_as_long_it_swings_twice_as_slowly() -> None:
    """Lengths times 4, masses by the rods' own: angles are the same at twice the times."""
    free, found = moved(four_bar(), 1.0)
    large, expected = moved(four_bar(1.2, 3.2, 2.4, 3.6), 2.0)
    assert np.max(np.abs(found.angles - expected.angles)) <= 1e-9
    assert large.points == free.points


def test_turned_with_its_weight_it_moves_the_same() -> None:
    """The frame and gravity turned by 50 degrees."""
    parts = four_bar()
    turn = math.radians(50.0)
    parts["frame"] = {"points": {"A": [0.0, 0.0], "D": [0.9 * math.cos(turn), 0.9 * math.sin(turn)]}}
    parts["gravity"] = [9.81 * math.sin(turn), -9.81 * math.cos(turn)]
    parts["drives"][0]["start"] += turn
    _free, found = moved(four_bar(), 1.0)
    _turned, expected = moved(parts, 1.0)
    assert np.max(np.abs(found.angles + turn - expected.angles)) <= 1e-9


# Masses, loads and drives.


def test_a_coupler_without_mass_is_the_limit_of_a_light_one() -> None:
    """The error of a coupler of m kg is in proportion to m: what is left of two light ones is that of none."""
    found = []
    for mass in (0.0, 1e-6, 2e-6):
        parts = four_bar()
        parts["links"]["BC"] = (
            rod("B", "C", 0.8, None, mass) if mass else {"points": {"B": [0, 0], "C": [0.8, 0]}}
        )
        free, course = moved(parts, 1.0)
        assert bool(free.equations.weights) == (mass == 0.0)
        found.append(course.angles[-1])
    assert np.max(np.abs(2.0 * found[1] - found[2] - found[0])) <= 1e-9


LOADS = [
    {"kind": "force", "point": "C", "vector": [3.0, -2.0]},
    {"kind": "force", "point": "B", "vector": ["2*x - 0.3*v", "-0.4*v + sin(q)*t"]},
    {"kind": "force", "point": "C", "vector": [1.0, 0.5], "axes": "AB"},
    {"kind": "torque", "link": "DC", "value": "0.2*x - 0.1*v", "relative_to": "BC"},
    {"kind": "torque", "link": "AB", "table": [[0.0, 0.3], [0.7, -0.4], [2.0, 0.5]], "over": "time"},
    {"kind": "spring", "points": ["A", "C"], "stiffness": 40.0, "free_length": 0.7},
    {"kind": "damper", "points": ["A", "C"], "damping": 3.0},
    {"kind": "spring", "link": "DC", "stiffness": 2.0, "free_angle": 0.4},
    {"kind": "damper", "link": "AB", "damping": 0.8},
    {"kind": "friction", "link": "DC", "viscous": 0.2, "quadratic": 0.1},
    {"kind": "weight", "point": "C", "value": 6.0},
]


@pytest.mark.parametrize("load", LOADS, ids=[f"{load['kind']} {number}" for number, load in enumerate(LOADS)])
def test_what_loads_do_is_what_energy_becomes(load: dict[str, object]) -> None:
    free, course = moved(four_bar(loads=[load]), 1.0, 1e-11, links_AB=3.0)
    turned_over = float(np.max(course.kinetic_energy))
    # a table has kinks, at which steps err by more than they tell
    bound = 1e-7 if "table" in load else 1e-9
    assert course.ended == "duration" and np.max(np.abs(course.energy_residual)) <= bound * turned_over
    label = next(one.label for one in free.equations.loads)
    assert np.any(np.abs(course.works[label]) > 1e-6)


@pytest.mark.parametrize(
    "load",
    [
        {"kind": "friction", "link": "DC", "quadratic": 0.5, "form": "plain sum"},
        {"kind": "force", "point": "C", "vector": [1.0, 0.0], "while_moving": [0.0, 1.0]},
    ],
)
def test_what_jumps_with_the_sense_of_the_motion_is_refused_by_name(load: dict[str, object]) -> None:
    with pytest.raises(NotComputedYet, match="loads"):
        free_motion_of(mechanism(four_bar(loads=[load])))


def test_a_kept_drive_takes_what_the_motion_takes() -> None:
    """A crank at constant speed under its weights: positions of the motion, and the moment of the reactions."""
    made = mechanism(four_bar())
    free = free_motion_of(made, keeps=["AB"])
    assert free.mobility == 0
    course = free.integrate(free.initial({"drives.AB": 1.0}), 2.0, TIGHT, samples=9)
    values = math.pi / 3 + course.time
    motion = ct.motion(made, at=values)
    found = course.places[:, [free.points.index(name) for name in motion.point.values]]
    assert np.max(np.abs(found - motion.position.values)) <= 1e-11
    assert np.max(np.abs(course.energy_residual)) <= 1e-11
    moments = ct.reactions(made, at=values).balancing.values[:, 0]
    assert np.max(np.abs(course.kept_forces["AB"] - moments)) <= 1e-10 * np.max(np.abs(moments))


def test_a_moment_on_the_drive_is_a_load() -> None:
    effort = DriveEffort("AB", lambda _m, t, _q, v: 2.0 * t - 0.5 * v)
    free = free_motion_of(mechanism(four_bar()), efforts=[effort])
    found = free.integrate(free.initial(), 1.0, TIGHT, samples=5)
    load = {"kind": "torque", "link": "AB", "value": "2*t - 0.5*v"}
    _free, expected = moved(four_bar(loads=[load]), 1.0)
    assert np.max(np.abs(found.angles[-1] - expected.angles[-1])) <= 1e-12
    assert abs(found.works["drive AB"][-1] - expected.works["torque AB"][-1]) <= 1e-12


# The start.


def test_speeds_that_are_given_are_kept_and_the_others_follow() -> None:
    made = mechanism(slider_crank())
    free = free_motion_of(made)
    for path, speed in (
        ("links.OA", 2.0),
        ("guides.B", -0.3),
        ("drives.OA", 2.0),
        ("points.A", (-0.128, 0.153)),
    ):
        start = free.initial({path: speed}) if path != "points.A" else free.initial({"links.OA": 1.0})
        if path == "points.A":
            velocity = free.integrate(start, 0.1, 1e-9, at=[0.0]).velocities[0, free.points.index("A")]
            start = free.initial({path: tuple(velocity)})
            assert abs(free.integrate(start, 0.1, 1e-9, at=[0.0]).angular_velocities[0, 0] - 1.0) <= 1e-12
            continue
        course = free.integrate(start, 0.1, 1e-9, at=[0.0])
        found = course.slide_speeds[0, 0] if path == "guides.B" else course.angular_velocities[0, 0]
        assert abs(found - speed) <= 1e-12  # type: ignore[operator]
        assert course.velocity_residual[0] <= 1e-13


@pytest.mark.parametrize(
    ("speeds", "named"),
    [
        ({"links.OA": 1.0, "guides.B": 5.0}, "guides.B"),
        ({"points.O": (1.0, 0.0)}, "points.O"),
        ({"links.nothing": 1.0}, "links.nothing"),
    ],
)
def test_speeds_that_cannot_be_are_refused_by_name(speeds: dict[str, object], named: str) -> None:
    with pytest.raises(InputError, match=named):
        free_motion_of(mechanism(slider_crank())).initial(speeds)


def test_a_drive_starts_where_it_is_asked_to() -> None:
    free = free_motion_of(mechanism(four_bar()))
    start = free.initial(values={"drives.AB": 2.0})
    there = ct.motion(mechanism(four_bar()), at=[2.0])
    course = free.integrate(start, 0.1, 1e-9, at=[0.0])
    found = course.places[0, [free.points.index(name) for name in there.point.values]]
    assert np.max(np.abs(found - there.position.values[0])) <= 1e-12


def test_bad_wishes_are_refused() -> None:
    free = free_motion_of(mechanism(four_bar()))
    start = free.initial()
    for duration in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(InputError, match="duration"):
            free.integrate(start, duration)
    with pytest.raises(InputError, match="instants"):
        free.integrate(start, 1.0, at=[0.0, 2.0])
    with pytest.raises(InputError, match="scheme"):
        free.integrate(start, 1.0, scheme="euler")
    light = four_bar(loads=[{"kind": "torque", "link": "AB", "value": 1.0}])
    for link in light["links"].values():
        link.pop("mass"), link.pop("shape")
    with pytest.raises(InputError, match="no mass"):
        free_motion_of(mechanism(light))


def test_a_motion_that_grows_without_bound_is_stopped_with_its_time() -> None:
    load = {"kind": "torque", "link": "OA", "value": "v*abs(v)"}
    parts = {
        "frame": {"points": {"O": [0.0, 0.0]}},
        "links": {"OA": rod("O", "A", 1.0, 0.0)},
        "loads": [load],
    }
    free = free_motion_of(mechanism(parts))
    # w' = 3 w^2 from w = 1: beyond t = 1/3 there is none
    course = free.integrate(free.initial({"links.OA": 1.0}), 1.0, 1e-9)
    assert course.ended in ("blow-up", "step size") and course.cause is not None
    assert 0.33 < course.time[-1] <= 1 / 3


# Routes.


def test_python_and_machine_code_agree() -> None:
    free = free_motion_of(mechanism(slider_crank()))
    start = free.initial({"links.OA": 3.0})
    one, other = (
        free.integrate(start, 1.0, 1e-11, at=[0.5, 1.0], executor=executor) for executor in ("auto", "arrays")
    )
    assert other.executor == "arrays"
    assert np.max(np.abs(one.coordinates - other.coordinates)) <= 1e-10


def test_the_stiff_scheme_agrees() -> None:
    parts = slider_crank(loads=[{"kind": "damper", "link": "OA", "damping": 500.0}])
    free = free_motion_of(mechanism(parts))
    one, other = (
        free.integrate(free.initial(), 0.5, 1e-9, at=[0.1, 0.5], scheme=scheme)
        for scheme in ("adaptive", "stiff")
    )
    assert other.steps < one.steps
    assert np.max(np.abs(one.coordinates - other.coordinates)) <= 1e-7


def test_many_at_once_are_as_many_one_by_one() -> None:
    made = mechanism(four_bar())
    free = free_motion_of(made)
    lengths = np.linspace(0.28, 0.32, 11)
    found = integrate_many(
        free, {"links.AB.points.B.x": lengths}, free.initial({"links.AB": 5.0}), 1.0, 1e-11, threads=2
    )
    for k in (0, 4, 10):
        own = free_motion_of(mechanism(four_bar(float(lengths[k]))))
        # masses are those of the description, not those of other rods
        parts = four_bar(float(lengths[k]))
        parts["links"]["AB"]["mass"] = 0.3
        own = free_motion_of(mechanism(parts))
        single = own.integrate(own.initial({"links.AB": 5.0}), 1.0, 1e-11, at=[1.0])
        assert np.max(np.abs(single.coordinates[0] - found.coordinates[0, :, k])) <= 1e-9
    assert np.max(np.abs(found.energy_residual)) <= 1e-9


# Change points.


@pytest.mark.parametrize(
    ("wider", "kind"), [(1e-2, None), (1e-4, None), (1e-7, "near miss"), (0.0, "crossing")]
)
def test_near_misses_are_told_from_change_points(wider: float, kind: str | None) -> None:
    """All links in line, and a rocker a little longer: then it turns back, with the energy it has."""
    parts = four_bar(0.3, 0.8, 0.5 * (1.0 + wider), 0.6)
    parts["drives"][0]["start"] = 1.0
    parts["links"]["DC"]["mass"] = 0.5
    _free, course = moved(parts, 1.0, TIGHT, links_AB=6.0)
    assert course.ended == "duration"
    assert {event.kind for event in course.events} == ({kind} if kind else set())
    assert np.max(np.abs(course.energy_residual)) <= 1e-7 * np.max(course.kinetic_energy)
    assert ("doubtful" in {free_statuses(code) for code in course.statuses}) == (kind == "near miss")


def free_statuses(code: int) -> str:
    return ("ok", "crossing", "doubtful")[code]


def test_where_no_smooth_motion_leads_through_it_stops_by_name() -> None:
    """A gap of 1e-9 of a length: too small to be resolved, too large to be none."""
    parts = four_bar(0.3, 0.8, 0.5 * (1.0 + 1e-9), 0.6)
    parts["drives"][0]["start"] = 1.0
    free, course = moved(parts, 1.0, TIGHT, links_AB=6.0)
    assert course.ended == "change point" and "change point" in str(course.cause)
    assert course.time[-1] < 0.75 and free.mobility == 1


def test_in_an_unstable_equilibrium_it_goes_to_its_end() -> None:
    """Upright but for rounding: speeds and forces say nothing of how fast the motion will be."""
    parts = parallelogram(2)
    for name in ("crank0", "crank1"):
        parts["links"][name]["angle"] = math.pi / 2
    free, course = moved(parts, 10.0, 1e-11)
    assert course.ended == "duration" and free.mobility == 1
    assert course.steps < 2000
    assert np.max(np.abs(course.energy_residual)) <= 1e-8 * 9.81 * 3.0
