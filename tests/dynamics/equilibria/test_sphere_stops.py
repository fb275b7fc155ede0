"""Equilibria on rigid stops of the sphere: moments of a compound pendulum about its hinge."""

from __future__ import annotations

import math
from typing import Any

import pytest

import centrode as ct

G, RADIUS, MASS, ARC = 9.81, 0.4, 1.3, math.pi / 3
# an arc from the hinge on the x axis: mean of sin along it
WEIGHT = MASS * G * RADIUS * (1.0 - math.cos(ARC)) / ARC
AXES = {"points": {"X": [1, 0, 0], "Y": [0, 1, 0], "P": [0, 0, 1]}}


def resting(stop: dict[str, Any], **parts: Any) -> ct.Dataset:
    """The only equilibrium of a pendulum that rests on a stop; without it, it hangs and stands."""
    given: dict[str, Any] = {
        "space": "sphere",
        "radius": RADIUS,
        "gravity": [0, 0, -G],
        "frame": AXES,
        "links": {"XA": {"length": ARC, "reference": ["X", "Y"], "mass": MASS, "shape": "arc", "angle": 0.2}},
        "stops": [{"name": "s", "restitution": 0.5} | stop],
    }
    found = ct.equilibrium(ct.Mechanism(**(given | parts)))
    closed = [k for k, force in enumerate(found.restraint_force.values[:, 0]) if force]
    assert len(closed) > 0
    return found.isel(equilibrium=closed)


@pytest.mark.parametrize(
    ("stop", "units"),
    [
        ({"link": "XA", "least": -1.1}, "N m"),
        # cos of the distance from the zenith is sin(arc) sin(angle)
        ({"points": ["P", "A"], "most": math.acos(math.sin(ARC) * math.sin(-1.1))}, "N m"),
        (
            {"point": "A", "direction": [0, 0, 2], "least": RADIUS * math.sin(ARC) * math.sin(-1.1)},
            "N",
        ),
    ],
    ids=["hinge", "rope", "wall"],
)
def test_a_spherical_pendulum_rests_on_a_stop_by_its_weight(stop: dict[str, Any], units: str) -> None:
    found = resting(stop)
    assert found.restraint_force.attrs["units"] == units
    # the same height twice, on either side of the vertical, but for a hinge, which counts its turns
    angles = found.generalised_coordinate.values[:, 0]
    slopes = {
        "N": RADIUS * math.sin(ARC) * math.cos(-1.1),
        "N m": 1.0 if "link" in stop else -math.sin(ARC) * math.cos(-1.1) / math.sin(stop.get("most", 1.0)),
    }
    assert math.isclose(angles[0], -1.1, abs_tol=1e-10)
    assert len(angles) == (1 if "link" in stop else 2)
    # virtual work: what the weight does along the angle, the stop does along its coordinate
    force = WEIGHT * math.cos(-1.1) / slopes[units]
    assert math.isclose(float(found.restraint_force[0, 0]), force, rel_tol=1e-9)


def test_a_stop_that_names_the_links_the_other_way_round_pushes_the_other_way() -> None:
    links = {
        "XC": {"length": ARC, "reference": ["X", "Y"], "angle": 0.0},
        "CA": {"length": ARC, "reference": ["C", "X"], "mass": MASS, "shape": "arc", "angle": 1.0},
    }
    drives = [{"link": "XC", "start": 0.0}]
    pairs = [
        {"link": "CA", "relative_to": "XC", "least": -1.3, "most": 1.2},
        {"link": "XC", "relative_to": "CA", "least": -1.2, "most": 1.3},
    ]
    results = []
    for stop in pairs:
        mechanism = {
            "space": "sphere", "radius": RADIUS, "gravity": [0, 0, -G], "frame": AXES, "links": links,
            "drives": drives, "stops": [{"name": "s", "restitution": 0.0} | stop],
        }  # fmt: skip
        found = ct.equilibrium(ct.Mechanism(**mechanism), hold={"XC": 0.0})
        closed = found.restraint_force.values[:, 0] != 0.0
        results.append((found.generalised_coordinate.values[closed], found.restraint_force.values[closed, 0]))
    (places, forces), (mirrored, pushes) = results
    assert len(places) == len(mirrored) > 0
    assert places == pytest.approx(mirrored, abs=1e-9)
    assert forces == pytest.approx(-pushes, rel=1e-9)
    assert forces[0] == pytest.approx(-WEIGHT * math.cos(1.2), rel=1e-9)
