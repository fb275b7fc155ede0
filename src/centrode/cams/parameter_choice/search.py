"""The best design within bounds, or how near the bounds the nearest one comes."""

from __future__ import annotations

import functools
import importlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from centrode.cams.contact_stress import ContactMaterial, LineContact
from centrode.cams.curvature_laws import derivatives
from centrode.cams.parameter_choice.problem import (
    ALWAYS,
    MEASURES,
    BatchPaths,
    ChoiceProblem,
    Family,
    Mesh,
    PathMeasure,
    PathTrial,
)
from centrode.cams.path_series import law_of, path_of
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam import CONSTANT, MEASURED, OF_WHEELS, POINT, Cam, vary_cam
from centrode.model.cam_files import AnyCam, require_curvature_cam
from centrode.model.examples.catalogue import CamSource, cam_of
from centrode.model.reading import FrozenMap
from centrode.printed_results import PrintsSummary

# The search for the best design: sequential quadratic programming from several starts, then more angles.
#
# The greatest value of a measure over the angles has kinks where it passes from one angle to another. So it
# becomes a variable t that every angle's value stays below (its epigraph), and the values at the angles are
# smooth. Between the angles looked at the worst ones are found, added, and the search goes on (exchange,
# after Remez), until nothing between them is worse.

# slower to import than NumPy
_optimize = functools.partial(importlib.import_module, "scipy.optimize")
_qmc = functools.partial(importlib.import_module, "scipy.stats.qmc")

Array = NDArray[np.float64]

STARTS = 8
EXCHANGES = 6
ROUNDS = 40
TOLERANCE = 1e-12
KEPT = 1e-9
"""A bound is tightened by this part, so that rounding does not break it."""
ACTIVE = 1e-6
"""A constraint binds where less than this part of its bound is left."""
# Least size of a cam, and least stress of one, within bounds of what else is measured: 1, 2, 4, 8 and 16 starts end in
# the same value to 6e-13 of it. So do, for the size, 1 to 12 exchanges, 20 and 80 rounds, half and double of ACTIVE;
# TOLERANCE at 1e-10 and 1e-14 to 1e-11 and 2e-13. Several starts are a reserve, for bounds whose designs lie in parts
# that do not hang together.


@dataclass(frozen=True)
class SearchResult:
    """The end of a search: places in the box, worst excess over a bound, value made best (scaled, small is good)."""

    share: Array
    excess: float
    value: float

    def better_than(self, other: SearchResult) -> bool:
        """Admissible ones before others; among these the better value, among others the lesser excess."""
        # whether bounds are kept comes before any value
        if (self.excess <= KEPT) != (other.excess <= KEPT):
            return self.excess <= KEPT
        return self.value < other.value if self.excess <= KEPT else self.excess < other.excess


def search(
    problem: ChoiceProblem, first: Array, starts: int = STARTS, warm: Sequence[Array] = ()
) -> list[SearchResult]:
    """Ends of searches from `first` (n,), `warm` ones and further places spread over the box, the best in front."""
    # Halton's points fill the box evenly for any number of them; the first is a corner
    spread = _qmc().Halton(len(first), scramble=False).random(starts) if starts else np.empty((0, len(first)))
    results: list[SearchResult] = []
    for start in [first, *warm, *spread[1:]]:
        # first into the bounds: a run that makes the value best needs a place from which that can be done
        inner = _run_search(problem, np.asarray(start, float), elastic=True)
        ends = [inner]
        # nearly admissible is enough: the second run keeps the bounds by itself
        if _worst(problem, inner) <= ACTIVE:
            ends.append(_run_search(problem, inner, elastic=False))
        results += [_judge(problem, end) for end in ends]
    ranked = _rank(results)
    # only the best end is worth the search with more angles
    return _rank([_exchange_angles(problem, ranked[0]), *ranked])


def kkt_residual(problem: ChoiceProblem, share: Array) -> tuple[float, dict[str, float]]:
    """Residual of the conditions of Karush, Kuhn and Tucker, and the multipliers of the bounds that bind.

    A best design has a slope that is a sum, with weights that are not negative, of slopes of the constraints that
    bind and of the sides of the box (Karush, Kuhn and Tucker). The residual is a part of the slope's own size; the
    multiplier of a bound tells by which part the value changes when the bound is moved by a part of itself.
    """
    values, slopes = problem.measure(share)
    count = len(share)
    columns, names = [], []
    top = values[problem.best].max()
    # the values that stand at the top share the slope of their maximum
    for row in np.flatnonzero(values[problem.best] >= top - ACTIVE * max(abs(top), 1.0)):
        columns.append(np.concatenate([slopes[problem.best][row], [-1.0]]))
        names.append("")
    for name, (measure, bound) in problem.limits.items():
        # what is left of a bound, in its scale
        room = measure.sign * bound / problem.scale(name) - values[name]
        for row in np.flatnonzero(room <= ACTIVE):
            columns.append(np.concatenate([slopes[name][row], [0.0]]))
            names.append(name)
    # a parameter at an end of its range is held by that end
    for index in range(count):
        for side, near in ((-1.0, share[index] <= ACTIVE), (1.0, share[index] >= 1 - ACTIVE)):
            if near:
                columns.append(side * np.eye(count + 1)[index])
                names.append("box")
    # the slope of the variable t is 1: weights of the constraints have to take it up
    goal = np.zeros(count + 1)
    goal[-1] = -1.0
    weights, miss = _optimize().nnls(np.stack(columns, axis=1), goal)
    held = {name: 0.0 for name in problem.limits}
    for name, weight in zip(names, weights, strict=True):
        if name in held:
            held[name] += float(weight)
    # a value that hardly depends on the parameters has a small slope: then the miss itself counts
    own = max(float(np.linalg.norm(slopes[problem.best], axis=1).max()), np.finfo(float).tiny)
    # multipliers as parts: by which part the value changes with a part of the bound
    return float(miss) / max(own, 1.0), {
        name: float(weight / max(abs(top), ACTIVE)) for name, weight in held.items()
    }


def _run_search(problem: ChoiceProblem, start: Array, elastic: bool) -> Array:
    """End (n,) of one run from a start (n,): of the value made best, or (`elastic`) of the excess over the bounds."""
    count = len(start)
    values, _slopes = problem.measure(start)
    limits = _targets(problem)
    if elastic:
        # the worst excess at the start, as the variable that is made least
        top = max(float((values[name] - limit).max()) for name, limit in limits.items())
    else:
        top = float(values[problem.best].max())

    def room(z: Array) -> Array:
        values, _slopes = problem.measure(z[:count])
        kept = [limit - values[name] + (z[-1] if elastic else 0.0) for name, limit in limits.items()]
        return np.concatenate(kept if elastic else [z[-1] - values[problem.best], *kept])

    def room_slope(z: Array) -> Array:
        _values, slopes = problem.measure(z[:count])
        kept = [_with(-slopes[name], 1.0 if elastic else 0.0) for name in limits]
        return np.concatenate(kept if elastic else [_with(-slopes[problem.best], 1.0), *kept])

    result = _optimize().minimize(
        lambda z: float(z[-1]),
        np.append(start, top),
        jac=lambda z: np.append(np.zeros(count), 1.0),
        method="SLSQP",
        # a little below zero: bounds that are kept with room to spare need no more of it
        bounds=[(0.0, 1.0)] * count + [(-0.02 if elastic else None, None)],
        constraints={"type": "ineq", "fun": room, "jac": room_slope},
        options={"ftol": TOLERANCE, "maxiter": ROUNDS},
    )
    # the programme's own tolerance may leave the box
    end = np.clip(result.x[:count], 0.0, 1.0)
    return np.asarray(end if np.isfinite(end).all() else start)


def _targets(problem: ChoiceProblem) -> dict[str, float]:
    """Scaled bounds with their signs, tighter by what rounding may take."""
    return {
        name: measure.sign * bound / problem.scale(name) - 0.5 * KEPT
        for name, (measure, bound) in problem.limits.items()
    }


def _with(slopes: Array, last: float) -> Array:
    return np.concatenate([slopes, np.full((len(slopes), 1), last)], axis=1)


def _worst(problem: ChoiceProblem, share: Array) -> float:
    return max(problem.excess(share).values())


def _judge(problem: ChoiceProblem, share: Array) -> SearchResult:
    best = problem.extremes(share)[problem.best][0]
    sign = problem._measures[problem.best].sign
    return SearchResult(share, _worst(problem, share), sign * best / problem.scale(problem.best))


def _rank(found: Sequence[SearchResult]) -> list[SearchResult]:
    best = found[0]
    for result in found[1:]:
        best = result if result.better_than(best) else best
    return [best, *(result for result in found if result is not best)]


def _exchange_angles(problem: ChoiceProblem, found: SearchResult) -> SearchResult:
    """The search goes on with the worst angles between those looked at, until none is worse."""
    best = replace(found, excess=np.inf)
    share = found.share
    admissible = found.excess <= 1e-3
    for _round in range(EXCHANGES):
        places = [at for _value, at in problem.extremes(share).values()]
        # a sixteen-hundredth of the range: neighbours of the worst angle, as it moves with the parameters
        step = abs(problem.family.mesh.ends[1] - problem.family.mesh.ends[0]) / 1600
        first, last = problem.family.mesh.ends
        near = [at + shift * step for at in places for shift in (-1, 0, 1)]
        problem.more = sorted({*problem.more, *(at for at in near if first <= at <= last)})
        share = _run_search(problem, share, elastic=not admissible)
        now = _judge(problem, share)
        settled = abs(now.value - best.value) <= 1e-12 and now.excess <= KEPT
        # the first round always counts: with more angles values are worse, and truer
        best = now if now.better_than(best) or np.isinf(best.excess) else best
        if settled:
            break
    return best


SAME = 1e-5
"""Two searches agree where what is made best differs by less than this part."""


@dataclass(frozen=True)
class JudgedDesign:
    """A measure of a design: its worst value in SI, the angle [rad] where it is, its bound if it has one."""

    value: float
    angle: float
    bound: float | None = None

    def relative_miss(self, measure: PathMeasure) -> float:
        """By which part of the bound it is missed; 0 where it is kept."""
        if self.bound is None:
            return 0.0
        by = measure.sign * (self.value - self.bound) / (abs(self.bound) or 1.0)
        return by if by > KEPT else 0.0


@dataclass(frozen=True)
class CamDesign:
    """Parameters in SI by their names, with the measures they lead to."""

    parameters: Mapping[str, float]
    measures: Mapping[str, JudgedDesign]

    @property
    def misses(self) -> dict[str, float]:
        """The bounds that are not kept, each with the part of it that is missed."""
        misses = {name: judged.relative_miss(MEASURES[name]) for name, judged in self.measures.items()}
        return {name: by for name, by in misses.items() if by > 0}


@dataclass(frozen=True)
class ParameterChoice:
    """Design that a search chose.

    Attributes
    ----------
    best : str
        The measure made best.
    chosen : CamDesign
        The best within the bounds; where there is none, the one whose worst miss is least.
    start : CamDesign
        What the description gives.
    admissible : bool
        Whether the chosen design keeps all bounds.
    binding : mapping of name -> float
        Bounds that bind: by which part the best value changes when the bound is moved by a part of itself.
    at_ends : tuple of str
        Parameters that stand at an end of their range.
    residual : float
        What is left of the slope of the best value after the bounds that bind have held it (0 at an optimum), as a
        part of it; NaN where no design is admissible.
    searches, agreeing : int
        Searches made, and how many of them ended at the same best value.
    """

    best: str
    chosen: CamDesign
    start: CamDesign
    admissible: bool
    binding: Mapping[str, float]
    at_ends: tuple[str, ...]
    residual: float
    searches: int
    agreeing: int


def choose(
    family: Family,
    start: Array,
    best: str,
    bounds: Mapping[str, float],
    starts: int = STARTS,
    warm: Sequence[Array] = (),
) -> ParameterChoice:
    """Choose the parameters of a family of designs.

    Parameters
    ----------
    family : Family
    start : (n,)
        Parameters in SI to start from, besides others spread over the box.
    best : str
        The measure to be made best: least, or greatest for lift and gap.
    bounds : mapping of name -> float
        Greatest values in SI (least ones for lift and gap) of measures.
    starts : int
        Starts spread over the box.
    warm : sequence of (n,)
        Further starts in SI.

    Notes
    -----
    Bounds are kept to 1e-9 of themselves. A search of this kind finds local optima; that `agreeing` of the searches
    ended at the same one speaks for it, and proves nothing.
    """
    _check(family, best, bounds)
    problem = ChoiceProblem(family, best, bounds)
    results = search(problem, family.share(start), starts, [family.share(cam_near) for cam_near in warm])
    first = results[0]
    admissible = first.excess <= KEPT
    residual, held = kkt_residual(problem, first.share) if admissible else (float("nan"), {})
    ends = [
        name for name, place in zip(family.names, first.share, strict=True) if min(place, 1 - place) <= ACTIVE
    ]
    return ParameterChoice(
        best=best,
        chosen=design(family, first.share, best, bounds),
        start=design(family, family.share(start), best, bounds),
        admissible=admissible,
        binding={name: by for name, by in held.items() if by > 0 and name not in ALWAYS},
        at_ends=tuple(ends),
        residual=residual,
        searches=1 + len(warm) + max(starts - 1, 0),
        agreeing=_count_agreeing(results[1:], first, admissible),
    )


def design(family: Family, share: Array, best: str, bounds: Mapping[str, float]) -> CamDesign:
    """A design with every measure that the family has."""
    asked = [name for name in MEASURES if name != "stress" or family.contact is not None]
    measures = ChoiceProblem(family, best, {name: bounds.get(name, 0.0) for name in asked}).extremes(share)
    values = family.values(share)
    parameters = {name: float(value) for name, value in zip(family.names, values, strict=True)}
    return CamDesign(parameters, {name: JudgedDesign(*measures[name], bounds.get(name)) for name in asked})


def _count_agreeing(found: Sequence[SearchResult], first: SearchResult, admissible: bool) -> int:
    same = [
        abs(result.value - first.value) <= SAME * max(abs(first.value), 1.0)
        if admissible
        else abs(result.excess - first.excess) <= SAME
        for result in found
        if not admissible or result.excess <= ACTIVE
    ]
    return sum(same)


def _check(family: Family, best: str, bounds: Mapping[str, float]) -> None:
    known = ", ".join(MEASURES)
    for name in (best, *bounds):
        if name not in MEASURES:
            what = _("{name} is not a measure of a cam").format(name=name)
            raise InputError("[choose]", what, _("use one of {known}").format(known=known))
    if family.contact is None and "stress" in (best, *bounds):
        what = _("the contact stress needs the force, the width and the materials")
        raise InputError("[choose]", what, _("write a table [contact]"))
    if not np.all(family.low < family.high):
        raise InputError(
            "[choose] parameters",
            _("the range of a parameter is empty"),
            _("write [from, to], from below to"),
        )


# What one measure costs in another: the best designs as a bound moves (Pareto's front).

POINTS = 15
FEW = 2
"""Starts of the searches along the front, besides those from its neighbours."""


@dataclass(frozen=True)
class TradeOff:
    """A front of best designs.

    Attributes
    ----------
    best, against : str
        The measure made best, and the one whose bound moves.
    designs : tuple of CamDesign
        From one end of the front, where `against` is best, to the other, where its bound does not bind.
    """

    best: str
    against: str
    designs: tuple[CamDesign, ...]

    def values(self, name: str) -> Array:
        """Values in SI of a measure along the front."""
        return np.array([design.measures[name].value for design in self.designs])


def trade_off(
    family: Family,
    start: Array,
    best: str,
    against: str,
    bounds: Mapping[str, float],
    points: int = POINTS,
    said: Callable[[int, int], None] = lambda _done, _of: None,
) -> TradeOff:
    """Best designs for `points` bounds of `against`, the other bounds kept.

    The ends are the design that is best in `against` alone and the one that is best in `best` without a bound of
    `against`; each point starts from its neighbour too. Without an admissible design the front is empty.
    """
    # neither measure of the front is bounded otherwise
    others = {name: bound for name, bound in bounds.items() if name not in (best, against)}
    ends = [
        _choose_among_equals(family, start, (against, best), others),
        _choose_among_equals(family, start, (best, against), others),
    ]
    if not all(end.admissible for end in ends):
        return TradeOff(best, against, ())
    low, high = (end.chosen.measures[against].value for end in ends)
    designs = [ends[0].chosen]
    for number, bound in enumerate(np.linspace(low, high, points)[1:-1]):
        said(number + 1, points - 2)
        warm = np.array(list(designs[-1].parameters.values()))
        made = choose(family, start, best, {**others, against: float(bound)}, FEW, [warm])
        if made.admissible:
            designs.append(made.chosen)
    return TradeOff(best, against, (*designs, ends[1].chosen))


def _choose_among_equals(
    family: Family, start: Array, order: tuple[str, str], bounds: Mapping[str, float]
) -> ParameterChoice:
    """The best in the first measure, and among its equals in the second."""
    first, second = order
    made = choose(family, start, first, bounds)
    if not made.admissible:
        return made
    sign = MEASURES[first].sign
    value = made.chosen.measures[first].value
    # a bound a hair beyond the best value, so that the second search has room
    held = {**bounds, first: value + sign * 1e-7 * abs(value)}
    again = choose(family, start, second, held, FEW, [np.array(list(made.chosen.parameters.values()))])
    return again if again.admissible else made


# From the description of a cam to the designs that its parameters lead to, and back to the chosen one.

STEEPEST = math.radians(60)
"""Of a pressure angle at the start that is to be chosen."""


def contact_of(cam: Cam) -> LineContact | None:
    """Contact that presses the roller; None where the description has none."""
    if cam.contact is None or cam.roller is None:
        return None
    first = ContactMaterial(cam.contact.cam.elasticity, cam.contact.cam.poisson)
    other = cam.contact.roller
    second = first if other is None else ContactMaterial(other.elasticity, other.poisson)
    return LineContact(
        cam.contact.force, cam.contact.width, cam.roller.radius, first, second, cam.contact.outer
    )


def working_arc(cam: Cam) -> tuple[float, float]:
    """Angles [rad] between which the roller is pressed: where a leg stands, else the whole range.

    A leg stands over ±pi/N, however much further `[mover] working_arc` lets the law hold.
    """
    low = -cam.range.stop if cam.curvature.symmetric else cam.range.start
    high = cam.range.stop
    if cam.mover is None:
        return low, high
    half = math.pi / cam.mover.legs
    return max(low, -half), min(high, half)


def family_of(cam: Cam) -> Family:
    """The designs of a description with `[choose]`; raises InputError where a parameter's range cannot be."""
    choose = cam.choose
    if choose is None:
        what = _("no parameter is given to choose")
        raise InputError("[choose]", what, _("write a table [choose] with parameters and bounds"))
    names = tuple(choose.parameters)
    ends = np.array([choose.parameters[name] for name in names], dtype=float)
    _check_ends(cam, dict(choose.parameters))
    low, high = working_arc(cam)
    mirrored = cam.curvature.symmetric
    mesh = Mesh((0.0 if mirrored else low, high), law_of(cam).breaks, mirrored)
    return Family(
        names, ends[:, 0], ends[:, 1], lambda values: _trial(cam, names, values), mesh, contact_of(cam)
    )


def start_of(cam: Cam, family: Family) -> Array:
    """The parameters' values in the description itself."""
    return np.array([given_value(cam, name) for name in family.names])


def bounds_of(cam: Cam) -> dict[str, float]:
    """Bounds in SI by the names of measures; the admissible stress of the contact where none is given."""
    assert cam.choose is not None
    bounds = {name: getattr(cam.choose, name) for name in MEASURED}
    if bounds["step"] is not None and cam.mover is None:
        what = _("a step is that of a walking wheel")
        raise InputError("[choose] step", what, _("give [mover] with legs and post, or omit it"))
    if bounds["stress"] is None and cam.contact is not None:
        bounds["stress"] = cam.contact.admissible
    return {name: bound for name, bound in bounds.items() if bound is not None}


def chosen_cam(cam: Cam, choice: ParameterChoice) -> Cam:
    """The description with the chosen parameters."""
    return vary_cam(cam, choice.chosen.parameters)


def _trial(cam: Cam, names: tuple[str, ...], values: Array) -> PathTrial:
    given = dict(zip(names, values.tolist(), strict=True))
    law = law_of(_with_law(cam, given))
    assert cam.roller is not None or "roller.radius" not in given
    roller = 0.0 if cam.roller is None else cam.roller.radius
    return PathTrial(
        curvature=lambda phi: derivatives(law, phi)[0],
        radius=given.get("start.radius", cam.start.radius),
        gamma=given.get("start.pressure_angle", cam.start.pressure_angle),
        roller_radius=given.get("roller.radius", roller),
        post=0.0 if cam.mover is None else cam.mover.post,
    )


def _with_law(cam: Cam, given: Mapping[str, float]) -> Cam:
    """The description with other numbers in its curvature law, not read once more: a search does it often."""
    numbers: dict[str, object] = {}
    points, letters = list(cam.curvature.points or ()), dict(cam.curvature.constants)
    for name, value in given.items():
        table, _dot, key = name.partition(".")
        if POINT.fullmatch(name):
            number = int(key.partition(".")[2]) - 1
            points[number] = (points[number][0], value)
            numbers["points"] = tuple(points)
        elif CONSTANT.fullmatch(name):
            letters[name.rpartition(".")[2]] = value
            numbers["constants"] = FrozenMap(letters)
        elif table == "curvature":
            numbers[key] = value
    return cam.model_copy(update={"curvature": cam.curvature.model_copy(update=numbers)})


def given_value(cam: Cam, name: str) -> float:
    """Number in SI of a description at a path such as "curvature.k0"."""
    table, _dot, key = name.partition(".")
    if POINT.fullmatch(name):
        assert cam.curvature.points is not None
        return float(cam.curvature.points[int(key.partition(".")[2]) - 1][1])
    if CONSTANT.fullmatch(name):
        return cam.curvature.constants[name.rpartition(".")[2]]
    return float(getattr(getattr(cam, table), key))


def _check_ends(cam: Cam, ranges: Mapping[str, tuple[float, float]]) -> None:
    """The ends of the box have to be designs: positive numbers, a roller smaller than its path, no stalled start."""
    lows = {name: ends[0] for name, ends in ranges.items()}
    highs = {name: ends[1] for name, ends in ranges.items()}
    roller = {name: value for name, value in highs.items() if name == "roller.radius"}
    for values in (lows, highs, {**lows, **roller}):
        try:
            end = vary_cam(cam, values)
            law_of(end)
        except InputError as error:
            what = _("no cam exists at an end of the range: {what}").format(what=error.what)
            raise InputError("[choose] parameters", what, error.repair) from None
        if abs(end.start.pressure_angle) > STEEPEST:
            what = _("a pressure angle at the start beyond {most:g} deg is not tried")
            raise InputError(
                "[choose] parameters", what.format(most=math.degrees(STEEPEST)), _("narrow its range")
            )


# A choice proved along the path itself: its bounds on many angles, and that no neighbour is better.
#
# The search uses its own paths (`tried`); here stand those that everything else is computed from.

ANGLES = 7201
NEAR_ANGLES = 721
DISTANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)
"""Of neighbours, as parts of the ranges of the parameters."""
EACH = 24
"""Neighbours at each distance."""
ROUNDING = 1e-8
"""A neighbour is better where it is so by more than this part: bounds are kept to 1e-9, and multiplied."""


@dataclass(frozen=True)
class Proof:
    """What was found along the path.

    Attributes
    ----------
    values : mapping of name -> float
        Worst values in SI.
    excess : float
        Greatest miss of a bound, as a part of it; not positive where all are kept to rounding.
    neighbours, admissible : int
        Designs near by that were looked at, and how many of them keep the bounds.
    gain : float
        By which part the best of them is better than the chosen one; not positive at an optimum.
    better : Cam or None
        That neighbour, where it is better.
    """

    values: Mapping[str, float]
    excess: float
    neighbours: int
    admissible: int
    gain: float
    better: Cam | None = None


def prove(cam: Cam, bounds: Mapping[str, float], best: str) -> Proof:
    """Look at a chosen cam and its neighbours, along their paths."""
    assert cam.choose is not None
    values = measures_of(cam, ANGLES)
    own = MEASURES[best].sign * values[best]
    near = _neighbours(cam)
    gain, better, admissible = -math.inf, None, 0
    for neighbour in near:
        measures = measures_of(neighbour, NEAR_ANGLES)
        if excess_of(measures, bounds) <= 0:
            admissible += 1
            by = (own - MEASURES[best].sign * measures[best]) / (abs(own) or 1.0)
            gain, better = (by, neighbour) if by > gain else (gain, better)
    kept = better if gain > ROUNDING else None
    return Proof(values, excess_of(values, bounds), len(near), admissible, gain, kept)


def measures_of(cam: Cam, angles: int) -> dict[str, float]:
    """Worst values in SI of all measures of a cam over its working arc; NaN where it has no such path."""
    contact = contact_of(cam)
    names = [name for name in (*MEASURES, *ALWAYS) if name != "stress" or contact is not None]
    low, high = working_arc(cam)
    mirrored = cam.curvature.symmetric
    try:
        path = path_of(cam)
    except InputError:
        return dict.fromkeys(names, math.nan)
    # the beginning is a place of its own: values are given there
    phi = np.unique(np.append(np.linspace(0.0 if mirrored else low, high, angles), 0.0))
    radius = cam.roller.radius if cam.roller is not None else 0.0
    rho, gamma, curvature = (
        values[:, None] for values in (path.radius(phi)[0], path.pressure_angle(phi), path.curvature(phi)[0])
    )
    post = 0.0 if cam.mover is None else cam.mover.post
    tried = BatchPaths(phi, rho, gamma, curvature, np.array([radius]), np.array([post]), mirrored)
    if not np.isfinite(rho * gamma * curvature).all():
        return dict.fromkeys(names, math.nan)
    every = {**MEASURES, **{name: measure for name, (measure, _bound) in ALWAYS.items()}}
    return {name: every[name].sign * float(every[name].of(tried, contact).max()) for name in names}


def excess_of(values: Mapping[str, float], bounds: Mapping[str, float]) -> float:
    """Greatest miss of a bound, as a part of it; infinite where there is no path."""
    limits = dict(ALWAYS) | {name: (MEASURES[name], bound) for name, bound in bounds.items()}
    missed = [
        measure.sign * (values[name] - bound) / (abs(bound) or 1.0)
        for name, (measure, bound) in limits.items()
    ]
    # where a measure is not known nothing is kept
    return max(math.inf if math.isnan(miss) else miss for miss in missed)


def _neighbours(cam: Cam) -> list[Cam]:
    """Designs at growing distances in all directions, inside the ranges of the parameters."""
    assert cam.choose is not None
    names = tuple(cam.choose.parameters)
    ends = np.array([cam.choose.parameters[name] for name in names], dtype=float)
    low, width = ends[:, 0], ends[:, 1] - ends[:, 0]
    share = (np.array([given_value(cam, name) for name in names]) - low) / width
    directions = 2 * _qmc().Halton(len(names), scramble=False).random(EACH + 1)[1:] - 1
    neighbours = []
    for distance in DISTANCES:
        for place in np.clip(share + distance * directions, 0.0, 1.0):
            values = dict(zip(names, (low + place * width).tolist(), strict=True))
            try:
                neighbours.append(vary_cam(cam, values))
            except InputError:
                continue
    return neighbours


# What a description asks to choose: the parameters, the proof, what the choice costs, the cam that comes of
# it.

MORE = 3
"""So often the search goes on from a neighbour that is better, as there are where a law is not smooth."""


@dataclass(frozen=True, repr=False)
class CamChoice(PrintsSummary):
    """A cam with chosen parameters.

    Attributes
    ----------
    cam : Cam
        The description with them.
    choice : ParameterChoice
    proof : Proof
        Its bounds and its neighbours along the path itself.
    front : TradeOff or None
        What the bound of another measure costs; None where none is requested.
    """

    cam: Cam
    choice: ParameterChoice
    proof: Proof
    front: TradeOff | None

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of the measures that this cam has: prints are those of a walking wheel."""
        kept = self.choice.chosen.measures
        wheel = self.cam.mover is not None
        return tuple(name for name in kept if name not in OF_WHEELS or wheel or kept[name].bound is not None)


def choose_cam(
    cam: CamSource,
    points: int = POINTS,
    *,
    front: bool = True,
    said: Callable[[int, int], None] = lambda _done, _of: None,
) -> CamChoice:
    """Choose the parameters that `[choose]` names, so that its bounds are kept and one measure is least.

    Parameters
    ----------
    cam : Cam
        With `[choose]`.
    points : int
        Of the front, where `trade_off` names a measure.
    front : bool
        Also the front.
    said : callable
        Told how many of the front's points are done, and of how many.

    Returns
    -------
    CamChoice
        Also where no design satisfies all bounds: then with the one whose worst miss is least.

    Raises
    ------
    InputError
        Nothing to choose, or ranges that hold no design.

    Examples
    --------
    >>> import centrode as ct
    >>> chosen = ct.choose_cam(ct.example("walking-wheel-four-legs"), front=False)  # doctest: +SKIP
    >>> chosen.choice.admissible  # doctest: +SKIP
    True
    """
    cam = cam_of(cam)
    cam = require_curvature_cam(cam)
    family = family_of(cam)
    assert cam.choose is not None
    start, best, bounds = start_of(cam, family), cam.choose.minimise, bounds_of(cam)
    choice = choose(family, start, best, bounds)
    chosen = chosen_cam(cam, choice)
    proof = prove(chosen, bounds, best)
    for _again in range(MORE):
        if proof.better is None:
            break
        warm = [start_of(proof.better, family), start_of(chosen, family)]
        choice = choose(family, start, best, bounds, warm=warm)
        chosen = chosen_cam(cam, choice)
        proof = prove(chosen, bounds, best)
    against = cam.choose.trade_off
    wanted = front and against is not None
    trade = trade_off(family, start, best, against or "", bounds, points, said) if wanted else None
    return CamChoice(chosen, choice, proof, trade)


def has_choice(cam: AnyCam) -> bool:
    """Whether parameters of a cam are to be chosen."""
    return isinstance(cam, Cam) and cam.choose is not None
