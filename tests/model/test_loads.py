"""Loads are a union: each table of a file is one of its classes, and nothing is lost on the way back."""

from __future__ import annotations

from typing import Any, get_args

import pytest

import centrode as ct
from centrode.model import loads
from centrode.model.loads import LOAD_DEFAULTS, AnyLoad, Load, read_load

TABLES: dict[str, dict[str, Any]] = {
    "PointForce": {"kind": "force", "point": "A", "vector": [1.0, "2*v"], "axes": "OA"},
    "GuideForce": {"kind": "force", "guide": "B", "table": [[0.0, 1.0], [1.0, 2.0]]},
    "Torque": {"kind": "torque", "link": "OA", "value": "0.2*x"},
    "PointSpring": {"kind": "spring", "points": ["O", "A"], "stiffness": 3.0, "free_length": 0.5},
    "HingeSpring": {"kind": "spring", "link": "OA", "stiffness": 3.0, "free_angle": 0.5},
    "PointDamper": {"kind": "damper", "points": ["O", "B"], "damping": 3.0},
    "HingeDamper": {"kind": "damper", "link": "AB", "damping": 3.0, "relative_to": "OA"},
    "LinkWeight": {"kind": "weight", "link": "AB"},
    "PointWeight": {"kind": "weight", "point": "B", "value": 9.0},
    "HingeFriction": {"kind": "friction", "link": "OA", "quadratic": 3.0, "form": "plain sum"},
    "GuideFriction": {"kind": "friction", "guide": "B", "viscous": 3.0},
    "BearingFriction": {"kind": "friction", "point": "A", "link": "AB", "coefficient": 0.1, "radius": 0.01},
    "SliderFriction": {"kind": "friction", "guide": "B", "coefficient": 0.1},
}
"""A table for each class of the union."""


def crank(table: dict[str, Any]) -> ct.Mechanism:
    return ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "angle": 1}, "AB": {"length": 3, "angle": 6}},
        guides=[{"point": "B", "through": [0, 0], "direction": 0}],
        drives=[{"link": "OA", "speed": 1}],
        gravity=[0, -9.81],
        loads=[table],
    )


def test_every_class_has_a_table() -> None:
    assert set(TABLES) == {one.__name__ for one in get_args(AnyLoad)}
    for one in get_args(AnyLoad):
        own = list(one.keys())
        assert own == [key for key in LOAD_DEFAULTS if key in own], one  # in the order of a file
    assert list(Load.keys()) == list(LOAD_DEFAULTS)


@pytest.mark.parametrize("name", TABLES)
def test_a_table_is_its_class_and_reads_back(name: str) -> None:
    mechanism = crank(TABLES[name])
    load = mechanism.loads[0]
    assert type(load) is getattr(loads, name)
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)).loads == (load,)
    assert read_load(load) is load
    assert crank({**TABLES[name], "name": "own"}).loads[0].label == "own"


@pytest.mark.parametrize(
    ("name", "label"),
    [("PointSpring", "spring O-A"), ("GuideForce", "force B"), ("BearingFriction", "friction A")],
)
def test_a_load_without_a_name_is_called_by_its_place(name: str, label: str) -> None:
    assert crank(TABLES[name]).loads[0].label == label


def test_keys_with_their_defaults_are_no_fault() -> None:
    """A program may give every key; what means nothing for the load is left out."""
    assert (
        crank({**TABLES["Torque"], "axes": "frame", "fit": "clearance", "point": None}).loads
        == crank(TABLES["Torque"]).loads
    )


def test_faults_of_a_load_are_told_at_its_keys() -> None:
    table = {"kind": "torque", "link": 3, "value": "3 N"}
    with pytest.raises(ct.InputError) as refusal:
        crank(table)
    assert str(refusal.value).splitlines()[0].startswith("[[loads]] 1, link: expected a name")
    assert str(refusal.value).splitlines()[1].startswith("[[loads]] 1, value: expected a torque")
