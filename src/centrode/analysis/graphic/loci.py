"""Vector equations of a point: the parts of its velocity or acceleration that are known, and the direction of the last.

One equation for each locus on which a point of a group lies; two of them meet in its image.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TypeAlias, assert_never

import numpy as np
import numpy.typing as npt

from centrode.analysis.graphic.stage import (
    ConstructionStage,
    ConstructionStep,
    ConstructionTrial,
    Edge,
    Kind,
    cross,
    dot,
)
from centrode.errors import InputError, MotionError
from centrode.kinematics.dyads import solved_angles
from centrode.locale import _
from centrode.structure.constraints import (
    FRAME,
    AngleDrive,
    Constraint,
    DistanceDrive,
    Entity,
    GearRatio,
    NoSlip,
    PointInLink,
    PointOnGuide,
    Positions,
)
from centrode.structure.gearing import Round, Straight
from centrode.structure.groups import (
    AngleEquation,
    AngleGiven,
    Arm,
    CylinderCircle,
    Group,
    GuideStop,
    Locus,
    Meshed,
    Newton,
    Rail,
    Rod,
    Rolled,
    Rolloff,
    Slot,
    Touch,
    Train,
)
from centrode.structure.plan import Structure, classify
from centrode.structure.rank import in_order, match, strong_components


@dataclass(frozen=True)
class RayLeg:
    """A known part of a vector equation."""

    kind: Kind
    vector: complex
    name: str
    text: str


@dataclass(frozen=True)
class Ray:
    """A vector equation: rate = origin + legs + unknown length along a direction.

    `origin_text` and `text` say the known first part and the unknown last one as an equation does; `at` is the
    place of the drawing whose rate it is, `of` its name, `arm` the length over which the unknown part turns a link.
    """

    origin: complex
    origin_text: str
    legs: tuple[RayLeg, ...]
    direction: complex
    kind: Kind
    name: str
    text: str
    at: complex
    of: str
    arm: float = 0.0
    link: str = ""

    @property
    def start(self) -> complex:
        """Where the direction begins."""
        return self.origin + sum(leg.vector for leg in self.legs)

    def length(self, end: complex) -> float:
        """The unknown part once the end is known, positive in the direction."""
        return dot(self.direction, end - self.start)

    def edges(self, end: complex) -> list[Edge]:
        """All parts as they are drawn."""
        place, edges = self.origin, []
        for leg in self.legs:
            edges.append(Edge(place, place + leg.vector, leg.kind, leg.name, self.link))
            place += leg.vector
        return [*edges, Edge(place, end, self.kind, self.name, self.link)]

    def equation(self, letter: str, name: str) -> str:
        """The equation in symbols: v_B = v_A + v_BA (⊥ AB)."""
        parts = [self.origin_text, *(leg.text for leg in self.legs), self.text]
        return f"{letter}_{name} = {' + '.join(part for part in parts if part)}"


def letter(stage: ConstructionStage) -> str:
    """Symbol of what is constructed."""
    return "v" if stage.order == 1 else "a"


def rate_symbol(stage: ConstructionStage, point: str) -> str:
    """Symbol of the rate of a point; nothing of one at rest."""
    return "" if stage.rate(point) == 0 else f"{letter(stage)}_{point}"


def around(stage: ConstructionStage, point: str, centre: str, link: str, known: bool = True) -> Ray:
    """A point on a circle about another one: known normal part, unknown part square to the arm."""
    drawing = stage.drawing
    arm = drawing.arm(drawing.point(centre), drawing.point(point), known)
    return turning_ray(stage, arm, point, centre, link)


def turning_ray(stage: ConstructionStage, arm: complex, point: str, centre: str, link: str) -> Ray:
    """Equation of a place that turns with a link about a known point of it, at the end of an arm."""
    symbol, name = letter(stage), f"{point}{centre}"
    legs: tuple[RayLeg, ...] = ()
    if stage.before is not None:
        # of velocities there is no normal part: w^2 r is of the second order
        legs = (RayLeg("normal", stage.inwards(link, arm), name, f"aⁿ_{name} (∥ {name})"),)
    kind: Kind = "relative" if stage.order == 1 else "tangential"
    text = f"{symbol if stage.order == 1 else 'aᵗ'}_{name} (⊥ {name})"
    return Ray(
        stage.rate(centre),
        rate_symbol(stage, centre),
        legs,
        # the unknown part is square to the arm whatever the order is
        1j * arm / abs(arm),
        kind,
        name,
        text,
        stage.drawing.point(centre) + arm,
        point,
        abs(arm),
        link,
    )


def sliding_ray(
    stage: ConstructionStage, on: str, at: complex, direction: complex, point: str, guide: str
) -> Ray:
    """A point of the unknown that slides on a known body: the body's own rate there, Coriolis, along the guide."""
    velocity = 0j if stage.before is None else stage.before.points[point]
    return _along(stage, on, at, direction, velocity, point, guide)


def _along(
    stage: ConstructionStage,
    on: str,
    at: complex,
    direction: complex,
    velocity: complex,
    point: str,
    guide: str,
) -> Ray:
    under = f"{point}′"
    legs: tuple[RayLeg, ...] = ()
    # Coriolis needs velocities, and a body that turns
    if stage.before is not None and on != FRAME and stage.before.turns[on] != 0.0:
        turned = stage.coriolis(on, at, velocity)
        legs = (RayLeg("coriolis", turned, f"{point}{under}", f"aᵏ_{point}{under}"),)
    origin = stage.point_rate(on, at)
    if on != FRAME:
        # the image of the place under the point, drawn beside those of the points
        stage.hidden.setdefault(under, origin)
    text = f"{letter(stage)}ʳ_{point}{under if on != FRAME else ''} (∥ guide {guide})"
    return Ray(
        origin,
        f"{letter(stage)}_{under}" if on != FRAME else "",
        legs,
        direction,
        "sliding",
        f"{point}{under}" if on != FRAME else point,
        text,
        at,
        point,
    )


def carrying_ray(stage: ConstructionStage, link: str, point: str, direction: complex, guide: str) -> Ray:
    """The place of an unknown link of known turning under a known point that slides on it."""
    at, under = stage.drawing.point(point), f"{point}′"
    legs: tuple[RayLeg, ...] = ()
    if stage.before is not None and stage.before.turns[link] != 0.0:
        # seen from the point the link's place moves backwards: so does Coriolis
        turned = -stage.coriolis(link, at, stage.before.points[point])
        legs = (RayLeg("coriolis", turned, f"{under}{point}", f"aᵏ_{under}{point}"),)
    text = f"{letter(stage)}ʳ_{under}{point} (∥ guide {guide})"
    origin, name = stage.points[point], f"{under}{point}"
    return Ray(
        origin, rate_symbol(stage, point), legs, direction, "sliding", name, text, at, under, link=link
    )


def ray_of(stage: ConstructionStage, locus: Locus, carriage: str | None) -> Ray:
    """The vector equation of a locus, for the place it is about."""
    drawing = stage.drawing
    match locus:
        case Rod():
            return around(stage, locus.point, locus.centre, locus.link)
        case CylinderCircle():
            return cylinder(stage, locus)
        case Rail():
            return _along_guide(stage, locus)
        case Slot():
            direction = drawing.heading(carriage or "", drawing.numbers.direction[locus.guide])
            return carrying_ray(stage, carriage or "", locus.point, direction, locus.guide)
        case GuideStop():
            return _driven(_along_guide(stage, locus), stage.driven[locus.drive])
        case Touch() | Rolloff():
            return _of_wheel(stage, locus)
        case _:
            assert_never(locus)


def _along_guide(stage: ConstructionStage, locus: Rail | GuideStop) -> Ray:
    """A point that slides along a guide of a known body."""
    drawing = stage.drawing
    direction = drawing.heading(locus.on, drawing.numbers.direction[locus.guide])
    return sliding_ray(stage, locus.on, drawing.point(locus.point), direction, locus.point, locus.guide)


def _driven(ray: Ray, rate: float) -> Ray:
    """The equation of a point that is driven along the direction and free square to it."""
    driven = RayLeg("driven", rate * ray.direction, ray.name, ray.text)
    # the part along the guide is known from the drive: the unknown one is square to it
    free = ray.text.replace("∥", "⊥")
    return replace(ray, legs=(*ray.legs, driven), direction=1j * ray.direction, text=free)


def cylinder(stage: ConstructionStage, locus: CylinderCircle) -> Ray:
    """A point at the end of a cylinder: the stroke's rate along it, Coriolis, and unknown turning about its foot."""
    drawing, name = stage.drawing, f"{locus.point}{locus.centre}"
    arm = drawing.arm(drawing.point(locus.centre), drawing.point(locus.point), known=True)
    along, rate = arm / abs(arm), stage.driven[locus.drive]
    legs = [RayLeg("driven", rate * along, name, f"{letter(stage)}ʳ_{name} (∥ {name})")]
    if stage.before is not None:
        apart = stage.before.points[locus.point] - stage.before.points[locus.centre]
        spin = dot(1j * along, apart) / abs(arm)
        stretch = dot(along, apart)
        # in this order the parts are drawn: normal, along, Coriolis
        legs.insert(0, RayLeg("normal", -(spin**2) * arm, name, f"aⁿ_{name} (∥ {name})"))
        legs.append(RayLeg("coriolis", 2j * spin * stretch * along, name, f"aᵏ_{name} (⊥ {name})"))
    text = f"{letter(stage) if stage.order == 1 else 'aᵗ'}_{name} (⊥ {name})"
    kind: Kind = "relative" if stage.order == 1 else "tangential"
    origin = stage.points[locus.centre]
    at = drawing.point(locus.point)
    first = rate_symbol(stage, locus.centre)
    return Ray(origin, first, tuple(legs), 1j * along, kind, name, text, at, locus.point, abs(arm))


def _of_wheel(stage: ConstructionStage, locus: Touch | Rolloff) -> Ray:
    """A wheel's centre beside or about its track, or a track that is carried past a known wheel."""
    drawing = stage.drawing
    contact = locus.contact if isinstance(locus, Touch) else locus.rolling
    track = drawing.numbers.gearing.track[contact.rolling]
    if isinstance(track, Round):
        return _about_track(stage, locus, contact.on, track)
    assert isinstance(track, Straight)
    direction = drawing.heading(contact.on, track.direction)
    if locus.carried:
        ray = carrying_ray(stage, contact.on, locus.point, direction, contact.rolling)
    else:
        at = drawing.point(locus.point)
        ray = sliding_ray(stage, contact.on, at, direction, locus.point, contact.rolling)
    if isinstance(locus, Touch):
        return ray
    # rolling: the centre goes back along the track by the radius times the wheel's turn against it
    turn = stage.turns[contact.link] - stage.turns[contact.on]
    way = -turn * drawing.numbers.gearing.radius[contact.rolling]
    # seen from the wheel the track is carried the other way
    return _driven(ray, -way if locus.carried else way)


def _about_track(stage: ConstructionStage, locus: Touch | Rolloff, on: str, track: Round) -> Ray:
    """A circle about the centre of a round track: the distance of the two centres turns as a rod would."""
    drawing, wheel = stage.drawing, locus.point
    centre = drawing.inside(on, track.centre)
    arm = drawing.arm(centre, drawing.point(wheel))
    # from the wheel's side the arm points backwards
    sense = -1.0 if locus.carried else 1.0
    origin = stage.points[wheel] if locus.carried else stage.point_rate(on, centre)
    name = f"{wheel}K"
    legs: tuple[RayLeg, ...] = ()
    if stage.before is not None:
        apart = stage.before.points[wheel] - stage.before.point_rate(on, centre)
        spin = dot(1j * arm, apart) / abs(arm) ** 2
        legs = (RayLeg("normal", -(spin**2) * sense * arm, name, f"aⁿ_{name} (∥ {name})"),)
    kind: Kind = "relative" if stage.order == 1 else "tangential"
    text = f"{letter(stage) if stage.order == 1 else 'aᵗ'}_{name} (⊥ {name})"
    first = rate_symbol(stage, wheel) if locus.carried else ("" if on == FRAME else f"{letter(stage)}_K")
    place = centre if locus.carried else drawing.point(wheel)
    of = "K" if locus.carried else wheel
    return Ray(origin, first, legs, 1j * arm / abs(arm), kind, name, text, place, of)


# Angular velocities and accelerations that gears and rolling wheels give.


def meshed_rate(stage: ConstructionStage, gear: GearRatio, link: str) -> float:
    """Turning of one link of a gear from that of the other two (Willis)."""
    weights = gear.weights(stage.drawing.numbers)
    # sum of weights times turns is zero
    known = sum(weight * stage.turns[other] for other, weight in weights.items() if other != link)
    return float(-known / weights[link])


def wheel_equations(stage: ConstructionStage, turning: object) -> list[str]:
    """The equation of a gear (Willis), or of a wheel that rolls on the frame, as a person writes it."""
    letter = "ω" if stage.order == 1 else "ε"
    if isinstance(turning, Meshed):
        turning = turning.gear
    if isinstance(turning, GearRatio):
        weights = turning.weights(stage.drawing.numbers)
        ratio = -weights[turning.first] / weights[turning.second]
        first, second = (
            _relative_turning_symbol(letter, link, turning.carrier)
            for link in (turning.first, turning.second)
        )
        return [f"{second} = {ratio:.5g}·{first}"]
    if isinstance(turning, Rolled) and turning.rolling.on == FRAME:
        wheel, centre = turning.rolling.link, turning.rolling.centre
        rate = "v" if stage.order == 1 else "aᵗ"
        return [f"|{letter}_{wheel}| = |{rate}_{centre}|/r"]
    return []


def _relative_turning_symbol(letter: str, link: str, carrier: str) -> str:
    """Turning of a link as its gear's carrier sees it."""
    parts = ["0" if name == FRAME else f"{letter}_{name}" for name in (link, carrier)]
    return parts[0] if carrier == FRAME else f"({parts[0]} − {parts[1]})"


def rolled_rate(stage: ConstructionStage, rolling: NoSlip) -> float:
    """Turning of a wheel against the body it rolls on, from the way of its centre along the track."""
    drawing = stage.drawing
    numbers, centre = drawing.numbers, drawing.point(rolling.centre)
    track = numbers.gearing.track[rolling.rolling]
    velocity = 0j if stage.before is None else stage.before.points[rolling.centre]
    relative = stage.points[rolling.centre] - stage.point_rate(rolling.on, centre)
    # the body carries the place itself along, and turns what passes: neither is rolled
    relative -= stage.coriolis(rolling.on, centre, velocity)
    if isinstance(track, Straight):
        heading = drawing.heading(rolling.on, track.direction)
        # on the left of its track a wheel that goes ahead turns clockwise
        return float(-dot(heading, relative) / numbers.gearing.radius[rolling.rolling])
    arm = drawing.arm(drawing.inside(rolling.on, track.centre), centre)
    return float(numbers.gearing.spin(rolling.rolling) * dot(1j * arm, relative) / abs(arm) ** 2)


def train_rates(stage: ConstructionStage, group: Train) -> dict[str, float]:
    """Turning of all links of a train."""
    rows = [_row(stage, equation) for equation in group.equations]
    # rates obey the equations of the angles with the constants left out: the same solver does
    return solved_angles(group, rows, Positions({}, {}, {}, dict(stage.turns)))


def _row(stage: ConstructionStage, equation: AngleEquation) -> tuple[Mapping[str, float], float]:
    """Factors of the turnings in an equation, and what they sum up to."""
    numbers = stage.drawing.numbers
    match equation:
        case GearRatio():
            return dict(equation.weights(numbers)), 0.0
        case NoSlip():
            return {equation.link: 1.0, equation.on: -1.0}, rolled_rate(stage, equation)
        case Arm(rolling=rolling):
            spin = numbers.gearing.spin(rolling.rolling)
            # w_wheel - w_on = spin (w_arm - w_on), all to one side
            return {rolling.link: 1.0, rolling.on: spin - 1.0, equation.link: -spin}, 0.0
        case AngleGiven():
            rate = 0.0 if equation.drive is None else stage.driven[equation.drive]
            return {equation.link: 1.0, equation.relative_to: -1.0}, rate
        case _:
            assert_never(equation)


# Groups of higher class by the method of false position.
#
# A rod is taken out of the group, or a point off its guide, and a link is turned at will: what is left are
# dyads. How much the rod would stretch tells how wrong the trial is; rates depend on it linearly, so two
# trials give the right one.

MOST_TRIALS = 2
"""Links turned at will at once: with three, a person no longer draws."""
SINGULAR = 1e-10

Array: TypeAlias = npt.NDArray[np.float64]
Equation: TypeAlias = tuple[Constraint, int]
Construct: TypeAlias = Callable[[Sequence[Group], ConstructionStage], None]


@dataclass(frozen=True)
class Cut:
    """Part taken out of a group: a rod with its two points, a cylinder's drive, or a point's guide."""

    name: str
    ends: tuple[str, str] = ("", "")
    rod: str = ""
    drive: str = ""
    guide: PointOnGuide | None = None

    def spares(self, equation: Equation) -> bool:
        """Whether an equation stays."""
        constraint = equation[0]
        # all that ties the rod's own pose falls with it: as a body it is out of the group
        if isinstance(constraint, PointInLink) and self.rod:
            return constraint.link != self.rod
        if isinstance(constraint, DistanceDrive):
            return constraint.drive != self.drive
        return constraint != self.guide

    def misfit(self, stage: ConstructionStage) -> float:
        """Rate at which the rod would stretch, or the point leave its guide [m/s or m/s^2]."""
        if self.guide is not None:
            return _off_guide(stage, self.guide)
        arm = _arm(stage, self.ends)
        along = arm / abs(arm)
        apart = stage.points[self.ends[1]] - stage.points[self.ends[0]]
        rate = stage.driven[self.drive] if self.drive else 0.0
        if stage.before is not None:
            # the normal part is known from the velocities and is no misfit
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


def solve_by_trials(
    structure: Structure, group: Newton, stage: ConstructionStage, construct: Construct
) -> None:
    """Add the rates of a group of higher class; InputError where no trial makes dyads of it."""
    opened = open_up(structure, group)
    size = _trial_size(stage)
    count = len(opened.turned)
    # no turn, then one link after the other turned by the size: as many trials as unknowns and one
    values = [tuple(size * (k == j + 1) for j in range(count)) for k in range(count + 1)]
    misfits = [_misfits(_construct_trial(stage, opened, trial, construct), opened) for trial in values]
    fitting = tuple(_interpolate_trial(np.array(values), np.array(misfits)).tolist())
    trial = ConstructionTrial(
        opened.turned, tuple(values), tuple(misfits), fitting, tuple(cut.name for cut in opened.cuts)
    )
    stage.steps.append(ConstructionStep(group.sentence, (), trial=trial))
    # the trials are thrown away: only the drawing with the right turns stays
    _adopt(stage, _construct_trial(stage, opened, fitting, construct))
    for cut in opened.cuts:
        _put_back(stage, cut)


def _trial_size(stage: ConstructionStage) -> float:
    """A turning as large as those that are known: rounding of one that is zero must not set it."""
    scale = float(stage.drawing.numbers.scale)
    sizes = [abs(turn) for turn in stage.turns.values()]
    sizes += [abs(rate) / scale for rate in stage.points.values()]
    if stage.before is not None:
        sizes += [turn**2 for turn in stage.before.turns.values()]
    return max(sizes) or 1.0


def _interpolate_trial(values: Array, misfits: Array) -> Array:
    """The trial that fits: misfits are linear in it."""
    # a trial differs from the first in one link alone, by the size: the greatest difference is that
    slopes = (misfits[1:] - misfits[0]).T / (values[1:] - values[0]).max(axis=1)
    # rows of velocities and of guides have scales of their own: each by its own greatest slope
    sizes = np.abs(slopes).max(axis=1, keepdims=True)
    if not sizes.all() or np.linalg.cond(slopes / sizes) > 1 / SINGULAR:
        raise MotionError(
            "",
            _("all trials fit equally well: the group is in a dead position"),
            _("choose another instant, or a finer reading step"),
        )
    return np.asarray(values[0] - np.linalg.solve(slopes, misfits[0]))


def _construct_trial(
    stage: ConstructionStage, opened: Opened, trial: Sequence[float], construct: Construct
) -> ConstructionStage:
    tried = stage.copy()
    tried.driven.update(zip(map(_drive, opened.turned), trial, strict=True))
    construct(opened.groups, tried)
    return tried


def _misfits(stage: ConstructionStage, opened: Opened) -> tuple[float, ...]:
    return tuple(cut.misfit(stage) for cut in opened.cuts)


def _adopt(stage: ConstructionStage, done: ConstructionStage) -> None:
    stage.points, stage.turns, stage.bases = done.points, done.turns, done.bases
    stage.hidden, stage.edges, stage.steps = done.hidden, done.edges, done.steps


def _put_back(stage: ConstructionStage, cut: Cut) -> None:
    """The rod that was taken out turns with its two points."""
    if not cut.rod:
        return
    # its points were drawn by others, so only its turn is missing
    arm = _arm(stage, cut.ends)
    ends = stage.points[cut.ends[0]], stage.points[cut.ends[1]]
    stage.turns[cut.rod] = cross(arm, ends[1] - ends[0]) / abs(arm) ** 2
    stage.bases[cut.rod] = cut.ends[0]
    stage.edges.append(Edge(*ends, "image", f"{cut.ends[1]}{cut.ends[0]}", cut.rod))


def _arm(stage: ConstructionStage, ends: tuple[str, str]) -> complex:
    place = stage.drawing.point
    return stage.drawing.arm(place(ends[0]), place(ends[1]), known=True)


def _off_guide(stage: ConstructionStage, guide: PointOnGuide) -> float:
    drawing = stage.drawing
    heading = drawing.heading(guide.on, drawing.numbers.direction[guide.guide])
    at = drawing.point(guide.point)
    velocity = 0j if stage.before is None else stage.before.points[guide.point]
    relative = (
        # what the guide's body gives, and Coriolis, are motion along with it: only across the guide it is a
        # misfit
        stage.points[guide.point] - stage.point_rate(guide.on, at) - stage.coriolis(guide.on, at, velocity)
    )
    return cross(heading, relative)


def _drive(link: str) -> str:
    """Name of the drive that turns a link at will; no drive of a description has a slash."""
    return f"trial/{link}"


def open_up(structure: Structure, group: Newton) -> Opened:
    """Cuts and links to turn at will with which a group falls into dyads, as few as will do."""
    cuts = list(_cuts(group))
    # the fewest cuts first: each one more trial to draw
    for count in range(1, MOST_TRIALS + 1):
        for chosen in combinations(cuts, count):
            links = [link for link in group.links if all(cut.rod != link for cut in chosen)]
            # as many links turned as ties cut, so that equations and unknowns stay equal
            for turned in combinations(links, count):
                groups = _fallen(structure, group, chosen, turned)
                if groups is not None:
                    return Opened(chosen, turned, groups)
    raise InputError(
        group.sentence,
        _(
            "the method of false position does not apply: two simultaneous trials do not split the group into dyads"
        ),
        _("use the velocities of the motion"),
    )


def _cuts(group: Newton) -> Iterator[Cut]:
    """Rods with two points of which nothing else of the group hangs; cylinders; points on guides."""
    constraints = list(dict.fromkeys(constraint for constraint, _row in group.equations))
    for link in group.links:
        hinges = [c.point for c in constraints if isinstance(c, PointInLink) and c.link == link]
        entity = Entity("link", link)
        held = sum(entity in c.bodies for c in constraints)
        # the rod is hinged in two points and tied by nothing else: without it its place is not needed
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
    # a drive of angle takes the place of what was cut
    equations += [(AngleDrive(_drive(link), link, FRAME), 0) for link in turned]
    neighbours = {
        number: [(e, k) for e in entities if e in equation[0].bodies for k in range(e.unknowns)]
        for number, equation in enumerate(equations)
    }
    owner = match(neighbours)
    # fewer pairs than unknowns: something is left that nothing places
    if len(owner) < sum(entity.unknowns for entity in entities):
        return None
    matched: dict[Entity, list[int]] = {entity: [] for entity in entities}
    for (entity, _k), number in owner.items():
        matched[entity].append(number)
    depends = {
        # what a thing is placed by comes before it
        entity: [o for number in own for o in equations[number][0].bodies if o != entity and o in matched]
        for entity, own in matched.items()
    }
    dyads: list[Group] = []
    for component in in_order(strong_components(depends), depends):
        own = sorted(number for entity in component for number in matched[entity])
        part = classify(structure.mechanism, component, [equations[n] for n in own])
        if isinstance(part, Newton):
            return None
        dyads.append(part)
    return tuple(dyads)
