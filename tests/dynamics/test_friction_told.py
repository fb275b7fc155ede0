"""What friction by coefficients acts between, where it stands or turns round, what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import centrode as ct
from mechanisms import EPS, parts_of

PUSH = {"kind": "force", "point": "B", "vector": [-5, 3]}
FOUR: dict[str, Any] = {
    "frame": {"points": {"O": [0, 0], "D": [4, 0]}},
    "links": {"OA": {"length": 1}, "AB": {"length": 3.5}, "DB": {"length": 3}},
    "drives": [{"link": "OA", "speed": 2.0}],
    "assembly": {"sides": {"B": "left"}},
}
SLIDER: dict[str, Any] = {
    "frame": {"points": {"O": [0, 0]}},
    "links": {"OA": {"length": 1}, "AB": {"length": 3}, "S": {"points": {"B": [0, 0]}}},
    "guides": [{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "S"}],
    "drives": [{"link": "OA", "speed": 2.0}],
    "assembly": {"sides": {"B": "ahead"}},
}
SLOT = {
    **SLIDER,
    "links": {"OA": {"length": 1}, "AB": {"length": 3}},
    "guides": [{"point": "B", "on": "frame", "through": "O", "direction": [1, 0]}],
}
PIN = {"kind": "friction", "point": "A", "coefficient": 0.1, "radius": 0.1}


def rubbing(base: dict[str, Any], *loads: dict[str, Any]) -> ct.Mechanism:
    return ct.Mechanism(**{**base, "loads": [PUSH, *loads]})


def hinge(**keys: Any) -> dict[str, Any]:
    return PIN | keys


def guide(**keys: Any) -> dict[str, Any]:
    return {"kind": "friction", "guide": "B", "coefficient": 0.1, **keys}


@pytest.mark.parametrize(
    ("base", "load", "bearings"),
    [
        (FOUR, hinge(), ["A/AB"]),
        (FOUR, hinge(pin="AB"), ["A/OA"]),
        (FOUR, hinge(link="AB"), ["A/AB"]),
        (FOUR, hinge(point="O"), ["O/OA"]),
        (FOUR, hinge(point="O", pin="frame"), ["O/OA"]),
        (SLIDER, hinge(point="B"), ["B/S"]),
        (SLOT, hinge(point="B"), ["B/AB"]),
    ],
)
def test_which_link_rubs_on_which_pin(
    base: dict[str, Any], load: dict[str, Any], bearings: list[str]
) -> None:
    assert ct.reactions(rubbing(base, load), 5).bearing.to_numpy().tolist() == bearings


def test_at_a_hinge_of_three_links_each_bears_with_its_own_force() -> None:
    three = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [4, 0], "E": [2, 3]}},
        links={
            "OA": {"length": 1},
            "AB": {"length": 3.5},
            "DB": {"length": 3},
            "BC": {"length": 2},
            "EC": {"length": 2.5},
        },
        drives=[{"link": "OA", "speed": 2.0}],
        loads=[
            {"kind": "force", "point": "C", "vector": [-5, 3]},
            {"kind": "friction", "point": "B", "coefficient": 0.2, "radius": 0.05, "pin": "DB"},
            {"kind": "friction", "point": "C", "coefficient": 0.2, "radius": 0.05},
        ],
        assembly={"sides": {"B": "left", "C": "left"}},
    )
    found = ct.reactions(three, 25)
    assert found.bearing.to_numpy().tolist() == ["B/AB", "B/BC", "C/EC"]
    good = found.reaction_status.to_numpy() == 0
    assert good.sum() > 20
    for label in ("B/AB", "B/BC", "C/EC"):
        force = np.hypot(*found.joint_force.sel(side=label).to_numpy().T)
        moment = abs(found.friction_moment.sel(bearing=label).to_numpy())
        assert np.allclose(moment[good], 0.01 * force[good], rtol=1e4 * EPS)


def test_the_pin_in_one_or_the_other_of_two_links_is_the_same() -> None:
    one, other = (ct.reactions(rubbing(FOUR, hinge(pin=name)), 25) for name in ("OA", "AB"))
    assert np.allclose(one.balancing, other.balancing, rtol=1e4 * EPS)
    assert np.allclose(one.friction_moment, -other.friction_moment, rtol=1e4 * EPS)


def test_a_joint_that_turns_round() -> None:
    """At the dead points of the slider; there what is told holds just after, whether the crank turns on or back."""
    for speed in (2.0, -2.0):
        machine = rubbing({**SLIDER, "drives": [{"link": "OA", "speed": speed}]}, guide())
        after, at, before = (
            ct.reactions(machine, at=[math.pi + np.sign(speed) * step]).friction_force.item()
            for step in (1e-9, 0.0, -1e-9)
        )
        assert math.isclose(at, after, rel_tol=1e-7)
        assert math.isclose(before, -after, rel_tol=1e-7)
        found = ct.reactions(machine, at=[1.0, math.pi, 4.0])
        assert found.friction_turns[:, 0].to_numpy().tolist() == [0, 1, 0]
        assert found.friction_power[1, 0] == 0.0
    whole = ct.reactions(machine, 73)
    places = whole.jumps.to_numpy()
    assert np.allclose(np.sort(places % math.pi), 0.0, atol=64 * EPS * 2 * math.pi)
    assert "jumps" not in ct.reactions(machine, 73, friction=False)


def test_a_joint_that_stands() -> None:
    """Two cranks, one of which stands: its bearing has no friction that anything tells."""
    five = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [3, 0]}},
        links={"OA": {"length": 1}, "AB": {"length": 3}, "BC": {"length": 3}, "DC": {"length": 1}},
        drives=[{"link": "OA", "speed": 1.0}, {"link": "DC", "speed": 0.0, "start": 1.0}],
        loads=[PUSH, hinge(point="O"), hinge(point="D")],
        assembly={"sides": {"B": "left"}},
    )
    found = ct.reactions(five, 13)
    assert found.attrs["standing"] == "D/DC"
    assert (found.friction_moment.sel(bearing="D/DC") == 0).all()
    assert (abs(found.friction_moment.sel(bearing="O/OA")) > 0).all()
    assert "jumps" not in found  # of two drives no value tells where
    assert found.attrs["power_residual"] < 1e-12


def test_without_friction_nothing_is_said_of_it() -> None:
    machine = rubbing(SLIDER, guide(), hinge())
    free, none = ct.reactions(machine, 9, friction=False), ct.reactions(rubbing(SLIDER), 9)
    assert free.drop_attrs().identical(none.drop_attrs())
    zero = ct.reactions(rubbing(SLIDER, guide(coefficient=0.0), hinge(coefficient=0)), 9)
    assert np.array_equal(zero.balancing, none.balancing)
    assert (zero.friction_power == 0).all()


def test_works_do_not_depend_on_the_order_of_the_samples() -> None:
    machine = rubbing(SLIDER, guide(), hinge())
    one, other = ct.reactions(machine, 49, 0.0, 5.0), ct.reactions(machine, 49, 5.0, 0.0)
    assert (one.friction_work > 0).all()
    assert np.allclose(one.friction_work, other.friction_work, rtol=1e4 * EPS)
    assert math.isclose(one.attrs["efficiency"], other.attrs["efficiency"], rel_tol=1e4 * EPS)
    back = rubbing({**SLIDER, "drives": [{"link": "OA", "speed": -2.0}]}, guide(), hinge())
    assert (ct.reactions(back, 49, -5.0, 0.0).friction_work > 0).all()


def test_works_need_a_range() -> None:
    machine = rubbing(SLIDER, guide())
    at = ct.reactions(machine, at=[2.0, 1.0])
    assert math.isnan(at.attrs["efficiency"])
    assert np.isnan(at.friction_work).all()


REFUSED: dict[str, tuple[Any, Any, str]] = {
    "negative": (FOUR, hinge(coefficient=-0.1), "must not be negative"),
    "no number": (FOUR, hinge(coefficient="x"), "expected a number"),
    "no radius": (FOUR, {k: v for k, v in PIN.items() if k != "radius"}, "the radius of the pin is missing"),
    "radius 0": (FOUR, hinge(radius=0), "radius must be positive"),
    "not a length": (FOUR, hinge(radius="10 kg"), "expected a length"),
    "no point": (FOUR, {**{k: v for k, v in PIN.items() if k != "point"}, "link": "AB"}, "needs the point"),
    "unknown point": (FOUR, hinge(point="Z"), 'unknown point "Z"'),
    "unknown pin": (FOUR, hinge(pin="Z"), "unknown link"),
    "pin elsewhere": (FOUR, hinge(pin="DB"), "pin DB has no hinge in A; use one of OA, AB"),
    "link elsewhere": (FOUR, hinge(link="DB"), "link DB has no hinge in A"),
    "pin and link": (FOUR, hinge(pin="AB", link="AB"), "which therefore does not rub"),
    "pin of the frame": (FOUR, hinge(point="O", pin="OA"), "the pin O is fixed in the frame"),
    "pin of a slot": (SLOT, hinge(point="B", pin="AB"), "fixed in the slider of its guide"),
    "fit": (FOUR, hinge(fit="tight"), 'expected one of "clearance", "new", "worn-in"'),
    "length of a pin": (FOUR, hinge(length=3), '"length" is not used'),
    "with a value": (FOUR, hinge(value=3), "are given together"),
    "value at a point": (
        FOUR,
        {"kind": "friction", "point": "A", "value": 3},
        "is used with Coulomb friction only",
    ),
    "value and pin": (
        FOUR,
        {"kind": "friction", "link": "AB", "value": 3, "pin": "OA"},
        '"pin" is used with',
    ),
    "unknown guide": (FOUR, guide(guide="Z"), "unknown guide"),
    "radius in a guide": (SLIDER, guide(radius=1), "is used with friction in a hinge only"),
    "both": (SLIDER, guide(point="B"), "acts on one of"),
    "negative length": (SLIDER, guide(length=-1), "length must be positive"),
    "no slider": (SLOT, guide(length=1), "no slider of its own"),
    "end of a link": (
        {**SLIDER, "links": {**SLIDER["links"], "AB": {"points": {"A": [0, 0], "B": [3, 0], "P": [1, 1]}}}},
        hinge(point="P"),
        "P is not a hinge",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_wrong_friction_is_refused(name: str) -> None:
    base, load, message = REFUSED[name]
    with pytest.raises(ct.InputError) as refused:
        ct.reactions(rubbing(base, load), 5)
    assert message in str(refused.value)


def test_the_same_contact_twice() -> None:
    with pytest.raises(ct.InputError, match="friction at A/AB is given twice"):
        ct.reactions(rubbing(FOUR, hinge(), hinge(link="AB")), 5)


def test_a_reaction_that_nothing_determines_has_no_friction() -> None:
    parallel = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [2, 0], "E": [1, 0]}},
        links={
            "OA": {"length": 1},
            "AB": {"points": {"A": [0, 0], "B": [2, 0], "C": [1, 0]}},
            "DB": {"length": 1},
            "EC": {"length": 1},
        },
        drives=[{"link": "OA", "speed": 1}],
        loads=[PUSH, hinge(point="C")],
        assembly={"sides": {"B": "left"}, "continuation": "keep"},
    )
    with pytest.raises(ct.InputError, match="friction at C/EC depends on a reaction"):
        ct.reactions(parallel, 5)


def test_what_knows_no_reactions_refuses() -> None:
    machine = ct.Mechanism(
        **{**SLIDER, "loads": [PUSH, guide()], "machine": {"mean_speed": 2.0, "fluctuation": 0.1}},
    )
    for compute in (
        ct.reduce,
        ct.steady_motion,
        ct.flywheel,
        lambda m: ct.force_polygons(m, at=1.0),
    ):
        with pytest.raises(ct.NotComputedYet, match="needs the reactions; compute the reactions"):
            compute(machine)
    with pytest.raises(ct.NotComputedYet, match="the real speed of a machine with Coulomb friction"):
        ct.reactions(machine, motion="real")


def test_there_is_none_on_the_sphere_yet() -> None:
    parts = parts_of(ct.example("spherical-crank-rocker"))
    load = {"kind": "friction", "point": "A", "coefficient": 0.1, "radius": 0.01}
    rocker = ct.Mechanism(**{**parts, "loads": [load]})
    with pytest.raises(ct.NotComputedYet, match="Coulomb friction is available for planar mechanisms only"):
        ct.reactions(rocker, 5)
    assert "friction_power" not in ct.reactions(rocker, 5, friction=False)


def test_the_description_comes_back() -> None:
    machine = rubbing(FOUR, hinge(fit="new", pin="AB", link="OA"))
    assert ct.parse_mechanism(ct.mechanism_text(machine)) == machine
