"""Trains of a ratio: all tooth numbers within bounds, by size; the nearest ratio where none has it.

Every combination of tooth numbers that coaxial axes leave is looked at, so nothing within the bounds is missed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from centrode.gears.closed_trains import ClosedTrain, willis_ratio
from centrode.gears.planetary_trains import (
    INTERNAL,
    ROOT,
    SCHEMES,
    TIP,
    CarrierSeries,
    Driver,
    OrdinaryTrain,
    PlanetaryScheme,
    PlanetaryTrain,
)
from centrode.model.gear_trains import ClosedShafts

AnyTrain: TypeAlias = PlanetaryTrain | CarrierSeries | ClosedTrain | OrdinaryTrain
"""Every kind of train that is listed."""
Whole = NDArray[np.int64]
Train = TypeVar("Train", bound=AnyTrain)

MOST_TRAINS = 1000
"""So many trains are listed at most, the smallest ones."""

NEAREST_KEPT = 1000
"""Tooth numbers of nearest ratio among which a train that works is sought first."""


@dataclass(frozen=True)
class TrainBounds:
    """What is sought.

    Attributes
    ----------
    ratio : speed of what drives over that of what is driven; a positive one is met in either sense of rotation, a
        negative one in the opposite sense only
    tolerance : of the ratio, relative
    least, most : numbers of teeth
    planets : number of them
    """

    ratio: float
    tolerance: float
    least: int
    most: int
    planets: int = 1

    def misses(self, ratios: NDArray[np.float64]) -> NDArray[np.float64]:
        """By how much ratios miss that which is sought, relative."""
        met = ratios if self.ratio < 0 else np.abs(ratios)
        return np.asarray(np.abs(met / self.ratio - 1))


@dataclass(frozen=True)
class FoundTrains:
    """Trains within the bounds, the smallest first; where there is none, the nearest one alone.

    Attributes
    ----------
    trains : those within the tolerance
    nearest : the one with the nearest ratio where there is none within; None where no teeth fit at all
    more : whether there are more than are listed
    """

    trains: tuple[AnyTrain, ...]
    nearest: AnyTrain | None = None
    more: bool = False


def find_trains(
    scheme: str, bounds: TrainBounds, driver: Driver | None = None, shafts: ClosedShafts | None = None
) -> FoundTrains:
    """All trains of a scheme within bounds, ranked by size.

    Parameters
    ----------
    scheme : a planetary one, "two carriers" (two of single planets in series), "closed", "one pair" or "two pairs"
    bounds : TrainBounds
    driver : of a planetary scheme; the usual one by default
    shafts : of a closed train
    """
    if shafts is not None:
        return _closed_trains(shafts, bounds)
    if scheme in SCHEMES:
        planetary = SCHEMES[scheme]
        return _planetary_trains(planetary, bounds, driver or planetary.driver)
    if scheme == "two carriers":
        return _carrier_series(bounds, driver or "sun")
    return _ordinary_trains(bounds, 1 if scheme == "one pair" else 2)


def rank_by_size(trains: list[Train]) -> list[Train]:
    """Trains by size; those of one size by their tooth numbers."""
    return sorted(trains, key=lambda train: (train.diameter, train.teeth))


def _planetary_trains(scheme: PlanetaryScheme, bounds: TrainBounds, driver: Driver) -> FoundTrains:
    within: list[Whole] = [np.empty((0, 4), np.int64)]
    nearest = _NearestRows(NEAREST_KEPT)
    for rows, misses in _rows_with_misses(scheme, bounds, driver):
        within.append(rows[misses <= bounds.tolerance])
        nearest.add(rows, misses)
    rows = np.concatenate(within)
    order = np.lexsort((*rows.T[::-1], _diameters(scheme, rows)))
    working = _working_trains(scheme, rows[order], bounds.planets, driver)
    found = list(islice(working, MOST_TRAINS + 1))
    if found:
        return FoundTrains(tuple(found[:MOST_TRAINS]), more=len(found) > MOST_TRAINS)
    while True:
        rows, misses = nearest.kept
        order = np.lexsort((*rows.T[::-1], _diameters(scheme, rows), misses))
        train = next(_working_trains(scheme, rows[order], bounds.planets, driver), None)
        if train is not None or not nearest.dropped:
            return FoundTrains((), train)
        # the meshes of none of them work: many more are looked at
        nearest = _NearestRows(20 * nearest.least)
        for rows, misses in _rows_with_misses(scheme, bounds, driver):
            nearest.add(rows, misses)


def _rows_with_misses(
    scheme: PlanetaryScheme, bounds: TrainBounds, driver: Driver
) -> Iterator[tuple[Whole, NDArray[np.float64]]]:
    """The rows of each sun, and by how much their ratios miss that which is sought."""
    for rows in _coaxial_rows(scheme, bounds):
        yield rows, bounds.misses(_ratios(scheme, rows, driver))


@dataclass
class _NearestRows:
    """The rows of nearest ratio, at least so many: to sort all the millions that are coaxial takes most of a minute."""

    least: int
    dropped: bool = False
    _rows: list[Whole] = field(default_factory=lambda: [np.empty((0, 4), np.int64)])
    _misses: list[NDArray[np.float64]] = field(default_factory=lambda: [np.empty(0)])
    _worst: float = math.inf
    _count: int = 0
    _room: int = 0

    def add(self, rows: Whole, misses: NDArray[np.float64]) -> None:
        """Rows that may be among the nearest; all those of one miss stay together."""
        near = misses <= self._worst
        self.dropped = self.dropped or not near.all()
        self._rows.append(rows[near])
        self._misses.append(misses[near])
        self._count += int(near.sum())
        if self._count > max(self._room, 4 * self.least):
            self._drop()

    def _drop(self) -> None:
        rows, misses = self.kept
        self._worst = float(np.partition(misses, self.least - 1)[self.least - 1])
        near = misses <= self._worst
        self.dropped = self.dropped or not near.all()
        self._rows, self._misses = [rows[near]], [misses[near]]
        # of one miss there may be more than any bound
        self._count, self._room = int(near.sum()), 4 * int(near.sum())

    @property
    def kept(self) -> tuple[Whole, NDArray[np.float64]]:
        """Rows and their misses, in the order in which they came."""
        return np.concatenate(self._rows), np.concatenate(self._misses)


def _working_trains(
    scheme: PlanetaryScheme, rows: Whole, planets: int, driver: Driver
) -> Iterator[PlanetaryTrain]:
    """The trains of rows whose meshes work, in the order of the rows."""
    for sun, planet, other, fixed in map(tuple, rows.tolist()):
        train = PlanetaryTrain(scheme, (sun, planet, other, fixed), planets, driver)
        if train.meshes_work:
            yield train


def _coaxial_rows(scheme: PlanetaryScheme, bounds: TrainBounds) -> Iterator[Whole]:
    """Rows z_1, z_2, z_2', z_3, for each sun, that are coaxial, clear and assemble; interference is not looked at."""
    teeth = np.arange(bounds.least, bounds.most + 1)
    planet, other = (np.ravel(part) for part in np.meshgrid(teeth, teeth, indexing="ij"))
    if not scheme.stepped:
        planet = other = teeth
    step = np.gcd(planet, other)
    greatest = np.maximum(planet, other)
    sign = scheme.sun * scheme.fixed
    sine = np.sin(np.pi / bounds.planets)
    for sun in teeth.tolist():
        arm = sun - scheme.sun * planet
        fixed = arm + scheme.fixed * other
        kept = (arm > 0) & (fixed >= bounds.least) & (fixed <= bounds.most)
        if bounds.planets > 1:
            kept &= arm * sine > greatest + TIP
        phase = sign * sun * other - planet * fixed
        kept &= (phase != 0) & (phase % (bounds.planets * step) == 0)
        yield np.stack([np.full(kept.sum(), sun), planet[kept], other[kept], fixed[kept]], axis=-1)


def _ratios(scheme: PlanetaryScheme, rows: Whole, driver: Driver) -> NDArray[np.float64]:
    sun, planet, other, fixed = rows.T
    # u_1H = (z_1 z_2' - s z_2 z_3)/(z_1 z_2'), the whole numbers first: near one digits would be lost.
    ratio = (sun * other - scheme.sun * scheme.fixed * planet * fixed) / (sun * other)
    return np.asarray(ratio if driver == "sun" else 1 / ratio)


def _diameters(scheme: PlanetaryScheme, rows: Whole) -> NDArray[np.float64]:
    """`PlanetaryTrain.diameter` of many."""
    sun, planet, other, fixed = rows.T
    reach = [sun - scheme.sun * planet + np.maximum(planet, other) + TIP]
    for sign, teeth in ((scheme.sun, sun), (scheme.fixed, fixed)):
        reach.append(teeth + (ROOT if sign == INTERNAL else TIP))
    return np.asarray(np.max(reach, axis=0), dtype=np.float64)


# Two parts that each have many tooth numbers: two carriers, two pairs, closed trains


@dataclass
class _SmallestPairs:
    """Pairs of places (first, second) with their sizes; only those that may be among the smallest are kept."""

    found: list[tuple[float, int, int]] = field(default_factory=list)
    worst: float = math.inf
    more: bool = False

    def add(self, first: int, second: Whole, sizes: NDArray[np.float64]) -> None:
        """Pairs of one place with many."""
        kept = sizes <= self.worst
        self.found += zip(sizes[kept].tolist(), [first] * int(kept.sum()), second[kept].tolist(), strict=True)
        if len(self.found) > 40 * MOST_TRAINS:
            # Only sizes up to that of the last one listed can still come in.
            self.found.sort()
            self.worst = self.found[MOST_TRAINS][0]
            self.found = [one for one in self.found if one[0] <= self.worst]
            self.more = True

    @property
    def pairs(self) -> list[tuple[int, int]]:
        """The pairs, the smallest first."""
        return [(first, second) for _size, first, second in sorted(self.found)]


def _products(
    ratios: NDArray[np.float64], sizes: Callable[[int, Whole], NDArray[np.float64]], bounds: TrainBounds
) -> tuple[list[tuple[int, int]], tuple[int, int] | None, bool]:
    """Pairs of places whose ratios have the product that is sought, the smallest first; else the nearest pair.

    A pair of places counts in both orders. `sizes` gives the size of one with many.
    """
    order = np.argsort(ratios, kind="stable")
    rising = ratios[order]
    wanted = abs(bounds.ratio)
    found = _SmallestPairs()
    nearest: tuple[float, int, int] | None = None
    for first, ratio in enumerate(ratios.tolist()):
        # A little wider than the tolerance: what lies on its edge is decided by `misses` itself.
        low, high = (wanted * (1 + side * bounds.tolerance * (1 + 1e-9)) / ratio for side in (-1, 1))
        begin, end = np.searchsorted(rising, low, "left"), np.searchsorted(rising, high, "right")
        second = order[begin:end]
        second = second[bounds.misses(np.sign(bounds.ratio) * ratio * ratios[second]) <= bounds.tolerance]
        if len(second):
            found.add(first, second, sizes(first, second))
        elif not found.found:
            for place in {max(int(begin) - 1, 0), min(int(end), len(order) - 1)}:
                miss = float(bounds.misses(np.array([np.sign(bounds.ratio) * ratio * rising[place]]))[0])
                if nearest is None or miss < nearest[0]:
                    nearest = (miss, first, int(order[place]))
    return found.pairs, None if nearest is None else nearest[1:], found.more


def _planetary_sets(bounds: TrainBounds, driver: Driver = "sun") -> list[PlanetaryTrain]:
    """All sets of sun, planets with one rim and ring that can be built."""
    scheme = SCHEMES["single planets"]
    rows = np.concatenate([*_coaxial_rows(scheme, bounds)])
    return list(_working_trains(scheme, rows, bounds.planets, driver))


def _closed_trains(shafts: ClosedShafts, bounds: TrainBounds) -> FoundTrains:
    sets = _planetary_sets(bounds)
    if not sets:
        return FoundTrains(())
    formula = willis_ratio(shafts)
    inner = np.array([float(-one.fixed_carrier_ratio) for one in sets])
    diameters = np.array([one.diameter for one in sets])
    found = _SmallestPairs()
    nearest = (math.inf, 0, 0)
    for first, ratio in enumerate(inner.tolist()):
        with np.errstate(divide="ignore", invalid="ignore"):
            misses = bounds.misses(formula.at(np.full_like(inner, ratio), inner))
        second = np.flatnonzero(misses <= bounds.tolerance)
        if len(second):
            found.add(first, second, np.maximum(diameters[first], diameters[second]))
        elif not found.found and np.isfinite(misses).any():
            place = int(np.nanargmin(misses))
            nearest = min(nearest, (float(misses[place]), first, place))

    def train_of(places: tuple[int, int]) -> ClosedTrain:
        return ClosedTrain(shafts, (sets[places[0]], sets[places[1]]))

    near = train_of(nearest[1:]) if math.isfinite(nearest[0]) else None
    return _list_of([train_of(pair) for pair in found.pairs], near, found.more)


def _carrier_series(bounds: TrainBounds, driver: Driver) -> FoundTrains:
    stages = _planetary_sets(bounds, driver)
    if not stages or bounds.ratio < 0:
        return FoundTrains(())
    ratios = np.array([float(stage.ratio) for stage in stages])
    diameters = np.array([stage.diameter for stage in stages])
    pairs, nearest, more = _products(
        ratios, lambda first, second: np.maximum(diameters[first], diameters[second]), bounds
    )

    def train_of(places: tuple[int, int]) -> CarrierSeries:
        return CarrierSeries((stages[places[0]], stages[places[1]]))

    return _list_of([train_of(pair) for pair in pairs], None if nearest is None else train_of(nearest), more)


def _list_of(trains: list[Train], nearest: Train | None, more: bool) -> FoundTrains:
    listed = rank_by_size(trains)
    more = more or len(listed) > MOST_TRAINS
    return FoundTrains(tuple(listed[:MOST_TRAINS]), None if listed else nearest, more)


def _ordinary_trains(bounds: TrainBounds, pairs: int) -> FoundTrains:
    teeth = np.arange(bounds.least, bounds.most + 1)
    driving, driven = (np.ravel(part) for part in np.meshgrid(teeth, teeth, indexing="ij"))
    sense = (-1) ** pairs
    # External pairs turn the sense round once each: a negative ratio needs an odd number of them.
    if bounds.ratio < 0 < sense:
        return FoundTrains(())
    ratios = driven / driving
    if pairs == 1:
        misses = bounds.misses(sense * ratios)
        trains = [
            OrdinaryTrain(((int(driving[at]), int(driven[at])),))
            for at in np.flatnonzero(misses <= bounds.tolerance)
        ]
        at = int(np.argmin(misses))
        return _list_of(trains, OrdinaryTrain(((int(driving[at]), int(driven[at])),)), more=False)

    def sizes(first: int, second: Whole) -> NDArray[np.float64]:
        axes = driving[first] + driven[first] + driving[second] + driven[second]
        return np.asarray((axes + driving[first] + driven[second]) / 2 + TIP)

    places, nearest, more = _products(ratios, sizes, bounds)

    def train_of(pair: tuple[int, int]) -> OrdinaryTrain:
        first, second = ((int(driving[at]), int(driven[at])) for at in pair)
        return OrdinaryTrain((first, second))

    return _list_of([train_of(pair) for pair in places], None if nearest is None else train_of(nearest), more)
