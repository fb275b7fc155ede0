"""Velocities and accelerations group by group, as they are drawn: where two directions meet, by similar triangles.

Positions are measured in the drawing; nothing is taken from the derivatives of the motion.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import assert_never

from centrode.analysis.graphic.loci import (
    Ray,
    RayLeg,
    carrying_ray,
    letter,
    meshed_rate,
    ray_of,
    rolled_rate,
    solve_by_trials,
    train_rates,
    turning_ray,
    wheel_equations,
)
from centrode.analysis.graphic.stage import (
    ORIGIN,
    ConstructionStage,
    ConstructionStep,
    Edge,
    Triangle,
    cross,
    dot,
    meet,
)
from centrode.errors import InputError
from centrode.locale import _
from centrode.structure.groups import (
    Aim,
    Group,
    Meet,
    Meshed,
    Newton,
    RigidPoint,
    Rod,
    Rolled,
    Train,
    TurnedLink,
    Turning,
    TwoPointLink,
)
from centrode.structure.plan import Structure

SMALL = 1e-12
"""Sides of a triangle shorter than this part of the longest are none."""


def construct(structure: Structure, stage: ConstructionStage) -> None:
    """Add the velocities or accelerations of every group of a plan, in its order."""
    for group in structure.groups:
        if isinstance(group, Newton):
            solve_by_trials(structure, group, stage, lambda parts, on: construct_groups(parts, on))
        else:
            construct_groups((group,), stage)


def construct_groups(groups: Sequence[Group], stage: ConstructionStage) -> None:
    """Add the rates of groups that can be drawn one after the other."""
    for group in groups:
        equations, triangle = _construct(group, stage)
        if equations:
            stage.steps.append(ConstructionStep(group.sentence, tuple(equations), triangle))


def _construct(group: Group, stage: ConstructionStage) -> tuple[list[str], Triangle | None]:
    match group:
        case RigidPoint():
            return _image(stage, group.link, group.point), None
        case TwoPointLink():
            return _through_two(stage, group), None
        case TurnedLink():
            stage.bases[group.link] = group.pivot
            stage.turns[group.link] = _turn_of(stage, group.turning, group.link)
            return wheel_equations(stage, group.turning), None
        case Aim():
            return _aim(stage, group)
        case Meet():
            return _meet(stage, group)
        case Train():
            return _train(stage, group), None
        case Newton():
            what = _("this construction cannot be used here")
            raise InputError(group.sentence, what, _("use the values of the motion"))
        case _:
            assert_never(group)


def _turn_of(stage: ConstructionStage, turning_of: Turning | Meshed | Rolled, link: str) -> float:
    """Turning [rad/s or rad/s^2] of a link that a drive, a guide, a gear or a rolling contact turns."""
    match turning_of:
        case Meshed(gear):
            return meshed_rate(stage, gear, link)
        case Rolled(rolling):
            return rolled_rate(stage, rolling) + stage.turns[rolling.on]
        case Turning():
            rate = 0.0 if turning_of.drive is None else stage.driven[turning_of.drive]
            if link == turning_of.link:
                return stage.turns[turning_of.relative_to] + rate
            # the link is the one that the other is measured from: its turn is the other way round
            return stage.turns[turning_of.link] - rate
        case _:
            assert_never(turning_of)


def _image(stage: ConstructionStage, link: str, point: str) -> list[str]:
    """A point of a link that is known: at the end of an arm, or by the similar triangle on two images."""
    base = stage.bases[link]
    if base == point:
        return []
    arm = stage.drawing.arm(stage.drawing.point(base), stage.drawing.point(point), known=True)
    # two points in one place have one rate; a direction of no length could not be read
    if arm == 0:
        stage.points[point] = stage.rate(base)
        return [f"{letter(stage)}_{point} = {letter(stage)}_{base}"]
    # with two images there already the third is drawn by a similar triangle; the rate is the same
    others = [name for name in stage.drawing.numbers.local[link] if name in stage.points and name != point]
    ray = turning_ray(stage, arm, point, base, link)
    rate = stage.points[point] = stage.rate(base) + stage.about(link, arm)
    if len(others) >= 2:
        first, second = others[:2]
        stage.edges += [
            Edge(stage.points[other], rate, "image", f"{point}{other}", link) for other in (first, second)
        ]
        images = ", ".join(name.lower() for name in (first, second))
        return [f"△{point.lower()}{images.replace(', ', '')} ∼ △{point}{first}{second}"]
    stage.edges += ray.edges(rate)
    return [ray.equation(letter(stage), point)]


def _through_two(stage: ConstructionStage, group: TwoPointLink) -> list[str]:
    """Add the turning of a link two of whose points have their images; it has no equation."""
    place = stage.drawing.point
    arm = stage.drawing.arm(place(group.first), place(group.second), known=True)
    apart = stage.points[group.second] - stage.points[group.first]
    # apart = i w arm (and what is inwards), so the vector product with the arm over its square gives w alone
    stage.turns[group.link] = cross(arm, apart) / abs(arm) ** 2
    stage.bases[group.link] = group.first
    ends = stage.points[group.first], stage.points[group.second]
    stage.edges.append(Edge(*ends, "image", f"{group.second}{group.first}", group.link))
    return []


def _aim(stage: ConstructionStage, group: Aim) -> tuple[list[str], Triangle | None]:
    """RPR: the place of the link under the target turns about the pivot, and the target slides over it."""
    numbers, drawing = stage.drawing.numbers, stage.drawing
    # a wheel that touches a straight track aims as a guide does
    if group.contact is not None:
        track = numbers.gearing.track[group.contact.rolling]
        direction, guide = track.direction, group.contact.rolling  # type: ignore[union-attr]
    else:
        direction, guide = numbers.direction[group.guide], group.guide
    arm = drawing.arm(drawing.point(group.pivot), drawing.point(group.target))
    under = f"{group.target}′"
    # the place under the target is no point of the link: it has a dash, and an image of its own
    first = turning_ray(stage, arm, under, group.pivot, group.link)
    heading = drawing.heading(group.link, direction)
    second = carrying_ray(stage, group.link, group.target, heading, guide)
    rate, triangle = draw_crossing(stage, under, first, second)
    # both equations end in one place: in the drawing it is where they cross
    stage.hidden[under] = rate
    stage.bases[group.link] = group.pivot
    stage.turns[group.link] = stage.read(first.length(rate)) / abs(arm)
    if group.block is not None and group.sliding is not None:
        stage.bases[group.block] = group.target
        stage.turns[group.block] = stage.turns[group.link]
        # the block turns with the link that it slides on
        stage.points[group.sliding] = stage.point_rate(group.block, drawing.point(group.sliding))
    return [first.equation(letter(stage), under), second.equation(letter(stage), under)], triangle


def _meet(stage: ConstructionStage, group: Meet) -> tuple[list[str], Triangle | None]:
    """A dyad with one unknown image: its two equations meet there."""
    reference = group.points[0] if group.points else f"{ORIGIN}{group.carriage}"
    if group.carriage is not None and group.turning is not None:
        stage.turns[group.carriage] = _turn_of(stage, group.turning, group.carriage)
        stage.bases[group.carriage] = reference
    rays = [
        _ray_of_point(stage, ray_of(stage, locus, group.carriage), group, reference) for locus in group.loci
    ]
    rate, triangle = draw_crossing(stage, reference, *rays)
    (stage.points if group.points else stage.hidden)[reference] = rate
    # the first point is where the dyad meets; what else the carriage has follows as images
    for point in group.points[1:]:
        if group.carriage is not None:
            _image(stage, group.carriage, point)
    for locus, ray in zip(group.loci, rays, strict=True):
        # rods turn by the unknown parts, which are known only now
        if isinstance(locus, Rod):
            stage.bases[locus.link] = locus.centre
            stage.turns[locus.link] = stage.read(ray.length(rate)) / ray.arm
    # a drive's stop gives the rate outright: there is nothing to draw
    if group.has_stop:
        return [f"{letter(stage)}_{reference} = {_drive_words(rays)}"], None
    return [ray.equation(letter(stage), reference) for ray in rays], triangle


def _drive_words(rays: Sequence[Ray]) -> str:
    """Sentence on what a drive gives along its guide."""
    parts = [leg.text for ray in rays for leg in ray.legs if leg.kind == "driven"]
    return _("{part}, given by the drive").format(part=" + ".join(parts))


def _ray_of_point(stage: ConstructionStage, ray: Ray, group: Meet, reference: str) -> Ray:
    """The equation of another place of the carriage, as one of the point that is looked for."""
    # both equations have to end in one place of the carriage: that of the other is carried over
    place = stage.drawing.point(reference)
    if group.carriage is None or ray.at == place:
        return ray
    arm = stage.drawing.arm(ray.at, place, known=True)
    name = f"{reference}{ray.of}"
    shift = RayLeg("carried", stage.about(group.carriage, arm), name, f"{letter(stage)}_{name}")
    return replace(ray, legs=(*ray.legs, shift))


def draw_crossing(
    stage: ConstructionStage, name: str, first: Ray, second: Ray
) -> tuple[complex, Triangle | None]:
    """Where two equations meet, drawn; with the triangle of their directions, where it is one."""
    rate = meet(first.start, first.direction, second.start, second.direction)
    stage.edges += [*first.edges(rate), *second.edges(rate)]
    return rate, triangle_of(stage, name, first, second, rate)


def triangle_of(
    stage: ConstructionStage, name: str, first: Ray, second: Ray, rate: complex
) -> Triangle | None:
    """The triangle of two equations of velocity; None of accelerations, and where a side is missing."""
    if stage.order != 1:
        return None
    corners = (first.start, second.start, rate)
    sides = (abs(corners[1] - corners[0]), abs(rate - corners[0]), abs(rate - corners[1]))
    # a triangle with a side of rounding has no angles
    if min(sides) <= SMALL * max(sides):
        return None
    names = (_side(first, second), first.text.split(" ")[0], second.text.split(" ")[0])
    # angles opposite to the sides, in the order of the sides
    angles = tuple(
        _angle(corners[a] - corners[k], corners[b] - corners[k])
        for k, a, b in ((2, 0, 1), (1, 0, 2), (0, 1, 2))
    )
    return Triangle(names, sides, (angles[0], angles[1], angles[2]))


def _side(first: Ray, second: Ray) -> str:
    """The known side: the difference of what both equations begin with."""
    texts = [
        " + ".join(part for part in (ray.origin_text, *(leg.text.split(" ")[0] for leg in ray.legs)) if part)
        for ray in (second, first)
    ]
    known = [text for text in texts if text]
    return " − ".join(known) if len(known) == 2 else known[0] if known else "0"


def _angle(a: complex, b: complex) -> float:
    return math.atan2(abs(cross(a, b)), dot(a, b))


def _train(stage: ConstructionStage, group: Train) -> list[str]:
    """Links that gears turn together: angular velocities by their equations, then images one after the other."""
    stage.turns.update(train_rates(stage, group))
    equations = [line for equation in group.equations for line in wheel_equations(stage, equation)]
    for link, pivot in group.places:
        stage.bases[link] = pivot
        for point, bringing in group.brought:
            if bringing == link:
                equations += _image(stage, link, point)
    return equations
