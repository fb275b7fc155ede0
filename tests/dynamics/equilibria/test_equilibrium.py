"""Equilibria against references and closed forms; where friction holds; what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr
from numpy.polynomial import Chebyshev

import centrode as ct
from centrode.dynamics.equilibria.small_motions import ASYMPTOTIC, NEUTRAL, STABILITIES, STABLE, UNSTABLE
from sprung import SPHERE, five_bar, pendulum, sprung_four_bar

# mpmath, 30 digits: the closed form of the dyad and derivatives of the energies (shared references of issue 30)
FOUR_BAR_AT = 0.34650872169043329
FIVE_BAR_AT, FIVE_BAR_ENERGY = (-0.234679831669363, 0.940758482527631), 3.70183189520561
ONE_ROD = {
    "frame": {"points": {"D": [0, 0]}},
    "links": {"DC": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
}
PRINTED = 5e-15
"""Half a unit of the last digit."""


@pytest.fixture(scope="module")
def of_five_bar() -> xr.Dataset:
    return ct.equilibrium(five_bar())


def stability(found: xr.Dataset, k: int) -> str:
    return STABILITIES[int(found["stability"].values[k])]


def test_four_bar_is_where_the_reference_has_it() -> None:
    found = ct.equilibrium(sprung_four_bar())
    assert abs(float(found.drive_value[0, 0]) - FOUR_BAR_AT) < 1e-9 * FOUR_BAR_AT
    # of a closed curve of positions half the equilibria are minima
    assert [stability(found, k) for k in range(2)] == [ASYMPTOTIC, UNSTABLE]
    assert found.sizes["equilibrium"] == 2


def test_five_bar_has_the_equilibrium_of_the_reference(of_five_bar: xr.Dataset) -> None:
    apart = np.abs(of_five_bar.drive_value.values - FIVE_BAR_AT).max(axis=1)
    k = int(np.argmin(apart))
    assert apart[k] < 1e-9
    assert abs(float(of_five_bar.potential_energy[k]) - FIVE_BAR_ENERGY) < 1e-9 * FIVE_BAR_ENERGY
    assert stability(of_five_bar, k) == STABLE


def test_forces_balance_in_all_equilibria_and_the_count_fits_a_surface(of_five_bar: xr.Dataset) -> None:
    # Morse: minima less saddles plus maxima is the Euler number of a closed orientable surface, which is even
    grows = of_five_bar.growth_rate.values > 1e-6
    index = np.sum(np.isfinite(of_five_bar.growth_rate.values) & grows, axis=1)
    assert int(np.sum((-1) ** index)) % 2 == 0
    assert of_five_bar.sizes["equilibrium"] == 16


def test_where_both_drives_rest_nothing_has_to_hold_one(of_five_bar: xr.Dataset) -> None:
    # the equilibrium of the reference, reached with the first drive held there
    found = ct.equilibrium(five_bar(), hold={"AB": FIVE_BAR_AT[0]})
    apart = np.abs(found.drive_value.values[:, 1] - FIVE_BAR_AT[1])
    k = int(np.argmin(apart))
    assert apart[k] < 1e-9
    assert abs(float(found.holding_moment[k, 0])) < 1e-9
    with pytest.raises(ct.InputError, match="nothing can move"):
        ct.equilibrium(five_bar(), hold=dict(zip(("AB", "ED"), FIVE_BAR_AT, strict=True)))


def test_held_pendulum_takes_the_moment_of_its_weight() -> None:
    two = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0},
            "AB": {"length": 0.5, "mass": 2, "shape": "rod", "angle": 0},
        },
        drives=[{"link": "OA", "start": 0}],
    )
    found = ct.equilibrium(two, hold={"OA": "60 deg"})
    # the second rod hangs below its hinge, or stands above it
    assert np.allclose(np.sort(found.angle.sel(link="AB").values), [-math.pi / 2, math.pi / 2], atol=1e-12)
    weight = 9.81 * (1 * 0.5 + 2 * 1.0) * math.cos(math.pi / 3)
    assert np.allclose(found.holding_moment.values, weight, rtol=1e-13)


def test_turns_of_links_that_no_load_counts_are_one_equilibrium() -> None:
    """A torsion spring on the first of two rods: its turns are others, those of the second rod are not.

    With k (q - q0) the moment of the spring and w the weight that the first rod bears, the roots of k (q - q0) +
    w cos q; the second rod hangs or stands.
    """
    stiffness, free = 6.0, 0.4
    two = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0},
            "AB": {"length": 0.5, "mass": 2, "shape": "rod", "angle": 0},
        },
        loads=[{"name": "k", "kind": "spring", "link": "OA", "stiffness": stiffness, "free_angle": free}],
    )
    moment = Chebyshev.interpolate(
        lambda q: stiffness * (q - free) + 9.81 * (1 * 0.5 + 2 * 1.0) * np.cos(q), 60, (-8, 8)
    )
    roots = np.sort([root.real for root in moment.roots() if abs(root.imag) < 1e-9 and abs(root.real) <= 8])
    found = ct.equilibrium(two)
    first, second = (found.angle.sel(link=link).values for link in ("OA", "AB"))
    assert found.sizes["equilibrium"] == 2 * len(roots) == 6
    for sine in (-1.0, 1.0):
        assert np.allclose(np.sort(first[np.abs(np.sin(second) - sine) < 1e-9]), roots, atol=1e-9)


def test_turns_of_a_crank_are_one_equilibrium_where_a_spring_counts_those_of_the_rocker() -> None:
    spring = {"name": "k", "kind": "spring", "link": "DC", "stiffness": 2.0, "free_angle": 1.2}
    loads = ct.Mechanism(loads=[spring], **ONE_ROD).loads
    assert ct.equilibrium(sprung_four_bar(loads=loads)).sizes["equilibrium"] == 2


def test_wheels_that_mesh_keep_their_teeth_within_half_a_round_trip() -> None:
    """With teeth as 2 to 3 the first wheel is back after three turns: it is told within half of them of its start.

    With q of the first wheel, weights balance where w1 cos q = r w2 cos(b0 - r (q - a0)): there are as many equilibria
    as that has roots on three turns. Stops of that wheel are as far away as its angle says.
    """
    begin, other, ratio = 0.3, 0.1, 2.0 / 3.0
    parts = {
        "gravity": [0, -9.81],
        "frame": {"points": {"O": [0, 0], "P": [3, 0]}},
        "links": {
            "a": {"points": {"O": [0, 0], "A": [1, 0]}, "mass": 1, "centre": [0.5, 0], "inertia": 0.1, "angle": begin},
            "b": {"points": {"P": [0, 0], "B": [2, 0]}, "mass": 2, "centre": [0.3, 0], "inertia": 0.1, "angle": other},
        },
        "gears": [{"links": ["a", "b"], "ratio": -ratio}],
    }  # fmt: skip
    turned = np.linspace(begin - 3.0 * math.pi, begin + 3.0 * math.pi, 30_001)
    balance = 0.5 * np.cos(turned) - ratio * 0.6 * np.cos(other - ratio * (turned - begin))
    roots = turned[:-1][np.signbit(balance[:-1]) != np.signbit(balance[1:])]
    found = ct.equilibrium(ct.Mechanism(**parts))
    first, second = (found.angle.sel(link=link).values for link in ("a", "b"))
    assert np.allclose(np.sort(first), roots, atol=1e-3)
    assert np.allclose(second, other - ratio * (first - begin), atol=1e-9)
    stopped = ct.equilibrium(ct.Mechanism(**parts, stops=[{"link": "a", "least": -4.0, "most": 5.0}]))
    inside = roots[(roots > -4.0) & (roots < 5.0)]
    resting = stopped.angle.sel(link="a").values
    assert 2 < len(inside) < len(roots)
    assert np.allclose(np.sort(resting[(resting > -3.99) & (resting < 4.99)]), inside, atol=1e-3)


def test_links_that_turn_together_are_told_in_the_nearest_turns() -> None:
    """A spring between two rods counts the turns of one against the other alone."""
    rods = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0},
            "AB": {"length": 0.5, "mass": 2, "shape": "rod", "angle": 0},
        },
        loads=[{"kind": "spring", "link": "AB", "relative_to": "OA", "stiffness": 3.0, "free_angle": 0.2}],
    )
    found = ct.equilibrium(rods)
    first, second = (found.angle.sel(link=link).values for link in ("OA", "AB"))
    assert np.max(np.abs(first)) <= math.pi
    assert np.max(np.abs(second)) <= 2.0 * math.pi
    # moments about O of both rods, and about A of the second: each position stands, and no two are one
    bend = 3.0 * (second - first - 0.2)
    assert np.allclose(9.81 * (0.5 + 2.0) * np.cos(first), bend, atol=1e-8)
    assert np.allclose(9.81 * 2 * 0.25 * np.cos(second), -bend, atol=1e-8)
    places = np.column_stack([second - first, np.cos(first), np.sin(first)])
    assert len(np.unique(places.round(6), axis=0)) == len(places) == 4


def test_a_spring_of_the_crank_counts_its_turns() -> None:
    """k (q - q0) + w cos q = 0 of one rod on a soft spring: roots a turn apart are equilibria of their own."""
    spring = {"name": "k", "kind": "spring", "link": "OA", "stiffness": 1e-3, "free_angle": 0.0}
    found = ct.equilibrium(pendulum(loads=[spring]))
    angles = np.sort(found.angle.sel(link="OA").values)
    assert np.allclose(1e-3 * angles + 9.81 * 0.5 * np.cos(angles), 0.0, atol=1e-9)
    assert np.min(np.diff(angles)) > 1.0 and np.max(angles) - np.min(angles) > 2.0 * math.pi


def test_sphere_hangs_where_its_energy_is_least() -> None:
    found = ct.equilibrium(ct.parse_mechanism(SPHERE))
    k = int(np.argmin(found.potential_energy.values))
    assert stability(found, k) == ASYMPTOTIC
    at = float(found.drive_value[k, 0])
    energies = []
    for value in (at - 1e-3, at, at + 1e-3):
        moved = ct.with_value(ct.parse_mechanism(SPHERE), "drives.AB.start", value)
        run = ct.simulate(moved, ct.Simulation(duration=1e-6, equations="multibody"), at=[0.0])
        energies.append(float(run.potential_energy[0]))
    # the energy of the simulation is least there, to the second order of the steps
    assert energies[1] < min(energies[0], energies[2])
    assert abs(energies[0] - energies[2]) < 1e-2 * (energies[0] - energies[1])


def test_friction_holds_a_rod_within_the_angle_of_its_closed_form() -> None:
    found = ct.equilibrium(pendulum(loads=[{"kind": "friction", "link": "OA", "value": 1.0}]))
    reach = math.asin(1.0 / (9.81 * 0.5))
    bands = np.sort(np.sort(found.friction_band.values[:, :, 0], axis=1), axis=0)
    middles = np.array([-math.pi / 2, math.pi / 2])
    assert np.allclose(bands, middles[:, None] + np.array([-reach, reach]), rtol=0, atol=1e-12)


def test_friction_that_is_greater_than_all_loads_holds_everywhere() -> None:
    found = ct.equilibrium(pendulum(loads=[{"kind": "friction", "link": "OA", "value": 5.0}]))
    assert found.friction_holds_everywhere.values.tolist() == [1]


def test_friction_with_two_freedoms_holds_as_far_as_springs_give_way() -> None:
    spring = {"kind": "spring", "stiffness": 10.0, "free_angle": 0.0}
    two = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0},
            "AB": {"length": 1, "mass": 1, "shape": "rod", "angle": 0},
        },
        loads=[
            {**spring, "link": "OA"},
            {**spring, "link": "AB", "relative_to": "OA"},
            {"kind": "friction", "link": "OA", "value": 0.2},
        ],
    )
    found = ct.equilibrium(two)
    k = int(np.argmin(np.abs(found.generalised_coordinate.values).max(axis=1)))
    # the hinge in O gives way by R / k, and the second rod goes with the first
    assert np.allclose(found.friction_reach.values[k], [0.02, 0.02], rtol=1e-12)


def test_massless_linkage_has_equilibria_and_no_frequencies() -> None:
    lever = ct.Mechanism(
        frame={"points": {"O": [0, 0], "F": [2, 0]}},
        links={"OA": {"length": 1, "angle": 1}},
        loads=[{"kind": "spring", "points": ["A", "F"], "stiffness": 5, "free_length": 0.1}],
    )
    found = ct.equilibrium(lever)
    assert [stability(found, k) for k in range(2)] == [STABLE, UNSTABLE]
    assert np.allclose(np.cos(found.angle.values[:, 0]), [1, -1], atol=1e-14)
    assert found.sizes["root"] == 0
    with pytest.raises(ct.InputError, match="has no mass"):
        ct.modes(lever)


def test_a_bar_on_its_centre_is_neutral_beside_a_spring() -> None:
    two = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0], "P": [1, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0},
            "PB": {"points": {"P": [0, 0], "B": [1, 0]}, "mass": 1, "inertia": 1, "centre": "P", "angle": 0},
        },
    )
    found = ct.equilibrium(two)
    assert NEUTRAL in {stability(found, k) for k in range(found.sizes["equilibrium"])}


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda: ct.equilibrium("crank-rocker"), "neither masses nor loads"),
        (lambda: ct.equilibrium(five_bar(), hold={"X": 1}), 'no drive "X"'),
        (lambda: ct.equilibrium(five_bar(), hold={"AB": "1 m"}), "hold AB"),
        (lambda: ct.modes(pendulum(), equilibrium=99), "there are 2 equilibria"),
        (lambda: ct.modes(five_bar(), speed={"AB": 0.0}), "it is zero"),
        (lambda: ct.modes(five_bar(), speed={"AB": 1, "ED": 1}), "2 drives have a speed"),
        (lambda: ct.equilibrium(five_bar(), vary={"links.AB.length": (2, 1)}), "the range is empty"),
        (lambda: ct.equilibrium(five_bar(), vary={}), "0 are given"),
        (
            lambda: ct.equilibrium(pendulum(loads=[{"kind": "torque", "link": "OA", "value": "sin(t)"}])),
            "depends on time",
        ),
        (
            lambda: ct.equilibrium(
                ct.Mechanism(
                    frame={"points": {"O": [0, 0]}},
                    links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
                )
            ),
            "every position is an equilibrium",
        ),
    ],
)
def test_what_has_no_equilibrium_says_why(made: object, words: str) -> None:
    with pytest.raises(ct.InputError, match=words):
        made()  # type: ignore[operator]


def test_a_moment_that_nothing_balances_finds_no_equilibrium() -> None:
    with pytest.raises(ct.MotionError, match="no equilibrium is found"):
        ct.equilibrium(pendulum(loads=[{"kind": "torque", "link": "OA", "value": 6.0}]))


def test_static_friction_holds_and_stops_forbid() -> None:
    found = ct.equilibrium(
        pendulum(
            loads=[{"kind": "friction", "link": "OA", "value": 1.0, "static": 2.0}],
            stops=[{"link": "OA", "least": -2.0, "most": 0.0}],
        )
    )
    assert np.allclose(found.angle.values[:, 0], -math.pi / 2, atol=1e-12)
    widths = np.ptp(found.friction_band.values[:, :, 0], axis=1)
    assert np.allclose(widths, 2 * math.asin(2.0 / (9.81 * 0.5)), rtol=1e-12)


def test_a_motor_gives_its_moment_at_rest() -> None:
    rod = pendulum(
        drives=[{"link": "OA", "start": 0}],
        motors=[{"drive": "OA", "kind": "linear", "idle_speed": 100, "starting_moment": 2.0}],
    )
    found = ct.equilibrium(rod)
    # m g l / 2 cos q = M
    assert np.allclose(np.cos(found.angle.values[:, 0]), 2.0 / (9.81 * 0.5), rtol=1e-12)
