"""Force polygons against closed forms, their steps and scales, and what is refused."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.force_polygons import polygons
from centrode.dynamics.force_polygons.polygons import PAPERS, ROOM, ForcePolygons
from centrode.dynamics.force_polygons.steps import Step
from centrode.numerics.round_scales import FORCE_SCALES, round_scale
from centrode.render.terminal import plain_text
from centrode.views.force_polygons import step_text
from mechanisms import EPS, Parts, four_bar, parts_of
from polygonal import (
    OPERATIONS,
    assert_routes_agree,
    loaded,
    size_of,
)


def test_action_equals_reaction() -> None:
    found = ct.force_polygons(ct.example("six-bar-press"), math.radians(120))
    for name, force in found.reactions.items():
        assert found.reactions[f"R{name[2]}{name[1]}"] == -force


@pytest.mark.parametrize("phi", [0.3, 1.2, 2.5, 4.0])
def test_a_slider_crank_under_a_piston_force(phi: float) -> None:
    """Massless: the rod is a two-force link at the angle beta, sin beta = r sin phi / l."""
    r, length, push = 0.05, 0.18, 4000.0
    engine = ct.slider_crank(crank=r, coupler=length, speed="1000 rpm")
    piston = engine.guides[0].point
    parts = parts_of(engine) | {"loads": [{"kind": "force", "point": piston, "vector": [-push, 0]}]}
    found = ct.force_polygons(ct.Mechanism(**parts), phi)
    beta = math.asin(r / length * math.sin(phi))
    rod, side = push / math.cos(beta), push * math.tan(beta)
    slider = found.names.index(next(name for name in found.names if name.startswith("slider")))
    assert abs(found.reactions["R12"]) == pytest.approx(rod, rel=OPERATIONS * EPS)
    assert abs(found.reactions[f"R0{slider}"]) == pytest.approx(abs(side), rel=OPERATIONS * EPS)
    # the drive holds against a piston force that turns the crank backwards
    turning = -push * r * math.sin(phi + beta) / math.cos(beta)
    assert found.balancing["crank"] == pytest.approx(turning, rel=OPERATIONS * EPS)
    group = found.groups[0]
    assert group.kind == "RRP"
    assert group.polygon.vector("R12ᵗ").force == 0


def test_a_scotch_yoke_by_hand() -> None:
    """A force F on the yoke turns the crank by F r sin phi; across the slot the pin carries F."""
    parts = parts_of(ct.example("scotch-yoke"))
    point = ct.example("scotch-yoke").guides[0].point
    parts["loads"] = [{"kind": "force", "point": point, "vector": [7.0, 0.0]}]
    mechanism = ct.Mechanism(**parts)
    found = ct.force_polygons(mechanism, 0.8)
    crank = next(iter(mechanism.links.values()))
    (length,) = {abs(complex(*at)) for at in crank.coordinates.values()} - {0.0}
    assert found.balancing[mechanism.drives[0].id] == pytest.approx(
        7.0 * length * math.sin(0.8), rel=64 * EPS
    )


def test_normal_and_tangential_parts() -> None:
    """The tangential part is square to the arm, the normal part along it; together they are the reaction."""
    found = ct.force_polygons(ct.example("six-bar-press"), math.radians(120))
    group = found.groups[1]
    assert (group.kind, group.numbers) == ("RRR", (2, 3))
    arm = found.places["B"] - found.places["A"]
    normal, tangential = (group.polygon.vector(f"R12{mark}").force for mark in "ⁿᵗ")
    assert abs((arm.conjugate() * normal).imag) <= OPERATIONS * EPS * abs(arm) * abs(normal)
    assert abs((arm.conjugate() * tangential).real) <= OPERATIONS * EPS * abs(arm) * abs(normal)
    assert abs(normal + tangential - found.reactions["R12"]) <= OPERATIONS * EPS * abs(normal)
    assert {one.name for one in group.polygon.sums} == {"R12", "R03"}
    assert abs(group.polygon.vector("R03").force - found.reactions["R03"]) <= OPERATIONS * EPS * abs(normal)
    with pytest.raises(KeyError):
        group.polygon.vector("R99")


def test_the_inner_reaction_is_a_chord_of_the_polygon() -> None:
    found = ct.force_polygons(ct.example("six-bar-press"), math.radians(120))
    for group in found.groups[:2]:
        (chord,) = group.polygon.chords
        corners = [0j, *(vector.end for vector in group.polygon.vectors)]
        size = max(map(abs, corners))
        assert abs(chord.end) <= OPERATIONS * EPS * size  # back to where the polygon begins
        assert min(abs(chord.start - corner) for corner in corners) <= OPERATIONS * EPS * size
        assert found.reactions[chord.name] == chord.force


def printed(found: ForcePolygons, step: Step) -> str:
    """A step as a terminal prints it."""
    return plain_text(step_text(step), found.mechanism.display)


def test_steps_of_the_press() -> None:
    found = ct.force_polygons(ct.example("six-bar-press"), math.radians(120))
    assert found.speed_from == "machine"
    steps = [printed(found, step) for step in found.steps]
    assert steps[0] == (
        "moments of link 4 about H: R34ᵗ·1.7 + 165.5 (G4) − 5.186 (Φ4) − 14.041 (MΦ4) = 0, R34ᵗ = -86.0431 N"
    )
    lever_arm = 0.85 * math.cos(math.radians(-27.745))
    assert 22 * 10 * lever_arm == pytest.approx(
        165.5, abs=0.06
    )  # the weight's arm about H, read off the source
    assert "R34ⁿ ∥ DH, R05 ⊥ guide H" in steps[1]
    assert [group.numbers for group in found.groups] == [(4, 5), (2, 3), (1,)]


def test_a_triad_by_an_assur_point_and_all_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    mechanism = loaded("third-class-triad")
    by_point = ct.force_polygons(mechanism, 0.9)
    monkeypatch.setattr(polygons, "triad_of", lambda cell: None)
    together = ct.force_polygons(mechanism, 0.9)
    assert [group.kind for group in by_point.groups] == ["triad", "input"]
    assert [group.kind for group in together.groups] == ["together", "input"]
    forces, _moments = size_of(together)
    assert by_point.reactions.keys() == together.reactions.keys()
    for name, force in together.reactions.items():
        # the Assur point lies a few lengths away
        assert abs(by_point.reactions[name] - force) <= 16 * OPERATIONS * EPS * forces


def test_the_lever_by_hand() -> None:
    """Of a crank alone: the turned image lies along the crank itself, G at its middle."""
    crank = ct.Mechanism(
        gravity=[0, -10],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 2.0, "mass": 3.0, "shape": "rod"}},
        drives=[{"link": "OA", "start": 0.0, "speed": 1.0}],
    )
    lever = ct.force_polygons(crank, 0.5).lever
    assert abs(lever.images["A"] - 2.0 * cmath.exp(0.5j)) <= 8 * EPS
    (weight,) = [one for one in lever.forces if one.name == "G1"]
    assert weight.moment == pytest.approx(-30.0 * math.cos(0.5), rel=8 * EPS)
    assert lever.balancing == pytest.approx(30.0 * math.cos(0.5), rel=8 * EPS)


def test_each_of_several_drives_has_its_lever() -> None:
    found = ct.force_polygons(loaded("two-link-arm"), 0.7)
    assert [lever.drive for lever in found.levers] == list(found.balancing)
    assert len(found.balancing) == 2
    assert found.work == {}
    assert_routes_agree(found)


@pytest.mark.parametrize("least", [1e-9, 0.3, 1.0, 1.0000001, 2.2, 2.6, 7.0, 12345.0])
def test_scales_are_of_the_series(least: float) -> None:
    scale = round_scale(least, series=FORCE_SCALES)
    assert least <= scale * (1 + 1e-9) <= 2.5 * least * (1 + 1e-8)
    mantissa = scale / 10.0 ** math.floor(math.log10(scale) + 1e-9)
    assert min(abs(mantissa - step) for step in (1.0, 2.0, 2.5, 5.0)) <= 16 * EPS * mantissa


@pytest.mark.parametrize("paper", list(PAPERS))
def test_polygons_go_on_the_paper(paper: str) -> None:
    found = ct.force_polygons(ct.example("six-bar-press"), math.radians(120), paper)
    wide, high = PAPERS[paper]
    for polygon in found.polygons:
        corners = np.array([0j, *(vector.end for vector in polygon.vectors)]) / polygon.scale
        assert np.ptp(corners.real) <= ROOM * wide
        assert np.ptp(corners.imag) <= high
        for vector in polygon.vectors:
            assert polygon.length(vector) == abs(vector.force) / polygon.scale


def test_loads_without_masses() -> None:
    lever = four_bar(1.0, 3.5, 3.0, 4.0, loads=[{"kind": "torque", "link": "DB", "value": 5.0}])
    found = ct.force_polygons(lever, 1.0)
    assert [one.symbol for one in found.outer if one.body != "frame"] == ["M1"]
    assert_routes_agree(found)


def refuse(mechanism: ct.Mechanism, at: float, told: str, **how: Any) -> None:
    with pytest.raises(ct.CentrodeError, match=told):
        ct.force_polygons(mechanism, at, **how)


def test_what_is_refused() -> None:
    press = ct.example("six-bar-press")
    refuse(four_bar(1.0, 3.5, 3.0, 4.0), 1.0, "neither masses nor loads")
    refuse(ct.example("spherical-four-bar"), 1.0, "sphere")
    refuse(press, 1.0, "is not a supported paper size", paper="A6")
    refuse(press, math.nan, "finite")
    refuse(loaded("three-crank-parallelogram"), 1.0, "constraints are redundant")


def weighted(name: str) -> ct.Mechanism:
    parts: Parts = parts_of(ct.example(name)) | {"gravity": [0, -9.81]}
    for body in parts["links"].values():
        body |= {"mass": 1.0, "centre": [0.1, 0.0], "inertia": 0.0}
    return ct.Mechanism(**parts)


def test_dead_points_are_singular_and_open_positions_told() -> None:
    with pytest.raises(ct.MotionError, match="singular"):
        ct.force_polygons(weighted("parallelogram"), math.pi)
    locked = weighted("slider-between-cranks-locked")
    with pytest.raises(ct.MotionError, match="open"):
        ct.force_polygons(locked, 2.5)
    (limit, *_rest) = ct.motion(locked).event_value.values
    with pytest.raises(ct.MotionError, match=r"singular|open"):
        ct.force_polygons(locked, float(limit))


def test_what_gears_and_kept_wheels_leave_out_is_said() -> None:
    geared = ct.force_polygons(loaded("geared-five-bar"), 1.0)
    assert any(
        "the radial component of the tooth force is neglected" in printed(geared, step)
        for step in geared.steps
    )
    kept = ct.force_polygons(loaded("rolling-wheel-rod"), 0.4)
    assert any("set to zero here" in printed(kept, step) for step in kept.steps)
