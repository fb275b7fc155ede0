"""Stops, ropes, clamps, friction and events on the sphere: compound pendulums, and equations of rotation of its own."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import quad, solve_ivp

import centrode as ct
from centrode.errors import InputError, NotComputedYet

Array = npt.NDArray[np.float64]
G, RADIUS, MASS, ARC = 9.81, 0.4, 1.3, math.pi / 3
LEAST, START = -1.2, 0.2
# an arc from the hinge on the x axis: means of sin^2 and sin along it
INERTIA = MASS * RADIUS**2 * (0.5 - math.sin(2 * ARC) / (4 * ARC))
WEIGHT = MASS * G * RADIUS * (1.0 - math.cos(ARC)) / ARC


def pendulum(**parts: object) -> ct.Mechanism:
    """An arc that hangs in a horizontal axis: a compound pendulum."""
    given: dict[str, object] = {
        "space": "sphere",
        "radius": RADIUS,
        "gravity": [0, 0, -G],
        "frame": {"points": {"X": [1, 0, 0], "Y": [0, 1, 0], "P": [0, 0, 1]}},
        "links": {
            "XA": {"length": ARC, "reference": ["X", "Y"], "mass": MASS, "shape": "arc", "angle": START}
        },
    }
    return ct.Mechanism(**(given | parts))


def run_of(mechanism: ct.Mechanism, duration: float, at: list[float] | None = None):
    return ct.simulate(mechanism, ct.Simulation(duration=duration, tolerance=1e-12), at=at)


def times_of(run, kind: str) -> Array:
    names = run.occasion_kind.attrs["flag_meanings"].split()
    return run.occasion_time.values[[names[k] == kind for k in run.occasion_kind.values]]


def fall(high: float, low: float) -> float:
    """Time in which the pendulum falls from rest at an angle to a lower one; the root at rest is substituted."""
    factor = math.sqrt(2.0 * WEIGHT / INERTIA)

    def rate(root: float) -> float:
        here = high - root * root
        return 2.0 * root / (factor * math.sqrt(math.sin(high) - math.sin(here)))

    return quad(rate, 0.0, math.sqrt(high - low), epsabs=1e-13, epsrel=1e-13)[0]


def test_a_pendulum_at_a_stop_bounces_at_the_instants_of_its_energy() -> None:
    restitution = 0.6
    run = run_of(pendulum(stops=[{"link": "XA", "least": LEAST, "restitution": restitution}]), 2.0)
    hits, time, high = times_of(run, "impact"), 0.0, START
    for number in range(6):
        time += fall(high, LEAST) * (1.0 if number == 0 else 2.0)
        assert hits[number] == pytest.approx(time, abs=1e-10)
        lost = WEIGHT * (math.sin(high) - math.sin(LEAST)) * (1.0 - restitution**2)
        assert float(run.occasion_loss[number]) == pytest.approx(lost, rel=1e-10)
        # it rises to the height of the energy that is left
        high = math.asin(math.sin(LEAST) + restitution**2 * (math.sin(high) - math.sin(LEAST)))
    # at rest the stop bears the moment of the weight
    assert float(run.restraint_force[-1, 0]) == pytest.approx(WEIGHT * math.cos(LEAST), rel=1e-12)
    assert run.restraint_force.attrs["units"] == "N m"


def integrated(rates: Callable[[float, Array], list[float]], start: list[float], end: float, event=None):
    return solve_ivp(rates, (0.0, end), start, method="DOP853", rtol=1e-13, atol=1e-14, events=event)


def test_a_compliant_stop_pushes_as_its_spring_and_damper() -> None:
    stiffness, damping = 40.0, 0.5
    parts = {"link": "XA", "least": LEAST, "stiffness": stiffness, "damping": damping}
    run = run_of(pendulum(stops=[parts]), 0.6, [0.6])

    def rates(_time: float, y: Array) -> list[float]:
        push = max(stiffness * (LEAST - y[0]) - damping * y[1], 0.0) if y[0] < LEAST else 0.0
        return [y[1], (push - WEIGHT * math.cos(y[0])) / INERTIA]

    touch = solve_ivp(
        rates, (0, 1), [START, 0.0], method="DOP853", rtol=1e-13, atol=1e-14, max_step=1e-3,
        events=lambda _t, y: y[0] - LEAST, dense_output=True,
    )  # fmt: skip
    assert times_of(run, "touches")[0] == pytest.approx(touch.t_events[0][0], abs=1e-9)
    assert float(run.generalised_coordinate[-1, 0]) == pytest.approx(touch.sol(0.6)[0], abs=1e-7)


def test_a_rope_stops_a_pendulum_where_the_law_of_cosines_says() -> None:
    restitution, most = 0.5, 1.9
    run = run_of(pendulum(stops=[{"points": ["P", "A"], "most": most, "restitution": restitution}]), 0.7)
    # cos of the distance from the zenith: sin(arc) sin(angle)
    low = math.asin(math.cos(most) / math.sin(ARC))
    assert times_of(run, "impact")[0] == pytest.approx(fall(START, low), abs=1e-10)
    speed = math.sqrt(2.0 * WEIGHT * (math.sin(START) - math.sin(low)) / INERTIA)
    slope = math.sin(ARC) * math.cos(low) / math.sin(most)
    impulse = INERTIA * (1.0 + restitution) * speed / slope
    assert float(run.occasion_impulse[0]) == pytest.approx(impulse, rel=1e-10)


def test_dry_friction_brings_a_pendulum_to_rest_where_its_equation_does() -> None:
    moment = 0.9
    run = run_of(pendulum(loads=[{"kind": "friction", "link": "XA", "value": moment}]), 4.0)
    y, time, sense = [START, 0.0], 0.0, -1.0
    while abs(WEIGHT * math.cos(y[0])) > moment:

        def rates(_time: float, x: Array, sense: float = sense) -> list[float]:
            return [x[1], (-sense * moment - WEIGHT * math.cos(x[0])) / INERTIA]

        def rests(_time: float, x: Array) -> float:
            return x[1]

        rests.terminal, rests.direction = True, -sense  # type: ignore[attr-defined]
        leg = integrated(rates, y, 10.0, rests)
        time, y, sense = time + leg.t[-1], [leg.y[0, -1], 0.0], -sense
    assert times_of(run, "sticks")[-1] == pytest.approx(time, abs=1e-8)
    assert float(run.generalised_coordinate[-1, 0]) == pytest.approx(y[0], abs=1e-9)


# Two arcs on a hinge each: rotations, masses and equations of motion written here.

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
ARCS, MASSES = (1.0, 0.6), (1.0, 0.7)


def turned(axis: Array, angle: complex, arm: Array) -> Array:
    """Rodrigues' formula."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return arm * cosine + np.cross(axis, arm) * sine + axis * (axis @ arm) * (1.0 - cosine)


def points_of_arcs(q: Array) -> tuple[Array, Array, Array]:
    """Places of quadrature of both arcs (n, 3), their masses (n), and the end of the second (3); over R = 1."""
    z, x = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    toward = turned(z, q[0], x)
    a = np.cos(ARCS[0]) * z + np.sin(ARCS[0]) * toward
    back = (z - (a @ z) * a) / np.sin(ARCS[0])
    along = turned(a, q[1], back)
    first = [np.cos(s) * z + np.sin(s) * toward for s in 0.5 * ARCS[0] * (1.0 + NODES)]
    second = [np.cos(s) * a + np.sin(s) * along for s in 0.5 * ARCS[1] * (1.0 + NODES)]
    masses = np.concatenate([0.5 * m * WEIGHTS for m in MASSES])
    return np.array(first + second), masses, np.cos(ARCS[1]) * a + np.sin(ARCS[1]) * along


STEP = 1e-30


def slopes(function: Callable[[Array], Array], q: Array) -> list[Array]:
    """Derivatives by both coordinates, by a complex step."""
    return [np.imag(function(q + 1j * STEP * np.eye(2)[k])) / STEP for k in range(2)]


def mass_matrix(q: Array) -> Array:
    places = slopes(lambda x: points_of_arcs(x)[0], q)
    masses = points_of_arcs(q)[1]
    return np.array([[np.sum(masses[:, None] * a * b) for b in places] for a in places])


def accelerations(q: Array, w: Array) -> Array:
    """M q'' = -sum m J' (J' of the motion itself) - m g z, the latter by a difference of J along w."""
    size = 1e-4
    masses = points_of_arcs(q)[1]

    def velocity(at: Array) -> Array:
        return np.tensordot(w, np.array(slopes(lambda x: points_of_arcs(x)[0], at)), 1)

    # the acceleration at constant speeds of the coordinates, of fourth order
    own = (
        8.0 * (velocity(q + size * w) - velocity(q - size * w))
        - (velocity(q + 2 * size * w) - velocity(q - 2 * size * w))
    ) / (12.0 * size)
    own[:, 2] += G
    force = -np.array([np.sum(masses[:, None] * a * own) for a in slopes(lambda x: points_of_arcs(x)[0], q)])
    return np.linalg.solve(mass_matrix(q), force)


TWO_ARCS: dict[str, object] = {
    "space": "sphere",
    "gravity": [0.0, 0.0, -G],
    "frame": {"points": {"Z": [0, 0, 1], "X": [1, 0, 0], "N": [0, -1, 0]}},
    "links": {
        "ZA": {"length": ARCS[0], "reference": ["Z", "X"], "mass": MASSES[0], "shape": "arc", "angle": 0.3},
        "AB": {"length": ARCS[1], "reference": ["A", "Z"], "mass": MASSES[1], "shape": "arc", "angle": 0.8},
    },
}


def test_a_rope_jerks_two_arcs_by_their_mass_matrix() -> None:
    restitution, most, duration = 0.4, 2.3, 0.8
    stops = [{"points": ["N", "B"], "most": most, "restitution": restitution}]
    mechanism = ct.Mechanism(**(TWO_ARCS | {"stops": stops}))
    chosen = ct.Simulation(duration=duration, tolerance=1e-12, speeds={"links.ZA": 2.0, "links.AB": -3.0})
    run = ct.simulate(mechanism, chosen, at=[0.0, duration])
    start = [*run.generalised_coordinate.values[0], *run.generalised_velocity.values[0]]

    def cosine(q: Array) -> Array:
        return np.array([-points_of_arcs(q)[2][1]])

    def rates(_time: float, y: Array) -> Array:
        return np.concatenate([y[2:], accelerations(y[:2], y[2:])])

    def taut(_time: float, y: Array) -> float:
        return float(cosine(y[:2])[0]) - math.cos(most)

    taut.terminal, taut.direction = True, -1.0  # type: ignore[attr-defined]
    before = solve_ivp(rates, (0, duration), start, method="DOP853", rtol=1e-11, atol=1e-12, events=taut)
    assert times_of(run, "impact") == pytest.approx(before.t_events[0], abs=1e-8)
    q, w = before.y[:2, -1], before.y[2:, -1]
    # the distance grows as its cosine falls
    along = -np.array([float(x[0]) for x in slopes(cosine, q)]) / math.sin(most)
    way = np.linalg.solve(mass_matrix(q), along)
    impulse = (1.0 + restitution) * float(along @ w) / float(along @ way)
    assert float(run.occasion_impulse[0]) == pytest.approx(impulse, rel=1e-7)
    behind = solve_ivp(
        rates, (before.t[-1], duration), [*q, *(w - impulse * way)], method="DOP853", rtol=1e-11, atol=1e-12
    )
    reached = [*run.generalised_coordinate.values[-1], *run.generalised_velocity.values[-1]]
    assert reached == pytest.approx(behind.y[:, -1], abs=1e-6)


def test_a_clamped_hinge_makes_one_body_of_two_until_it_lets_go() -> None:
    """The momentum about the vertical is that of one body; an event of the angle the other way round ends it."""
    mechanism = ct.Mechanism(
        **TWO_ARCS,
        clamps=[{"link": "ZA", "relative_to": "AB", "until": 0.4}],
        events=[
            {"name": "there", "link": "ZA", "relative_to": "AB", "when": "x + 0.9"},
            {"name": "here", "link": "AB", "relative_to": "ZA", "when": "x - 0.9", "do": "end"},
        ],
    )
    run = ct.simulate(
        mechanism,
        ct.Simulation(duration=3, tolerance=1e-12, speeds={"links.ZA": 2.0, "links.AB": 0.0}),
        at=list(np.linspace(0, 3, 301)),
    )
    held = run.time.values < 0.4
    q, w = run.generalised_coordinate.values, run.generalised_velocity.values
    assert np.max(np.abs(q[held, 1] - 0.8)) < 1e-13
    assert w[held, 0] == pytest.approx(2.0, abs=1e-11)
    (released,) = times_of(run, "lets_go")
    there, here = times_of(run, "condition")
    assert (released, here) == (0.4, pytest.approx(there, abs=1e-13))
    assert abs(float(q[-1, 1]) - 0.9) < 0.2


def test_a_stop_along_a_great_circle_is_that_of_a_rocker_with_the_pole_as_its_hinge() -> None:
    """C runs in the circle of 90 deg about D: a guide, or a rocker without mass, give the same motion and moment."""
    rods = {"mass": 1, "shape": "arc"}
    common: dict[str, object] = {
        "space": "sphere",
        "radius": RADIUS,
        "gravity": [0, 0, -G],
        "drives": [{"link": "AB", "start": 0.5, "speed": 1}],
        "assembly": {"sides": {"C": "left"}},
        "frame": {"points": {"A": [1, 0, 0], "D": [0, 1, 0], "Z": [0, 0, 1]}},
    }
    links = {
        "AB": {"length": "15 deg", "reference": ["A", "D"], **rods},
        "BC": {"length": "45 deg", **rods},
    }
    guide = {"guides": [{"point": "C", "on": "frame", "pole": "D", "radius": "90 deg"}]}
    rocker = {"links": links | {"DC": {"length": "90 deg", "reference": ["D", "Z"]}}}
    arc, angle = (
        float(ct.motion(ct.Mechanism(**(common | parts)), samples=2)[name][0, -1])
        for parts, name in (({"links": links} | guide, "slide"), (rocker, "joint_angle"))
    )
    stop, runs = {"restitution": 0.5}, []
    for parts, where, zero in (
        ({"links": links} | guide, {"guide": "C"}, arc),
        (rocker, {"link": "DC"}, angle),
    ):
        bounds = {"least": zero - 0.1, "most": zero + 0.1}
        runs.append(run_of(ct.Mechanism(**(common | parts), stops=[stop | where | bounds]), 1.5))
    one, other = runs
    assert len(times_of(one, "impact")) > 2
    assert times_of(one, "impact") == pytest.approx(times_of(other, "impact"), abs=1e-9)
    assert np.max(np.abs(one.slide.values[:, 0] - arc)) <= 0.1 + 1e-12
    assert one.occasion_impulse.values[:6] == pytest.approx(other.occasion_impulse.values[:6], rel=1e-8)


def test_friction_in_a_hinge_without_an_angle_is_that_of_the_reduced_equation_and_holds() -> None:
    four_bar: dict[str, object] = {
        "space": "sphere",
        "gravity": [0, 0, -G],
        "frame": {"points": {"A": [1, 0, 0], "D": [0, 1, 0], "Z": [0, 0, 1]}},
        "links": {
            "AB": {"length": "25 deg", "reference": ["A", "D"], "mass": 1, "shape": "arc"},
            "BC": {"length": "60 deg", "mass": 1, "shape": "arc"},
            "DC": {"length": "90 deg", "reference": ["D", "Z"], "mass": 1, "shape": "arc"},
        },
        "drives": [{"link": "AB", "start": 0.5, "speed": 1}],
        "assembly": {"sides": {"C": "left"}},
    }
    values = []
    for equations in ("multibody", "reduced"):
        mechanism = ct.Mechanism(
            **four_bar, loads=[{"kind": "friction", "link": "BC", "relative_to": "DC", "value": 0.2}]
        )
        chosen = ct.Simulation(duration=0.5, speed=4.0, tolerance=1e-11, equations=equations)
        values.append(float(ct.simulate(mechanism, chosen, at=[0.5]).drive_value.values[-1, ...].item()))
    assert values[0] == pytest.approx(values[1], abs=1e-7)
    stuck = ct.Mechanism(
        **four_bar,
        loads=[{"kind": "friction", "link": "BC", "relative_to": "DC", "value": 40, "static": 50}],
    )
    run = ct.simulate(stuck, ct.Simulation(duration=5.0, equations="multibody"))
    assert np.ptp(run.drive_value.values) < 1e-13


@pytest.mark.parametrize(
    ("part", "words"),
    [
        ({"link": "AB", "most": 1.0}, "have no hinge in common"),
        ({"link": "ZA", "least": 1.0, "most": 0.5}, "has to be below"),
        ({"points": ["N", "B"], "most": 0.1}, "beyond its bound"),
    ],
)
def test_what_means_nothing_on_the_sphere_is_named(part: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        run_of(ct.Mechanism(**(TWO_ARCS | {"stops": [part]})), 0.1)


def test_a_guide_with_a_link_of_its_own_is_refused_by_name() -> None:
    shoe = {"points": {"A": [0, 0]}, "mass": 0.5}
    guided = pendulum()
    parts = {"guides": [{"point": "A", "on": "frame", "pole": "X", "radius": ARC, "link": "shoe"}]}
    with pytest.raises(NotComputedYet, match=r"\[\[guides\]\] A, link: it is not computed on the sphere"):
        run_of(pendulum(links={"XA": guided.links["XA"], "shoe": shoe}, **parts), 0.1)
