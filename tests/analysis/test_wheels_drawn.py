"""Loci of wheels in a drawing: wheels beside or about their tracks, tracks that rest on wheels or are carried past."""

from __future__ import annotations

import re

import pytest

import centrode as ct
from centrode.analysis.graphic.checks import GraphicCheck
from centrode.kinematics.preparation import ready
from centrode.structure.groups import Aim, Meet, Touch
from drawn import errors

CRANK = """
[frame.points]
O = [0, 0]
D = [3, 0]
[links.OA]
length = 0.5
angle = 0.4
[[drives]]
link = "OA"
speed = 1.3
"""
ROD = """
[links.AB]
length = 2
[links.wheel]
points = { B = [0, 0], M = [0.2, 0] }
[[rolling]]
link = "wheel"
centre = "B"
radius = 0.3
on = "frame"
"""
ABOUT_A_CIRCLE = (
    CRANK + ROD + 'along = { centre = [3, 1], radius = 0.9 }\n[assembly]\nsides = { B = "left" }\n'
)
BESIDE_A_LINE = (
    CRANK + ROD + 'along = { through = [0, -0.8], direction = [1, 0] }\n[assembly]\nsides = { B = "ahead" }\n'
)
RESTING = (
    CRANK
    + """
[links.wheel]
points = { A = [0, 0], M = [0.2, 0] }
[links.lever]
points = { D = [0, 0], E = [-4, 0.3] }
angle = -0.2
[[rolling]]
link = "wheel"
centre = "A"
radius = 0.3
on = "lever"
along = { through = [0, 0], direction = [-1, 0] }
"""
)
CARRIED = (
    CRANK
    + """
[links.wheel]
points = { A = [0, 0], M = [0.2, 0] }
[links.table]
points = { T = [0, 0], E = [1, 0.3] }
[[guides]]
point = "T"
on = "frame"
through = [2, 0]
direction = [0, 1]
link = "table"
[[rolling]]
link = "wheel"
centre = "A"
radius = 0.3
on = "table"
"""
)
CARRIED_CIRCLE = (
    CARRIED + 'along = { centre = [-1, -1], radius = 1.5 }\n[assembly]\nsides = { T = "ahead" }\n'
)
CARRIED_LINE = CARRIED + "along = { through = [0, 0.1], direction = [-0.96, 0.28] }\n"


def loci(text: str) -> set[tuple[str, bool]]:
    """(letter, carried) of every wheel's locus; "A" of links that rest on a wheel."""
    found = set()
    for group in ready(ct.parse_mechanism(text)).structure.groups:
        if isinstance(group, Aim) and group.contact is not None:
            found.add(("A", True))
        if isinstance(group, Meet):
            found |= {(locus.letter, locus.carried) for locus in group.loci if isinstance(locus, Touch)}
    return found


@pytest.mark.parametrize(
    ("text", "locus"),
    [
        (ABOUT_A_CIRCLE, ("R", False)),
        (BESIDE_A_LINE, ("P", False)),
        (RESTING, ("A", True)),
        (CARRIED_CIRCLE, ("R", True)),
        (CARRIED_LINE, ("P", True)),
    ],
)
def test_loci_of_wheels(text: str, locus: tuple[str, bool]) -> None:
    assert locus in loci(text)
    mechanism = ct.parse_mechanism(text)
    for at in (0.5, 1.1):
        found = errors(mechanism, at)
        assert found is not None
        assert (found[0] <= found[1]).all()


def test_a_link_that_is_found_before_its_points() -> None:
    """A cross of two slots on known pins, kept from turning: no point of it is found with it."""
    text = """
    [frame.points]
    O = [0, 0]
    F = [2, 1]
    [links.OA]
    length = 0.5
    angle = 0.4
    [links.shoe]
    points = { S = [0, 0] }
    [links.cross]
    points = { E = [1, 1], G = [0.3, 0.9] }
    [[guides]]
    point = "A"
    on = "cross"
    through = [0, 0]
    direction = [0, 1]
    [[guides]]
    point = "F"
    on = "cross"
    through = [0, 0]
    direction = [1, 0]
    [[guides]]
    name = "rest"
    point = "S"
    on = "frame"
    through = [0, -1]
    direction = [1, 0]
    link = "shoe"
    [[gears]]
    links = ["OA", "cross"]
    carrier = "shoe"
    ratio = 0.25
    [[drives]]
    link = "OA"
    speed = 1.3
    [[drives]]
    guide = "rest"
    start = 0.1
    speed = 0.2
    """
    mechanism = ct.parse_mechanism(text)
    groups = ready(mechanism).structure.groups
    assert any(isinstance(group, Meet) and not group.points for group in groups)
    found = errors(mechanism, 0.5)
    assert found is not None
    assert (found[0] <= found[1]).all()
    figures = ct.figures(ct.graphic_analysis(mechanism, instants=[0.5]))
    assert len(figures) == 3


@pytest.mark.parametrize(
    ("name", "at", "equations"),
    [
        (
            "planetary-gear-train",
            0.5,
            ["(X_planet − X_OA) = -1.3333·(X_sun − X_OA)", "(0 − X_OA) = 0.3·(X_planet − X_OA)"],
        ),
        ("geared-five-bar", 0.5, ["X_EC = -2·X_OA"]),
        ("rolling-wheel-rod", 0.3, []),
    ],
)
def test_equations_of_wheels_are_written_and_hold(name: str, at: float, equations: list[str]) -> None:
    results = ct.graphic_analysis(ct.example(name), instants=[at])
    (check,) = results.checks
    assert isinstance(check, GraphicCheck)
    found = ct.summary(results).splitlines()
    for letter, diagram in (("ω", check.diagrams.velocity), ("ε", check.diagrams.acceleration)):
        for equation in equations:
            told = equation.replace("X", letter)
            assert f"    {told}" in found
            numbers = re.sub(rf"{letter}_(\w+)", lambda one, turns=diagram.turns: repr(turns[one[1]]), told)
            left, right = numbers.split(" = ")
            # the ratio is told with five figures
            assert value_of(left) == pytest.approx(value_of(right), rel=1e-4, abs=1e-12)
    if name == "rolling-wheel-rod":
        assert "    |ω_wheel| = |v_C|/r" in found
        velocity = check.diagrams.velocity
        assert abs(velocity.turns["wheel"]) == pytest.approx(abs(velocity.images["C"]) / 0.3, rel=1e-14)


def value_of(text: str) -> float:
    """A number, a difference "(a − b)", or a product of two of them."""
    product = 1.0
    for factor in text.split("·"):
        first, *rest = factor.strip("()").split(" − ")
        product *= float(first) - sum(map(float, rest))
    return product
