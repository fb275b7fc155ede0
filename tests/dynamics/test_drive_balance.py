"""Forces in the real motion: what the links need, with what the flywheel takes, is the driving moment."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.force_polygons.results import force_polygon_results
from centrode.dynamics.kinetostatics.reactions import has_real_motion
from centrode.dynamics.motion_results import study
from centrode.dynamics.reduction import Reducer
from centrode.dynamics.steady_motion.machine import closing_balance
from centrode.topics.presentation import sheet_of
from machines import BACKWARD_ROCKER, GAS_ENGINE, Array, centre_of, engine

PRESS = "six-bar-press"
ROUNDING = 1e4 * float(np.finfo(float).eps)
"""The equations are solved with a condition of a hundred or so, and powers are sums of some ten products."""


def gas_loads(moving: Any) -> Array:
    """Power [W] of gas and brake at each sample: the force of the table, the column by the sense of the piston."""
    rows = np.array([[0.1, -1000, -4000], [0.2, -900, -500], [0.3, 2500, -200]])
    slide = moving.slide.sel(guide="B").values
    speed = moving.slide_velocity.sel(guide="B").values
    there, back = (np.interp(slide, rows[:, 0], rows[:, column]) for column in (1, 2))
    turning = moving.angular_velocity.sel(link="OA").values
    return np.where(speed >= 0.0, there, back) * speed + (-40 - 0.1 * turning) * turning


def rocker_loads(moving: Any) -> Array:
    """Power [W] of the torque that brakes the rocker."""
    return np.asarray(-5 * moving.angular_velocity.sel(link="CB").values ** 2)


def one_sided(moving: Any) -> Array:
    """Power [W] of the force that resists the piston on its way out."""
    speed = moving.velocity.sel(point="B", axis="x").values
    return np.where(speed >= 0.0, -2000 * speed, 0.0)


MACHINES: dict[str, tuple[Callable[[], ct.Mechanism], Callable[[Any], Array]]] = {
    "gas engine": (lambda: ct.parse_mechanism(GAS_ENGINE), gas_loads),
    "rocker": (lambda: ct.parse_mechanism(BACKWARD_ROCKER), rocker_loads),
    "compressor": (engine, one_sided),
}


@pytest.fixture(scope="module", params=MACHINES)
def machine(request: pytest.FixtureRequest) -> tuple[ct.Mechanism, Any, Any, Array]:
    """A machine, its reactions in the real motion, its steady motion, and the power of its loads."""
    make, loads = MACHINES[request.param]
    mechanism = make()
    found, moving = ct.reactions(mechanism, 45, motion="real"), ct.steady_motion(mechanism, 45)
    return mechanism, found, moving, loads(moving)


def inertia_powers(mechanism: ct.Mechanism, moving: Any) -> tuple[Array, Array]:
    """Power [W] that accelerates and lifts the links at each sample, and the sum of its sizes, by point and angle."""
    power, size = np.zeros(moving.sizes["sample"]), np.zeros(moving.sizes["sample"])
    for name, link in mechanism.links.items():
        if link.mass is None:
            continue
        first = next(iter(link.coordinates))
        arm = centre_of(mechanism, moving, name) - moving.position.sel(point=first).values
        across = np.stack([-arm[:, 1], arm[:, 0]], axis=-1)
        turning = moving.angular_velocity.sel(link=name).values[:, None]
        bending = moving.angular_acceleration.sel(link=name).values[:, None]
        velocity = moving.velocity.sel(point=first).values + turning * across
        acceleration = moving.acceleration.sel(point=first).values + bending * across - turning**2 * arm
        parts = (
            link.mass * ((acceleration - np.array(mechanism.gravity or (0.0, 0.0))) * velocity).sum(axis=-1),
            (link.inertia or 0.0) * (turning * bending)[:, 0],
        )
        power += sum(parts)
        size += sum(np.abs(part) for part in parts)
    return power, size


def test_the_closing_check_of_the_coursework() -> None:
    """6310.25 + 1459.23 * (-2.7735) = 2263.0: it is printed nowhere in the source (seeds, section 2).

    The crank turns against the coordinate of this description, its value, so that moments have the other sign.
    """
    found = ct.reactions(PRESS, at=["120 deg"], motion="real")
    assert float(found.moment_of_links[0]) == pytest.approx(-6310.25, abs=0.005)
    assert found.attrs["inertia"] == pytest.approx(1459.23, abs=0.005)
    assert float(found.drive_acceleration[0]) == pytest.approx(2.7735, abs=0.00005)
    assert float(found.driving_moment[0]) == pytest.approx(-2263.0, abs=0.05)
    assert float(found.inertia_moment_of_group[0]) == pytest.approx(-1459.23 * 2.7735, abs=0.1)


def test_the_printed_slips_close_as_well() -> None:
    """With the inertias of the source's slips the same driving moment: work of the loads over a turn."""
    found = ct.reactions("six-bar-press-printed", at=["120 deg"], motion="real")
    closing = found.moment_of_links + found.attrs["inertia"] * found.drive_acceleration
    assert float(closing[0]) == pytest.approx(2263.0, abs=0.05)


def test_polygons_and_lever_give_the_same_in_the_real_motion() -> None:
    found = ct.force_polygons(PRESS, "120 deg", motion="real")
    reactions = ct.reactions(PRESS, at=["120 deg"], motion="real")
    assert found.speed_from == "steady" and found.group is not None
    needed = float(reactions.moment_of_links[0])
    for balancing in (found.balancing["OA"], found.work["OA"], found.lever.balancing):
        assert balancing == pytest.approx(needed, rel=ROUNDING)
    assert needed - found.group.inertia_moment[0] == pytest.approx(found.group.driving[0], rel=ROUNDING)
    size = float(np.hypot(*reactions.joint_force.sel(side="A/AB").values[0]))
    assert abs(found.reactions["R12"]) == pytest.approx(size, rel=ROUNDING)


def test_what_the_links_need_is_the_power_of_inertia_and_loads(machine: Any) -> None:
    """Over the speed of the drive: masses times accelerations times velocities, less what the loads give."""
    mechanism, found, moving, loads = machine
    power, size = inertia_powers(mechanism, moving)
    needed = (power - loads) / moving.drive_speed.values
    great = float(np.max((size + np.abs(loads)) / np.abs(moving.drive_speed.values)))
    assert np.abs(found.moment_of_links.values - needed).max() <= ROUNDING * great


def test_with_the_flywheel_it_is_the_driving_moment(machine: Any) -> None:
    _mechanism, found, moving, _loads = machine
    closing = found.moment_of_links + found.attrs["inertia"] * found.drive_acceleration
    size = float(np.abs(found.moment_of_links).max() + np.abs(found.inertia_moment_of_group).max())
    assert np.abs(closing - found.driving_moment).max() <= ROUNDING * size
    assert np.array_equal(found.driving_moment, moving.driving_moment)
    assert 0.0 <= found.attrs["driving_residual"] <= found.attrs["driving_error"] < 1e-9


def test_the_links_take_over_a_cycle_what_the_loads_give(machine: Any) -> None:
    """Kinetic energies come back, so that the means of both sides are the same: by the trapezoid rule, roughly."""
    mechanism, _found, _moving, _loads = machine
    found = ct.reactions(mechanism, 721, motion="real")
    work = float(np.trapezoid(found.moment_of_links.values, found.drive_value.values[:, 0]))
    wheel = ct.flywheel(mechanism)
    great = 2 * np.pi * float(np.abs(found.moment_of_links).max())
    # jumps of the loads cost a step each
    assert abs(work + wheel.work_of_loads) <= great / 720


# One sign of every moment in a document, whichever way the drive turns.

CLOCKWISE = '[study]\ncoordinate = { link = "OA", sense = "clockwise" }\n'
ONE_SIGN: dict[str, tuple[Callable[[], ct.Mechanism], float]] = {
    "press": (lambda: ct.example(PRESS), -1.0),
    "press as printed": (lambda: ct.example("six-bar-press-printed"), 1.0),
    "gas engine": (lambda: ct.parse_mechanism(GAS_ENGINE), 1.0),
    "gas engine, against": (lambda: ct.parse_mechanism(GAS_ENGINE + CLOCKWISE), -1.0),
    "backward rocker": (lambda: ct.parse_mechanism(BACKWARD_ROCKER), -1.0),
    "backward rocker, along": (lambda: ct.parse_mechanism(BACKWARD_ROCKER + CLOCKWISE), 1.0),
}
"""Machines, and whether their drive turns along its coordinate."""


@pytest.mark.parametrize("name", ONE_SIGN)
def test_no_document_has_two_signs_of_one_moment(name: str) -> None:
    """Reduction, flywheel, real motion, reactions, force polygons, closing balance and simulation count alike."""
    make, along = ONE_SIGN[name]
    mechanism = make()
    results = study(mechanism, 13, motion="real")
    machine, found = results.machine, results.reactions
    assert machine is not None and found is not None
    steady, forces = machine.steady, found.reactions
    values = steady.drive_value.values[:, 0]
    assert np.all(np.sign(steady.drive_speed) == along)
    assert np.allclose(steady.drive_speed, forces.drive_rate, rtol=ROUNDING, atol=0)
    # moments of loads and the slope of the inertia: those of the reduction at the same place and speed
    reduced = [Reducer.of(mechanism).at(values[k], float(steady.drive_speed[k])) for k in range(1, 13)]
    for one, name_of in (("moment", "moment_of_loads"), ("inertia_slope", "inertia_slope_of_links")):
        expected = np.array([float(getattr(at, one)[0]) for at in reduced])
        assert np.abs(steady[name_of].values[1:] - expected).max() <= 1e-6 * np.abs(expected).max(), name_of
    # what the drive gives, by work over the cycle, by the mean of the course, in the forces
    assert np.sign(machine.flywheel.driving_moment) == along
    assert float(steady.driving_moment.mean()) == pytest.approx(machine.flywheel.driving_moment, rel=ROUNDING)
    assert np.array_equal(forces.driving_moment, steady.driving_moment)
    assert np.array_equal(forces.moment_of_links, forces.balancing[:, 0], equal_nan=True)
    assert np.array_equal(forces.drive_acceleration, steady.drive_acceleration)
    # the closing balance, and by hand at the same place
    here = closing_balance(machine)
    at = float(here.drive_value[0])
    links = float(here.moment_of_links)
    assert links + here.attrs["inertia"] * float(here.drive_acceleration) == pytest.approx(
        float(here.driving_moment), rel=1e-9
    )
    (balancing,) = ct.force_polygons(mechanism, at, motion="real").balancing.values()
    assert balancing == pytest.approx(links, rel=1e-9)
    # set going at its mean speed: the first instant of a simulation is that of the reduction
    assert mechanism.machine is not None
    speed = mechanism.machine.mean_speed
    run = ct.simulate(mechanism, ct.Simulation(duration=1e-3, driving="0", speed=speed, samples=2))
    start = Reducer.of(mechanism).at(float(run.drive_value[0, 0]), along * speed)
    assert float(run.moment_of_loads[0]) == pytest.approx(float(start.moment[0]), rel=1e-9)
    assert np.sign(run.drive_speed[0]) == along


def test_the_mean_motion_knows_no_flywheel() -> None:
    found = ct.reactions(PRESS, 5)
    assert found.attrs["rate_from"] == "machine"
    assert "driving_moment" not in found and "inertia" not in found.attrs
    assert ct.force_polygons(PRESS, 2.0).group is None


def test_loads_of_time_see_the_time_that_the_energies_see() -> None:
    """In the works the time in formulas runs as at the mean speed; with the real one the balance would not close."""
    mechanism = engine(more='[[loads]]\nkind = "torque"\nlink = "OA"\nvalue = "-300 - 250*sin(20*t)"')
    found = ct.reactions(mechanism, 37, motion="real")
    assert found.attrs["driving_residual"] <= found.attrs["driving_error"]


def test_a_run_has_the_forces_of_the_motion_that_is_chosen() -> None:
    mean, real = (study(ct.example(PRESS), 19, motion=motion) for motion in ("mean", "real"))  # type: ignore[arg-type]
    assert mean.reactions is not None and real.reactions is not None
    assert mean.reactions.reactions.attrs["rate_from"] == "machine"
    assert real.reactions.reactions.identical(ct.reactions(PRESS, 19, motion="real"))


def test_which_machines_have_a_real_motion() -> None:
    assert has_real_motion(ct.example(PRESS))
    assert not has_real_motion(ct.example("single-cylinder-engine"))
    driven = engine(more='[[loads]]\nkind = "torque"\nlink = "OA"\nvalue = "900"')  # the loads drive
    assert not has_real_motion(driven)
    rubbing = engine(
        more='[[loads]]\nkind = "friction"\npoint = "A"\nlink = "AB"\ncoefficient = 0.1\nradius = 0.01'
    )
    assert not has_real_motion(rubbing)


def test_the_terminal_shows_the_balance_with_its_numbers() -> None:
    shown = "M_b + J_I·ε = -6310.25 + 1459.23·2.77354 = -2263.03 N·m"
    assert shown in ct.summary(ct.reactions(PRESS, at=["120 deg"], motion="real"))
    assert shown in ct.summary(force_polygon_results(ct.example(PRESS), ["120 deg"], motion="real"))
    sheet = sheet_of(ct.reactions(PRESS, 13, motion="real"))
    columns = [column.name for column in sheet.tables["reactions"].columns]
    names = ["drive_acceleration", "moment_of_links", "inertia_moment_of_group", "driving_moment"]
    assert [name for name in columns if name in names] == names
    assert "drive-balance" in sheet.pictures
    assert "the real speed of the machine" in ct.summary(ct.reactions(PRESS, 13, motion="real"))


@pytest.mark.parametrize(
    "call",
    [
        lambda: ct.reactions(PRESS, 5, motion="steady"),  # type: ignore[arg-type]
        lambda: ct.force_polygons(PRESS, 2.0, motion="fast"),  # type: ignore[arg-type]
        lambda: study(ct.example(PRESS), 5, motion=""),  # type: ignore[arg-type]
    ],
)
def test_another_motion_is_refused(call: Callable[[], Any]) -> None:
    with pytest.raises(ct.InputError, match="is not a motion of the drive; use one of mean, real"):
        call()


def test_the_real_motion_needs_a_machine() -> None:
    with pytest.raises(ct.InputError, match=r"\[machine\]"):
        ct.force_polygons("single-cylinder-engine", 1.0, motion="real")
