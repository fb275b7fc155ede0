"""The profile of a cam by a curvature law: how it closes, what its return arc keeps, undercut, its outlines."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.profiles import cam_outlines
from centrode.cams.roller_path import frames
from centrode.sheets.outlines import (
    DrawnLines,
    DrawnRollers,
    LineUse,
    OutlineDrawing,
    OutlineSet,
    Shape,
)
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Deferred,
    Fact,
    FactTable,
    Failure,
    Formula,
    Paragraph,
    Scalar,
    Section,
    Sheet,
    illustrations,
)
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Text, Title, Unit
from centrode.views.curvature_cams import ROUNDED, angle, carrier_table, course, shortfall

if TYPE_CHECKING:
    from centrode.cams.profiles import ProfileBody, Undercut
    from centrode.cams.results import CamProfileResults

SAMPLES = 720
"""Spaces between the points of an outline over a turn."""
NORMALS = 24
"""Normals over the turn."""
MOST_ROLLERS = 12
PLACES = 200
"""Points of a stretch that is cut away."""
LAYERS = {
    "path": Sentence("path of the roller's centre"),
    "profile-working": Sentence("profile, working arc"),
    "profile-return": Sentence("profile, return arc"),
    "groove-working": Sentence("outer wall, working arc"),
    "groove-return": Sentence("outer wall, return arc"),
}


def sheet(results: CamProfileResults) -> Sheet:
    """Everything there is to say about the profile of a cam."""
    heading, body = Sentence("Profile of the cam"), results.body
    chapters = Deferred({"profile": lambda: _chapter(results)})
    if body is None or results.dataset is None:
        return Sheet(heading=heading, facts=_facts(results), chapters=chapters, failure=_failure(results))
    dataset = results.dataset
    variables = [str(name) for name in dataset.data_vars if name != "carrier_angle"]
    return Sheet(
        heading=heading,
        facts=_facts(results),
        scalars=_scalars(body),
        tables=Deferred({"cam-profile": lambda: carrier_table(dataset, variables)}),
        datasets={"cam-profile": dataset},
        pictures=Deferred({"cam-body": lambda: _drawing(results, body)}),
        chapters=chapters,
        outlines=Deferred({"cam-profile": lambda: _outlines(results, body)}),
    )


# Facts and numbers


def _facts(results: CamProfileResults) -> tuple[Fact, ...]:
    body = results.body
    if body is None:
        return (Fact(Sentence("return arc"), Sentence("none")),)
    roller = Sentence("radius {radius}", radius=Number(body.roller, "m"))
    return (Fact(Sentence("roller"), roller), *_closing(body), *_bends(body))


def _closing(body: ProfileBody) -> Iterator[Fact]:
    """The working arc, the return arc, and how they join."""
    working, closure = body.closed.arcs[0], Sentence("closure")
    ends = Sentence("{first} to {last}", first=angle(working.start), last=angle(working.stop))
    yield Fact(Sentence("working arc"), ends)
    if not body.closed.whole:
        yield Fact(closure, Sentence("open: give [return] or [mover] to close it"))
        return
    returned = body.returned
    if returned is None:
        yield Fact(closure, _kinks(body))
        return
    way = Sentence("the smoothest within the bounds")
    if not returned.additions:
        way = Sentence("the smoothest, without active bounds")
    shape = Sentence("convex")
    if returned.curvature.least < 0.0:
        hollow = Number(-1.0 / returned.curvature.least, "m")
        shape = Sentence("hollow with a radius from {radius}", radius=hollow)
    yield Fact(Sentence("return arc"), Joined((way, shape)))
    size = Sentence(
        "ρ {least} to {greatest}, radius of curvature from {bend}, pressure angle up to {steepest}",
        least=Number(returned.radius.least, "m"),
        greatest=Number(returned.radius.greatest, "m"),
        bend=Number(1.0 / returned.curvature.greatest, "m"),
        steepest=angle(max(-returned.pressure_angle.least, returned.pressure_angle.greatest), ".5g"),
    )
    yield Fact(NOTHING, size)
    joined = Sentence(
        "joined in value, slope and curvature: gap {gap}, kink {kink}, curvature {jump}",
        gap=Number(_greatest_gap(body), "m", ".1g", unit_fixed=True),
        kink=Number(body.closed.greatest_kink, "rad", ".1g", unit_fixed=True),
        jump=Number(body.greatest_jump, digits=".1g"),
    )
    yield Fact(NOTHING, joined)


def _greatest_gap(body: ProfileBody) -> float:
    """The greatest step of the path [m] from one arc to the next."""
    return float(max(abs(joint.gap) for joint in body.closed.joints))


def _kinks(body: ProfileBody) -> Text:
    """How a path closes that was not designed to."""
    if not body.kinks:
        return Sentence("closed without a kink")
    places = Joined([_bare(math.remainder(joint.at, math.tau)) for joint in body.kinks])
    worst = max(body.kinks, key=lambda joint: abs(joint.kink)).kink
    kink, unit = angle(abs(worst)), Unit("rad", shown=True)
    if worst > 0:
        return Sentence("kinks of {kink} inwards at {places} {unit}", kink=kink, places=places, unit=unit)
    return Sentence("kinks of {kink} outwards at {places} {unit}", kink=kink, places=places, unit=unit)


def _bare(value: float) -> Number:
    """An angle [rad] without its unit."""
    return Number(value, "rad", unit_hidden=True)


def _bends(body: ProfileBody) -> Iterator[Fact]:
    """Undercut, and the roller that would be too large."""
    most, at = body.greatest_roller
    if math.isfinite(most):
        bend = Sentence(
            "from {radius} where it is convex, at {at}", radius=Number(most - body.roller, "m"), at=angle(at)
        )
        yield Fact(Sentence("radius of curvature of the profile"), bend)
        below = Sentence("below {radius}", radius=Number(most, "m"))
        yield Fact(Sentence("greatest roller"), below)
    if body.undercuts:
        stretches, unit = Joined([_stretch(cut) for cut in body.undercuts]), Unit("rad", shown=True)
        text = Sentence("from {stretches} {unit}", stretches=stretches, unit=unit)
        yield Fact(Sentence("undercut"), text)
        return
    yield Fact(Sentence("undercut"), Sentence("none"))
    depth, place = body.overlap
    if depth:
        across = Sentence(
            "at {place} the roller cuts into the cam by {depth} across a narrow part",
            place=angle(place),
            depth=Number(depth, "m", ".3g"),
        )
        yield Fact(Sentence("overlap"), across)


def _stretch(cut: Undercut) -> Sentence:
    start = math.remainder(cut.start, math.tau)
    return Sentence("{first} to {last}", first=_bare(start), last=_bare(start + cut.stop - cut.start))


def _scalars(body: ProfileBody) -> dict[str, Scalar]:
    most, at = body.greatest_roller
    scalars = {
        "cam_closed": Scalar(int(body.closed.whole), "1"),
        "cam_kink": Scalar(body.closed.greatest_kink, "rad"),
        "cam_undercuts": Scalar(len(body.undercuts), "1"),
        "cam_overlap": Scalar(body.overlap[0], "m"),
    }
    if math.isfinite(most):
        scalars["cam_greatest_roller"] = Scalar(most, "m")
        scalars["cam_greatest_roller_at"] = Scalar(at, "rad")
    if body.returned is not None:
        scalars["cam_return_least_radius"] = Scalar(body.returned.radius.least, "m")
        scalars["cam_return_greatest_radius"] = Scalar(body.returned.radius.greatest, "m")
    return scalars


def _failure(results: CamProfileResults) -> Failure | None:
    if results.refusal is None:
        return None
    return Failure(Name(results.refusal.what), Name(results.refusal.repair))


# Outlines and drawing


def _outlines(results: CamProfileResults, body: ProfileBody) -> OutlineSet:
    return OutlineSet(Title(results.cam.title), tuple(cam_outlines(body, SAMPLES, groove=results.groove)))


def _drawing(results: CamProfileResults, body: ProfileBody) -> OutlineDrawing:
    """The cam in its axes: phi = 0 is up, phi grows clockwise."""
    return OutlineDrawing(
        Sentence("Profile of the cam"),
        Title(results.cam.title),
        _outlines(results, body).pieces,
        LAYERS,
        tuple(_shapes(results, body)),
        Sentence("centre of the cam"),
    )


def _shapes(results: CamProfileResults, body: ProfileBody) -> Iterator[Shape]:
    """Normals of the profile through the roller's centre, rollers at the joints, what is cut away."""
    frame = frames(body.closed, body.closed.start + math.tau * np.arange(NORMALS) / NORMALS)
    feet = frame.place - body.roller * frame.normal
    tips = frame.place + body.roller * frame.normal if results.groove else frame.place
    yield DrawnLines(LineUse.NORMAL, Sentence("normals"), tuple(np.stack([feet, tips], axis=1)))
    joints = _joints(body)
    texts = tuple(
        Number(math.degrees(math.remainder(at, math.tau)), "deg", ".4g", unit_fixed=True) for at in joints
    )
    centres = frames(body.closed, np.array(joints)).place
    yield DrawnRollers(Sentence("roller at the joints"), body.roller, centres, texts)
    if body.undercuts:
        lines = (body.profile(np.linspace(cut.start, cut.stop, PLACES)).place for cut in body.undercuts)
        yield DrawnLines(LineUse.UNDERCUT, Sentence("undercut"), tuple(lines))


def _joints(body: ProfileBody) -> list[float]:
    """Ends of the working arc and kinks [rad]."""
    arcs = body.closed.arcs
    ends = {arcs[0].stop, body.closed.stop} if len(arcs) > 1 else {body.closed.stop}
    return sorted({joint.at for joint in body.kinks} | ends)[:MOST_ROLLERS]


# Chapter


def _chapter(results: CamProfileResults) -> Chapter:
    """The profile that the roller leaves, how it closes, undercut."""
    text = Sentence(
        "The profile is the inner parallel curve of the roller's path at the distance $r$, the radius of the "
        "roller; the return arc joins the working arc with equal value, slope and curvature."
    )
    equations = Formula(
        (("x", "rho sin phi - r sin psi"), ("y", "rho cos phi - r cos psi"), ("psi", "phi - gamma"))
    )
    blocks: list[Block] = [
        Paragraph(text),
        equations,
        FactTable(_facts(results)),
        *shortfall(_failure(results)),
    ]
    body, dataset = results.body, results.dataset
    sections = []
    if body is not None and dataset is not None:
        if body.returned is not None:
            blocks += _joining(body, body.returned.radius.greatest)
        columns = [("profile_radius", "R"), ("profile_angle", "alpha"), ("cam_pressure_angle", "gamma")]
        table = course(dataset, columns, Sentence("The profile in polar coordinates"))
        caption = Sentence("The cam with its roller and the path of the roller's centre")
        sections = [
            Section(Sentence("Coordinates"), (table,)),
            illustrations(["cam-body"], {"cam-body": caption}),
        ]
    return Chapter(Sentence("Profile of the cam"), (Section(NOTHING, tuple(blocks)), *sections))


def _joining(body: ProfileBody, size: float) -> Iterator[Check]:
    """The designed arc meets the working one in its place and its direction."""
    yield Check(
        Sentence("The arcs join: the gap is {share} of the radius."), _greatest_gap(body), size, ROUNDED
    )
    smooth = Sentence("They join without a kink, within {share} rad.")
    yield Check(smooth, body.closed.greatest_kink, 1.0, ROUNDED)
