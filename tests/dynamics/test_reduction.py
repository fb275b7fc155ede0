"""Reduction of worked mechanisms: printed numbers, closed forms, the jet's derivative, exact jumps."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import centrode as ct
from centrode.dynamics.masses import masses_of
from centrode.dynamics.reduction import Reducer
from centrode.kinematics.path import JETS
from centrode.kinematics.preparation import ready
from centrode.model.examples import example_text
from centrode.numerics.jets import Jet
from mechanisms import EPS, OPERATIONS, conditioning, on_branch, solve_evenly

Array = npt.NDArray[np.float64]
REFERENCE = Path(__file__).parents[1] / "reference" / "six-bar-printed-values.csv"
ROUNDED = 1 + 1e-9
AT = math.radians(120.0)
TURN = 2.0 * math.pi


def printed(symbol: str) -> tuple[float, float]:
    """A printed value of the coursework and half a unit of its last digit."""
    with REFERENCE.open(encoding="utf-8", newline="") as file:
        row = next(row for row in csv.DictReader(file) if row["symbol"] == symbol)
    return float(row["printed"]), float(row["half_unit"])


def agrees(found: float, symbol: str) -> None:
    value, half_unit = printed(symbol)
    assert abs(found - value) <= half_unit * ROUNDED


def work_over_a_turn(reducer: Reducer, start: float, nodes: int = 20) -> float:
    """Work of the loads while the drive goes one turn back, by Gauss's rule between the jumps and eight cuts."""
    cuts = np.linspace(start - TURN, start, 9)
    ends = np.unique(np.concatenate([cuts, reducer.jumps(start - TURN, start)]))
    x, w = np.polynomial.legendre.leggauss(nodes)
    half, middle = np.diff(ends) / 2, (ends[1:] + ends[:-1]) / 2
    q = (middle[:, None] + half[:, None] * x).ravel()
    return -float(np.sum((half[:, None] * w).ravel() * reducer.at(q).moment))


def test_printed_numbers_of_the_reduction() -> None:
    """By the source's coordinate, which runs against the crank angle."""
    printed_press = ct.example("six-bar-press-printed")
    at = ct.reduce(printed_press, at=["99.1 deg"])
    agrees(float(at.reduced_inertia[0]), "J2")
    agrees(float(at.reduced_moment[0]), "M_r")
    work = -work_over_a_turn(Reducer.of(printed_press), TURN)
    agrees(work, "A_c")
    agrees(-work / TURN, "M_d")


def test_the_rule_of_the_work_has_converged() -> None:
    reducer = Reducer.of(ct.example("six-bar-press"))
    coarse, fine = (work_over_a_turn(reducer, math.radians(219.1), nodes) for nodes in (20, 40))
    # roundings of some 400 summands of up to 9000 N times 1 m times 2 pi
    assert abs(coarse - fine) <= 400 * EPS * 9000 * TURN


def test_corrected_numbers_of_the_press() -> None:
    at = ct.reduce(ct.example("six-bar-press"), at=[AT])
    by_link = at.reduced_inertia_part.isel(sample=0)
    assert abs(float(at.reduced_inertia[0]) - 15.457) <= 0.5e-3
    assert abs(float(at.reduced_inertia[0] - by_link.sel(link="slider")) - 13.861) <= 0.5e-3
    assert abs(float(at.reduced_inertia[0] - by_link.sum())) <= 4 * EPS * float(at.reduced_inertia[0])


def test_the_press_stops_where_crank_and_coupler_are_in_line() -> None:
    """O, A, B in line: B at 1.445 + 0.347 or 1.445 - 0.347 from O, and 0.85 from C = (1.25, 0)."""
    reducer = Reducer.of(ct.example("six-bar-press"))
    start = math.radians(219.1)
    found = reducer.jumps(start - TURN, start)
    exact = []
    for reach, turn in ((1.445 + 0.347, 0.0), (1.445 - 0.347, math.pi)):
        angle = math.acos((reach**2 + 1.25**2 - 0.85**2) / (2 * reach * 1.25)) + turn
        exact.append(angle - TURN * math.ceil((angle - start) / TURN))
    # a root of a velocity coefficient with slope of at least 0.3 m/rad^2, the velocity being rounded a few times
    assert np.allclose(found, sorted(exact), rtol=0, atol=64 * EPS * TURN)


def test_a_load_on_both_sides_of_its_jump() -> None:
    """The force is not along its gate, so its moment jumps where B turns round in its height."""
    press = ct.parse_mechanism(
        example_text("six-bar-press")
        .replace("while_moving = [1, 0]", "while_moving = [0, 1]")
        .replace('point = "H"\nvector', 'point = "B"\nvector')
    )
    reducer = Reducer.of(press)
    row = reducer.loads.index("force B")
    at = reducer.jumps(0.0, TURN)
    below, above, on = (reducer.at(at, side=side).moment_parts[row] for side in (-1, 1, 0))
    # H is driven through A and B alone: B turns round in its height at the ends of the rocker's swing, where its
    # moment is rounding, and upright over C, where it is not
    upright = abs(reducer.at(at, side=1).moment_parts[row]) + abs(reducer.at(at, side=-1).moment_parts[row])
    assert len(at) == 4
    assert int(np.sum(upright > 1.0)) == 2
    for k in np.flatnonzero(upright > 1.0):
        assert {below[k] == 0.0, above[k] == 0.0} == {True, False}
        assert on[k] == (below[k] or above[k])
        step = 1e-6
        for value, side in ((below[k], -1), (above[k], 1)):
            beside = reducer.at(at[k] + side * step).moment_parts[row, 0]
            assert (beside == 0.0) == (value == 0.0)


def jet_of_inertia(mechanism: ct.Mechanism, values: Array) -> Jet:
    """Reduced inertia as a jet, from positions as jets of one order more."""
    solved = solve_evenly(ready(mechanism), 2, float(values[0]), float(values[-1]))
    kinematics = solved.ready.kinematics
    at = kinematics.positions(JETS, Jet.variable(values, 2), on_branch(solved, values))
    total: Any = 0.0
    for mass in masses_of(mechanism):
        pose = at.poses[mass.link]
        centre = mass.centre
        x, y = kinematics.numbers.local[mass.link][centre.base]
        place = kinematics.numbers.space.place(JETS, pose, (x + centre.along, y + centre.across))
        total = total + sum((x.slope() * x.slope() for x in place), Jet((0.0, 0.0))) * mass.mass
        cosine, sine = (x if isinstance(x, Jet) else Jet((x, 0.0, 0.0)) for x in pose.rotor)
        turning = cosine.lower_order() * sine.slope() - sine.lower_order() * cosine.slope()
        total = total + turning * turning * mass.inertia
    assert isinstance(total, Jet)
    return total


def test_inertia_and_its_derivative_are_the_jets() -> None:
    press = ct.example("six-bar-press")
    values = np.linspace(0.0, TURN, 37)
    jet = jet_of_inertia(press, values)
    found = Reducer.of(press).at(values)
    worst = np.max([conditioning(solve_evenly(ready(press), 1, float(q), float(q))) for q in values[::6]])
    size = float(np.max(found.inertia))
    assert np.max(abs(jet.value - found.inertia)) <= OPERATIONS * EPS * worst * size
    assert np.max(abs(jet.derivative(1) - found.inertia_slope)) <= OPERATIONS * EPS * worst * size


def test_slider_crank_in_closed_form() -> None:
    """A massless rod: J = I + m x'^2 with x = r cos q + sqrt(l^2 - r^2 sin^2 q)."""
    r, rod, m, inertia = 0.3, 1.1, 7.0, 0.4
    crank = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": r, "inertia": inertia},
            "AB": {"length": rod},
            "block": {"points": ["B"], "mass": m},
        },
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
        drives=[{"link": "OA", "start": 0.2, "speed": 3.0}],
        loads=[{"kind": "force", "guide": "B", "value": "-50 - 4*v"}],
        assembly={"sides": {"B": "ahead"}},
    )
    data = ct.reduce(crank, samples=25)
    q = data.drive_value.isel(drive=0).to_numpy()
    root = np.sqrt(rod**2 - (r * np.sin(q)) ** 2)
    slope = -r * np.sin(q) - r * r * np.sin(q) * np.cos(q) / root
    bend = -r * np.cos(q) - r * r * np.cos(2 * q) / root - (r * r * np.sin(q) * np.cos(q)) ** 2 / root**3
    tolerance = 64 * EPS
    assert np.allclose(data.reduced_inertia, inertia + m * slope**2, rtol=0, atol=tolerance)
    assert np.allclose(data.reduced_inertia_slope, 2 * m * slope * bend, rtol=0, atol=4 * tolerance)
    force = -50 - 4 * (3.0 * slope)
    assert np.allclose(data.reduced_moment, force * slope, rtol=0, atol=60 * tolerance)
    assert data.reduced_inertia_part.sel(link="OA").values.tolist() == [inertia] * 25


def test_a_displacement_drive_gives_masses_and_forces() -> None:
    lift = ct.Mechanism(
        links={"block": {"points": ["B"], "mass": 3.0}},
        guides=[{"point": "B", "on": "frame", "through": [0, 0], "direction": [0, 1], "link": "block"}],
        drives=[{"guide": "B", "start": 0.0, "speed": 0.5}],
        gravity=[0, -10],
        study={"from": 0, "to": 1},
    )
    data = ct.reduce(lift, samples=3)
    assert data.reduced_inertia.values.tolist() == [3.0] * 3
    assert data.reduced_moment.values.tolist() == [-30.0] * 3
    units = {
        name: data[name].attrs["units"]
        for name in ("reduced_inertia", "reduced_inertia_slope", "reduced_moment")
    }
    assert units == {"reduced_inertia": "kg", "reduced_inertia_slope": "kg/m", "reduced_moment": "N"}
    press = ct.reduce(ct.example("six-bar-press"), samples=2)
    assert [press[name].attrs["units"] for name in units] == ["kg m^2", "kg m^2/rad", "N m"]


def test_what_is_not_reached_is_absent() -> None:
    parts = example_text("slider-between-cranks-locked").replace(
        "[links.AC]", "[links.AC]\nmass = 1\nshape = 'rod'"
    )
    data = ct.reduce(ct.parse_mechanism(parts))
    opened = data.status.to_numpy() == ct.Status.OPEN
    assert opened.any()
    for name in ("reduced_inertia", "reduced_inertia_slope", "reduced_moment", "reduced_inertia_part"):
        assert np.isnan(data[name].to_numpy()[opened]).all()
        assert np.isfinite(data[name].to_numpy()[data.status.to_numpy() == ct.Status.OK]).all()


def test_the_machine_gives_the_speed_and_the_drive_its_sense() -> None:
    data = ct.reduce(ct.example("six-bar-press"), samples=3)
    assert data.drive_rate.values.tolist() == [-65 * TURN / 60] * 3
    assert data.attrs["rate_from"] == "machine"
    text = example_text("six-bar-press")
    alone = ct.parse_mechanism(text[: text.index("[machine]")] + text[text.index("[study]") :])
    data = ct.reduce(alone, samples=3)
    assert data.drive_rate.values.tolist() == [-1.0] * 3
    assert data.attrs["rate_from"] == "drive"


def test_samples_do_not_matter() -> None:
    """At the same values of the drive the same bits, and the same jumps, whatever else is asked for."""
    press = ct.example("six-bar-press")
    few, many = ct.reduce(press, samples=5), ct.reduce(press, samples=721)
    assert np.array_equal(few.jumps, many.jumps)
    both = np.isclose(
        few.drive_value.values[:, 0][:, None],
        many.drive_value.values[:, 0][None],
        rtol=0,
        atol=4 * EPS * TURN,
    )
    rows, columns = np.nonzero(both)
    assert len(rows) == 5
    for name in ("reduced_inertia", "reduced_moment"):
        size = float(abs(many[name]).max())
        assert np.allclose(few[name].values[rows], many[name].values[columns], rtol=0, atol=256 * EPS * size)


def test_what_never_moves_never_turns_round() -> None:
    """H moves along its line only, and the slider does not turn: neither foretells a jump."""
    text = example_text("six-bar-press").replace("while_moving = [1, 0]", "while_moving = [0, 1]")
    load = '[[loads]]\nkind = "torque"\nlink = "slider"\nvalue = "-3*abs(v)"\n'
    still = ct.parse_mechanism(text.replace("[machine]", f"{load}[machine]"))
    assert Reducer.of(still).jumps(-TURN, TURN).size == 0
