"""Events of free motions: impacts, friction that sticks, clamps and conditions, against tables and closed forms.

The tables in tests/reference/dynamics: end-stop by quadrature of the energy in 30 digits, double-pendulum-wall
and stick-slip by SciPy's DOP853 at 1e-13 with its events and by a second code; each has its advised tolerance.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.forward_dynamics.bounded_forces import forces_within, impulses_of_impact
from centrode.errors import InputError

TABLES = Path(__file__).parents[2] / "reference" / "dynamics"
ROD = {"shape": "rod"}
TIGHT = 1e-12


def rows(name: str) -> list[dict[str, str]]:
    with (TABLES / f"{name}.csv").open() as file:
        return list(csv.DictReader(file))


def happened(run, *kinds: str, part: str = "") -> list[int]:
    """Numbers of the occasions of some kinds."""
    names = run.occasion_kind.attrs["flag_meanings"].split()
    return [
        k
        for k, kind in enumerate(run.occasion_kind.values)
        if names[kind] in kinds and (not part or run.occasion_part.values[k] == part)
    ]


def slider_crank(**parts: object) -> ct.Mechanism:
    """Crank OA 0.1 m, rod AB 0.3 m, slider B of 1 kg on the x axis, ahead of O."""
    given: dict[str, object] = {
        "gravity": [0, -9.81],
        "frame": {"points": {"O": [0, 0]}},
        "links": {
            "OA": {"length": 0.1, "mass": 0.2, **ROD},
            "AB": {"length": 0.3, "mass": 0.5, **ROD},
            "slider": {"points": ["B"], "mass": 1},
        },
        "guides": [{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "slider"}],
        "drives": [{"link": "OA", "start": "60 deg", "speed": 1}],
        "assembly": {"sides": {"B": "ahead"}},
    }
    return ct.Mechanism(**(given | parts))


def sledge(**parts: object) -> ct.Mechanism:
    """A block of 2 kg on a guide along x, at the origin."""
    given: dict[str, object] = {
        "frame": {"points": {"O": [0, 0]}},
        "links": {"block": {"points": {"P": [0, 0]}, "mass": 2}},
        "guides": [{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
        "drives": [{"guide": "P", "start": 0}],
    }
    return ct.Mechanism(**(given | parts))


def simulated(mechanism: ct.Mechanism, duration: float, at=None, **settings: object):
    chosen = ct.Simulation(duration=duration, tolerance=TIGHT, **settings)
    return ct.simulate(mechanism, chosen, at=at)


# Public tables.


def test_a_slider_crank_at_an_end_stop_bounces_at_the_instants_of_the_energy_integral():
    run = simulated(slider_crank(stops=[{"guide": "B", "most": 0.38, "restitution": 0.5}]), 1.0)
    hits, table = happened(run, "impact"), rows("end-stop")
    times = run.occasion_time.values[hits]
    for time, row in zip(times, table, strict=False):
        assert abs(time - float(row["t"])) < 1e-10
    # speeds before and behind: lost energies by the reduced inertia at the stop
    lost = run.occasion_loss.values[hits][: len(table)]
    before = np.array([float(row["crank_speed_before"]) for row in table])
    assert np.allclose(lost / lost[0], (before / before[0]) ** 2, rtol=1e-9)
    # impacts accumulate as a geometric series; behind that the mechanism rests on the stop
    (rest,) = happened(run, "comes_to_rest")
    late = times[-6:-3]
    aitken = late[2] - (late[2] - late[1]) ** 2 / (late[2] - 2 * late[1] + late[0])
    assert abs(run.occasion_time.values[rest] - aitken) < 1e-8
    assert abs(float(run.drive_value[-1, 0]) - 0.55978664859225159) < 1e-12
    assert run.attrs["worst_energy_residual"] < 1e-10
    assert np.all(run.restraint_force.values[run.contact_mode.values != 0] < 0.0)


def test_a_double_pendulum_at_a_wall_jumps_by_the_mass_matrix():
    pendulum = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "angle": -1.8, **ROD},
            "AB": {"length": 1, "mass": 1, "angle": -2.4, **ROD},
        },
        stops=[{"point": "B", "direction": [1, 0], "most": 0.6, "restitution": 0.6}],
    )
    table = rows("double-pendulum-wall")
    run = simulated(pendulum, 5.0, at=[*(float(row["t"]) + 1e-9 for row in table), 5.0])
    hits = happened(run, "impact")
    assert len(hits) == len(table)
    for number, (hit, row) in enumerate(zip(hits, table, strict=True)):
        assert abs(run.occasion_time.values[hit] - float(row["t"])) < 1e-9
        assert abs(run.occasion_impulse.values[hit] - float(row["impulse"])) < 1e-9
        speeds = run.generalised_velocity.values[number]
        # a nanosecond behind the impact, at accelerations of some 20 rad/s^2
        assert np.allclose(speeds, [float(row["dOA_after"]), float(row["dAB_after"])], atol=1e-7)
    reached = [*run.generalised_coordinate.values[-1], *run.generalised_velocity.values[-1]]
    assert np.allclose(reached, [-1.3172039455, -1.5205126338, 0.93980970724, 0.47487632689], atol=1e-9)


def stick_slip() -> ct.Mechanism:
    return slider_crank(
        gravity=None,
        links={
            "OA": {"length": 0.1, "mass": 0.2, **ROD},
            "AB": {"length": 0.3},
            "block": {"points": ["B"], "mass": 1},
        },
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
        drives=[{"link": "OA", "start": "90 deg", "speed": 1}],
        loads=[
            {"kind": "spring", "link": "OA", "stiffness": 1.5, "free_angle": "90 deg"},
            {"kind": "friction", "guide": "B", "value": 3, "static": 4.5, "surface_speed": 0.1},
        ],
    )


def test_a_block_on_a_belt_sticks_and_slips_at_the_instants_of_the_table():
    table = rows("stick-slip")
    run = simulated(stick_slip(), 2.0, at=[float(row["t"]) for row in table])
    events = happened(run, "sticks", "slips")
    names = run.occasion_kind.attrs["flag_meanings"].split()
    assert [names[run.occasion_kind.values[k]] for k in events] == [row["event"] for row in table]
    for number, (event, row) in enumerate(zip(events, table, strict=True)):
        assert abs(run.occasion_time.values[event] - float(row["t"])) < 1e-9
        assert abs(float(run.drive_value[number, 0]) - float(row["crank_angle"])) < 1e-9
    assert run.attrs["worst_energy_residual"] < 1e-11


# Closed forms.


def test_a_ball_between_two_walls_keeps_its_time_and_loses_what_restitution_says():
    ball = sledge(stops=[{"guide": "P", "least": -1, "most": 1, "restitution": 0.8}])
    run = simulated(ball, 5.0, speeds={"guides.P": 1.0})
    # each way of two metres takes 2 / 0.8^n seconds
    assert np.allclose(run.occasion_time.values, [1.0, 1.0 + 2 / 0.8], atol=1e-13)
    assert np.allclose(run.occasion_loss.values, [0.36, 0.36 * 0.64], rtol=1e-12)


def test_a_rope_that_gets_taut_without_restitution_holds_a_pendulum():
    rope = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0], "R": [0.5, 0]}},
        links={
            "body": {"points": {"P": [0, 0]}, "mass": 1},
            "cross": {"points": {"Q": [0, 0]}, "mass": 1e-9},
        },
        guides=[
            {"point": "Q", "on": "frame", "through": "O", "direction": [1, 0], "link": "cross"},
            {"point": "P", "on": "cross", "through": [0, 0], "direction": [0, 1], "link": "body"},
        ],
        stops=[{"points": ["R", "P"], "most": 1.0, "name": "rope"}],
    )
    run = simulated(rope, 1.0, at=np.linspace(0, 1, 201))
    (hit,) = happened(run, "impact")
    # it falls until the rope from (0.5, 0) is 1 m long
    fall = math.sqrt(1.0 - 0.25)
    assert abs(run.occasion_time.values[hit] - math.sqrt(2 * fall / 9.81)) < 1e-12
    apart = run.position.sel(point="P").values - [0.5, 0]
    behind = run.time.values > run.occasion_time.values[hit]
    assert np.allclose(np.hypot(*apart[behind].T), 1.0, atol=1e-12)
    # the speed along the rope is gone
    along = fall
    assert abs(run.occasion_loss.values[hit] - 0.5 * 2 * 9.81 * fall * along**2) < 1e-6


def test_a_compliant_stop_is_half_a_swing_of_its_spring():
    block = sledge(stops=[{"guide": "P", "most": 0.5, "stiffness": 200}])
    run = simulated(block, 2.0, speeds={"guides.P": 1.0})
    touches, leaves = happened(run, "touches"), happened(run, "leaves")
    half = math.pi * math.sqrt(2 / 200)
    assert abs(run.occasion_time.values[touches[0]] - 0.5) < 1e-12
    assert abs(run.occasion_time.values[leaves[0]] - 0.5 - half) < 1e-11
    assert abs(float(run.generalised_velocity[-1, 0]) + 1.0) < 1e-11


def test_several_contacts_stick_at_once_and_break_loose_in_turn():
    """Two blocks pulled by a spring each: each breaks loose where its spring pulls as much as it holds."""
    blocks = ct.Mechanism(
        frame={"points": {"O": [0, 0], "S": [0, 1]}},
        links={
            "one": {"points": {"P": [0, 0]}, "mass": 1},
            "two": {"points": {"Q": [0, 0]}, "mass": 1},
        },
        guides=[
            {"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "one"},
            {"point": "Q", "on": "frame", "through": "S", "direction": [1, 0], "link": "two"},
        ],
        loads=[
            {"kind": "friction", "guide": "P", "value": 1, "static": 2},
            {"kind": "friction", "guide": "Q", "value": 2, "static": 3},
            {"kind": "force", "guide": "P", "value": "t"},
            {"kind": "force", "guide": "Q", "value": "t"},
        ],
    )
    run = simulated(blocks, 4.0)
    times = {run.occasion_part.values[k]: run.occasion_time.values[k] for k in happened(run, "slips")}
    assert abs(times["friction P"] - 2.0) < 1e-13
    assert abs(times["friction Q"] - 3.0) < 1e-13
    # then v' = t - kinetic friction
    last = dict(zip(("P", "Q"), run.generalised_velocity.values[-1], strict=True))
    assert abs(last["P"] - ((16 - 4) / 2 - 2)) < 1e-11
    assert abs(last["Q"] - ((16 - 9) / 2 - 2)) < 1e-11


def test_a_clamp_lets_go_at_its_time_and_at_an_event():
    clamped = sledge(
        loads=[{"kind": "force", "guide": "P", "value": 4}],
        clamps=[{"guide": "P", "until": 0.5}],
    )
    run = simulated(clamped, 1.5)
    assert abs(float(run.generalised_coordinate[-1, 0]) - 0.5 * 2 * 1.0) < 1e-12
    assert abs(float(run.restraint_force[0, 0]) + 4.0) < 1e-12
    waits = sledge(
        loads=[{"kind": "force", "guide": "P", "value": 4}],
        clamps=[{"guide": "P", "until": "go"}],
        events=[
            {"name": "go", "when": "t - 0.25"},
            {"name": "far", "guide": "P", "when": "x - 1", "do": "end"},
        ],
    )
    ended = simulated(waits, 10.0)
    assert ended.attrs["ended"] == "event"
    assert abs(float(ended.occasion_time[-1]) - 1.25) < 1e-12
    assert list(ended.occasion_part.values) == ["go", "clamp P", "far"]


def test_a_block_on_a_slope_stays_and_the_result_does_not_creep():
    held = sledge(
        gravity=[4.0, -9.0],
        loads=[{"kind": "friction", "guide": "P", "value": 8, "static": 9}],
    )
    run = simulated(held, 1e4, at=[0.0, 1e4])
    assert float(run.generalised_coordinate[-1, 0]) == 0.0
    assert not len(happened(run, "slips"))


# Forces within bounds, and impulses.


def test_forces_within_bounds_fit_their_bounds_and_accelerations():
    generator = np.random.default_rng(30)
    for _case in range(200):
        count = int(generator.integers(1, 6))
        root = generator.normal(size=(count, int(generator.integers(1, count + 2))))
        matrix, wanted = root @ root.T, generator.normal(size=root.shape[1])
        right = root @ wanted
        high = generator.uniform(0.0, 2.0, count)
        low = np.where(generator.random(count) < 0.5, -high, 0.0)
        force, w = forces_within(matrix, right, low, high)
        assert np.allclose(w, matrix @ force + right, atol=1e-9)
        assert np.all((force >= low) & (force <= high))
        inner = (force > low + 1e-9) & (force < high - 1e-9)
        assert np.allclose(w[inner], 0.0, atol=1e-8)
        assert np.all(w[force == low] > -1e-8) or np.any(low == high)
        assert np.all((w < 1e-8) | (force < high) | (low == high))


def test_no_impact_makes_energy_whatever_the_restitutions():
    generator = np.random.default_rng(31)
    for _case in range(200):
        count = int(generator.integers(1, 5))
        root = generator.normal(size=(count, count + 1))
        matrix, before = root @ root.T, generator.normal(size=count)
        before[0] = -abs(before[0])
        shares = generator.uniform(0.0, 1.0, count)
        impulses, after = impulses_of_impact(matrix, before, shares, np.ones(count, dtype=bool))
        assert float(impulses @ (before + after)) <= 1e-10
        assert np.all(impulses >= 0.0)
        assert np.all(after >= -1e-9)


# What is wrong is named.


@pytest.mark.parametrize(
    ("parts", "named"),
    [
        ({"stops": [{"guide": "P", "least": 1, "most": 0}]}, "below most"),
        ({"stops": [{"guide": "P", "most": 1, "restitution": 1.5}]}, "between 0 and 1"),
        ({"stops": [{"guide": "P"}]}, "least, most"),
        ({"stops": [{"guide": "P", "most": 1, "restitution": 1, "stiffness": 1}]}, "given together"),
        ({"stops": [{"guide": "P", "most": 1, "damping": 1}]}, "stiffness"),
        ({"stops": [{"guide": "R", "most": 1}]}, "R"),
        ({"stops": [{"point": "P", "most": 1}]}, "direction"),
        ({"events": [{"guide": "P", "when": "3"}]}, "never changes its sign"),
        ({"events": [{"guide": "P", "when": "y"}]}, "y"),
        ({"clamps": [{"guide": "P", "until": "nothing"}]}, "no event"),
        ({"clamps": [{"guide": "P"}, {"guide": "P"}]}, "two stops, clamps or events"),
        ({"loads": [{"kind": "friction", "guide": "P", "value": 2, "static": 1}]}, "static"),
        ({"loads": [{"kind": "friction", "guide": "P", "viscous": 2, "static": 1}]}, "static"),
    ],
)
def test_wrong_contacts_are_named(parts, named):
    with pytest.raises(InputError) as caught:
        sledge(**parts)
    assert named in str(caught.value)


def test_a_stop_that_is_violated_at_the_start_is_named():
    with pytest.raises(InputError, match="stop P"):
        simulated(sledge(stops=[{"guide": "P", "least": 0.1}]), 1.0)


def test_a_clamped_part_that_moves_is_named():
    with pytest.raises(InputError, match="clamp P"):
        simulated(sledge(clamps=[{"guide": "P"}]), 1.0, speeds={"guides.P": 1.0})


def test_events_need_the_equations_of_all_links_and_the_adaptive_scheme():
    stopped = sledge(stops=[{"guide": "P", "most": 1}], drives=[{"guide": "P", "start": 0, "speed": 1}])
    with pytest.raises(InputError, match="all links"):
        simulated(stopped, 1.0, equations="reduced")
    with pytest.raises(InputError, match="adaptive"):
        simulated(stopped, 1.0, scheme="stiff")


def test_loads_of_one_sense_resist_hold_and_let_go():
    """A force against the way forwards alone: it stops the block, holds what is less, and is gone backwards."""
    resisted = sledge(
        loads=[
            {"kind": "force", "point": "P", "vector": [-6, 0], "while_moving": [1, 0]},
            {"kind": "force", "guide": "P", "value": "4 - 2*t"},
        ]
    )
    run = simulated(resisted, 4.0, speeds={"guides.P": 1.0})
    names = run.occasion_kind.attrs["flag_meanings"].split()
    # 2 v' = -2 - 2 t until v = 0; then the force holds 4 - 2 t until that is negative
    stops = math.sqrt(3) - 1
    kinds = [names[kind] for kind in run.occasion_kind.values]
    assert kinds == ["sticks", "slips"]
    assert np.allclose(run.occasion_time.values, [stops, 2.0], atol=1e-12)
    assert abs(float(run.generalised_velocity[-1, 0]) + 2.0) < 1e-11


def test_a_diagram_with_two_columns_has_its_force_in_each_sense():
    rows_of = [[-5, 3, -1], [5, 3, -1]]
    driven = sledge(loads=[{"kind": "force", "guide": "P", "table": rows_of}])
    forwards = simulated(driven, 1.0, speeds={"guides.P": 1.0})
    backwards = simulated(driven, 1.0, speeds={"guides.P": -1.0})
    assert abs(float(forwards.generalised_velocity[-1, 0]) - 2.5) < 1e-11
    assert abs(float(backwards.generalised_velocity[-1, 0]) + 1.5) < 1e-11
