"""Vector equations of a point: the parts of its velocity or acceleration that are known, and the direction of the last.

One equation for each locus on which a point of a group lies; two of them meet in its image.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from centrode.analysis.graphic.board import dot
from centrode.analysis.graphic.stage import Edge, Kind, Stage
from centrode.structure.constraints import FRAME
from centrode.structure.gearing import Round, Straight
from centrode.structure.groups import Locus, Rail, Rod, Rolloff, Slot, Stop, Stroke, Touch


@dataclass(frozen=True)
class Leg:
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
    legs: tuple[Leg, ...]
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
        place, found = self.origin, []
        for leg in self.legs:
            found.append(Edge(place, place + leg.vector, leg.kind, leg.name, self.link))
            place += leg.vector
        return [*found, Edge(place, end, self.kind, self.name, self.link)]

    def equation(self, letter: str, name: str) -> str:
        """The equation in symbols: v_B = v_A + v_BA (⊥ AB)."""
        parts = [self.origin_text, *(leg.text for leg in self.legs), self.text]
        return f"{letter}_{name} = {' + '.join(part for part in parts if part)}"


def letter(stage: Stage) -> str:
    """Symbol of what is constructed."""
    return "v" if stage.order == 1 else "a"


def told(stage: Stage, point: str) -> str:
    """Symbol of the rate of a point; nothing of one at rest."""
    return "" if stage.rate(point) == 0 else f"{letter(stage)}_{point}"


def around(stage: Stage, point: str, centre: str, link: str, known: bool = True) -> Ray:
    """A point on a circle about another one: known normal part, unknown part square to the arm."""
    drawing = stage.drawing
    arm = drawing.arm(drawing.point(centre), drawing.point(point), known)
    return turning(stage, arm, point, centre, link)


def turning(stage: Stage, arm: complex, point: str, centre: str, link: str) -> Ray:
    """What turns with a link about a point of it that is known, at the end of an arm."""
    symbol, name = letter(stage), f"{point}{centre}"
    legs: tuple[Leg, ...] = ()
    if stage.before is not None:
        legs = (Leg("normal", stage.inwards(link, arm), name, f"aⁿ_{name} (∥ {name})"),)
    kind: Kind = "relative" if stage.order == 1 else "tangential"
    text = f"{symbol if stage.order == 1 else 'aᵗ'}_{name} (⊥ {name})"
    return Ray(
        stage.rate(centre),
        told(stage, centre),
        legs,
        1j * arm / abs(arm),
        kind,
        name,
        text,
        stage.drawing.point(centre) + arm,
        point,
        abs(arm),
        link,
    )


def sliding(stage: Stage, on: str, at: complex, direction: complex, point: str, guide: str) -> Ray:
    """A point of the unknown that slides on a known body: the body's own rate there, Coriolis, along the guide."""
    velocity = 0j if stage.before is None else stage.before.points[point]
    return _along(stage, on, at, direction, velocity, point, guide)


def _along(
    stage: Stage, on: str, at: complex, direction: complex, velocity: complex, point: str, guide: str
) -> Ray:
    under = f"{point}′"
    legs: tuple[Leg, ...] = ()
    if stage.before is not None and on != FRAME and stage.before.turns[on] != 0.0:
        turned = stage.coriolis(on, at, velocity)
        legs = (Leg("coriolis", turned, f"{point}{under}", f"aᵏ_{point}{under}"),)
    origin = stage.carried(on, at)
    if on != FRAME:
        stage.hidden.setdefault(under, origin)
    text = f"{letter(stage)}ʳ_{point}{under if on != FRAME else ''} (∥ {guide})"
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


def carrying(stage: Stage, link: str, point: str, direction: complex, guide: str) -> Ray:
    """The place of an unknown link of known turning under a known point that slides on it."""
    at, under = stage.drawing.point(point), f"{point}′"
    legs: tuple[Leg, ...] = ()
    if stage.before is not None and stage.before.turns[link] != 0.0:
        turned = -stage.coriolis(link, at, stage.before.points[point])
        legs = (Leg("coriolis", turned, f"{under}{point}", f"aᵏ_{under}{point}"),)
    text = f"{letter(stage)}ʳ_{under}{point} (∥ {guide})"
    origin, name = stage.points[point], f"{under}{point}"
    return Ray(origin, told(stage, point), legs, direction, "sliding", name, text, at, under, link=link)


def ray_of(stage: Stage, locus: Locus, carriage: str | None) -> Ray:
    """The vector equation of a locus, for the place it is about."""
    drawing = stage.drawing
    numbers = drawing.numbers
    if isinstance(locus, Rod):
        return around(stage, locus.point, locus.centre, locus.link)
    if isinstance(locus, Stroke):
        return cylinder(stage, locus)
    if isinstance(locus, Rail):
        direction = drawing.heading(locus.on, numbers.direction[locus.guide])
        return sliding(stage, locus.on, drawing.point(locus.point), direction, locus.point, locus.guide)
    if isinstance(locus, Slot):
        direction = drawing.heading(carriage or "", numbers.direction[locus.guide])
        return carrying(stage, carriage or "", locus.point, direction, locus.guide)
    if isinstance(locus, Stop):
        direction = drawing.heading(locus.on, numbers.direction[locus.guide])
        ray = sliding(stage, locus.on, drawing.point(locus.point), direction, locus.point, locus.guide)
        return _driven(ray, stage.driven[locus.drive])
    return _of_wheel(stage, locus)


def _driven(ray: Ray, rate: float) -> Ray:
    """The equation of a point that is driven along the direction and free square to it."""
    driven = Leg("driven", rate * ray.direction, ray.name, ray.text)
    free = ray.text.replace("∥", "⊥")
    return replace(ray, legs=(*ray.legs, driven), direction=1j * ray.direction, text=free)


def cylinder(stage: Stage, locus: Stroke) -> Ray:
    """A point at the end of a cylinder: the stroke's rate along it, Coriolis, and unknown turning about its foot."""
    drawing, name = stage.drawing, f"{locus.point}{locus.centre}"
    arm = drawing.arm(drawing.point(locus.centre), drawing.point(locus.point), known=True)
    along, rate = arm / abs(arm), stage.driven[locus.drive]
    legs = [Leg("driven", rate * along, name, f"{letter(stage)}ʳ_{name} (∥ {name})")]
    if stage.before is not None:
        apart = stage.before.points[locus.point] - stage.before.points[locus.centre]
        spin = dot(1j * along, apart) / abs(arm)
        stretch = dot(along, apart)
        legs.insert(0, Leg("normal", -(spin**2) * arm, name, f"aⁿ_{name} (∥ {name})"))
        legs.append(Leg("coriolis", 2j * spin * stretch * along, name, f"aᵏ_{name} (⊥ {name})"))
    text = f"{letter(stage) if stage.order == 1 else 'aᵗ'}_{name} (⊥ {name})"
    kind: Kind = "relative" if stage.order == 1 else "tangential"
    origin = stage.points[locus.centre]
    at = drawing.point(locus.point)
    first = told(stage, locus.centre)
    return Ray(origin, first, tuple(legs), 1j * along, kind, name, text, at, locus.point, abs(arm))


def _of_wheel(stage: Stage, locus: Touch | Rolloff) -> Ray:
    """A wheel's centre beside or about its track, or a track that is carried past a known wheel."""
    drawing = stage.drawing
    contact = locus.contact if isinstance(locus, Touch) else locus.rolling
    track = drawing.numbers.gearing.track[contact.rolling]
    if isinstance(track, Round):
        return _about_track(stage, locus, contact.on, track)
    assert isinstance(track, Straight)
    direction = drawing.heading(contact.on, track.direction)
    if locus.carried:
        ray = carrying(stage, contact.on, locus.point, direction, contact.rolling)
    else:
        at = drawing.point(locus.point)
        ray = sliding(stage, contact.on, at, direction, locus.point, contact.rolling)
    if isinstance(locus, Touch):
        return ray
    # rolling: the centre goes back along the track by the radius times the wheel's turn against it
    turn = stage.turns[contact.link] - stage.turns[contact.on]
    way = -turn * drawing.numbers.gearing.radius[contact.rolling]
    return _driven(ray, -way if locus.carried else way)


def _about_track(stage: Stage, locus: Touch | Rolloff, on: str, track: Round) -> Ray:
    """A circle about the centre of a round track: the distance of the two centres turns as a rod would."""
    drawing, wheel = stage.drawing, locus.point
    centre = drawing.inside(on, track.centre)
    arm = drawing.arm(centre, drawing.point(wheel))
    sense = -1.0 if locus.carried else 1.0
    origin = stage.points[wheel] if locus.carried else stage.carried(on, centre)
    name = f"{wheel}K"
    legs: tuple[Leg, ...] = ()
    if stage.before is not None:
        apart = stage.before.points[wheel] - stage.before.carried(on, centre)
        spin = dot(1j * arm, apart) / abs(arm) ** 2
        legs = (Leg("normal", -(spin**2) * sense * arm, name, f"aⁿ_{name} (∥ {name})"),)
    kind: Kind = "relative" if stage.order == 1 else "tangential"
    text = f"{letter(stage) if stage.order == 1 else 'aᵗ'}_{name} (⊥ {name})"
    first = told(stage, wheel) if locus.carried else ("" if on == FRAME else f"{letter(stage)}_K")
    place = centre if locus.carried else drawing.point(wheel)
    of = "K" if locus.carried else wheel
    return Ray(origin, first, legs, 1j * arm / abs(arm), kind, name, text, place, of)
