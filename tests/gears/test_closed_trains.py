"""Closed trains: ratios, lists, efficiency and flow of power against linear equations of all six members."""

from __future__ import annotations

from contextlib import suppress
from functools import cache
from itertools import combinations, permutations, product

import numpy as np
import pytest

import centrode as ct
from centrode.errors import InputError, MotionError
from centrode.gears.closed_trains import ClosedTrain, polynomial, willis_ratio
from centrode.gears.planetary_trains import SCHEMES, MeshEfficiency, PlanetaryTrain
from centrode.gears.train_search import TrainBounds, find_trains
from centrode.model.gear_trains import GEAR_TRAINS, SET_MEMBERS, ClosedShafts
from centrode.views.closed_train_chapters import ratio_letters

SETS = SCHEMES["single planets"]
LOSSES = MeshEfficiency(0.98, 0.99)
COLUMN = {member: number for number, member in enumerate(SET_MEMBERS)}

HOIST = ClosedShafts(
    joined=[["carrier 1", "sun 2"], ["ring 1", "ring 2"]], input="sun 1", output="ring 1", fixed="carrier 2"
)
SIMPSON = ClosedShafts(
    joined=[["sun 1", "sun 2"], ["carrier 1", "ring 2"]],
    input="ring 1",
    output="carrier 1",
    fixed="carrier 2",
)
CIRCULATES = ClosedShafts(
    joined=[["sun 1", "sun 2"], ["ring 1", "ring 2"]], input="sun 1", output="carrier 1", fixed="carrier 2"
)
IN_SERIES = ClosedShafts(
    joined=[["carrier 1", "sun 2"], ["ring 1", "ring 2"]], input="sun 1", output="carrier 2", fixed="ring 1"
)
CLASSICAL = {"hoist": HOIST, "simpson": SIMPSON, "circulates": CIRCULATES, "series": IN_SERIES}


def _every_closure() -> list[ClosedShafts]:
    """All ways to join two sets by two shafts and to choose what drives, is driven and rests, that bear moments."""
    parts = ("sun", "ring", "carrier")
    found = []
    for one, other in combinations(product(parts, parts), 2):
        if one[0] == other[0] or one[1] == other[1]:
            continue
        joined = [[f"{first} 1", f"{second} 2"] for first, second in (one, other)]
        shafts = [member for member in SET_MEMBERS if member not in (joined[0][1], joined[1][1])]
        for driving, driven, fixed in permutations(shafts, 3):
            with suppress(InputError):  # a free member: its set would idle
                found.append(ClosedShafts(joined=joined, input=driving, output=driven, fixed=fixed))
    return found


def _speeds(shafts: ClosedShafts, first: float, second: float) -> np.ndarray | None:
    """Of all members: both Willis equations, both couplings, what rests, what drives; None where they do not tell."""
    rows, sides = [], [0, 0, 0, 0, 0, 1]
    for number, ratio in ((1, first), (2, second)):
        row = np.zeros(6)
        row[COLUMN[f"sun {number}"]], row[COLUMN[f"ring {number}"]] = 1, ratio
        row[COLUMN[f"carrier {number}"]] = -1 - ratio
        rows.append(row)
    for one, other in shafts.joined:
        rows.append(np.eye(6)[COLUMN[one]] - np.eye(6)[COLUMN[other]])
    rows += [np.eye(6)[COLUMN[shafts.fixed]], np.eye(6)[COLUMN[shafts.input]]]
    matrix = np.array(rows)
    return None if abs(np.linalg.det(matrix)) < 1e-9 else np.linalg.solve(matrix, sides)


def _moments(
    shafts: ClosedShafts, speeds: np.ndarray, loss: float, powers: tuple[int, int]
) -> np.ndarray | None:
    """On all members: balance of each set, power of each mesh against its carrier, balance of the inner shaft."""
    rows, sides = [], [0, 0, 0, 0, 0, 1]
    for number, power in zip((1, 2), powers, strict=True):
        sun, ring, carrier = (COLUMN[f"{part} {number}"] for part in ("sun", "ring", "carrier"))
        row = np.zeros(6)
        row[[sun, ring, carrier]] = 1
        rows.append(row)
        # What the sun gives against the carrier less the loss is what the ring takes, or the other way round.
        row = np.zeros(6)
        row[sun], row[ring] = (
            (speeds[sun] - speeds[carrier]) * loss**power,
            speeds[ring] - speeds[carrier],
        )
        rows.append(row)
    for shaft in (shafts.inner, shafts.shaft(shafts.input)):
        row = np.zeros(6)
        row[[COLUMN[member] for member in shaft]] = 1
        rows.append(row)
    matrix = np.array(rows)
    return None if abs(np.linalg.det(matrix)) < 1e-12 else np.linalg.solve(matrix, sides)


def _efficiencies(shafts: ClosedShafts, speeds: np.ndarray, loss: float) -> list[float]:
    """Of those flows of power through both sets whose meshes lose in the sense in which power flows."""
    found = []
    for powers in product((1, -1), repeat=2):
        moments = _moments(shafts, speeds, loss, powers)
        if moments is None:
            continue
        against = [
            moments[COLUMN[f"sun {k}"]] * (speeds[COLUMN[f"sun {k}"]] - speeds[COLUMN[f"carrier {k}"]])
            for k in (1, 2)
        ]
        if all((power > 0) == (flow > 0) for power, flow in zip(powers, against, strict=True)):
            driven = [COLUMN[member] for member in shafts.shaft(shafts.output)]
            found.append(float(-np.sum(moments[driven] * speeds[driven])))
    return found


def _random_train(shafts: ClosedShafts, generator: np.random.Generator) -> ClosedTrain | None:
    stages = []
    for _number in (1, 2):
        sun, planet = int(generator.integers(17, 60)), int(generator.integers(17, 50))
        stages.append(PlanetaryTrain(SETS, (sun, planet, planet, sun + 2 * planet), 3))
    train = ClosedTrain(shafts, (stages[0], stages[1]))
    formula, ratios = willis_ratio(shafts), train.set_ratios
    stands = 0 in (polynomial(formula.numerator, *ratios), polynomial(formula.denominator, *ratios))
    return None if stands else train


def test_every_closure_has_the_speeds_and_the_efficiency_of_its_equations() -> None:
    """All 216 closures with random teeth: speeds, efficiency and flow of power of two systems of six equations."""
    generator, closures, seen, rounds = np.random.default_rng(33), _every_closure(), 0, 0
    assert len(closures) == 216
    loss = LOSSES.external * LOSSES.internal
    for shafts, _case in product(closures, range(6)):
        train = _random_train(shafts, generator)
        if train is None:
            continue
        first, second = map(float, train.set_ratios)
        speeds = _speeds(shafts, first, second)
        assert speeds is not None
        assert np.allclose([float(train.speeds[member]) for member in SET_MEMBERS], speeds, rtol=1e-9)
        moments = _moments(shafts, speeds, 1.0, (1, 1))
        assert moments is not None
        powers = np.array([one.power for one in train.powers()])
        assert np.allclose(powers, moments * speeds, rtol=1e-8, atol=1e-8 * np.abs(powers).max())
        expected = _efficiencies(shafts, speeds, loss)
        found = train.efficiency(LOSSES)
        # Where a train nearly locks, a second flow of power, which locks, fulfils its equations too.
        assert any(found == pytest.approx(value, rel=1e-7) for value in expected), (shafts, found, expected)
        given = [one.power for one in train.powers(LOSSES) if one.member in shafts.shaft(shafts.output)]
        assert found == pytest.approx(-sum(given), rel=1e-7)
        seen += 1
        rounds += train.circulating_power > 0
    assert seen > 1200
    assert 100 < rounds < seen - 100


def test_power_that_goes_round_comes_on_top_of_what_drives() -> None:
    """A member of the loop carries 1 and what circulates; where power branches none carries more than what drives."""
    generator = np.random.default_rng(7)
    for shafts in _every_closure():
        train = _random_train(shafts, generator)
        if train is None:
            continue
        loop = [member for pair in shafts.joined for member in pair]
        carried = max(abs(one.power) for one in train.powers() if one.member in loop)
        if train.circulating_power > 0:
            assert carried == pytest.approx(1 + train.circulating_power, rel=1e-9)
        else:
            assert carried <= 1 + 1e-12


def test_formulas_of_classical_schemes() -> None:
    """As textbooks have them, and whether power circulates."""
    stages = tuple(PlanetaryTrain(SETS, teeth, 3) for teeth in ((17, 25, 25, 67), (18, 27, 27, 72)))
    p, q = 67 / 17, 72 / 18
    expected = {
        "hoist": (-(p + q + p * q), "-p_1 - p_2 - p_1 p_2", 0.0),
        "simpson": ((1 + p + q) / p, "frac(1 + p_1 + p_2, p_1)", 0.0),
        "circulates": ((1 + p) * q / (q - p), "frac(p_2 + p_1 p_2, p_2 - p_1)", p / (q - p)),
        "series": ((1 + p) * (1 + q), "1 + p_1 + p_2 + p_1 p_2", 0.0),
    }
    for name, (ratio, letters, circulating) in expected.items():
        train = ClosedTrain(CLASSICAL[name], (stages[0], stages[1]))
        assert float(train.ratio) == pytest.approx(ratio, rel=1e-13), name
        assert ratio_letters(train.formula) == letters
        assert train.circulating_power == pytest.approx(circulating, rel=1e-12, abs=1e-14), name


def test_printed_ratio_of_an_automatic_gearbox() -> None:
    """First gear of the THM 440-T4 by its maker's service bulletin: 26, 62 and 42, 74 teeth give 2.92.

    Each ring is one shaft with the other carrier; the front sun drives, the rear one is held.
    """
    shafts = ClosedShafts(
        joined=[["ring 1", "carrier 2"], ["carrier 1", "ring 2"]],
        input="sun 1",
        output="carrier 2",
        fixed="sun 2",
    )
    assert round(willis_ratio(shafts).at(62 / 26, 74 / 42), 2) == 2.92


@cache
def _sets(most: int) -> list[PlanetaryTrain]:
    """All sets of 17 to `most` teeth that can be built with three planets, by looking at every sun and planet."""
    numbers = range(17, most + 1)
    sets = (
        PlanetaryTrain(SETS, (sun, planet, planet, sun + 2 * planet), 3)
        for sun, planet in product(numbers, repeat=2)
        if sun + 2 * planet <= most
    )
    return [one for one in sets if one.can_be_built]


@pytest.mark.parametrize("name", CLASSICAL)
def test_lists_are_those_of_brute_force(name: str) -> None:
    """Ten ratios of each scheme: all pairs of sets whose six equations give it; where there is none, the nearest."""
    shafts, sets = CLASSICAL[name], _sets(78)
    generator = np.random.default_rng(11)
    inner = [-float(one.fixed_carrier_ratio) for one in sets]
    ratios = np.full((len(sets), len(sets)), np.inf)
    for first, second in product(range(len(sets)), repeat=2):
        speeds = _speeds(shafts, inner[first], inner[second])
        if speeds is not None and abs(speeds[COLUMN[shafts.output]]) > 1e-12:
            ratios[first, second] = 1 / speeds[COLUMN[shafts.output]]
    finite = np.abs(ratios[np.isfinite(ratios)])
    listed = 0
    for _case in range(10):
        wanted = float(np.exp(generator.uniform(*np.log(np.quantile(finite, [0.05, 0.95])))))
        tolerance = float(generator.choice([0.0005, 0.01]))
        found = find_trains("closed", TrainBounds(wanted, tolerance, 17, 78, 3), shafts=shafts)
        misses = np.abs(np.abs(ratios) / wanted - 1)
        expected = {
            sets[first].teeth + sets[second].teeth for first, second in np.argwhere(misses <= tolerance)
        }
        if found.more:
            assert len(found.trains) == 1000 < len(expected)
            assert {train.teeth for train in found.trains} <= expected
            sizes = sorted(
                max(sets[one].diameter, sets[other].diameter)
                for one, other in np.argwhere(misses <= tolerance)
            )
            assert [train.diameter for train in found.trains] == sizes[:1000]
        else:
            assert {train.teeth for train in found.trains} == expected
        if not expected:
            assert found.nearest is not None
            assert abs(abs(float(found.nearest.ratio)) / wanted - 1) == pytest.approx(misses.min(), rel=1e-6)
        listed += len(expected)
    assert listed > 20


def test_rings_at_rest_are_two_carriers_in_series() -> None:
    bounds = TrainBounds(25.0, 0.004, 17, 78, 3)
    closed = find_trains("closed", bounds, shafts=IN_SERIES)
    series = find_trains("two carriers", bounds)
    assert [train.teeth for train in closed.trains] == [train.teeth for train in series.trains]
    for one, other in zip(closed.trains, series.trains, strict=True):
        assert one.efficiency(LOSSES) == pytest.approx(other.efficiency(LOSSES), rel=1e-13)


def test_forces_of_the_mechanism_are_those_of_the_flow_of_power() -> None:
    """A moment on the drum: the moment of the motor and the forces of all teeth as `reactions` has them."""
    results = ct.gear_train("closed-planetary-train")
    train = results.chosen
    assert isinstance(train, ClosedTrain)
    text = ct.mechanism_text(ct.train_mechanism(results))
    text += '[[loads]]\nkind = "torque"\nlink = "ring-1"\nvalue = "-100 N m"\n'
    forces = ct.reactions(ct.parse_mechanism(text), samples=3)
    driving = float(forces.balancing[0, 0])
    assert driving == pytest.approx(100 / float(train.ratio), rel=1e-12)
    moments = {one.member: one.moment * driving for one in train.powers()}
    # The teeth hold what acts from outside on each sun and ring.
    for gear, body, member in (
        ("sun-1-planet-1", "first", "sun 1"),
        ("planet-1-ring-1", "second", "ring 1"),
        ("carrier-1-planet-2", "first", "sun 2"),
        ("planet-2-ring-1", "second", "ring 2"),
    ):
        held = forces.gear_moment.sel(gear=gear, gear_body=body)
        assert np.allclose(held, -moments[member], rtol=1e-9), member


@pytest.mark.parametrize(
    ("shafts", "said"),
    [
        ("", "the shafts of a closed train are missing"),
        ('joined = [["carrier 1", "sun 2"]], input = "sun 1", output = "ring 1", fixed = "carrier 2"', "expected"),
        (
            'joined = [["carrier 1", "sun 1"], ["ring 1", "ring 2"]], input = "sun 1", output = "ring 1", '
            'fixed = "carrier 2"',
            "belong to one set",
        ),
        (
            'joined = [["carrier 1", "sun 2"], ["carrier 1", "ring 2"]], input = "sun 1", output = "ring 1", '
            'fixed = "carrier 2"',
            "is joined twice",
        ),
        (
            'joined = [["carrier 1", "sun 2"], ["ring 1", "ring 2"]], input = "sun 1", output = "ring 1", '
            'fixed = "ring 2"',
            "output and fixed name the same shaft",
        ),
        (
            'joined = [["carrier 1", "sun 2"], ["ring 1", "ring 2"]], input = "sun 1", output = "ring 1", '
            'fixed = "carrier 1"',
            "its set bears no moment",
        ),
        (
            'joined = [["carrier 1", "sun 2"], ["ring 1", "ring 2"]], input = "sum 1", output = "ring 1", '
            'fixed = "carrier 2"',
            "sun 1",
        ),
    ],
)  # fmt: skip
def test_bad_shafts_say_where_and_what_helps(shafts: str, said: str) -> None:
    line = f"shafts = {{ {shafts} }}\n" if shafts else ""
    with pytest.raises(InputError) as refusal:
        GEAR_TRAINS.parse(
            f'kind = "gear train"\nmodule = "2 mm"\nscheme = "closed"\nratio = 20\n{line}', "train.toml"
        )
    assert said in str(refusal.value)
    assert "train.toml" in str(refusal.value)


def test_shafts_belong_to_closed_trains_alone() -> None:
    text = GEAR_TRAINS.text(ct.example("closed-planetary-train"))
    with pytest.raises(InputError, match="only a closed train"):
        GEAR_TRAINS.parse(text.replace('"closed"', '"two carriers"'))
    with pytest.raises(InputError, match="driver of this scheme"):
        GEAR_TRAINS.parse('driver = "sun"\n' + text)
    described = ct.GearTrain(
        kind="gear train", scheme="closed", ratio=23.7512345, tolerance=1e-9, module="3 mm", shafts=HOIST
    )
    with pytest.raises(MotionError, match="the nearest is"):
        ct.gear_train(described)
