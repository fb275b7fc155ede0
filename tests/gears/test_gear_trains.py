"""Trains of gears: lists against brute force over all teeth, efficiency against moments, motion against `run`."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.errors import InputError, MotionError
from centrode.gears import train_search
from centrode.gears.planetary_trains import (
    EXTERNAL,
    SCHEMES,
    CarrierSeries,
    MeshEfficiency,
    OrdinaryTrain,
    PlanetaryScheme,
    PlanetaryTrain,
    pair_works,
)
from centrode.gears.train_search import TrainBounds, find_trains
from centrode.model.gear_trains import GEAR_TRAINS

LEAST = 17
MOST = {"single planets": 84, "stepped planets": 56, "external meshes": 42, "internal meshes": 56}
PLANETS = 3
NEAR = 1e-9


@cache
def _buildable(name: str) -> list[tuple[tuple[int, int, int, int], float]]:
    """All trains of a scheme within its bounds with omega_1/omega_H, by looking at every combination of four numbers.

    Axes, planets and phases of teeth are compared as lengths and angles; module 2, so that radii are numbers of teeth.
    """
    scheme = SCHEMES[name]
    teeth = np.arange(LEAST, MOST[name] + 1)
    found = []
    for sun in teeth.tolist():
        grid = np.meshgrid(teeth, teeth, teeth, indexing="ij")
        planet, other, fixed = (part.ravel() for part in grid)
        if not scheme.stepped:
            same = planet == other
            planet, other, fixed = planet[same], other[same], fixed[same]
        arm = sun + planet if scheme.sun == EXTERNAL else sun - planet
        second = fixed + other if scheme.fixed == EXTERNAL else fixed - other
        centres = arm[:, None] * np.exp(2j * np.pi * np.arange(2) / PLANETS)
        apart = np.abs(centres[:, 1] - centres[:, 0])
        kept = (arm == second) & (arm > 0) & (apart > 2 * (np.maximum(planet, other) + 2) + NEAR)
        for numbers in np.stack([planet, other, fixed], axis=-1)[kept].tolist():
            if _teeth_meet(scheme, sun, *numbers):
                speed = _sun_speed(scheme, sun, *numbers)
                if speed is not None:
                    found.append(((sun, *numbers), speed))
    return found


def _teeth_meet(scheme: PlanetaryScheme, sun: int, planet: int, other: int, fixed: int) -> bool:
    """Whether the second planet can be turned so that its teeth fall into gaps of both central wheels at once."""
    place = 1 / PLANETS  # of the second planet, in turns
    # Turned by steps of its second rim's pitch, that rim keeps its mesh with the fixed wheel; the first has to follow.
    steps = np.arange(other)
    own = (-scheme.fixed * fixed * place + steps) / other
    phase = -scheme.sun * planet * own - sun * place
    return bool((np.abs(phase - np.round(phase)) < NEAR).any())


def _sun_speed(scheme: PlanetaryScheme, sun: int, planet: int, other: int, fixed: int) -> float | None:
    """Speed of wheel 1 over that of the carrier, by velocities of the contacts."""
    arm = sun - scheme.sun * planet
    # The planet is at rest at the fixed wheel, which it touches at radius `fixed`.
    rolls = -arm / (fixed - arm)
    at_sun = arm + rolls * (sun - arm)
    return None if abs(at_sun) < NEAR else at_sun / sun


def _works(name: str, teeth: tuple[int, int, int, int]) -> bool:
    return PlanetaryTrain(SCHEMES[name], teeth).meshes_work


@pytest.mark.parametrize("name", SCHEMES)
def test_lists_are_those_of_brute_force(name: str) -> None:
    """25 ratios of each scheme: the same trains, in the order of their size; where there is none, the nearest."""
    generator = np.random.default_rng(33)
    scheme, every = SCHEMES[name], _buildable(name)
    speeds = np.array([speed if scheme.driver == "sun" else 1 / speed for _teeth, speed in every])
    listed = 0
    for _case in range(25):
        wanted = float(np.exp(generator.uniform(*np.log(np.quantile(np.abs(speeds), [0.02, 0.98])))))
        tolerance = float(generator.choice([0.002, 0.02]))
        found = find_trains(name, TrainBounds(wanted, tolerance, LEAST, MOST[name], PLANETS))
        misses = np.abs(np.abs(speeds) / wanted - 1)
        expected = {every[at][0] for at in np.flatnonzero(misses <= tolerance) if _works(name, every[at][0])}
        assert {train.teeth for train in found.trains} == expected
        sizes = [train.diameter for train in found.trains]
        assert sizes == sorted(sizes)
        listed += len(sizes)
        for train in found.trains[:3]:
            assert isinstance(train, PlanetaryTrain)
            assert train.can_be_built
        if not expected:
            order = np.argsort(misses, kind="stable")
            nearest = next(misses[at] for at in order if _works(name, every[at][0]))
            assert found.nearest is not None
            assert abs(abs(float(found.nearest.ratio)) / wanted - 1) == pytest.approx(nearest, rel=1e-9)
    assert listed > 30


@pytest.mark.parametrize("name", SCHEMES)
def test_the_nearest_train_does_not_depend_on_how_many_are_kept(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of one row at a time and of all together: those of equal ratio stay together, those that do not work fall out."""
    bounds = [
        TrainBounds(wanted, 1e-6, LEAST, MOST[name], PLANETS) for wanted in (900.0, -900.0, 1.00001, 3.14159)
    ]
    nearest = []
    for kept in (1, 30, 10**9):
        monkeypatch.setattr(train_search, "NEAREST_KEPT", kept)
        nearest.append([find_trains(name, one).nearest for one in bounds])
    assert nearest[0] == nearest[1] == nearest[2]
    assert all(one is not None for one in nearest[0])


def test_an_unreachable_ratio_is_looked_for_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The ratio z_1 z_2'/((z_2' - z_2)(z_1 + z_2)) is at most half the teeth: rows are made once and few are sorted."""
    counts: Counter[str] = Counter()

    def counted(what: str, function: Callable[..., Any], size: Callable[..., int]) -> Callable[..., Any]:
        def call(*given: Any) -> Any:
            answer = function(*given)
            counts[what] += size(answer)
            return answer

        return call

    monkeypatch.setattr(train_search, "_ratios", counted("looked at", train_search._ratios, len))
    monkeypatch.setattr(train_search, "_diameters", counted("sorted", train_search._diameters, len))
    bounds = TrainBounds(5000.0, 1e-3, 17, 90, PLANETS)
    rows = sum(len(rows) for rows in train_search._coaxial_rows(SCHEMES["external meshes"], bounds))
    found = find_trains("external meshes", bounds)
    assert found.nearest is not None and float(found.nearest.ratio) < 45.5
    assert rows > 100_000
    assert counts["looked at"] == rows
    assert counts["sorted"] <= 4 * train_search.NEAREST_KEPT + rows // 74


def test_two_carriers_are_all_products() -> None:
    bounds = TrainBounds(17.3, 0.004, 17, 75, 3)
    every = [
        train
        for sun, planet in product(range(17, 76), repeat=2)
        if sun + 2 * planet <= 75
        and (
            train := PlanetaryTrain(SCHEMES["single planets"], (sun, planet, planet, sun + 2 * planet), 3)
        ).can_be_built
    ]
    expected = {
        (*first.teeth, *second.teeth)
        for first, second in product(every, repeat=2)
        if abs(float(first.ratio * second.ratio) / 17.3 - 1) <= 0.004
    }
    found = find_trains("two carriers", bounds)
    assert {train.teeth for train in found.trains} == expected
    assert len(expected) > 3
    series = found.trains[0]
    assert isinstance(series, CarrierSeries)
    efficiency = MeshEfficiency()
    assert series.efficiency(efficiency) == pytest.approx(
        math.prod(stage.efficiency(efficiency) for stage in series.stages), rel=1e-14
    )


@pytest.mark.parametrize("wanted", [5.31, -3.1, 9.77])
def test_ordinary_trains_are_all_products(wanted: float) -> None:
    bounds = TrainBounds(wanted, 0.0005, 17, 40)
    scheme = "one pair" if wanted < 0 else "two pairs"
    numbers = range(17, 41)
    if scheme == "one pair":
        expected = {
            teeth for teeth in product(numbers, repeat=2) if abs(teeth[1] / teeth[0] / -wanted - 1) <= 0.0005
        }
    else:
        four = np.array(list(product(numbers, repeat=4)))
        ratios = four[:, 1] * four[:, 3] / (four[:, 0] * four[:, 2])
        expected = set(map(tuple, four[np.abs(ratios / wanted - 1) <= 0.0005].tolist()))
    found = find_trains(scheme, bounds)
    assert {train.teeth for train in found.trains} == expected
    if not expected:
        assert found.nearest is not None


def test_a_list_is_cut_at_its_smallest_trains() -> None:
    """The thousand smallest of many."""
    found = find_trains("two pairs", TrainBounds(2.017, 0.02, 17, 42))
    assert found.more
    assert len(found.trains) == 1000
    numbers = range(17, 43)
    four = np.array(list(product(numbers, repeat=4)), dtype=np.int64)
    ratios = four[:, 1] * four[:, 3] / (four[:, 0] * four[:, 2])
    four = four[np.abs(ratios / 2.017 - 1) <= 0.02]
    lengths = sorted((four.sum(axis=1) / 2 + (four[:, 0] + four[:, 3]) / 2 + 2).tolist())
    assert [train.diameter for train in found.trains] == lengths[:1000]


def _efficiency_by_moments(train: PlanetaryTrain, meshes: MeshEfficiency) -> float:
    """Moments of wheel 1, wheel 3 and carrier with a loss of each mesh, for that flow of power which is possible."""
    ratio = float(train.fixed_carrier_ratio)
    loss = meshes.of_mesh(train.scheme.sun) * meshes.of_mesh(train.scheme.fixed)
    sun_speed, carrier_speed = float(train.sun_ratio), 1.0
    for forwards in (True, False):
        # Against the carrier the power of wheel 1 and that of wheel 3 sum up to what the meshes lose.
        sun = 1.0
        fixed = -ratio * loss if forwards else -ratio / loss
        carrier = -(sun + fixed)
        # Wheel 1 drives against the carrier where its moment works there; the sign of all moments is still free.
        for sign in (1, -1):
            works = sign * sun * (sun_speed - carrier_speed) > 0
            power_of_sun, power_of_carrier = sign * sun * sun_speed, sign * carrier * carrier_speed
            given, taken = (
                (power_of_sun, power_of_carrier)
                if train.driver == "sun"
                else (power_of_carrier, power_of_sun)
            )
            if works == forwards and given > 0 > taken:
                return -taken / given
    return math.nan


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("driver", ["sun", "carrier"])
def test_efficiency_is_that_of_the_moments(name: str, driver: str) -> None:
    generator = np.random.default_rng(5)
    meshes = MeshEfficiency(0.96, 0.985)
    rows, locked = _buildable(name), 0
    for place in generator.integers(0, len(rows), 60):
        train = PlanetaryTrain(SCHEMES[name], rows[place][0], 3, driver)  # type: ignore[arg-type]
        by_moments = _efficiency_by_moments(train, meshes)
        if math.isnan(by_moments):  # a train that locks itself gives nothing away
            assert train.efficiency(meshes) <= 0
            locked += 1
        else:
            assert train.efficiency(meshes) == pytest.approx(by_moments, rel=1e-9, abs=1e-12)
    assert locked < 60


def test_efficiency_of_the_usual_train() -> None:
    """1 - psi z_3/(z_1 + z_3) with a ring (V. N. Kudryavtsev), psi the loss with the carrier at rest."""
    train = PlanetaryTrain(SCHEMES["single planets"], (20, 34, 34, 88), 3)
    loss = 1 - 0.98 * 0.99
    assert train.efficiency(MeshEfficiency()) == pytest.approx(1 - loss * 88 / 108, rel=1e-14)
    assert train.ratio == Fraction(27, 5)


def test_how_many_planets_fit() -> None:
    for teeth in ((20, 34, 34, 88), (60, 17, 17, 94), (17, 60, 60, 137)):
        most = PlanetaryTrain(SCHEMES["single planets"], teeth).most_planets
        fits = [
            count
            for count in range(2, 40)
            if PlanetaryTrain(SCHEMES["single planets"], teeth, count).planets_clear
        ]
        assert most == max(fits, default=1)


TRAINS = {
    "single": 'scheme = "single planets"\nratio = 5.4\n',
    "stepped": 'scheme = "stepped planets"\nratio = 12\ninput_speed = "1000 rpm"\n',
    "external": 'scheme = "external meshes"\nratio = 20\npair_behind = [15, 30]\nteeth = [17, 60]\n',
    "internal": 'scheme = "internal meshes"\nratio = 40\n',
    "backwards": 'scheme = "single planets"\ndriver = "carrier"\nratio = 0.2\n',
    "series": 'scheme = "two carriers"\nratio = 25\npair_behind = [20, 30]\ntolerance = 0.005\n',
    "hoist": 'scheme = "closed"\nratio = 24\nshafts = { joined = [["carrier 1", "sun 2"], ["ring 1", "ring 2"]], '
    'input = "sun 1", output = "ring 1", fixed = "carrier 2" }\n',
    "gearbox": 'scheme = "closed"\nratio = 2.92\npair_behind = [20, 30]\nshafts = { joined = [["ring 1", "carrier 2"], '
    '["carrier 1", "ring 2"]], input = "sun 1", output = "carrier 2", fixed = "sun 2" }\n',
    "circulating": 'scheme = "closed"\nratio = 30\nshafts = { joined = [["sun 1", "sun 2"], '
    '["carrier 1", "carrier 2"]], input = "sun 1", output = "ring 1", fixed = "ring 2" }\n',
    "pair": 'scheme = "one pair"\nratio = 3\n',
    "pairs": 'scheme = "two pairs"\nratio = 9\noutput_speed = "60 rpm"\npair_behind = [15, 30]\n',
}


def _link_of(member: str, scheme: str) -> str:
    """The link of the mechanism that a member of the plan is: shafts of an ordinary train carry two wheels."""
    if scheme == "closed":
        return member.replace(" ", "-")
    kind, _space, number = member.partition(" ")
    if kind == "wheel" and scheme in ("one pair", "two pairs"):
        return f"shaft-{int(number) // 2 + 1}"
    if member == "wheel 2":
        return "carrier-1"  # the sun of the second train is the carrier of the first
    return member.replace(" ", "-")


@pytest.mark.parametrize("name", TRAINS)
def test_the_mechanism_of_a_train_moves_as_its_plan_says(name: str) -> None:
    """Angular velocities of `run` against those of the plan; contacts and axes have the velocities of the triangles."""
    described = GEAR_TRAINS.parse(f'kind = "gear train"\nmodule = "2 mm"\n{TRAINS[name]}')
    assert GEAR_TRAINS.parse(GEAR_TRAINS.text(described)) == described
    results = ct.gear_train(described)
    mechanism = ct.train_mechanism(results)
    motion = ct.motion(mechanism, samples=5)
    driver = mechanism.drives[0].link
    assert len(results.motions) > 1
    for member in results.motions:
        link = _link_of(member.members[0], described.scheme)
        speeds = motion.angular_velocity.sel(link=link) / motion.angular_velocity.sel(link=driver)
        assert np.allclose(speeds, member.speed / results.input_speed, rtol=1e-12, atol=1e-13), link
        slopes = np.diff(member.velocities) / np.diff(member.places)
        assert np.allclose(slopes, member.speed, rtol=1e-9)
    first, last = motion.angular_velocity.sel(link=driver), results.output_speed / results.input_speed
    ends = {"crank", "carrier-2", "carrier-1", "wheel-1", "shaft-2", "shaft-3", "ring-1"} & set(
        map(str, motion.link.to_numpy())
    )
    assert any(np.allclose(motion.angular_velocity.sel(link=link) / first, last, rtol=1e-12) for link in ends)


def test_contacts_have_one_velocity() -> None:
    """Wheels that touch have the same velocity at the contact, the planet none at the fixed wheel."""
    results = ct.gear_train("stepped-planet-train")
    sun, planet, carrier = results.motions
    assert sun.velocities[1] == pytest.approx(planet.velocities[1], rel=1e-12)
    assert planet.velocities[0] == pytest.approx(carrier.velocities[1], rel=1e-12)
    assert abs(planet.velocities[2]) < 1e-12


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ('scheme = "single planet"\nratio = 5', "single planets"),
        ('scheme = "single planets"', "the ratio is missing"),
        ('scheme = "single planets"\nratio = 0', "must not be zero"),
        ('scheme = "single planets"\nratio = 5\ninput_speed = 3\noutput_speed = 1', "one of them follows"),
        ('scheme = "single planets"\ninput_speed = 3\noutput_speed = 0', "at rest"),
        ('scheme = "single planets"\nratio = 5\nteeth = [30, 20]', "exceeds"),
        ('scheme = "single planets"\nratio = 5\nteeth = [5, 20]', "whole number from 10"),
        ('scheme = "single planets"\nratio = 5\nplanets = 0', "planets"),
        ('scheme = "one pair"\nratio = 5\ndriver = "sun"', "driver of this scheme"),
        ('scheme = "single planets"\nratio = -5\npair_behind = [15, 30]', "without a sign"),
        ('scheme = "single planets"\nratio = 5\nmesh_efficiency = { external = 1.2 }', "between 0.5 and 1"),
    ],
)
def test_bad_descriptions_say_where_and_what_helps(keys: str, said: str) -> None:
    with pytest.raises(InputError) as refusal:
        GEAR_TRAINS.parse(f'kind = "gear train"\nmodule = "2 mm"\n{keys}', "train.toml")
    assert said in str(refusal.value)
    assert "train.toml" in str(refusal.value)


def test_a_ratio_that_no_train_has_names_the_nearest() -> None:
    described = GEAR_TRAINS.parse(
        'kind = "gear train"\nmodule = "2 mm"\nscheme = "single planets"\nratio = 20\n'
    )
    with pytest.raises(MotionError) as refusal:
        ct.gear_train(described)
    assert "the nearest is" in str(refusal.value)
    with pytest.raises(InputError, match="there are"):
        ct.gear_train(
            GEAR_TRAINS.parse(GEAR_TRAINS.text(described).replace("20.0", "5.4") + "chosen = 999\n")
        )


@pytest.mark.parametrize("name", ct.example_names("gear train"))
def test_built_in_trains(name: str) -> None:
    described = ct.example(name)
    assert GEAR_TRAINS.parse(GEAR_TRAINS.text(described)) == described
    results = ct.gear_train(name)
    assert "nan" not in ct.summary(results)
    assert 0 < results.efficiency(results.chosen) < 1


def test_unshifted_pairs_of_few_teeth_do_not_work_in_rings() -> None:
    assert pair_works("external", 17, 40)
    assert not pair_works("internal", 20, 24)
    assert pair_works("internal", 20, 60)
    assert not pair_works("internal", 60, 60)


def test_speeds_and_lengths_of_ordinary_trains() -> None:
    train = OrdinaryTrain(((20, 40), (18, 54)))
    assert train.ratio == 6
    assert train.diameter == (20 + 40 + 18 + 54) / 2 + (20 + 54) / 2 + 2
    assert train.efficiency(MeshEfficiency(0.97)) == pytest.approx(0.97**2)
