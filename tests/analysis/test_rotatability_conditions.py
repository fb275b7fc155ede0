"""Conditions of turning in symbols hold at the limits, which are those of `ct.limits`."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

import centrode as ct
from centrode.analysis.rotatability.causes import CauseKind, Tracer
from mechanisms import EPS
from samples import examples_at_hand
from turning import assert_swings

SLOW = "scissor-lift-cylinder"
"""Its group of higher class takes seconds."""
LIMITED = [
    "slider-between-cranks-locked",
    "double-rocker",
    "triple-rocker",
    "elliptic-trammel",
    "tangent-mechanism",
    "stephenson-driven-at-coupler",
    "stephenson-driven-at-rocker",
    SLOW,
]


@pytest.mark.parametrize("name", examples_at_hand(LIMITED))
def test_limits_are_those_of_ct_limits_to_the_last_bit(name: str) -> None:
    mechanism = ct.example(name)
    found = ct.rotatability(mechanism)
    low, high = ct.limits(mechanism).interval
    assert {limit.value for limit in found.limits if limit.end == "low"} == {low} - {-math.inf}
    assert {limit.value for limit in found.limits if limit.end == "high"} == {high} - {math.inf}
    assert found.turns_fully is (False if mechanism.drives[0].kind == "angle" else None)
    assert_swings(found)
    if mechanism.study.start is None and name != SLOW:
        events = set(ct.motion(mechanism, samples=2).event_value.values.tolist())
        assert {limit.value for limit in found.limits} & events


def test_the_locked_mechanism_of_the_source() -> None:
    """CB and BD are collinear where C is 2 m away from D, C on its guide and D where the initial angles put it."""
    found = ct.rotatability(ct.example("slider-between-cranks-locked"))
    height = math.sin(0.5)
    c0 = complex(0.5 + math.cos(0.5), height)
    d = c0 + 1.2 * np.exp(4.7j) + 0.8 * np.exp(5.7j)
    for limit in found.limits:
        t = limit.value
        c = complex(0.5 * math.cos(t) + math.sqrt(1 - (0.5 * math.sin(t) - height) ** 2), height)
        # the distance changes by about 0.5 m/rad there
        assert abs(abs(c - d) - 2.0) <= 16 * EPS
        assert str(limit.condition) == "sin(phi3 - phi4) = 0"
        assert limit.links == ("CB", "BD")
        assert limit.cause.kind == CauseKind.RODS_IN_LINE and limit.cause.stretched
        assert limit.cause.bodies == ((Tracer.LINK, "CB"), (Tracer.LINK, "BD"))
        assert limit.cause.points == ("C", "D")
        assert limit.cause.distance == pytest.approx(2.0, abs=16 * EPS)
    assert abs(found.limits[1].value - 1.79991241652444) <= 1e-14


def left_side(condition: str, angles: dict[str, float], slides: dict[str, float]) -> float:
    """What the left side of a condition less its right side amounts to at angles and displacements."""
    left, _sign, right = condition.partition(" = ")
    if left in slides:
        return slides[left] - float(right.removesuffix(" m"))
    name, _bracket, inside = left.removesuffix(")").partition("(")
    total, sign = 0.0, 1.0
    for word in inside.split():
        if word in "+-":
            sign = -1.0 if word == "-" else 1.0
        else:
            total += sign * (angles[word] if word in angles else float(word))
    return float({"sin": math.sin, "cos": math.cos}[name](total))


INVERTED = ct.Mechanism(
    frame={"points": {"O": [0, 0], "D": [0, -1]}},
    links={"OA": {"length": 1.2}, "lever": {"points": {"D": [0, 0], "E": [0, 0.4]}}},
    guides=[{"point": "A", "on": "lever", "through": [0.3, 0.4], "direction": "20 deg"}],
    drives=[{"link": "OA", "start": 1, "speed": 1}],
    assembly={"sides": {"A": "ahead"}},
)
"""The crank's pin comes nearer to the lever's pivot than the lever's guide is."""

SKEW = ct.Mechanism(
    frame={"points": {"O": [0, 0]}},
    links={"OA": {"points": {"O": [0, 0], "A": [1, 0.3]}}, "AB": {"points": {"A": [0, 0], "B": [0.5, 0.6]}}},
    guides=[{"point": "B", "on": "frame", "through": [0, 0.1], "direction": "35 deg"}],
    drives=[{"link": "OA", "start": 0.6, "speed": 1}],
    assembly={"sides": {"B": "ahead"}},
)
"""Links whose points do not lie on their axes, so that conditions have constants."""


@pytest.mark.parametrize(
    "mechanism",
    [
        INVERTED,
        SKEW,
        ct.example("slider-between-cranks-locked"),
        ct.example("double-rocker"),
        ct.example("stephenson-driven-at-coupler"),
        ct.example("elliptic-trammel"),
    ],
)
def test_conditions_in_symbols_hold_at_the_limits(mechanism: ct.Mechanism) -> None:
    found = ct.rotatability(mechanism)
    assert len(found.limits) == 2
    for limit in found.limits:
        motion = ct.motion(mechanism, at=[limit.value])
        angles = {
            f"phi{k + 1}": float(motion.angle.sel(link=name)[0])
            for k, name in enumerate(mechanism.link_names)
        }
        guides = [guide.id for guide in mechanism.guides]
        slides = {f"s_{name}": float(motion.slide.sel(guide=name)[0]) for name in guides}
        # a root of a radicand that is zero but for some units in the last place; constants have six digits
        assert abs(left_side(str(limit.condition), angles, slides)) <= 16 * math.sqrt(EPS) + 1e-6


@pytest.mark.parametrize(
    "name",
    [
        "slider-between-cranks-locked",
        "double-rocker",
        "triple-rocker",
        "elliptic-trammel",
        "stephenson-driven-at-coupler",
    ],
)
def test_conditions_are_the_determinants_of_the_equations_in_symbols(name: str) -> None:
    """But for lengths and the sign, which do not decide where they are zero."""
    mechanism = ct.example(name)
    determinants = {
        frozenset(group.links): str(group.determinant) for group in ct.equations(mechanism).groups
    }
    for limit in ct.rotatability(mechanism).limits:
        wave = re.search(r"(sin|cos)\([^()]*\)", determinants[frozenset(limit.links)])
        assert wave is not None
        assert str(limit.condition) == f"{wave[0]} = 0"


def test_conditions_have_the_constants_of_bent_links() -> None:
    turned = math.atan2(0.6, 0.5) - math.radians(35)
    assert {str(limit.condition) for limit in ct.rotatability(SKEW).limits} == {
        f"cos(phi2 + {turned:.6g}) = 0"
    }
