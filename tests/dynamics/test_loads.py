"""Each kind of load and mass in closed form, and what is refused, with its reason."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.reduction import Reducer
from mechanisms import EPS

FRAME: dict[str, Any] = {"points": {"O": [0, 0], "D": [3.0, 1.0]}}
CRANK: dict[str, Any] = {"points": {"O": [0, 0], "A": [0.8, 0]}}
VALUES = np.array([-2.0, -0.4, 0.3, 1.9])


def crank(*loads: dict[str, Any], link: dict[str, Any] | None = None, **more: Any) -> ct.Mechanism:
    """A crank about O."""
    return ct.Mechanism(
        frame=FRAME,
        links={"OA": {**CRANK, **(link or {})}},
        drives=[{"link": "OA", "start": 0.0, "speed": 2.0}],
        loads=list(loads),
        **more,
    )


def moment(mechanism: ct.Mechanism) -> Any:
    return Reducer.of(mechanism).at(VALUES).moment


def slider(*loads: dict[str, Any], **more: Any) -> ct.Mechanism:
    """A Scotch yoke: its block H moves as 0.5 cos q along the x axis."""
    return ct.Mechanism(
        links={"OA": {"length": 0.5}, "yoke": {"points": {"H": [0, 0]}}},
        frame={"points": {"O": [0, 0]}},
        guides=[
            {"point": "H", "on": "frame", "through": [0, 0], "direction": [1, 0], "link": "yoke"},
            {"point": "A", "on": "yoke", "through": "H", "direction": [0, 1]},
        ],
        drives=[{"link": "OA", "start": 0.0, "speed": 2.0}],
        loads=list(loads),
        **more,
    )


def close(found: Any, exact: Any, size: float) -> None:
    assert np.allclose(found, exact, rtol=0, atol=32 * EPS * size)


@pytest.mark.parametrize(
    ("load", "exact"),
    [
        ({"kind": "force", "point": "A", "vector": [3, -5]}, lambda q: 0.8 * (-3 * np.sin(q) - 5 * np.cos(q))),
        ({"kind": "force", "point": "A", "vector": [3, -5], "axes": "OA"}, lambda q: -4.0 + 0 * q),
        ({"kind": "force", "point": "A", "vector": ["2*x", "v"]},
         lambda q: -2 * 0.64 * np.cos(q) * np.sin(q) + 2.0 * 0.64 * np.cos(q) ** 2),
        ({"kind": "force", "point": "A", "vector": [0, "v + x"], "axes": "OA"}, lambda q: 0.8 * 1.6 + 0 * q),
        ({"kind": "force", "point": "A", "vector": ["1", "t*q"]},
         lambda q: 0.8 * (-np.sin(q) + q / 2 * q * np.cos(q))),
        ({"kind": "torque", "link": "OA", "value": "3 - 0.5*v**2 + x"}, lambda q: 1.0 + q),
        ({"kind": "friction", "link": "OA", "value": 3}, lambda q: -3 + 0 * q),
        ({"kind": "friction", "link": "OA", "viscous": 3}, lambda q: -6 + 0 * q),
        ({"kind": "friction", "link": "OA", "value": "2 + q**2", "quadratic": 3}, lambda q: -14 - q**2),
        ({"kind": "spring", "link": "OA", "stiffness": 4, "free_angle": 0.5}, lambda q: -4 * (q - 0.5)),
        ({"kind": "damper", "link": "OA", "damping": 1.5}, lambda q: -3.0 + 0 * q),
        ({"kind": "weight", "point": "A", "value": 7}, lambda q: -7 * 0.8 * np.cos(q)),
        ({"kind": "force", "point": "A", "vector": [0, 0]}, lambda q: 0 * q),
    ],
    ids=lambda value: value["kind"] if isinstance(value, dict) else "",
)  # fmt: skip
def test_loads_on_a_crank(load: dict[str, Any], exact: Any) -> None:
    close(moment(crank(load, gravity=[0, -9.81])), exact(VALUES), 16)


@pytest.mark.parametrize("free", [0.0, 1.2])
def test_springs_and_dampers_between_points(free: float) -> None:
    """A spring has the moment -dV/dq of V = k (l - l0)^2/2, l^2 = a^2 + d^2 - 2 a (3 cos q + sin q)."""
    length = np.sqrt(0.64 + 10 - 1.6 * (3 * np.cos(VALUES) + np.sin(VALUES)))
    slope = 0.8 * (3 * np.sin(VALUES) - np.cos(VALUES)) / length
    spring = crank({"kind": "spring", "points": ["A", "D"], "stiffness": 50, "free_length": free})
    close(moment(spring), -50 * (length - free) * slope, 200)
    damper = crank({"kind": "damper", "points": ["D", "A"], "damping": 6})
    close(moment(damper), -6 * 2.0 * slope**2, 12)


def test_a_spring_of_no_free_length_where_its_ends_meet() -> None:
    pin = ct.Mechanism(
        frame={"points": {"O": [0, 0], "B": [0.8, 0]}},
        links={"OA": CRANK},
        drives=[{"link": "OA", "start": 0.0, "speed": 2.0}],
        loads=[{"kind": "spring", "points": ["A", "B"], "stiffness": 50}],
    )
    assert Reducer.of(pin).at([0.0]).moment.tolist() == [0.0]


def test_weights_of_masses_and_of_their_own() -> None:
    link = {"mass": 5, "centre": [0.3, 0.1], "inertia": 0.2}
    arm = 0.3 * np.cos(VALUES) - 0.1 * np.sin(VALUES)
    heavy = crank(link=link, gravity=[0, -10])
    close(moment(heavy), -50 * arm, 50)
    assert Reducer.of(heavy).loads == ("weight OA",)
    close(Reducer.of(heavy).at(VALUES).inertia, 0.2 + 5 * 0.1, 1)
    given = crank({"kind": "weight", "link": "OA", "value": 80}, link=link, gravity=[0, -10])
    close(moment(given), -80 * arm, 80)  # in place of 50, not besides
    said = crank({"kind": "weight", "link": "OA"}, link=link, gravity=[0, -10])
    close(moment(said), -50 * arm, 50)
    sideways = crank(link=link, gravity=[6, 8])
    close(moment(sideways), 5 * (-6 * (0.3 * np.sin(VALUES) + 0.1 * np.cos(VALUES)) + 8 * arm), 50)
    assert Reducer.of(crank({"kind": "torque", "link": "OA", "value": 1}, link=link)).loads == ("torque OA",)


@pytest.mark.parametrize(
    ("link", "inertia"),
    [
        ({"mass": 6, "shape": "rod"}, 6 * 0.64 / 3),
        ({"mass": 6, "shape": "disc", "radius": 0.2, "centre": "O"}, 6 * 0.04 / 2),
        ({"mass": 6, "shape": "disc", "radius": 0.2, "centre": "A"}, 6 * 0.04 / 2 + 6 * 0.64),
        ({"mass": 6, "shape": "rod", "inertia": 0.5}, 0.5 + 6 * 0.16),
        ({"points": {"A": [0.8, 0], "O": [0, 0], "S": [0.4, 0]}, "mass": 6, "shape": "rod"}, 6 * 0.64 / 3),
        ({"inertia": 0.7}, 0.7),
        ({"mass": 6, "centre": "A", "inertia": 0}, 6 * 0.64),
    ],
)
def test_shapes(link: dict[str, Any], inertia: float) -> None:
    close(Reducer.of(crank(link=link)).at(VALUES).inertia, inertia, inertia)


def test_a_diagram_with_a_column_for_each_way() -> None:
    rows = [[-0.5, 10, 0], [0.1, 40, -5], [0.5, 100, -20]]
    yoke = slider({"kind": "force", "guide": "H", "table": rows})
    q = np.array([0.4, 2.0, 3.6, 5.9])
    x, slope = 0.5 * np.cos(q), -0.5 * np.sin(q)
    there, back = (np.interp(x, [-0.5, 0.1, 0.5], column) for column in ([10, 40, 100], [0, -5, -20]))
    found = Reducer.of(yoke).at(q)
    close(found.moment, np.where(slope > 0, there, back) * slope, 100)
    kink = math.acos(0.2)
    exact = [0.0, kink, math.pi, 2 * math.pi - kink]
    close(Reducer.of(yoke).jumps(-0.1, 6.2), exact, 8)
    backwards = Reducer.of(yoke).at(q, rate=-2.0)
    close(backwards.moment, np.where(slope < 0, there, back) * slope, 100)
    one_way = slider({"kind": "force", "guide": "H", "table": [row[:2] for row in rows]})
    close(Reducer.of(one_way).at(q).moment, there * slope, 100)


def test_a_diagram_of_many_rows() -> None:
    """Every row is passed twice a turn; all of them are found, in a moment."""
    x = np.linspace(-0.5, 0.5, 2001)
    yoke = slider({"kind": "force", "guide": "H", "table": [[float(at), float(10 * at**2)] for at in x]})
    found = Reducer.of(yoke).jumps(0.1, math.pi - 0.1)
    inner = x[(abs(x) < 0.5 * math.cos(0.1)) & (abs(x) < 0.5)]
    # the arc cosine loses digits towards the ends of the stroke as 1 / sin
    exact = np.sort(np.arccos(2 * inner))
    assert np.allclose(found, exact, rtol=0, atol=16 * EPS * math.pi / math.sin(0.1))


def test_a_diagram_from_a_file(tmp_path: Path) -> None:
    (tmp_path / "indicator.csv").write_text(
        "position [mm],there [kN],back [N]\n-500,0.01,0\n100,0.04,-5\n500,0.1,-20\n"
    )
    text = ct.mechanism_text(slider({"kind": "torque", "link": "OA", "value": 1}))
    old = 'kind = "torque"\nlink = "OA"\nvalue = 1.0\n'
    assert old in text
    new = 'kind = "force"\nguide = "H"\ntable = "indicator.csv"\n'
    (tmp_path / "press.toml").write_text(text.replace(old, new))
    read = ct.read_mechanism(tmp_path / "press.toml")
    assert read.loads[0].table == ((-0.5, 10, 0), (0.1, 40, -5), (0.5, 100, -20))
    assert ct.parse_mechanism(ct.mechanism_text(read)) == read


def test_labels_tell_loads_apart() -> None:
    pull = {"kind": "force", "point": "A", "vector": [1, 0]}
    several = crank(
        pull, {**pull, "name": "gust"}, pull, {"kind": "spring", "points": ["A", "D"], "stiffness": 1}
    )
    assert Reducer.of(several).loads == ("force A", "gust", "force A 2", "spring A-D")


def test_the_centre_of_a_link_of_two_points_is_its_middle() -> None:
    """J = I + m (l/2)^2, as with the centre written out."""
    left_out = crank(link={"mass": 3, "inertia": 0.2})
    length = math.dist(*left_out.links["OA"].coordinates.values())
    found = ct.reduce(left_out, samples=3).reduced_inertia.values
    assert found == pytest.approx(0.2 + 3 * (length / 2) ** 2, rel=8 * EPS)
    written = crank(link={"mass": 3, "inertia": 0.2, "centre": [length / 2, 0]})
    assert found == pytest.approx(ct.reduce(written, samples=3).reduced_inertia.values, rel=8 * EPS)


REFUSED: list[tuple[ct.Mechanism, str]] = [
    (crank(), "neither masses nor loads"),
    (
        crank(link={"points": {"O": [0, 0], "A": [1, 0], "B": [0, 1]}, "mass": 1, "inertia": 1}),
        "the position of its centre of mass is not given",
    ),
    (crank(link={"mass": 1, "centre": "A"}), "no moment of inertia"),
    (crank(link={"mass": 1, "centre": "A", "shape": "disc"}), "a disc needs a radius"),
    (crank(link={"mass": 1, "centre": "A", "shape": "rod"}), "the centre of a rod is its middle"),
    (crank(link={"shape": "rod"}), "it has a shape, but no mass"),
    (crank(link={"points": {"O": [0, 0], "A": [1, 0], "B": [0, 1]}, "mass": 1, "shape": "rod"}), "one line"),
    (crank({"kind": "weight", "point": "A", "value": 3}), "no direction without gravity"),
    (crank({"kind": "weight", "point": "A"}, gravity=[0, -10]), "no mass of its own"),
    (crank({"kind": "weight", "link": "OA"}, gravity=[0, -10]), "link OA has no mass"),
    (crank({"kind": "torque", "link": "OA", "value": "log(x - 100)"}), "no finite value at"),
    (slider({"kind": "force", "guide": "H", "table": [[0, 1], [0.5, 2]]}), "the stroke reaches -0.35"),
]


@pytest.mark.parametrize(("mechanism", "reason"), REFUSED, ids=[reason for _mechanism, reason in REFUSED])
def test_incomplete_masses_and_loads_are_refused(mechanism: ct.Mechanism, reason: str) -> None:
    with pytest.raises(ct.InputError, match=reason) as refusal:
        ct.reduce(mechanism, samples=9)
    assert refusal.value.repair


@pytest.mark.parametrize(
    ("load", "reason"),
    [
        ({"kind": "force", "point": "Z", "vector": [1, 0]}, "unknown point"),
        ({"kind": "force", "point": "A"}, '"vector" is missing'),
        (
            {"kind": "force", "guide": "A", "value": 1, "vector": [1, 0]},
            "is used with a force in a point only",
        ),
        (
            {"kind": "force", "point": "A", "vector": [1, 0], "table": [[0, 1], [1, 2]]},
            "is used with a force along a guide only",
        ),
        ({"kind": "force", "guide": "A"}, "one of value, table is missing"),
        ({"kind": "force", "guide": "A", "table": [[1, 1], [0, 2]]}, "displacements that increase"),
        ({"kind": "force", "guide": "A", "table": [[1, 1]]}, "two rows or more"),
        ({"kind": "force", "guide": "A", "table": [[0, 1, 2], [1, 2]]}, "expected"),
        ({"kind": "force", "guide": "A", "table": "none.csv"}, "none.csv"),
        ({"kind": "force", "point": "A", "vector": ["3 kg", 0]}, "kg"),
        ({"kind": "force", "point": "A", "vector": ["3*w", 0]}, "unknown name"),
        ({"kind": "spring", "points": ["A", "D"], "stiffness": -1}, "must not be negative"),
        ({"kind": "torque", "link": "OA", "value": 1, "while_moving": [1, 0]}, "is not used with a torque"),
    ],
)
def test_wrong_loads_are_refused(load: dict[str, Any], reason: str) -> None:
    with pytest.raises(ct.InputError, match=reason):
        crank(load)


@pytest.mark.parametrize("key", ["mass", "inertia"])
def test_negative_masses_are_refused(key: str) -> None:
    with pytest.raises(ct.InputError, match=f"{key} must not be negative"):
        crank(link={key: -1})


def test_friction_in_a_guide() -> None:
    """Dry friction always takes away, whichever way the block goes; its moment has a kink where the block turns."""
    rubbing = slider({"kind": "friction", "guide": "H", "value": 7, "viscous": 2, "quadratic": 5})
    reducer = Reducer.of(rubbing)
    for rate in (2.0, -1.5):
        slope = -0.5 * np.sin(VALUES)
        power = -7 * abs(slope * rate) - 2 * (slope * rate) ** 2 - 5 * abs(slope * rate) ** 3
        close(rate * reducer.at(VALUES, rate=rate).moment, power, 10)
    close(reducer.jumps(-1.0, 7.0), [0.0, math.pi, 2 * math.pi], 8)
    turning = reducer.jumps(1.0, 4.0)
    for side in (-1, 0, 1):
        close(reducer.at(turning, side=side).moment, 0.0, 10)


def test_dry_friction_needs_a_sense_but_no_speed() -> None:
    swing = ct.Mechanism(
        frame=FRAME,
        links={"OA": CRANK},
        drives=[{"link": "OA", "law": "0.8*sin(t)"}],
        loads=[{"kind": "friction", "link": "OA", "value": 2}],
        study={"to": 3},
    )
    close(ct.reduce(swing, samples=7).reduced_moment, -2 * np.sign(np.cos(np.linspace(0, 3, 7))), 2)
    reducer = Reducer.of(swing)
    close(reducer.at([0.1]).moment, -2.0, 2)
    close(reducer.at([0.1], rate=-1).moment, 2.0, 2)
    assert reducer.at([0.1], rate=0.0).moment == 0.0  # nothing slides


def test_the_plain_sum_takes_squares_from_the_drive() -> None:
    """As a source does for a hinge of the plane as well: -a v^2, whatever the hinge's own coefficient."""
    four = ct.example("crank-rocker")
    link, drive = list(four.links)[-1], four.drives[0].link
    loads = [
        {"kind": "friction", "link": link, "quadratic": 0.3, "form": form}
        for form in ("plain sum", "virtual work")
    ]
    found = Reducer.of(
        ct.Mechanism(
            frame=four.frame,
            links=four.links,
            drives=four.drives,
            assembly=four.assembly,
            guides=four.guides,
            loads=loads,
        )
    ).at(VALUES, rate=2.0)
    motion = ct.motion(four, at=VALUES)
    slope = motion.angular_velocity_coefficient.sel(link=link).to_numpy()
    assert drive != link
    close(found.moment_parts[0], -0.3 * 4 * slope**2, 10)
    close(found.moment_parts[1], -0.3 * 4 * abs(slope) ** 3, 10)


def test_friction_by_a_coefficient_is_not_reduced() -> None:
    rubbing = crank({"kind": "friction", "point": "O", "radius": 0.01, "coefficient": 0.1})
    with pytest.raises(ct.NotComputedYet, match="needs the reactions; compute the reactions"):
        ct.reduce(rubbing)


def test_speeds_need_a_law() -> None:
    swing = ct.Mechanism(
        frame=FRAME,
        links={"OA": CRANK},
        drives=[{"link": "OA", "law": "0.8*sin(t)"}],
        loads=[{"kind": "damper", "link": "OA", "damping": 2}],
        study={"to": 3},
    )
    data = ct.reduce(swing, samples=7)
    close(data.reduced_moment, -2 * 0.8 * np.cos(data.time), 2)
    with pytest.raises(ct.InputError, match="law of time"):
        Reducer.of(swing).at([0.1])
    close(Reducer.of(swing).at([0.1], rate=3.0).moment, -6.0, 6)
