"""Friction by coefficients in free motions: closed forms, equations written down apart, reactions at the same state.

Oracles share no formula with the package: closed forms of blocks, SciPy's DOP853 on equations of one body or of three
by Newton and Euler, Painlevé's condition of a sliding rod, and `ct.reactions`, which solves all bodies at once.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import centrode as ct
from centrode.errors import InputError, MotionError, NotComputedYet
from centrode.model.files import mechanism_text

G = 9.81
TIGHT = 1e-12


def simulated(mechanism: ct.Mechanism, duration: float, at=None, **settings):
    return ct.simulate(mechanism, ct.Simulation(duration=duration, tolerance=TIGHT, **settings), at=at)


def happened(run, kind: str, part: str) -> list[float]:
    """Instants of the occasions of a kind [s]."""
    names = run.occasion_kind.attrs["flag_meanings"].split()
    parts = run.occasion_part.values if "occasion_part" in run else []
    found = zip(run.occasion_time.values, run.occasion_kind.values, parts, strict=False)
    return [float(t) for t, k, p in found if names[k] == kind and p == part]


def block(angle: float = 0.0, speed: float | None = None, **load: object) -> ct.Mechanism:
    """A block of 2 kg on a guide inclined by an angle [rad]."""
    law = {} if speed is None else {"speed": speed}
    return ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={"block": {"points": {"P": [0, 0]}, "mass": 2}},
        guides=[
            {
                "point": "P",
                "on": "frame",
                "through": "O",
                "direction": [math.cos(angle), math.sin(angle)],
                "link": "block",
            }
        ],
        drives=[{"guide": "P", "start": 0, **law}],
        loads=[{"kind": "friction", "guide": "P", **load}],
    )


# Closed forms.


@pytest.mark.parametrize("coefficient", [0.2, 0.7])
def test_a_block_slides_up_an_inclined_plane_and_back_or_stays(coefficient: float):
    angle = math.radians(30)
    run = simulated(block(angle, coefficient=coefficient), 2.0, speeds={"drives.P": 3.0})
    up = G * (math.sin(angle) + coefficient * math.cos(angle))
    down = max(G * (math.sin(angle) - coefficient * math.cos(angle)), 0.0)
    stops = 3.0 / up
    assert abs(float(run.drive_value[-1, 0]) - (4.5 / up - 0.5 * down * (2.0 - stops) ** 2)) < 1e-12
    assert happened(run, "sticks", "guide P") == ([] if down else pytest.approx([stops], rel=0.0, abs=1e-12))
    normal = 2 * G * math.cos(angle)
    assert abs(float(run.restraint_force[0, 0]) + coefficient * normal) < 1e-12
    held = coefficient * normal if down else 2 * G * math.sin(angle)
    assert abs(float(run.restraint_force[-1, 0]) - held) < 1e-12
    assert run.attrs["worst_energy_residual"] < 1e-11


@pytest.mark.parametrize(("static", "slips"), [(0.6, False), (0.55, True)])
def test_what_sticks_holds_up_to_the_static_coefficient(static: float, slips: bool):
    # tan 30 deg = 0.5774
    run = simulated(block(math.radians(30), coefficient=0.3, static_coefficient=static), 1.0)
    fall = 0.5 * G * (0.5 - 0.3 * math.cos(math.radians(30)))
    assert abs(float(run.drive_value[-1, 0]) + (fall if slips else 0.0)) < 1e-12


@pytest.mark.parametrize("pull", [1.0, 1000.0])
@pytest.mark.parametrize("length", [0.1499, 0.1501, 0.4])
def test_a_drawer_that_is_pulled_beside_its_guide_jams_below_twice_its_arm_times_the_coefficient(
    pull: float, length: float
):
    drawer = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "drawer": {"points": {"S": [0, 0], "D": [0, 0.3]}, "mass": 2, "inertia": 0.1, "centre": [0, 0]}
        },
        guides=[{"point": "S", "on": "frame", "through": "O", "direction": [1, 0], "link": "drawer"}],
        drives=[{"guide": "S", "start": 0}],
        loads=[
            {"kind": "force", "point": "D", "vector": [pull, 0]},
            {"kind": "friction", "guide": "S", "coefficient": 0.25, "length": length},
        ],
    )
    run = simulated(drawer, 1.0)
    # the ends press with twice P e / l: what is left of the pull is P (1 - 2 mu e / l)
    left = pull * max(1.0 - 2.0 * 0.25 * 0.3 / length, 0.0)
    assert abs(float(run.drive_value[-1, 0]) - 0.5 * left / 2.0) < 1e-12 * pull
    assert bool(run.contact_mode[-1, 0]) is (left == 0.0)


def test_two_hinges_stick_at_once_and_hold_a_double_pendulum():
    hinges = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "shape": "rod", "angle": -1.5},
            "AB": {"length": 1, "mass": 1, "shape": "rod", "angle": -1.2},
        },
        loads=[
            {"kind": "friction", "point": "O", "coefficient": 0.2, "static_coefficient": 0.3, "radius": 0.1},
            {"kind": "friction", "point": "A", "coefficient": 0.3, "radius": 0.1},
        ],
    )
    run = simulated(hinges, 10.0, speeds={"links.OA": 2})
    assert np.all(run.contact_mode[-1] == 1)
    assert np.all(abs(run.generalised_velocity[-1]) < 1e-15)
    first, second = (float(x) for x in run.angle[-1])
    outer = 0.5 * G * math.cos(second)
    inner = outer + 1.5 * G * math.cos(first)
    # the moment at O bears both links, in it that at A has gone round: O/OA against the frame, A/AB against OA
    assert np.allclose(run.restraint_force[-1], [inner, outer], rtol=0.0, atol=1e-10)
    assert abs(inner) <= 0.3 * 0.1 * 2 * G
    assert abs(outer) <= 0.3 * 0.1 * G
    # to and fro each has slipped and stuck several times
    assert len(happened(run, "sticks", "A/AB")) >= 2
    assert len(happened(run, "slips", "O/OA")) >= 1
    assert run.attrs["worst_energy_residual"] < 1e-10


# Equations written down apart.


def integrated(rates: Callable[[float, np.ndarray], list[float]], start: list[float], end: float, event=None):
    """SciPy's DOP853 up to an event: time and state there."""
    if event is not None:
        event.terminal = True
    solved = solve_ivp(
        rates,
        [start[0], end],
        start[1:],
        method="DOP853",
        rtol=1e-13,
        atol=1e-14,
        events=event,
        max_step=0.02,
    )
    return float(solved.t[-1]), solved.y[:, -1], solved.status == 1


def test_a_pendulum_with_friction_in_its_hinge_comes_to_rest_where_its_equation_does():
    coefficient, radius = 0.3, 0.05
    pendulum = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
        loads=[{"kind": "friction", "point": "O", "coefficient": coefficient, "radius": radius}],
    )
    run = simulated(pendulum, 20.0)

    def acceleration(angle: float, speed: float, sense: float) -> float:
        """Root of I a = -m g l/2 cos - s mu r |R(a)| by fixed points; R by the motion of the centre."""
        along, found = G * math.sin(angle) - 0.5 * speed**2, 0.0
        for _round in range(60):
            across = 0.5 * found + G * math.cos(angle)
            found = 3.0 * (
                -0.5 * G * math.cos(angle) - sense * coefficient * radius * math.hypot(along, across)
            )
        return found

    time, angle, sense = 0.0, 0.0, -1.0
    while True:

        def turns(_t: float, y: np.ndarray) -> float:
            return float(y[1])

        turns.direction = -sense  # type: ignore[attr-defined]
        time, (angle, _speed), _event = integrated(
            lambda _t, y, s=sense: [y[1], acceleration(y[0], y[1], s)], [time, angle, 0.0], 20.0, turns
        )
        sense = -sense
        # at rest the pin bears the weight
        if abs(0.5 * G * math.cos(angle)) <= coefficient * radius * G:
            break
    (rest,) = happened(run, "sticks", "O/OA")
    assert abs(rest - time) < 1e-9
    assert abs(float(run.generalised_coordinate[-1, 0]) - angle) < 1e-10
    assert run.attrs["worst_energy_residual"] < 1e-10


def test_a_block_on_a_belt_sticks_and_slips_as_the_force_that_presses_it_varies():
    kinetic, static, stiffness, belt = 0.3, 0.4, 200.0, 0.2
    carried = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0], "W": [0, 0]}},
        links={"block": {"points": {"P": [0, 0]}, "mass": 2}},
        guides=[{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
        drives=[{"guide": "P", "start": 0}],
        loads=[
            {"kind": "force", "guide": "P", "value": f"-{stiffness}*x"},
            {"kind": "force", "point": "P", "vector": [0, "-10*sin(7*t)"]},
            {
                "kind": "friction",
                "guide": "P",
                "coefficient": kinetic,
                "static_coefficient": static,
                "surface_speed": belt,
            },
        ],
    )
    run = simulated(carried, 4.0)

    def press(t: float) -> float:
        return 2 * G + 10 * math.sin(7 * t)

    sticks, slips = [], []
    time, place, speed = 0.0, 0.0, 0.0
    while time < 4.0:
        # slower than the belt, which drives it forwards
        def meets(_t: float, y: np.ndarray) -> float:
            return float(y[1]) - belt

        meets.direction = 1.0  # type: ignore[attr-defined]
        time, (place, speed), event = integrated(
            lambda t, y: [y[1], (-stiffness * y[0] + kinetic * press(t)) / 2],
            [time, place, speed],
            4.0,
            meets,
        )
        if not event:
            break
        sticks.append(time)

        def lets_go(t: float, y: np.ndarray) -> float:
            return static * press(t) - stiffness * float(y[0])

        if lets_go(time, np.array([place])) <= 0.0:
            pytest.fail("the case is one in which it sticks")
        time, (place,), event = integrated(lambda _t, _y: [belt], [time, place], 4.0, lets_go)
        if event:
            slips.append(time)
        speed = belt
    assert len(sticks) >= 3
    assert happened(run, "sticks", "guide P") == pytest.approx(sticks, rel=0.0, abs=1e-9)
    assert happened(run, "slips", "guide P") == pytest.approx(slips, rel=0.0, abs=1e-9)
    assert abs(float(run.drive_value[-1, 0]) - place) < 1e-9


def crank_slider(*loads: dict[str, object], stops: Sequence[object] = (), **drive: object) -> ct.Mechanism:
    return ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 0.1, "mass": 0.5, "shape": "rod"},
            "AB": {"length": 0.3, "mass": 2, "shape": "rod"},
            "piston": {"points": ["B"], "mass": 3},
        },
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "piston"}],
        drives=[{"link": "OA", "start": "60 deg", **drive}],
        loads=[{"kind": "force", "point": "B", "vector": [-50, -20]}, *loads],
        stops=stops,
        assembly={"sides": {"B": "ahead"}},
    )


def test_a_slider_crank_with_friction_in_its_guide_runs_as_newton_and_euler_write_it():
    """Eight equations of three bodies: the acceleration of the crank, forces in O, A, B and in the guide."""
    coefficient, r, length = 0.15, 0.1, 0.3
    run = simulated(
        crank_slider({"kind": "friction", "guide": "B", "coefficient": coefficient}),
        1.0,
        speeds={"drives.OA": 30},
    )

    def acceleration(_t: float, y: np.ndarray) -> list[float]:
        q, v = float(y[0]), float(y[1])
        sine = -r * math.sin(q) / length
        rod = math.asin(sine)
        turn = -r * math.cos(q) / (length * math.cos(rod))
        # second derivative of the rod's angle: turn * a + bend
        bend = (r * math.sin(q) * v * v + length * math.sin(rod) * (turn * v) ** 2) / (length * math.cos(rod))
        # acceleration of the slider: slide * a + rest
        slide = -r * math.sin(q) - length * math.sin(rod) * turn
        rest = (
            -r * math.cos(q) * v * v
            - length * math.cos(rod) * (turn * v) ** 2
            - length * math.sin(rod) * bend
        )
        sense = math.copysign(1.0, slide * v)

        def centre(arm_q: float, arm_rod: float) -> tuple[float, float, float, float]:
            """Of a point at r-share and l-share: ax = p a + s, ay = u a + w."""
            p = -arm_q * math.sin(q) - arm_rod * math.sin(rod) * turn
            s = -arm_q * math.cos(q) * v * v - arm_rod * (
                math.cos(rod) * (turn * v) ** 2 + math.sin(rod) * bend
            )
            u = arm_q * math.cos(q) + arm_rod * math.cos(rod) * turn
            w = -arm_q * math.sin(q) * v * v - arm_rod * (
                math.sin(rod) * (turn * v) ** 2 - math.cos(rod) * bend
            )
            return p, s, u, w

        for normal in (1.0, -1.0):
            # unknowns: a, Ox, Oy, Ax, Ay (on the rod), Bx, By (on the slider), N
            matrix, right = np.zeros((8, 8)), np.zeros(8)
            p, s, u, w = centre(r / 2, 0.0)
            matrix[0, [0, 1, 3]], right[0] = [0.5 * p, -1, 1], -0.5 * s
            matrix[1, [0, 2, 4]], right[1] = [0.5 * u, -1, 1], -0.5 * w - 0.5 * G
            # crank about O: J a = -A x r - weight
            matrix[2, [0, 3, 4]] = [0.5 * r * r / 3, -r * math.sin(q), r * math.cos(q)]
            right[2] = -0.5 * G * r / 2 * math.cos(q)
            p, s, u, w = centre(r, length / 2)
            matrix[3, [0, 3, 5]], right[3] = [2 * p, -1, 1], -2 * s
            matrix[4, [0, 4, 6]], right[4] = [2 * u, -1, 1], -2 * w - 2 * G
            # rod about its centre: forces A at -l/2, -B at +l/2
            half_x, half_y = length / 2 * math.cos(rod), length / 2 * math.sin(rod)
            inertia = 2 * length**2 / 12
            matrix[5, [0, 3, 4, 5, 6]] = [inertia * turn, -half_y, half_x, -half_y, half_x]
            right[5] = -inertia * bend
            friction = -sense * coefficient * normal
            matrix[6, [0, 5, 7]], right[6] = [3 * slide, -1, -friction], -3 * rest - 50
            matrix[7, [6, 7]], right[7] = [1, 1], 3 * G + 20
            found = np.linalg.solve(matrix, right)
            if found[7] * normal >= 0.0:
                return [v, float(found[0])]
        raise AssertionError("no sign of the normal force fits")

    # kinks of the sense and of the sign of the normal force hold SciPy back: many short steps
    solved = solve_ivp(
        acceleration, [0, 1], [math.radians(60), 30.0], method="DOP853", rtol=1e-12, atol=1e-12, max_step=2e-4,
        t_eval=[0.25, 0.5, 1.0],
    )  # fmt: skip
    own = ct.simulate(
        crank_slider({"kind": "friction", "guide": "B", "coefficient": coefficient}),
        ct.Simulation(duration=1, tolerance=TIGHT, speeds={"drives.OA": 30}),
        at=[0.25, 0.5, 1.0],
    )
    assert np.allclose(own.drive_value[:, 0], solved.y[0], rtol=0.0, atol=2e-6)
    assert np.allclose(own.drive_speed[:, 0], solved.y[1], rtol=0.0, atol=2e-5)
    first = acceleration(0.0, np.array([float(run.drive_value[0, 0]), 30.0]))[1]
    assert abs(float(run.drive_acceleration[0, 0]) - first) < 1e-9 * abs(first)


# The same state in inverse dynamics.

RUBBING = [
    {"kind": "friction", "point": "O", "coefficient": 0.1, "radius": "20 mm"},
    {"kind": "friction", "point": "A", "coefficient": 0.12, "radius": "15 mm", "fit": "new"},
    {"kind": "friction", "point": "B", "coefficient": 0.1, "radius": "12 mm"},
    {"kind": "friction", "guide": "B", "coefficient": 0.15, "length": "60 mm", "height": "40 mm"},
]


@pytest.mark.parametrize("coefficient", [None, 0.2])
def test_an_impact_loses_what_its_restitution_takes_and_the_result_says_so_of_friction(coefficient):
    """The slider of the mechanism meets a stop: friction takes no impulse, whatever presses its guide then."""
    restitution, frictions = 0.5, [{"kind": "friction", "guide": "B", "coefficient": coefficient}]
    rubs = frictions if coefficient else []
    run = simulated(
        crank_slider(*rubs, stops=[{"guide": "B", "least": 0.25, "restitution": restitution}]), 0.3
    )
    assert ("friction_at_impacts" in run.attrs) is (coefficient is not None)
    # J (1 + e) u / 2 with the speeds away from the stop: the impulse gives the speed before
    impulse, lost = float(run.occasion_impulse[0]), float(run.occasion_loss[0])
    time = float(run.occasion_time[0])
    speed = abs(float(simulated(crank_slider(*rubs), 0.3, at=[time]).slide_velocity[0, 0]))
    assert lost == pytest.approx(0.5 * impulse * speed * (1.0 - restitution), rel=1e-8)
    assert run.attrs["worst_energy_residual"] < 1e-8


@pytest.mark.parametrize("which", [(0,), (1,), (2,), (3,), (0, 1, 2, 3)])
def test_the_friction_of_a_motion_is_that_of_the_reactions_at_its_states(which: tuple[int, ...]):
    loads = [RUBBING[k] for k in which]
    run = ct.simulate(
        crank_slider(*loads),
        ct.Simulation(duration=1, tolerance=1e-10, speeds={"drives.OA": 30}),
        at=np.linspace(0, 1, 21),
        reactions=True,
    )
    assert run.attrs["worst_imbalance"] < 1e-12
    driven = crank_slider(*loads, speed=30)
    compared = 0
    for k in range(run.sizes["sample"]):
        value, speed, acceleration = (
            float(run[name][k, 0]) for name in ("drive_value", "drive_speed", "drive_acceleration")
        )
        if abs(speed) < 1e-6:
            continue
        compared += 1
        there = ct.reactions(driven, at=[value], speed=speed, acceleration=acceleration)
        assert abs(float(there.balancing[0, 0])) < 1e-11
        for label in run.contact.values:
            own = float(run.restraint_force.sel(contact=label)[k])
            other = (
                there.friction_force.sel(guide="B")
                if label == "guide B"
                else there.friction_moment.sel(bearing=label)
            )
            assert abs(own - float(other[0])) < 1e-12
        assert np.allclose(run.joint_force[k], there.joint_force[0], rtol=0.0, atol=1e-10)
        assert np.allclose(run.guide_moment[k], there.guide_moment[0], rtol=0.0, atol=1e-12)
    assert compared >= 15


@pytest.mark.parametrize(
    "name",
    ["geared-five-bar", "inverted-slider-crank", "oscillating-cylinder", "elliptic-trammel", "cardan-gear"],
)
def test_friction_of_all_joints_of_an_example_is_that_of_the_reactions(name: str):
    """Moving guides, cut joints, teeth that press hinges, pins of several links."""
    generator = np.random.default_rng(len(name))
    given = tomllib.loads(mechanism_text(ct.example(name)))
    for link in given["links"].values():
        link.pop("shape", None)
        link["mass"], link["inertia"] = float(generator.uniform(0.5, 2)), float(generator.uniform(0.01, 0.1))
        link["centre"] = [float(x) for x in generator.uniform(-0.1, 0.1, 2)]
    for key in ("simulation", "machine"):
        given.pop(key, None)
    bare = ct.Mechanism(**given)
    bodies = [set(part.coordinates) for part in bare.links.values()] + [set(bare.frame.points)]
    hinges = sorted({point for k, one in enumerate(bodies) for other in bodies[:k] for point in one & other})
    given["loads"] = [
        {
            "kind": "friction",
            "point": point,
            "coefficient": float(generator.uniform(0.05, 0.2)),
            "radius": 0.01,
        }
        for point in hinges
    ]
    given["loads"] += [
        {"kind": "friction", "guide": guide.id, "coefficient": float(generator.uniform(0.05, 0.2))}
        for guide in bare.guides
    ]
    mechanism = ct.Mechanism(**given, gravity=[0, -G])
    drive = mechanism.drives[0].id
    run = ct.simulate(
        mechanism,
        ct.Simulation(duration=0.02, tolerance=1e-9, equations="multibody", speeds={f"drives.{drive}": 2.0}),
        at=[0.0, 0.02],
    )
    for k in range(2):
        value, speed, acceleration = (
            float(run[key][k, 0]) for key in ("drive_value", "drive_speed", "drive_acceleration")
        )
        there = ct.reactions(mechanism, at=[value], speed=speed, acceleration=acceleration)
        size = float(np.nanmax(np.abs(there.joint_force)))
        assert abs(float(there.balancing[0, 0])) < 1e-12 * size
        for label in run.contact.values:
            own = float(run.restraint_force.sel(contact=label)[k])
            other = (
                there.friction_force.sel(guide=label.removeprefix("guide "))
                if label.startswith("guide ")
                else there.friction_moment.sel(bearing=label)
            )
            assert abs(own - float(other[0])) < 1e-13 * size


# Painlevé.


def sliding_rod(coefficient: float, angle: float, gravity: float = -G) -> ct.Mechanism:
    """A rod of 1 m whose end slides along x; k = 3 mu sin cos / (1 + 3 cos^2) is what friction feeds back."""
    return ct.Mechanism(
        gravity=[0, gravity],
        frame={"points": {"O": [0, 0]}},
        links={"rod": {"points": {"P": [0, 0], "Q": [1, 0]}, "mass": 1, "shape": "rod", "angle": angle}},
        guides=[{"point": "P", "on": "frame", "through": "O", "direction": [1, 0]}],
        drives=[{"guide": "P", "start": 0}, {"link": "rod", "start": angle}],
        loads=[{"kind": "friction", "guide": "P", "coefficient": coefficient}],
    )


def feedback(coefficient: float, angle: float) -> float:
    return 3 * coefficient * abs(math.sin(angle) * math.cos(angle)) / (1 + 3 * math.cos(angle) ** 2)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_painleves_rod_starts_below_the_condition_and_is_refused_beyond_it(way: float):
    angle = math.atan(2.0) if way > 0 else math.pi - math.atan(2.0)
    # 4/3 is the least coefficient at which there is a paradox, at tan = 2
    assert abs(feedback(4 / 3, angle) - 1.0) < 1e-14
    run = simulated(sliding_rod(4 / 3 - 1e-9, angle), 1e-3, speeds={"drives.P": 2.0, "drives.rod": 0.0})
    assert run.attrs["ended"] in ("duration", "ambiguous friction")
    with pytest.raises(MotionError) as caught:
        simulated(sliding_rod(4 / 3 + 1e-9, angle), 1e-3, speeds={"drives.P": 2.0, "drives.rod": 0.0})
    # where the rod is dragged there are two forces, where it is pushed before its end there is none
    what = "has several solutions" if way > 0 else "has no solution"
    assert "at 0 s friction at guide P " + what in str(caught.value)


def test_a_rod_that_turns_into_the_paradox_ends_there_by_name():
    # hung from its guide the normal force is below zero and stays finite: a second force comes from infinity
    angle, coefficient = 2.9, 1.6
    run = simulated(
        sliding_rod(coefficient, angle, gravity=G), 2.0, speeds={"drives.P": 5.0, "drives.rod": -1.0}
    )
    assert run.attrs["ended"] == "ambiguous friction"
    assert "friction at guide P has several solutions from there on" in run.attrs["cause"]
    time = float(run.attrs["cause"].split()[1])
    again = simulated(
        sliding_rod(coefficient, angle, gravity=G), 2.0, at=[0.0, time - 1e-9],
        speeds={"drives.P": 5.0, "drives.rod": -1.0},
    )  # fmt: skip
    assert abs(feedback(coefficient, float(again.drive_value[-1, 1])) - 1.0) < 1e-6


# Refusals.


@pytest.mark.parametrize(
    ("load", "words"),
    [
        ({"guide": "P", "coefficient": 0.3, "static_coefficient": 0.2}, "at least the coefficient (0.3)"),
        ({"guide": "P", "value": 3, "static_coefficient": 0.2}, "static_coefficient"),
        ({"guide": "P", "coefficient": 0.3, "static": 4}, "static is used with the value"),
        ({"point": "P", "coefficient": 0.3, "radius": 0.01, "surface_speed": 1}, "in a guide only"),
        ({"guide": "P", "coefficient": 0.3, "static_coefficient": -0.2}, "static_coefficient"),
    ],
)
def test_coefficients_that_mean_nothing_are_refused(load: dict[str, object], words: str):
    with pytest.raises(InputError, match=words.replace("(", r"\(").replace(")", r"\)")):
        ct.Mechanism(
            frame={"points": {"O": [0, 0]}},
            links={"block": {"points": {"P": [0, 0]}, "mass": 2}},
            guides=[{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
            loads=[{"kind": "friction", **load}],
        )


def test_reactions_have_no_belt_and_the_reduced_equation_no_coefficients():
    with pytest.raises(InputError, match="equations of all links"):
        ct.simulate(block(coefficient=0.3), ct.Simulation(duration=1, equations="reduced"))
    with pytest.raises(NotComputedYet, match="belt"):
        ct.reactions(block(speed=1.0, coefficient=0.3, surface_speed=0.1), at=[0.0])


def test_friction_at_a_joint_that_redundant_constraints_leave_open_is_refused():
    rods = {"mass": 1, "shape": "rod"}
    third = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"A": [0, 0], "D": [1, 0], "E": [2, 0]}},
        links={
            "AB": {"length": 0.3, **rods},
            "BCF": {"points": {"B": [0, 0], "C": [1, 0], "F": [2, 0]}, **rods},
            "DC": {"length": 0.3, **rods},
            "EF": {"length": 0.3, **rods},
        },
        drives=[{"link": "AB", "start": "60 deg"}],
        assembly={"sides": {"C": "left"}},
        loads=[{"kind": "friction", "point": "C", "coefficient": 0.1, "radius": 0.01}],
    )
    with pytest.raises(InputError, match="constraints do not determine"):
        ct.simulate(third, ct.Simulation(duration=1, speeds={"drives.AB": 1}))
