"""Gears and rolling wheels inside groups of higher class: the same mechanism driven from its other end moves alike."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.kinematics.preparation import ready
from mechanisms import EPS, Parts, parts_of

ROLLED_ROD: Parts = {
    "frame": {"points": {"O": [0.0, 0.0]}},
    "links": {
        "OA": {"length": 1.1},
        "wheel": {"points": {"A": [0, 0], "P": [0.6, 0.1]}, "angle": 0.4},
        "PB": {"length": 3.0},
    },
    "guides": [{"point": "B", "through": [0, 0.2], "direction": [1, 0]}],
    "rolling": [
        {
            "link": "wheel",
            "centre": "A",
            "radius": 0.9,
            "along": {"centre": "O", "radius": 2.0, "inside": True},
        }
    ],
    "drives": [{"link": "OA", "start": 0.5, "speed": 1.0}],
    "assembly": {"sides": {"B": "ahead"}},
}


def other_end(parts: Parts, drive: Parts, at: Any, angles: dict[str, float]) -> ct.Mechanism:
    """The same links, driven otherwise; initial angles by a hundredth of a degree, as a reader would give them."""
    links = {
        name: {**link, "angle": angles[name] if name in ("EC", "wheel") else round(angles[name], 4)}
        for name, link in parts["links"].items()
    }
    if "link" in drive:
        del links[drive["link"]]["angle"]
    new = {**parts, "links": links, "drives": [{**drive, "start": at, "speed": 1.0}]}
    new.pop("assembly", None)
    return ct.Mechanism(**new)


def wheel_on_the_floor() -> tuple[Parts, Parts, tuple[str, str]]:
    parts = parts_of(ct.example("rolling-wheel-rod"))
    parts.pop("study", None)
    return parts, {"guide": "B"}, ("slide", "B")


def five_bar() -> tuple[Parts, Parts, tuple[str, str]]:
    parts = parts_of(ct.example("geared-five-bar"))
    parts.pop("study", None)
    return parts, {"link": "AB"}, ("angle", "AB")


# parts, the other drive, what it drives, and a range in which that end does not turn back
CASES = {
    "geared five-bar driven at a rod": (*five_bar(), (0.5, 0.9)),
    "wheel on the floor driven through a rod at its rim": (*wheel_on_the_floor(), (0.1, 0.4)),
    "planet driven through a rod at its rim": (ROLLED_ROD, {"guide": "B"}, ("slide", "B"), (0.5, 0.9)),
}


@pytest.mark.parametrize("name", CASES)
def test_driven_from_the_other_end(name: str) -> None:
    parts, drive, (variable, which), (start, stop) = CASES[name]
    forward = ct.motion(ct.Mechanism(**parts), 41, start=start, stop=stop)
    dimension = "link" if variable == "angle" else "guide"
    values = forward[variable].sel({dimension: which}).to_numpy()
    angles = {link: float(forward.angle.sel(link=link)[20]) for link in parts["links"]}
    mechanism = other_end(parts, drive, float(values[20]), angles)
    kinds = {group.kind for group in ready(mechanism).structure.groups}
    assert "higher class" in kinds
    back = ct.motion(mechanism, at=values)
    assert (back.status == ct.Status.OK).all()
    # the way back divides by the speed of the driven end
    speed = np.abs(
        forward[f"{'angular_' if variable == 'angle' else 'slide_'}velocity"].sel({dimension: which})
    )
    allowed = 256 * EPS * 6 / float(speed.min())
    for found in ("position", "angle"):
        assert float(np.abs(back[found].to_numpy() - forward[found].to_numpy()).max()) <= allowed
    assert float(back.residual.max()) <= 64 * EPS
