"""Groups of higher class by the method of false position.

A rod is taken out of the group, or a point off its guide, and a link is turned at will: what is left are dyads. How
much the rod would stretch tells how wrong the trial is; rates depend on it linearly, so two trials give the right
one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.graphic.board import cross, dot
from centrode.analysis.graphic.stage import Edge, Stage, Step, Trial
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.structure.assur import step_of
from centrode.structure.constraints import (
    FRAME,
    AngleDrive,
    Constraint,
    DistanceDrive,
    Entity,
    PointInLink,
    PointOnGuide,
)
from centrode.structure.groups import Group, Newton
from centrode.structure.plan import Structure, classify
from centrode.structure.rank import in_order, match, strong_components

MOST_TRIALS = 2
"""Links turned at will at once: with three, a person no longer draws."""
SINGULAR = 1e-10

Array: TypeAlias = npt.NDArray[np.float64]
Equation: TypeAlias = tuple[Constraint, int]
Construct: TypeAlias = Callable[[Sequence[Group], Stage], None]


@dataclass(frozen=True)
class Cut:
    """What is taken out of a group: a rod with its two points, a cylinder's drive, or a point's guide."""

    name: str
    ends: tuple[str, str] = ("", "")
    rod: str = ""
    drive: str = ""
    guide: PointOnGuide | None = None

    def spares(self, equation: Equation) -> bool:
        """Whether an equation stays."""
        constraint = equation[0]
        if isinstance(constraint, PointInLink) and self.rod:
            return constraint.link != self.rod
        if isinstance(constraint, DistanceDrive):
            return constraint.drive != self.drive
        return constraint != self.guide

    def misfit(self, stage: Stage) -> float:
        """How fast the rod would stretch, or the point leave its guide: a velocity or an acceleration."""
        if self.guide is not None:
            return _off_guide(stage, self.guide)
        arm = _arm(stage, self.ends)
        along = arm / abs(arm)
        apart = stage.points[self.ends[1]] - stage.points[self.ends[0]]
        rate = stage.driven[self.drive] if self.drive else 0.0
        if stage.before is not None:
            spin = cross(along, stage.before.points[self.ends[1]] - stage.before.points[self.ends[0]]) / abs(
                arm
            )
            rate -= spin**2 * abs(arm)
        return dot(along, apart) - rate


@dataclass(frozen=True)
class Opened:
    """A group of higher class made drawable: what was cut, the links turned at will, the dyads that are left."""

    cuts: tuple[Cut, ...]
    turned: tuple[str, ...]
    groups: tuple[Group, ...]


def solve_by_trials(structure: Structure, group: Newton, stage: Stage, construct: Construct) -> None:
    """Add the rates of a group of higher class; InputError where no trial makes dyads of it."""
    opened = open_up(structure, group)
    size = _trial_size(stage)
    count = len(opened.turned)
    values = [tuple(size * (k == j + 1) for j in range(count)) for k in range(count + 1)]
    misfits = [_misfits(_tried(stage, opened, trial, construct), opened) for trial in values]
    found = tuple(_corrected(np.array(values), np.array(misfits)).tolist())
    trial = Trial(opened.turned, tuple(values), tuple(misfits), found, tuple(cut.name for cut in opened.cuts))
    stage.steps.append(Step(step_of(group), (), trial=trial))
    _adopt(stage, _tried(stage, opened, found, construct))
    for cut in opened.cuts:
        _put_back(stage, cut)


def _trial_size(stage: Stage) -> float:
    """A turning as large as those that are known: rounding of one that is zero must not set it."""
    scale = float(stage.drawing.numbers.scale)
    sizes = [abs(turn) for turn in stage.turns.values()]
    sizes += [abs(rate) / scale for rate in stage.points.values()]
    if stage.before is not None:
        sizes += [turn**2 for turn in stage.before.turns.values()]
    return max(sizes) or 1.0


def _corrected(values: Array, misfits: Array) -> Array:
    """The trial that fits: misfits are linear in it."""
    slopes = (misfits[1:] - misfits[0]).T / (values[1:] - values[0]).max(axis=1)
    sizes = np.abs(slopes).max(axis=1, keepdims=True)
    if not sizes.all() or np.linalg.cond(slopes / sizes) > 1 / SINGULAR:
        raise MotionError(
            "",
            _("the trials all fit alike: the group stands at a dead point"),
            _("choose another instant, or a finer reading step"),
        )
    return np.asarray(values[0] - np.linalg.solve(slopes, misfits[0]))


def _tried(stage: Stage, opened: Opened, trial: Sequence[float], construct: Construct) -> Stage:
    tried = stage.copied()
    tried.driven.update(zip(map(_drive, opened.turned), trial, strict=True))
    construct(opened.groups, tried)
    return tried


def _misfits(stage: Stage, opened: Opened) -> tuple[float, ...]:
    return tuple(cut.misfit(stage) for cut in opened.cuts)


def _adopt(stage: Stage, done: Stage) -> None:
    stage.points, stage.turns, stage.bases = done.points, done.turns, done.bases
    stage.hidden, stage.edges, stage.steps = done.hidden, done.edges, done.steps


def _put_back(stage: Stage, cut: Cut) -> None:
    """The rod that was taken out turns with its two points."""
    if not cut.rod:
        return
    arm = _arm(stage, cut.ends)
    ends = stage.points[cut.ends[0]], stage.points[cut.ends[1]]
    stage.turns[cut.rod] = cross(arm, ends[1] - ends[0]) / abs(arm) ** 2
    stage.bases[cut.rod] = cut.ends[0]
    stage.edges.append(Edge(*ends, "image", f"{cut.ends[1]}{cut.ends[0]}", cut.rod))


def _arm(stage: Stage, ends: tuple[str, str]) -> complex:
    place = stage.drawing.point
    return stage.drawing.arm(place(ends[0]), place(ends[1]), known=True)


def _off_guide(stage: Stage, guide: PointOnGuide) -> float:
    drawing = stage.drawing
    heading = drawing.heading(guide.on, drawing.numbers.direction[guide.guide])
    at = drawing.point(guide.point)
    velocity = 0j if stage.before is None else stage.before.points[guide.point]
    relative = (
        stage.points[guide.point] - stage.carried(guide.on, at) - stage.coriolis(guide.on, at, velocity)
    )
    return cross(heading, relative)


def _drive(link: str) -> str:
    """Name of the drive that turns a link at will; no drive of a description has a slash."""
    return f"trial/{link}"


def open_up(structure: Structure, group: Newton) -> Opened:
    """Cuts and links to turn at will with which a group falls into dyads, as few as will do."""
    cuts = list(_cuts(group))
    for count in range(1, MOST_TRIALS + 1):
        for chosen in combinations(cuts, count):
            links = [link for link in group.links if all(cut.rod != link for cut in chosen)]
            for turned in combinations(links, count):
                groups = _fallen(structure, group, chosen, turned)
                if groups is not None:
                    return Opened(chosen, turned, groups)
    raise InputError(
        step_of(group),
        _("the method of false position does not apply: two trials at once do not make dyads of the group"),
        _("take velocities from the motion"),
    )


def _cuts(group: Newton) -> Iterator[Cut]:
    """Rods with two points of which nothing else of the group hangs; cylinders; points on guides."""
    constraints = list(dict.fromkeys(constraint for constraint, _row in group.equations))
    for link in group.links:
        hinges = [c.point for c in constraints if isinstance(c, PointInLink) and c.link == link]
        entity = Entity("link", link)
        held = sum(entity in c.bodies for c in constraints)
        if len(hinges) == 2 and held == 2:
            yield Cut(link, (hinges[0], hinges[1]), rod=link)
    for c in constraints:
        if isinstance(c, DistanceDrive):
            yield Cut(c.drive, (c.first, c.second), drive=c.drive)
        if isinstance(c, PointOnGuide):
            yield Cut(c.guide, guide=c)


def _fallen(
    structure: Structure, group: Newton, cuts: Sequence[Cut], turned: Sequence[str]
) -> tuple[Group, ...] | None:
    """The dyads that a group falls into, in order; None where something of higher class is left."""
    rods = {cut.rod for cut in cuts}
    entities = [Entity("point", name) for name in group.points]
    entities += [Entity("link", name) for name in group.links if name not in rods]
    equations: list[Equation] = [e for e in group.equations if all(cut.spares(e) for cut in cuts)]
    equations += [(AngleDrive(_drive(link), link, FRAME), 0) for link in turned]
    neighbours = {
        number: [(e, k) for e in entities if e in equation[0].bodies for k in range(e.unknowns)]
        for number, equation in enumerate(equations)
    }
    owner = match(neighbours)
    if len(owner) < sum(entity.unknowns for entity in entities):
        return None
    matched: dict[Entity, list[int]] = {entity: [] for entity in entities}
    for (entity, _k), number in owner.items():
        matched[entity].append(number)
    depends = {
        entity: [o for number in own for o in equations[number][0].bodies if o != entity and o in matched]
        for entity, own in matched.items()
    }
    found: list[Group] = []
    for component in in_order(strong_components(depends), depends):
        own = sorted(number for entity in component for number in matched[entity])
        part = classify(structure.mechanism, component, [equations[n] for n in own])
        if isinstance(part, Newton):
            return None
        found.append(part)
    return tuple(found)
