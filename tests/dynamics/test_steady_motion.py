"""Steady motion against closed forms, against the integrated equation of motion, and against its own energies."""

from __future__ import annotations

import math
import tomllib
from itertools import pairwise

import numpy as np
import pytest
import tomli_w
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import centrode as ct
from centrode.dynamics.steady_motion import steady
from centrode.dynamics.steady_motion.speed import MeanSpeed
from centrode.dynamics.steady_motion.steady import solution_of
from machines import STROKE, centre_of, crank, engine, kinetic_energy
from samples import few

EPS = float(np.finfo(np.float64).eps)
MEANS: tuple[MeanSpeed, ...] = ("middle", "time")
PUSH = """\
[[loads]]
kind = "damper"
points = ["O", "B"]
damping = 60
"""


@pytest.mark.parametrize("speed", [1.0, -2.5])
@pytest.mark.parametrize("fluctuation", [0.004, 0.02, 0.045, 0.8])
def test_a_crank_in_closed_form(speed: float, fluctuation: float) -> None:
    """Constant inertia 2, M = -s (20 + 5 sin q): the work swings by 10 J, so J omega_m^2 delta = 10 J for all of J."""
    sense = math.copysign(1.0, speed)
    mechanism = crank(f"{-sense}*(20 + 5*sin(q))", fluctuation, speed)
    found = ct.flywheel(mechanism)
    assert found.turns == 1
    assert abs(found.work_of_loads + 40 * math.pi) <= found.error
    assert found.driving_moment == pytest.approx(sense * 20.0, rel=64 * EPS)
    assert found.energy_greatest - found.energy_least == pytest.approx(10.0, rel=64 * EPS * 20)
    needed = 10.0 / (100.0 * fluctuation)
    # the energy of the links counts as constant in the source's way: their inertia is not taken off
    assert found.inertia_first_order == pytest.approx(needed, rel=1e-12)
    assert found.inertia == pytest.approx(needed - 2.0, rel=1e-11)
    assert found.inertia_by_tangents == pytest.approx(needed - 2.0, rel=1e-11)
    assert (found.added == 0.0) == (fluctuation > 0.05)
    total, real = max(needed, 2.0), min(fluctuation, 0.05)
    assert found.obtained == pytest.approx(real, rel=1e-11)
    assert found.greatest_speed == pytest.approx(10.0 * (1 + real / 2), rel=1e-12)
    data = ct.steady_motion(mechanism, 37)
    turned = data.turned.values
    work = 5.0 * sense * (np.cos(0.3 + sense * turned) - np.cos(0.3))
    np.testing.assert_allclose(data.work, work, rtol=0.0, atol=64 * EPS * 40 * math.pi)
    square = 100.0 * (1 - real / 2) ** 2 + 2 * (work + 5.0 * (1 + sense * np.cos(0.3))) / total
    np.testing.assert_allclose(data.drive_speed**2, square, rtol=1e-11)
    np.testing.assert_allclose(
        data.drive_acceleration,
        -5.0 * sense * np.sin(0.3 + sense * turned) / total,
        rtol=0.0,
        atol=1e-11 * 5 / total,
    )
    np.testing.assert_allclose(data.angular_velocity[:, 0], data.drive_speed, rtol=4 * EPS)


@pytest.mark.parametrize("mean", MEANS)
@pytest.mark.parametrize("fluctuation", few([0.002, 0.4], [0.002, 0.05, 0.4]))
@pytest.mark.parametrize("more", ["", PUSH])
def test_the_speed_has_the_fluctuation_asked_for(mean: MeanSpeed, fluctuation: float, more: str) -> None:
    """To 1e-9 and better, by the energies at many places: from the quadrature, not from the tangents."""
    found = solution_of(engine(f"fluctuation = {fluctuation}", more), mean)
    assert found.needed is not None
    assert found.speed.inertia == found.needed > 0.0
    turned = np.linspace(0.0, found.cycle.period, 20001)
    speeds = found.speed.at(turned)
    ends = found.speed.extremes()
    # between samples the speed keeps below its extremes by half the curvature times the squared step
    assert 0.0 <= ends.greatest - speeds.max() <= 1e-6 * 20 * fluctuation
    assert 0.0 <= speeds.min() - ends.least <= 1e-6 * 20 * fluctuation
    assert abs((ends.greatest - ends.least) / 20.0 - fluctuation) <= 1e-9
    middle, in_time = (
        0.5 * (ends.greatest + ends.least),
        found.cycle.period / float(found.speed.time(turned)[-1]),
    )
    assert abs((middle if mean == "middle" else in_time) - 20.0) <= 1e-9
    assert abs(in_time - middle) > 1e-9, "the two meanings differ"


MACHINES: list[tuple[str, str, MeanSpeed]] = [
    ("fluctuation = 0.2", "", "middle"),
    ("fluctuation = 0.4", PUSH, "time"),
    ("[[machine.shafts]]\ninertia = 0.5\nratio = -3", "", "time"),
    ("[[machine.shafts]]\ninertia = 0.5\nratio = -3", PUSH, "middle"),
]


@pytest.mark.parametrize(
    ("machine", "more", "mean"),
    few(MACHINES[1::2], MACHINES),
)
def test_the_equation_of_motion_gives_the_same_speed(machine: str, more: str, mean: MeanSpeed) -> None:
    """(J_I + J_II) omega omega' + J_II' omega^2 / 2 = M, integrated over the cycle by DOP853."""
    mechanism = engine(machine, more)
    found = solution_of(mechanism, mean)
    cycle, moment = found.cycle, found.balance.driving_moment
    if found.needed is None:
        assert found.speed.inertia == pytest.approx(4.5, rel=4 * EPS)
    drive = found.speed.balance.driving_moment
    assert drive == pytest.approx(moment, rel=0.1)

    def slope(turned: float, speed: np.ndarray) -> np.ndarray:
        at = np.array([turned % cycle.period])
        inertia, change, load = cycle.reduction.at(cycle.value(at), speed)
        return (drive + load - 0.5 * change * speed**2) / ((found.speed.inertia + inertia) * speed)

    # the load jumps where the piston turns back: between, everything is smooth
    jumps = np.sort(cycle.sense * (np.array(cycle.reduction.jumps(0.4, 0.4 + cycle.period)) - cycle.first))
    inner = jumps[(jumps > 1e-9) & (jumps < cycle.period - 1e-9)]
    assert len(inner) == 2
    speed = found.speed.at(np.array([0.0]))
    for low, high in zip([0.0, *inner], [*inner, cycle.period], strict=True):
        inside = low + 1e-12, high - 1e-12
        run = solve_ivp(slope, inside, speed, method="DOP853", rtol=1e-9, atol=1e-10)
        assert run.success
        speed = run.y[:, -1]
        assert abs(speed[0] - found.speed.at(np.array([high - 1e-12]))[0]) <= 1e-7 * speed[0]
    assert abs(speed[0] - found.speed.at(np.array([0.0]))[0]) <= 1e-7 * speed[0], "the cycle closes"


@pytest.mark.parametrize("mechanism", [engine(), engine(speed=-1.0), ct.example("six-bar-press")])
def test_energy_closes_over_the_cycle(mechanism: ct.Mechanism) -> None:
    """Kinetic and potential energy by real velocities and places, work of the load by the way of its point."""
    data = ct.steady_motion(mechanism, 721)
    inertia = data.attrs["inertia"]
    shaft = 0.5 * inertia * data.drive_speed.values**2
    potential = np.zeros(721)
    for name, link in mechanism.links.items():
        if link.mass is not None and link.centre is not None:
            potential -= link.mass * centre_of(mechanism, data, name) @ np.array(mechanism.gravity)
    load = mechanism.loads[0]
    way = data.position.sel(point=load.point, axis="x").values
    # the load acts on the way out only: its work is that of all the ways out, to the turning points
    out = np.maximum(np.diff(way), 0.0)
    force = -float(load.vector[0])
    work = -force * np.concatenate([[0.0], np.cumsum(out)])
    energy = kinetic_energy(mechanism, data) + shaft + potential
    turned = data.turned.values
    driven = data.driving_moment.values[0] * (data.drive_value.values[:, 0] - data.drive_value.values[0, 0])
    balance = energy - energy[0] - driven - work
    # samples miss the turning point by at most half a step: the way lost there is a (step/2)^2 / 2
    lost = force * 2 * np.abs(data.acceleration_coefficient.sel(point=load.point, axis="x")).max().item()
    assert np.abs(balance).max() <= lost * (turned[1] / 2) ** 2
    assert abs(balance[-1]) <= 1e-9 * np.ptp(energy) + lost * (turned[1] / 2) ** 2
    away = np.abs(balance[1:] - balance[:-1])
    assert np.median(away) <= 1e-11 * np.abs(energy).max(), "exact but for the steps over a turning point"
    np.testing.assert_allclose(np.hypot(*data.velocity.sel(point="A").values.T), abs(data.drive_speed) * np.hypot(
        *data.velocity_coefficient.sel(point="A").values.T), rtol=64 * EPS)  # fmt: skip


TURNING = (
    "drag-link", "crank-rocker", "jansen-leg", "galloway", "geared-five-bar", "planetary-hypocycloid", "parallelogram",
    "third-class-triad", "inverted-slider-crank", "six-bar-press",
)  # fmt: skip


def burdened(name: str) -> ct.Mechanism:
    """An example with a mass on every link, weights, a torque on its last link and a greater one on its drive."""
    tables = tomllib.loads(ct.mechanism_text(ct.example(name)))
    for number, (link, table) in enumerate(tables["links"].items()):
        at = list(ct.example(name).links[link].coordinates)
        table |= {"mass": 1.0 + 0.3 * number, "centre": at[-1], "inertia": 0.05}
    drive = tables["drives"][0]
    sense = math.copysign(1.0, ct.example(name).drives[0].speed or 1.0)
    tables["gravity"] = [1.0, -9.81]
    tables["loads"] = [
        {"kind": "torque", "link": drive["link"], "value": -sense * 40.0},
        {"kind": "torque", "link": list(tables["links"])[-1], "value": 3.0},
    ]
    tables["machine"] = {"mean_speed": 3.0, "fluctuation": 0.1, "shafts": [{"inertia": 0.2}]}
    return ct.parse_mechanism(tomli_w.dumps(tables))


@pytest.mark.parametrize(
    "name", few(("crank-rocker", "galloway", "planetary-hypocycloid", "third-class-triad"), TURNING)
)
def test_energy_closes_on_any_linkage(name: str) -> None:
    """Constant torques work by the angles of their links, so the balance is exact at every sample."""
    mechanism = burdened(name)
    data = ct.steady_motion(mechanism, 25)
    shaft = 0.5 * data.attrs["inertia"] * data.drive_speed.values**2
    energy = kinetic_energy(mechanism, data) + shaft
    for link, part in mechanism.links.items():
        energy -= (part.mass or 0.0) * centre_of(mechanism, data, link) @ np.array(mechanism.gravity)
    work = data.driving_moment.values[0] * data.turned.values
    for load in mechanism.loads:
        angle = data.angle.sel(link=load.link).values
        work = work + float(load.value) * (angle - angle[0])
    size = np.abs(energy).max() + np.abs(work).max()
    # velocities near change points are good to 1e-10, and squared; elsewhere the conditioning of the linkage counts
    np.testing.assert_allclose(energy - energy[0], work, rtol=0.0, atol=1e-10 * size)
    found = ct.flywheel(mechanism)
    assert found.inertia is not None
    assert abs(found.obtained - 0.1) <= 1e-9, "by the energy equation alone"
    assert abs(0.5 * (found.greatest_speed + found.least_speed) - 3.0) <= 1e-9
    assert found.turns == {"galloway": 2}.get(name, 1)


def test_works_with_a_jump_are_exact() -> None:
    """Resisted on the way out only, the piston takes force times stroke a cycle; gravity gives back what it takes."""
    found = ct.flywheel(engine())
    assert abs(found.work_of_loads + 2000 * STROKE) <= max(found.error, 64 * EPS * 2000 * STROKE)
    assert found.error <= 1e-10 * 2000 * STROKE
    press = ct.flywheel(ct.example("six-bar-press"))
    # H stands still where O, A, B are in line: OB = 1.445 +- 0.347
    ends = []
    for reach in (1.445 + 0.347, 1.445 - 0.347):
        x = (reach**2 - 0.85**2 + 1.25**2) / 2.5
        bx, by = x - 1.25, math.sqrt(reach**2 - x**2)
        dx, dy = 1.25 + 2 * bx, 2 * by
        ends.append(dx + math.sqrt(1.7**2 - (dy - 0.9) ** 2))
    exact = -9000 * abs(ends[0] - ends[1])
    assert abs(press.work_of_loads - exact) <= press.error + 64 * EPS * abs(exact)


@pytest.mark.parametrize("samples", [2, 5, 13])
def test_nothing_depends_on_the_number_of_samples(samples: int) -> None:
    few, many = (ct.steady_motion(engine(), count) for count in (samples, 241))
    every = many.isel(sample=slice(None, None, 240 // (samples - 1)))
    for name in ("work", "energy_change", "drive_speed", "drive_acceleration", "velocity", "acceleration"):
        size = float(np.abs(many[name]).max())
        np.testing.assert_allclose(few[name], every[name], rtol=0.0, atol=1e-12 * size)
    assert few.attrs["inertia"] == many.attrs["inertia"]


def test_more_panels_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """The stated error covers what a mesh three times as fine finds."""
    coarse = ct.flywheel(engine())
    monkeypatch.setattr("centrode.dynamics.steady_motion.cycle.PANELS_PER_TURN", 217)
    monkeypatch.setattr(
        steady, "_kept_solution", lambda mechanism, kind: steady._solve(mechanism, kind, None)
    )
    fine = ct.flywheel(engine())
    assert abs(fine.work_of_loads - coarse.work_of_loads) <= coarse.error + fine.error
    assert fine.inertia == pytest.approx(coarse.inertia, rel=1e-12)
    assert fine.energy_greatest == pytest.approx(coarse.energy_greatest, abs=coarse.error + fine.error)
    assert fine.error != coarse.error


def test_first_order_misses_by_the_first_order() -> None:
    """The source's inertia differs by less and less as the fluctuation falls; the diagram is exact."""
    apart = []
    for fluctuation in (0.2, 0.1, 0.05, 0.025):
        found = ct.flywheel(engine(f"fluctuation = {fluctuation}"))
        assert found.inertia is not None
        assert found.inertia_first_order is not None
        assert found.inertia_by_tangents == pytest.approx(found.inertia, rel=1e-12)
        apart.append(abs(found.inertia_first_order - found.inertia) * fluctuation)  # of the energies
    ratios = [one / finer for one, finer in pairwise(apart)]
    assert all(1.5 < ratio < 2.7 for ratio in ratios), ratios


def test_the_tangents_touch_and_meet_at_the_inertia() -> None:
    found = solution_of(engine("fluctuation = 0.3"))
    lines = found.tangents
    assert lines is not None
    turned = np.linspace(0.0, found.cycle.period, 5001)
    inertia, work = found.cycle.inertia.at(turned), found.balance.total.integral(turned)
    size = 1e-10 * np.ptp(work)
    assert (work - lines.upper_intercept - lines.upper_slope * inertia).max() <= size
    assert (work - lines.lower_intercept - lines.lower_slope * inertia).min() >= -size
    meet = -lines.inertia
    assert lines.upper_intercept + lines.upper_slope * meet == pytest.approx(
        lines.lower_intercept + lines.lower_slope * meet, rel=1e-11
    )
    assert brentq(
        lambda x: (lines.upper_intercept - lines.lower_intercept) + (lines.upper_slope - lines.lower_slope) * x,
        -1e6, 1e6, xtol=1e-9,
    ) == pytest.approx(meet, rel=1e-9)  # fmt: skip


def test_equal_machines_keep_their_own_order_of_names() -> None:
    """Equality leaves the order of points and links open; what is kept of one machine is not told of the other."""
    machine = engine()
    described = dict(tomllib.loads(ct.mechanism_text(machine)))
    described["links"] = dict(reversed(described["links"].items()))
    turned = ct.parse_mechanism(tomli_w.dumps(described))
    assert turned == machine
    for mechanism in (machine, turned):
        assert list(ct.steady_motion(mechanism, samples=5).link.values) == list(mechanism.links)


def test_a_machine_that_cannot_be_hashed() -> None:
    machine = engine()
    copy = machine.model_copy(update={"loads": list(machine.loads)})
    assert ct.flywheel(copy).inertia == ct.flywheel(machine).inertia
