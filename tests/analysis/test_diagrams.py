"""Velocities and accelerations as they are drawn, against the motion's derivatives and closed forms by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings

import centrode as ct
from centrode.analysis.graphic.checks import STEPS, graphic_check
from centrode.analysis.graphic.diagrams import (
    Diagram,
    acceleration_diagram,
    diagrams,
    drawing_of,
    driven_rates,
    velocity_diagram,
)
from centrode.analysis.graphic.stage import DrawingBoard, Edge, cross, meet
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import solve
from centrode.numerics.round_scales import round_scale
from drawn import EPS, OPERATIONS, answers, errors, errors_of
from growing import descriptions, mechanism_of
from growing_higher import higher_descriptions
from samples import examples_at_hand, few

PLANE = [name for name in examples_at_hand(ct.example_names()) if ct.example(name).space == "plane"]


def an_instant(name: str) -> float:
    """A value of the drive, or a time, a little beyond the initial position."""
    mechanism = ct.example(name)
    path = ready(mechanism).kinematics.path
    if path.by_time or mechanism.drives[0].speed is None:
        return 0.7
    return path.initial + path.forward * path.unit * (0.3 if mechanism.drives[0].kind == "angle" else 0.06)


@pytest.mark.parametrize("name", PLANE)
def test_drawing_and_motion_agree_to_rounding(name: str) -> None:
    found = errors(ct.example(name), an_instant(name))
    assert found is not None
    apart, allowed = found
    assert (apart <= allowed).all()


def test_the_examples_have_dyads_of_all_kinds() -> None:
    kinds = {group.kind for name in PLANE for group in ready(ct.example(name)).structure.groups}
    assert kinds >= {"RRR", "RRP", "RPR", "PRP", "RPP", "gear", "gear train", "rolling wheel", "higher class"}


@settings(max_examples=few(10, 50))
@given(descriptions())
def test_random_mechanisms(parts: dict[str, Any]) -> None:
    prepared = ready(mechanism_of(parts))
    found = errors_of(prepared, prepared.kinematics.path.initial + 0.01)
    assume(found is not None)
    assert found is not None
    assert (found[0] <= found[1]).all()


@settings(max_examples=few(3, 25))
@given(higher_descriptions())
def test_random_groups_of_higher_class(parts: dict[str, Any]) -> None:
    try:
        prepared = ready(mechanism_of(parts))
    except ct.InputError:
        assume(False)  # a plate on rods may be left loose
    found = errors_of(prepared, prepared.kinematics.path.initial + 0.01)
    assume(found is not None)
    assert found is not None
    assert (found[0] <= found[1]).all()


def edges(diagram: Diagram, kind: str) -> list[Edge]:
    return [edge for edge in diagram.edges if edge.kind == kind]


def test_coriolis_in_a_moving_guide() -> None:
    """A lever about D, the pin A of a crank in its slot along DA: by hand."""
    lever = ct.example("whitworth-quick-return")
    data = ct.motion(lever, at=[0.9])
    apart = [data.position.sel(point=name).values[0] @ (1, 1j) for name in ("A", "D", "O")]
    e, crank = apart[0] - apart[1], apart[0] - apart[2]
    velocity = 1j * crank * float(data.angular_velocity.sel(link="OA")[0])
    along = e / abs(e)
    turn, slide = cross(along, velocity) / abs(e), (along.conjugate() * velocity).real
    (found,) = edges(acceleration_diagram(lever, 0.9), "coriolis")
    # the place of the lever under A has less of it than A
    wanted = -2j * turn * slide * along
    assert abs(found.vector - wanted) <= 16 * EPS * abs(wanted) * (1 + abs(velocity) / abs(slide))


def test_normal_parts_point_to_the_centre_of_the_circle() -> None:
    four_bar = ct.four_bar(crank=1, coupler=3.5, rocker=3, ground=4)
    diagram = acceleration_diagram(four_bar, 1.0)
    data = ct.motion(four_bar, at=[1.0])
    normal = {edge.link: edge.vector for edge in edges(diagram, "normal")}
    for link, length in {"crank": 1.0, "coupler": 3.5, "rocker": 3.0}.items():
        rate = float(data.angular_velocity.sel(link=link)[0])
        assert abs(normal[link]) == pytest.approx(rate**2 * length, rel=64 * EPS)


def test_the_frame_stands_at_the_pole() -> None:
    diagram = velocity_diagram(ct.example("six-bar-press"), 0.5)
    assert [diagram.images[name] for name in ("O", "C")] == [0, 0]


def test_images_of_plates_are_similar_to_them() -> None:
    found = diagrams(ct.example("watt-six-bar"), 0.8)
    link, points = next(
        (name, list(link.coordinates))
        for name, link in found.mechanism.links.items()
        if len(link.coordinates) == 3
    )
    for diagram in (found.velocity, found.acceleration):
        a, b, c = (diagram.images[name] for name in points)
        p, q, r = (found.places[name] for name in points)
        assert abs((c - a) / (b - a) - (r - p) / (q - p)) <= 256 * EPS * abs((r - p) / (q - p)), link


@pytest.mark.parametrize("name", ["third-class-triad", "fourth-class-group", "stephenson-driven-at-rocker"])
def test_false_positions_are_told(name: str) -> None:
    diagram = velocity_diagram(ct.example(name), an_instant(name))
    (trial,) = [step.trial for step in diagram.steps if step.trial is not None]
    assert len(trial.values) == len(trial.links) + 1
    # linear in the trial: what is found lies where the misfit vanishes
    (v0,), (v1,) = trial.values
    (m0,), (m1,) = trial.misfits
    assert trial.found[0] == pytest.approx(v0 - m0 * (v1 - v0) / (m1 - m0), rel=8 * EPS)
    assert diagram.turns[trial.links[0]] == trial.found[0]


def test_triangles_keep_the_law_of_sines() -> None:
    triangles = [
        step.triangle
        for name in ("jansen-leg", "six-bar-press", "whitworth-quick-return")
        for step in velocity_diagram(ct.example(name), an_instant(name)).steps
        if step.triangle is not None
    ]
    assert len(triangles) >= 6
    for triangle in triangles:
        assert sum(triangle.angles) == pytest.approx(math.pi, abs=16 * EPS)
        ratios = [side / math.sin(angle) for side, angle in zip(triangle.sides, triangle.angles, strict=True)]
        least = min(math.sin(angle) for angle in triangle.angles)
        assert np.ptp(ratios) <= OPERATIONS * EPS * ratios[0] / least


def test_instant_centres_stand_where_perpendiculars_meet() -> None:
    found = diagrams(ct.example("slider-crank-offset"), 0.8)
    crank, rod = found.mechanism.link_names[:2]
    assert found.centres[crank] == found.places[next(iter(found.mechanism.links[crank].coordinates))]
    centre = found.centres[rod]
    assert centre is not None
    for point in found.mechanism.links[rod].coordinates:
        arm, rate = centre - found.places[point], found.velocity.images[point]
        assert abs((arm.conjugate() * rate).real) <= 64 * EPS * abs(arm) * abs(rate)
        assert found.reach(rod, point) == pytest.approx(abs(arm), rel=64 * EPS)


def test_a_translating_link_has_its_centre_at_infinity() -> None:
    found = diagrams(ct.example("parallelogram"), 1.0)
    assert None in found.centres.values()
    worked = diagrams(ct.example("slider-between-cranks"), math.pi / 2)
    assert worked.centres["AC"] is None


@pytest.mark.parametrize("step", [1e-2, 1e-4, 1e-6])
def test_reading_errors_shrink_with_the_step(step: float) -> None:
    press = ct.example("six-bar-press")
    prepared = ready(press)
    span = grid_at(prepared.kinematics.path, np.array([0.5]))
    exact = dataset_of(solve(prepared, span))
    driven = driven_rates(prepared, span)
    condition = answers(prepared, drawing_of(prepared, exact, DrawingBoard()), driven, tries=8)
    true, read = (velocity_diagram(press, 0.5, angle_step=one) for one in (None, step))
    apart = max(abs(read.images[name] - true.images[name]) for name in true.images)
    # random directions may miss the worst case, once in each group
    assert 0 < apart <= len(prepared.structure.groups) * condition[0] * step


def test_lengths_on_paper_are_read_to_a_step() -> None:
    press = ct.example("six-bar-press")
    found = graphic_check(press, 0.5, length_step=5e-4)
    grain = 0.5 * found.diagrams.velocity.scale
    for row in found.rows:
        if row.quantity == "velocity":
            assert row.graphic / grain == pytest.approx(round(row.graphic / grain), abs=1e-9)
    assert found.row("velocity", "H").difference != 0.0


@pytest.mark.parametrize(
    ("extent", "scale"), [(90.0, 1.0), (91.0, 1.5), (0.9, 0.01), (0.0, 1.0), (1e-9 * 90 * 7, 8e-9)]
)
def test_scales_are_round_and_hold_the_drawing(extent: float, scale: float) -> None:
    assert round_scale(extent, 90.0) == pytest.approx(scale, rel=4 * EPS)


def test_lines_that_are_parallel_do_not_meet() -> None:
    assert meet(0, 1, 2 + 1j, 1j) == 2
    with pytest.raises(ct.MotionError, match="dead position"):
        meet(0, 1, 1j, -1)


def test_the_sphere_has_no_such_diagrams() -> None:
    with pytest.raises(ct.InputError, match="do not apply on the sphere"):
        velocity_diagram(ct.example("spherical-four-bar"), 0.5)


def test_where_the_mechanism_is_not() -> None:
    locked = ct.example("slider-between-cranks-locked")
    with pytest.raises(ct.MotionError, match="is open: nothing can be constructed"):
        acceleration_diagram(locked, 2.5)
    (limit, *_rest) = ct.motion(locked).event_value.values
    with pytest.raises(ct.MotionError, match=r"singular|open"):
        acceleration_diagram(locked, float(limit))


def test_a_change_point_is_a_dead_point_of_the_drawing() -> None:
    with pytest.raises(ct.MotionError, match="dead position"):
        velocity_diagram(ct.example("parallelogram"), math.pi)


@pytest.mark.parametrize("at", [math.nan, math.inf, 1e9])
def test_instants_have_to_be_within_reach(at: float) -> None:
    with pytest.raises(ct.InputError):
        velocity_diagram(ct.example("crank-rocker"), at)


@pytest.mark.parametrize("step", [0.0, -1.0, 1.0, math.nan])
def test_steps_out_of_range(step: float) -> None:
    with pytest.raises(ct.InputError, match="at most 30 deg"):
        DrawingBoard(step)
    with pytest.raises(ct.InputError, match="at most 10 mm"):
        DrawingBoard(None, step)


def test_integrated_velocities_stand_beside_them() -> None:
    """To what every adaptive step may add."""
    pytest.importorskip("centrode.equations.integration", reason="equations are not integrated here")
    check = graphic_check(ct.example("slider-between-cranks"), 1.0)
    for row in check.rows:
        assert (row.integrated is None) == (row.quantity in ("angular_acceleration", "acceleration"))
        if row.integrated is not None:
            assert abs(row.integrated - row.closed) <= 1e-10 * STEPS


def test_a_mechanism_at_rest_has_accelerations_alone() -> None:
    """Where the law turns back: its rate is rounding, which no scale should magnify."""
    bars = {"OA": {"length": 1.0}, "AB": {"length": 3.0}, "DB": {"length": 2.5}}
    drive = {"link": "OA", "start": 1.0, "law": "0.5*sin(2*t)"}
    swinging = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [3, 0]}},
        links=bars,
        drives=[drive],
        assembly={"sides": {"B": "left"}},
    )
    found = diagrams(swinging, math.pi / 4)
    assert max(abs(image) for image in found.velocity.images.values()) < 16 * EPS
    assert found.velocity.scale == 1.0
    assert found.centres == {}
    assert abs(found.acceleration.images["A"]) == pytest.approx(2.0, rel=16 * EPS)
