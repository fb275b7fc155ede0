"""Simulated motion against closed forms, quadratures and the steady motion by the energy equation."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.integrate
import scipy.optimize
import scipy.special

import centrode as ct
from burdened import burdened
from centrode.dynamics.reduction import Reducer
from centrode.dynamics.simulation.steady_state import steady_regime
from centrode.model.simulation import Motor
from growing import KINDS, mechanism_of
from growing import grown as grown_parts
from samples import few
from simulated import crank_rocker, pendulum, rotor, spherical

TIGHT = 1e-12
EPS = 2.0**-52


def grown(tolerance: float, steps: float, rate: float = 1.0) -> float:
    """What local errors of a tolerance may come up to: all in one sense, growing with the motion."""
    return tolerance * steps * math.exp(rate)


def test_a_pendulum_against_elliptic_functions() -> None:
    """Released from the horizontal: theta = 2 asin(k sn(w t + K, k)) from the vertical, k = sin(45 deg)."""
    found = ct.simulate(pendulum(), ct.Simulation(duration=5, tolerance=TIGHT, samples=401))
    k, w = math.sin(math.pi / 4), math.sqrt(9.81 / 0.7)
    sn = scipy.special.ellipj(w * found.time.values + scipy.special.ellipk(k * k), k * k)[0]
    expected = 2 * np.arcsin(k * sn) - math.pi / 2
    assert np.max(np.abs(found.drive_value.values[:, 0] - expected)) <= grown(TIGHT, found.evaluations)
    assert found.attrs["ended"] == "duration"


def test_a_pendulum_that_turns_over() -> None:
    """The time of a turn is 2 k K(k) / w with k^2 = 4 w^2 / (v^2 at the bottom)."""
    length, bottom = 0.7, 12.0
    at_start = math.sqrt(bottom**2 - 2 * 9.81 / length)
    found = ct.simulate(pendulum(), ct.Simulation(speed=at_start, turns=3, tolerance=TIGHT))
    w = math.sqrt(9.81 / length)
    k = 2 * w / bottom
    assert found.attrs["ended"] == "turns"
    turn = 2 * k * scipy.special.ellipk(k * k) / w
    assert float(found.time[-1]) == pytest.approx(3 * turn, abs=grown(TIGHT, found.evaluations))
    assert float(found.turned[-1]) == pytest.approx(6 * math.pi, rel=4 * EPS)


def test_free_motion_against_the_quadrature() -> None:
    """t = int sqrt(J / (2 (E - V))) dq of a crank-rocker under gravity, without friction, from rest to rest to 1e-9."""
    mechanism = crank_rocker()
    start, speed = math.radians(20), 4.0
    found = ct.simulate(mechanism, ct.Simulation(speed=speed, duration=1.5, tolerance=1e-13, samples=4))
    inner = ct.reduce(mechanism, at=[start])
    energy = 0.5 * float(inner.reduced_inertia[0]) * speed**2

    def along(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        reduced = ct.reduce(mechanism, at=np.ravel(q))
        motion = ct.motion(mechanism, at=np.ravel(q))
        heights = motion.position.sel(axis="y")
        middle = [
            3 * 0.5 * heights.sel(point="A"),
            5 * 0.5 * (heights.sel(point="A") + heights.sel(point="B")),
            4 * 0.5 * heights.sel(point="B"),
        ]
        return reduced.reduced_inertia.values, 9.81 * sum(part.values for part in middle)

    v_start = along(np.array([start]))[1][0]
    nodes, weights = np.polynomial.legendre.leggauss(20)
    for k in range(1, 4):
        edges = np.linspace(start, float(found.drive_value[k, 0]), 61)
        half = np.diff(edges) / 2
        q = (edges[:-1] + half)[:, None] + half[:, None] * nodes
        inertia, potential = along(q)
        pace = np.sqrt(inertia / (2 * (energy - (potential - v_start))))
        time = float(np.sum(half[:, None] * weights * pace.reshape(q.shape)))
        assert time == pytest.approx(float(found.time[k]), abs=1e-9)


LOADS = """
[[loads]]
kind = "friction"
link = "OA"
value = 1.5
[[loads]]
kind = "friction"
link = "AB"
relative_to = "OA"
viscous = 0.4
quadratic = 0.2
[[loads]]
kind = "spring"
points = ["A", "D"]
stiffness = 3
free_length = 2
[[loads]]
kind = "damper"
link = "DB"
damping = 0.3
[[loads]]
kind = "spring"
link = "DB"
stiffness = 2
free_angle = 1.5
[[loads]]
kind = "force"
point = "B"
vector = [-4, "2*cos(3*t)"]
while_moving = [1, 0]
"""


@pytest.mark.parametrize("tolerance", few([1e-8], [1e-8, 1e-11]))
def test_energy_balance_with_friction(tolerance: float) -> None:
    """Works are integrated, energies are those of the places themselves: the residual is the integrator's."""
    found = ct.simulate(
        crank_rocker(LOADS), ct.Simulation(driving="8 - 0.5*v", speed=2, duration=12, tolerance=tolerance)
    )
    turnover = sum(
        float(np.sum(np.abs(np.diff(found[name].values))))
        for name in ("kinetic_energy", "potential_energy", "work_of_drive", "work_of_friction")
    )
    assert found.attrs["worst_energy_residual"] <= 100 * tolerance * turnover
    assert float(found.work_of_friction[-1]) < 0.0
    # friction takes energy at every instant
    assert (np.diff(found.work_of_friction.values) <= tolerance * turnover).all()


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_run_up_in_either_sense(sense: float) -> None:
    """J v' = a - b v in the sense of the drive; what is found counts along its value."""
    found = ct.simulate(
        rotor(sense=sense), ct.Simulation(driving="3 - 0.5*v", duration=4, tolerance=TIGHT, samples=50)
    )
    t = found.time.values
    speed = 6 * (1 - np.exp(-t))
    assert found.drive_speed.values == pytest.approx(sense * speed, abs=grown(TIGHT, 6 * found.evaluations))
    turned = 6 * (t + np.exp(-t) - 1)
    assert found.turned.values == pytest.approx(turned, abs=grown(TIGHT, 24 * found.evaluations))
    assert sense * found.drive_value.values[-1, 0] > 0.0
    driving = 3 - 0.5 * sense * found.drive_speed.values
    assert found.driving_moment.values == pytest.approx(sense * driving, rel=8 * EPS)


def test_the_steady_motion_by_the_energy_equation() -> None:
    """Driven by the moment of `steady_motion`, from its speed, the press runs as that says: over a turn and back."""
    press = ct.example("six-bar-press")
    steady = ct.steady_motion(press, samples=181)
    assert press.machine is not None
    shaft = press.machine.shafts[0].model_copy(update={"inertia": steady.attrs["inertia"]})
    machine = press.machine.model_copy(update={"shafts": (shaft,)})
    # given in the sense of the drive, which turns against its value
    moment = -float(steady.driving_moment[0])
    settings = ct.Simulation(
        driving=repr(moment),
        speed=-float(steady.drive_speed[0]),
        duration=1.1 * float(steady.time[-1]),
        tolerance=TIGHT,
    )
    times = np.clip(steady.time.values, 0.0, None)
    found = ct.simulate(press.model_copy(update={"machine": machine}), settings, at=times, motion=True)
    reach = grown(TIGHT, 10 * found.evaluations)
    assert found.drive_speed.values == pytest.approx(steady.drive_speed.values, abs=reach)
    assert found.drive_acceleration.values == pytest.approx(steady.drive_acceleration.values, abs=10 * reach)
    assert found.velocity.values == pytest.approx(steady.velocity.values, abs=10 * reach)


def test_the_regime_of_the_run_up() -> None:
    """The regime found by the return map is the one that a long run-up comes to, and balances the source's works."""
    press = ct.example("six-bar-press-run-up")
    regime = steady_regime(press)
    assert press.simulation is not None
    # six periods after the multiplier 0.276 has worn off the start
    later = ct.simulate(press, press.simulation.model_copy(update={"duration": 25.0, "samples": 20001}))
    last = -later.drive_speed.values[later.time.values > 25.0 - regime.time]
    step = 25.0 / 20000
    curved = float(np.max(np.abs(np.diff(last, 2))))
    assert last.max() == pytest.approx(regime.greatest_speed, abs=curved + 1e-7)
    assert last.min() == pytest.approx(regime.least_speed, abs=curved + 1e-7)
    assert regime.time == pytest.approx(2 * math.pi / regime.mean_speed, rel=1e-12)
    assert step < regime.time / 500
    assert regime.multiplier == pytest.approx(0.276, abs=0.001)
    # the loads do not depend on the speed: their work is that of a cycle at any
    assert regime.driving_moment == pytest.approx(
        ct.flywheel(ct.example("six-bar-press")).work_of_loads / (2 * math.pi), rel=1e-9
    )


def test_the_sphere_against_its_closed_forms() -> None:
    """The thesis's equation with gamma and psi by hand, integrated by another program."""
    crank, coupler, alpha, moment = math.pi / 12, math.pi / 4, 0.1, 1.0
    found = ct.simulate(
        spherical(crank, coupler), ct.Simulation(driving="1", duration=6, tolerance=TIGHT, samples=7)
    )
    i_ab, i_cb = 1 - math.cos(crank), 1 - math.cos(coupler)

    def angles(b: float) -> tuple[float, float]:
        gamma = math.asin(math.sin(crank) * math.cos(b) / math.sin(coupler))
        x, y = math.cos(crank), math.sin(crank) * math.sin(b)
        psi = math.asin(math.cos(coupler) / math.hypot(x, y)) - math.atan2(y, x)
        return gamma, psi

    def slopes(b: float) -> tuple[float, float]:
        gamma, psi = angles(b)
        g = -math.sin(crank) * math.sin(b) / (math.sin(coupler) * math.cos(gamma))
        p = -math.sin(crank) * math.cos(psi) * math.cos(b)
        p /= math.cos(crank) * math.cos(psi) - math.sin(crank) * math.sin(psi) * math.sin(b)
        return g, p

    def inertia(b: float) -> float:
        g, p = slopes(b)
        return i_ab + i_cb * g * g + 2 * p * p

    def rates(_t: float, y: np.ndarray) -> list[float]:
        b, v = y
        g, p = slopes(b)
        # five-point difference of the inertia: 1e-3 to the fourth power, over a function that varies within 1 rad
        h = 1e-3
        slope = (8 * (inertia(b + h) - inertia(b - h)) - inertia(b + 2 * h) + inertia(b - 2 * h)) / (12 * h)
        friction = alpha * v * v * (1 + g * g + p * p)
        return [v, (moment - friction - 0.5 * slope * v * v) / inertia(b)]

    other = scipy.integrate.solve_ivp(
        rates, (0, 6), [0.0, 0.0], "DOP853", found.time.values, rtol=1e-11, atol=1e-11
    )
    assert found.drive_speed.values == pytest.approx(other.y[1], abs=1e-8)


PLAIN = """
[[loads]]
kind = "friction"
link = "DB"
viscous = 0.3
quadratic = 0.2
[[loads]]
kind = "spring"
link = "DB"
stiffness = 2
free_angle = 1.5
"""


@pytest.mark.parametrize("mechanism", [crank_rocker(PLAIN), ct.example("spherical-crank-rocker-rigid")])
def test_another_integration_of_the_reduction(mechanism: ct.Mechanism) -> None:
    """The reduction asked at every instant, in place of its series and formulas; smooth loads, no events."""
    reducer = Reducer.of(mechanism)

    def rates(t: float, y: np.ndarray) -> list[float]:
        at = reducer.at([y[0]], [y[1]], time=[t])
        moment = at.moment[0] + 1.5 - 0.3 * y[1] + math.sin(4 * t)
        return [y[1], float((moment - 0.5 * at.inertia_slope[0] * y[1] ** 2) / at.inertia[0])]

    start, duration = reducer.ready.kinematics.path.initial, few(0.2, 0.6)
    other = scipy.integrate.solve_ivp(rates, (0, duration), [start, 2.0], "DOP853", rtol=1e-10, atol=1e-11)
    settings = ct.Simulation(driving="1.5 - 0.3*v + sin(4*t)", speed=2, duration=duration, tolerance=TIGHT)
    found = ct.simulate(mechanism, settings)
    reach = grown(1e-10, other.nfev)
    assert float(found.drive_value[-1, 0]) == pytest.approx(other.y[0, -1], abs=reach)
    assert float(found.drive_speed[-1]) == pytest.approx(other.y[1, -1], abs=reach)


def test_the_representation_tells_its_error() -> None:
    found = ct.simulate(crank_rocker(LOADS), ct.Simulation(driving="8", speed=2, duration=2))
    assert 0.0 < found.attrs["representation_error"] < 1e-11


def test_instants_and_motion() -> None:
    mechanism = crank_rocker()
    at = [0.0, 0.4, 0.7]
    found = ct.simulate(mechanism, ct.Simulation(speed=3, duration=1), at=at, motion=True)
    assert found.time.values.tolist() == at
    there = ct.kinematic_coefficients(mechanism, at=found.drive_value.values[:, 0])
    rate = found.drive_speed.values
    expected = there.velocity_coefficient.isel(drive=0).values * rate[:, None, None]
    assert found.velocity.values == pytest.approx(expected, abs=64 * EPS * 4 * np.abs(rate).max())


def test_an_interruption_keeps_what_is_done() -> None:
    def stop(share: float) -> None:
        if share > 0.3:
            raise KeyboardInterrupt

    found = ct.simulate(crank_rocker(), ct.Simulation(speed=3, duration=50), progress=stop)
    assert found.attrs["ended"] == "interrupted"
    assert 10 < float(found.time[-1]) < 50


def test_motors() -> None:
    """Kloss: the breakdown moment at the breakdown slip, nothing at the synchronous speed; both through their gear."""
    speeds = {"0.8": 157.0 * 0.8 / 3, "1": 157.0 / 3}
    kloss = Motor(kind="asynchronous", idle_speed=157, breakdown_moment=40, breakdown_slip=0.2, ratio=3)
    moments = {}
    for name, speed in speeds.items():
        found = ct.simulate(rotor(), ct.Simulation(motor=kloss, speed=speed, duration=1e-3), at=[0.0])
        moments[name] = float(found.driving_moment[0])
    assert moments["0.8"] == pytest.approx(3 * 40, rel=1e-12)
    assert moments["1"] == pytest.approx(0.0, abs=1e-10)
    line = Motor(kind="linear", idle_speed=100, starting_moment=20, ratio=2)
    found = ct.simulate(rotor(), ct.Simulation(motor=line, speed=10, duration=1e-3), at=[0.0])
    assert float(found.driving_moment[0]) == pytest.approx(2 * 20 * (1 - 20 / 100), rel=1e-12)


def test_a_regime_that_any_speed_is() -> None:
    """Without loads and drive every speed comes back."""
    regime = steady_regime(rotor(), ct.Simulation(speed=5))
    assert regime.multiplier == 1.0
    assert regime.indifferent
    assert regime.fluctuation == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("bottom", [12.0, 7.4872])
def test_a_pendulum_that_turns_over_has_no_regime_of_its_own(bottom: float) -> None:
    """It turns in 2 k K(k) / w at any speed; barely over the top (7.48713 rad/s) deviations grow by rounding alone."""
    length = 0.7
    regime = steady_regime(pendulum(), ct.Simulation(speed=math.sqrt(bottom**2 - 2 * 9.81 / length)))
    w = math.sqrt(9.81 / length)
    k = 2 * w / bottom
    assert regime.indifferent
    assert regime.greatest_speed == pytest.approx(bottom, rel=1e-8)
    assert regime.time == pytest.approx(2 * k * scipy.special.ellipk(k * k) / w, rel=1e-5)


def test_a_moment_that_balances_the_loads_at_any_speed() -> None:
    """Not conservative, and yet any speed comes back: 3 N m against a load of 3 N m."""
    load = '[[loads]]\nkind = "torque"\nlink = "OA"\nvalue = -3\n'
    assert steady_regime(rotor(load), ct.Simulation(driving="3", speed=5)).indifferent
    assert not steady_regime(ct.example("six-bar-press-run-up")).indifferent


@pytest.mark.parametrize("seed", range(few(3, 5)))
def test_random_mechanisms_keep_their_balance(seed: int) -> None:
    """Every kind of load at once: works, energies and the reduction between the nodes agree."""
    random = np.random.default_rng(seed)
    kinds = random.choice(KINDS, 1 + seed % 3).tolist()
    mechanism = mechanism_of(burdened(grown_parts(kinds, seed), seed))
    tolerance = 1e-9
    settings = ct.Simulation(driving="20 - 2*v + 5*sin(2*t)", speed=1, duration=1, tolerance=tolerance)
    try:
        found = ct.simulate(mechanism, settings)
    except ct.InputError as refused:
        assert (
            "moment of inertia is zero where" in refused.what or "no link has a mass" in refused.what
        )  # the crank may have no mass
        return
    near = found.attrs["ended"] == "limit"
    turnover = sum(
        float(np.sum(np.abs(np.diff(found[name].values))))
        for name in (
            "kinetic_energy",
            "potential_energy",
            "work_of_drive",
            "work_of_friction",
            "work_of_other_loads",
        )
    )
    # towards a limit the inertia grows by six powers of ten, and energies with it
    assert found.attrs["worst_energy_residual"] <= (1e6 if near else 100) * tolerance * turnover
    assert found.attrs["representation_error"] < 1e-8
