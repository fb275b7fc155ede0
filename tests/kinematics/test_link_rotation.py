"""Where closed forms say that angles of links stand: against the turns that the arrays count on the mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tools.campaigns.rotatability.cases import drawn

import centrode as ct
from centrode.errors import Status
from centrode.kinematics.machine_code.event_free_mechanisms import EventScreening
from centrode.kinematics.machine_code.link_rotation import LinkRotation
from centrode.kinematics.machine_code.trace import trace_motion
from centrode.kinematics.machine_code.variables import SCALE, centre_of, varied_of, winding_of
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import requested_grid, solve
from centrode.numerics.arrays import ARRAYS
from centrode.structure.dimensions import dimensions_of
from samples import few


def rotation_of(screening: EventScreening) -> LinkRotation:
    """Closed forms of all angles that turn."""
    return LinkRotation.of(screening.traced, tuple(screening.traced.turning), screening.names)


def of_example(name: str, values: dict[str, Any]) -> tuple[EventScreening, dict[str, Any]]:
    """What screens variants of a built-in mechanism, and the variables of these."""
    prepared = ready(ct.example(name))
    span = requested_grid(prepared, 37, None, None)
    numbers = dimensions_of(prepared.mechanism, values, ARRAYS)
    varied = varied_of(numbers, values)
    traced = trace_motion(prepared, span, varied)
    names = tuple(dict.fromkeys([*varied.names, SCALE]))
    links = tuple(traced.turning)
    return EventScreening(traced, span.parameter, names, links, "arrays"), varied.values(numbers)


@pytest.mark.parametrize("number", few((0, 1, 2, 3, 14, 15), range(40)))
def test_random_mechanisms(number: int) -> None:
    """Angles with the turns of the arrays stay within half a turn of where they stand; all links are told."""
    kind, _values, _mesh, screening, (prepared, span, numbers, rows) = drawn(2, number)
    assert screening.closure is not None
    rotation = rotation_of(screening)
    assert rotation.headings.keys() == screening.traced.turning.keys()
    with np.errstate(all="ignore"):
        solved = solve(prepared, span, numbers, 1000)
    clear = screening.closure.judge(rows, "arrays", 1).clear & (solved.status == Status.OK).all(axis=1)
    found = rotation.judge(rows, "arrays", 1)
    # in the plane a circle about the pivot either has the other pivot inside or not; on the sphere it is an ellipse
    assert found.told[clear].mean() >= (1.0 if kind.mechanism.space == "plane" else 0.8)
    lanes = np.nonzero(clear & found.near)[0]
    assert len(lanes) > 50
    (drive,) = screening.traced.winders
    for link in rotation.headings:
        angle = solved.angles[0, lanes][:, :, solved.layout.angles.index(link)]
        turned = found.values[winding_of(link, drive)][lanes, None] * span.parameter
        assert np.abs(angle - turned - found.values[centre_of(link)][lanes, None]).max() < np.pi - 1e-4


def test_a_crank_turns_and_a_rocker_swings() -> None:
    """Grashof: with the shortest link for a crank the other one swings, with the shortest link fixed both turn."""
    for name, path, sense in (
        ("crank-rocker", "links.AB.length", 0.0),
        ("drag-link", "links.AB.length", 1.0),
    ):
        values = {path: ct.value_at(ct.example(name), path) * np.linspace(0.99, 1.01, 5)}
        screening, rows = of_example(name, values)
        found = rotation_of(screening).judge(rows, "arrays", 1)
        assert found.near.all()
        (drive,) = screening.traced.winders
        for link in screening.links:
            np.testing.assert_array_equal(found.values[winding_of(link, drive)], sense)


@pytest.mark.parametrize(
    "name", ["crank-rocker", "six-bar-press", "inverted-slider-crank", "spherical-four-bar"]
)
def test_nothing_is_followed_over_the_mesh(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither in mechanisms that are told, nor in those whose groups open."""
    crank = {"spherical-four-bar": "links.AB.length"}.get(name, "links.OA.length")
    values = {crank: ct.value_at(ct.example(name), crank) * np.array([0.999, 1.0, 1.001, 9.0])}
    screening, rows = of_example(name, values)
    followed: list[int] = []
    monkeypatch.setattr(type(screening._centring), "centres", lambda *_given: followed.append(1))
    assert screening.judge(rows).clear[:3].all()
    assert not followed


def test_where_coefficients_are_alike_the_mesh_tells() -> None:
    """A crank as long as the frame passes the other pivot: its direction as seen from there jumps."""
    crank = ct.value_at(ct.example("drag-link"), "frame.points.D.x")
    values = {"links.OA.length": crank * (1.0 + np.array([-1e-12, 0.0, 1e-12]))}
    screening, rows = of_example("drag-link", values)
    assert not rotation_of(screening).judge(rows, "arrays", 1).told.any()


def test_what_a_gear_turns_is_not_told() -> None:
    """Its direction has another frequency than the drive's."""
    mechanism = ct.example("geared-five-bar")
    path = next(f"links.{name}.length" for name, link in mechanism.links.items() if link.length is not None)
    screening, _rows = of_example("geared-five-bar", {path: np.array([ct.value_at(mechanism, path)])})
    assert screening.links == ("AB", "CB")
    assert not rotation_of(screening).headings
