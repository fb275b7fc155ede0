"""The profile of a cam with a follower: what the terminal, the files, the figures and the document show."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.closed_forms import TURN, ClosedForms
from centrode.cams.followers.geometry import Face, Oscillating
from centrode.cams.followers.motion_results import ROUNDED
from centrode.cams.followers.profile_results import (
    instant_centre_difference,
    is_never_undercut,
    profile_difference,
)
from centrode.quantities import QUANTITIES
from centrode.sheets.outlines import (
    DrawnBaseCircle,
    DrawnFollower,
    DrawnLines,
    DrawnTurning,
    LineUse,
    MarkedPlaces,
    OutlineDrawing,
    OutlineSet,
    Shape,
)
from centrode.sheets.players import CamPlayer
from centrode.sheets.plots import AxisLabel, Curve, SpanPanel, SpanPlot
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Deferred,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Paragraph,
    Scalar,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Symbol, Text, Title
from centrode.views.columns import columns_of
from centrode.views.follower_formulas import FollowerFormulas, length
from centrode.views.followers import angle, course

if TYPE_CHECKING:
    import xarray as xr

    from centrode.cams.followers.geometry import FollowerCam
    from centrode.cams.followers.profile_results import FollowerProfileResults
    from centrode.cams.profiles import Undercut

Array = np.ndarray

LAYERS: Mapping[str, Text] = {
    "path": Sentence("path of the roller's centre"),
    "profile": Sentence("profile of the cam"),
    "cutter": Sentence("path of the cutter's centre"),
}
MOST_BENT = 4.0
"""Radii of curvature are shown up to so many base radii: where the profile is straight they are infinite."""
NORMALS, NORMAL = 36, 0.18
"""Normals over the turn, and the length of one where there is no roller, over the base radius."""
MOST_MARKS, BESIDE = 16, 0.08
"""Joints of segments that are named at most, and how far a name stands from its joint, over the size of the cam."""
ARROW = 0.3
"""Radius of the arrow that shows how the cam turns, over the base radius."""
HINGE = 0.016
"""Radius of a hinge's circle over the size of the cam."""
GUIDE, BELOW, ABOVE = 11.0, 2.0, 4.0
"""Length of a guide, and of what is between it and the highest place below, and of the stem above it, in hinges."""
OVER = 0.12
"""How far a face goes on beyond the contact, over the base radius."""


def sheet(results: FollowerProfileResults) -> Sheet:
    """Everything there is to say about the profile of a cam with a follower."""
    title = Title(results.cam.title)
    motion = Section(NOTHING, (CamPlayer(title, results.body),))
    return Sheet(
        heading=Sentence("Profile of the cam"),
        facts=tuple(_facts(results)),
        scalars=_scalars(results),
        tables=Deferred(
            {"cam-profile": lambda: _table(results.dataset), "cam-points": lambda: _table(results.points)}
        ),
        datasets={"cam-profile": results.dataset, "cam-points": results.points},
        pictures=Deferred({"cam-curvature": lambda: _curves(results), "cam-body": lambda: _drawing(results)}),
        chapters=Deferred(
            {
                "motion": lambda: Chapter(Sentence("Motion"), (motion,)),
                "profile": lambda: _chapter(results),
            }
        ),
        outlines={"cam-profile": OutlineSet(title, results.outlines)},
    )


# Facts


def _facts(results: FollowerProfileResults) -> Iterator[Fact]:
    """Sizes, pressure angle, curvature, undercut, contact along a face, cutter and points."""
    cam, body = results.cam, results.body
    radius: Text = length(body.base_radius)
    if cam.body.base_radius is None:
        radius = Sentence("{radius}, the least that the bounds admit", radius=radius)
    yield Fact(Sentence("base radius"), radius)
    yield Fact(Sentence("greatest radius"), Number(results.greatest_radius, "m", digits=".5g"))
    yield Fact(Sentence("pressure angle"), _pressure(body))
    yield from _curvature(body)
    yield from _undercut(body)
    if isinstance(body.touch, Face):
        yield Fact(Sentence("contact on the face"), _contact(body))
    if cam.tool is not None:
        radius, most = length(cam.tool.radius), body.greatest_cutter[0]
        text = Sentence("radius {radius}", radius=radius)
        if math.isfinite(most):
            text = Sentence("radius {radius}, at most {most}", radius=radius, most=length(most))
        yield Fact(Sentence("cutter"), text)
    tolerance = Number(cam.study.chord_tolerance, "m", digits=".3g")
    count = Number(results.points.sizes["sample"], digits="d")
    yield Fact(
        Sentence("points"), Sentence("{count}, chords within {tolerance}", count=count, tolerance=tolerance)
    )


def _pressure(body: FollowerCam) -> Text:
    if not ClosedForms(body).has_pressure_angle:
        return Sentence("{zero}: the face is perpendicular to its motion", zero=angle(0.0))
    pressure = body.pressure
    return Sentence(
        "{least} at {at_least} to {greatest} at {at_greatest}",
        least=angle(pressure.least),
        at_least=angle(pressure.at_least),
        greatest=angle(pressure.greatest),
        at_greatest=angle(pressure.at_greatest),
    )


def _curvature(body: FollowerCam) -> Iterator[Fact]:
    """The least radii of curvature where the profile bulges and where it is hollow."""
    (bend, place), (hollow, there) = body.least_bend, body.greatest_cutter
    label: Text = Sentence("radius of curvature of the profile")
    if math.isfinite(bend):
        text = Sentence("from {radius} where it is convex, at {at}", radius=length(bend), at=angle(place))
        if bend <= 0.0:
            text = Sentence(
                "from {radius} where it is undercut, at {at}", radius=length(bend), at=angle(place)
            )
        yield Fact(label, text)
        label = NOTHING
    if 0.0 < hollow < math.inf:
        yield Fact(
            label,
            Sentence("from {radius} where it is hollow, at {at}", radius=length(hollow), at=angle(there)),
        )


def _undercut(body: FollowerCam) -> Iterator[Fact]:
    """What the follower cuts away, what a roller overlaps, how great a roller may be."""
    cut = Sentence("at {stretches}", stretches=_stretches(body.undercuts))
    yield Fact(Sentence("undercut"), cut if body.undercuts else Sentence("none"))
    depth, place = body.overlap
    if depth and not body.undercuts:
        text = Sentence(
            "at {place} the roller cuts into the cam by {depth} across a narrow part",
            place=angle(place),
            depth=Number(depth, "m", digits=".3g"),
        )
        yield Fact(Sentence("overlap"), text)
    most, _place = body.greatest_roller
    if 0.0 < body.touch.roller < math.inf and 0.0 < most < math.inf:
        text = Sentence("below {radius} on this path of its centre", radius=length(most))
        yield Fact(Sentence("greatest roller"), text)


def _stretches(undercuts: list[Undercut]) -> Text:
    """Stretches of the angle of the cam, and corners."""
    return Joined(
        tuple(
            Sentence(
                "{first} to {last}",
                first=replace(_degrees(one.start), unit_hidden=True),
                last=_degrees(one.stop),
            )
            if one.start < one.stop
            else _degrees(one.start)
            for one in undercuts
        )
    )


def _degrees(place: float) -> Number:
    """An angle of the cam [rad] in degrees, whatever the display."""
    return Number(math.degrees(place), "deg", unit_fixed=True)


def _contact(body: FollowerCam) -> Text:
    """Where the cam touches a flat face, and how wide that is."""
    least, greatest = body.face.least, body.face.greatest
    sizes = {"least": length(least), "greatest": length(greatest), "width": length(greatest - least)}
    if isinstance(body.guide, Oscillating):
        return Sentence("{least} to {greatest} from the pivot, {width} wide", **sizes)
    return Sentence("{least} to {greatest} from the follower's axis, {width} wide", **sizes)


def _scalars(results: FollowerProfileResults) -> dict[str, Scalar]:
    """Numbers of the profile; what has no bound is left out."""
    body = results.body
    scalars = {
        "cam_base_radius": Scalar(body.base_radius, "m"),
        "cam_profile_greatest_radius": Scalar(results.greatest_radius, "m"),
        "cam_undercuts": Scalar(len(body.undercuts), "1"),
        "cam_overlap": Scalar(body.overlap[0], "m"),
    }
    placed = {
        "greatest_pressure_angle": (*_steepest(body), "rad"),
        "least_bend": (*body.least_bend, "m"),
    }
    if isinstance(body.touch, Face):
        scalars["cam_face_from"] = Scalar(body.face.least, "m")
        scalars["cam_face_to"] = Scalar(body.face.greatest, "m")
    else:
        placed["greatest_roller"] = (*body.greatest_roller, "m")
        placed["greatest_cutter"] = (*body.greatest_cutter, "m")
    for name, (value, place, unit) in placed.items():
        if math.isfinite(value):
            scalars[f"cam_{name}"] = Scalar(value, unit)
            scalars[f"cam_{name}_at"] = Scalar(place, "rad")
    return scalars


def _steepest(body: FollowerCam) -> tuple[float, float]:
    """The greatest size of the pressure angle [rad], and where [rad]."""
    pressure = body.pressure
    if -pressure.least >= pressure.greatest:
        return abs(pressure.least), pressure.at_least
    return abs(pressure.greatest), pressure.at_greatest


def _table(dataset: xr.Dataset) -> Table:
    """All variables of a dataset, one column for each axis of places, one row a sample."""
    return Table(
        tuple(
            Column(header, _texts(values) if values.dtype.kind == "U" else values.values, unit)
            for name, variable in dataset.data_vars.items()
            for header, unit, values in columns_of(variable, str(name))
        )
    )


def _texts(values: xr.DataArray) -> tuple[Text, ...]:
    return tuple(map(Name, values.values.tolist()))


# Figures


def _curves(results: FollowerProfileResults) -> SpanPlot:
    """Pressure angle and radius of curvature over a turn, with what is admissible."""
    cam, dataset = results.cam, results.dataset
    steep, back = cam.bounds.pressure_angle, cam.bounds.return_pressure_angle or cam.bounds.pressure_angle
    panels = []
    if ClosedForms(results.body).has_pressure_angle:
        panels.append(_panel(dataset, "cam_pressure_angle", steep, None if back is None else -back))
    panels.append(_panel(dataset, "profile_bend", cam.bounds.curvature_radius))
    if "face_place" in dataset:
        panels.append(_panel(dataset, "face_place"))
    ends = np.cumsum([0.0, *(segment.angle for segment in cam.segments)]).tolist()
    return SpanPlot(
        Sentence("Pressure angle and curvature of the cam"),
        Title(cam.title),
        AxisLabel(Sentence("angle of the cam"), Symbol("φ"), "rad"),
        dataset["cam_angle"].values,
        tuple(ends),
        (),
        tuple(panels),
    )


def _panel(dataset: xr.Dataset, name: str, *bounds: float | None) -> SpanPanel:
    quantity, values = QUANTITIES[name], dataset[name].values
    if name == "profile_bend":
        # beyond is a gap, as between opposite signs of a radius that passes infinity
        values = np.where(np.abs(values) <= MOST_BENT * dataset.attrs["base_radius"], values, math.nan)
    heading = Sentence(quantity.long_name)
    return SpanPanel(
        AxisLabel(symbol=Symbol(quantity.symbol), unit=quantity.unit),
        (Curve(heading, values, 0),),
        bounds=tuple(bound for bound in bounds if bound is not None),
        heading=heading,
        # a face is touched far from the pivot about which it turns
        zero_line=name != "face_place" or bool(np.nanmin(values) < 0.0),
    )


def _drawing(results: FollowerProfileResults) -> OutlineDrawing:
    """The cam in its axes with the follower at the beginning of the turn."""
    body = results.body
    start = Number(0.0, "deg", unit_fixed=True)
    return OutlineDrawing(
        Sentence("Profile of the cam, and its follower at {start}", start=start),
        Title(results.cam.title),
        results.outlines,
        LAYERS,
        (
            DrawnBaseCircle(Sentence("base circle"), body.base_radius),
            _normals(body),
            _joints(body),
            *_follower(body),
            *_undercut_lines(body),
            DrawnTurning(ARROW * body.base_radius, body.sense),
        ),
        Sentence("centre of the cam"),
    )


def _normals(body: FollowerCam) -> DrawnLines:
    """From the profile to the roller's centre, else a piece of the same length all round."""
    roller = body.touch.roller
    size = roller if 0.0 < roller < math.inf else NORMAL * body.base_radius
    contact = body.contact(body.edges[-1] * np.arange(NORMALS) / NORMALS)
    lines = np.stack([contact.place, contact.place + size * contact.normal], axis=1)
    return DrawnLines(LineUse.NORMAL, Sentence("normals"), tuple(lines))


def _joints(body: FollowerCam) -> MarkedPlaces:
    """Contacts where segments meet, with the angle of the cam inside the profile."""
    joints = np.array(getattr(body.motion, "joints", body.edges)[:-1][:MOST_MARKS])
    contact = body.contact(joints)
    away = BESIDE * float(np.ptp(contact.place, axis=0).max() + body.base_radius)
    return MarkedPlaces(
        Sentence("segments meet: angle of the cam"),
        contact.place,
        tuple(Number(math.degrees(joint), "deg", ".4g", unit_fixed=True) for joint in joints),
        contact.place - away * contact.normal,
    )


def _follower(body: FollowerCam) -> Iterator[Shape]:
    """The follower as it stands at the beginning of a turn: roller, edge or face, guide or pivot."""
    guide, flat = body.guide, isinstance(body.touch, Face)
    turn = np.linspace(0.0, body.edges[-1], 73)
    hinge = HINGE * float(np.ptp(body.contact(turn).place, axis=0).max())
    tip = body.contact(np.zeros(1)).centre[0]
    roller = 0.0 if flat else body.touch.roller
    beyond = OVER * body.base_radius
    lines: tuple[Array, ...]
    if isinstance(guide, Oscillating):
        pivot = np.array([guide.distance, 0.0])
        lines = (np.stack([pivot, tip]),)
        if flat:
            normal = np.array([math.sin(guide.start), math.cos(guide.start)])
            foot = pivot - guide.face_offset * normal
            along = np.array([-normal[1], normal[0]])
            lines = (np.stack([pivot, foot, foot + (body.face.greatest + beyond) * along]),)
        yield DrawnLines(LineUse.FOLLOWER, Sentence("follower"), lines)
        yield DrawnFollower(hinge, pivot=pivot, tip=None if flat else tip, roller=roller)
        return
    foot = np.array([guide.offset, guide.start]) if flat else tip
    up = np.array([0.0, 1.0])
    # the guide stands above the highest place
    lift = float(np.max(body.motion.lift(np.linspace(0.0, body.edges[-1], 721))[0]))
    low = foot + (lift + roller + BELOW * hinge) * up
    walls = np.stack([low, low + GUIDE * hinge * up])
    lines = (np.stack([foot, walls[1] + ABOVE * hinge * up]),)
    if flat:
        ends = body.face.least - beyond, body.face.greatest + beyond
        lines = (*lines, foot + np.array([[end, 0.0] for end in ends]))
    yield DrawnLines(LineUse.FOLLOWER, Sentence("follower"), lines)
    yield DrawnLines(LineUse.AXIS, NOTHING, (np.array([[foot[0], 0.0], foot]),))
    yield DrawnFollower(hinge, walls=walls, tip=None if flat else tip, roller=roller)


def _undercut_lines(body: FollowerCam) -> Iterator[DrawnLines]:
    """Stretches that run back, and corners that are cut away."""
    lines: list[Array] = []
    for one in body.undercuts:
        if one.stop == one.start:
            lines.append(body.contact(np.array([one.start])).place)
        for turn in (0.0, math.tau):
            start, stop = one.start - turn, one.stop - turn
            cuts = [start, *(edge for edge in body.edges if start < edge < stop), stop]
            for low, high in pairwise(cuts):
                first, last = max(low, body.edges[0]), min(high, body.edges[-1])
                if first < last:
                    lines.append(body.contact(np.linspace(first, np.nextafter(last, first), 200)).place)
    if lines:
        yield DrawnLines(LineUse.UNDERCUT, Sentence("undercut"), tuple(lines))


# Chapter


def _name_of_curves(results: FollowerProfileResults) -> Sentence:
    """What the curves over a turn show: under a flat face that only translates no pressure angle changes."""
    if ClosedForms(results.body).has_pressure_angle:
        return Sentence("Pressure angle and curvature over a turn")
    return Sentence("Curvature of the profile and place of the contact over a turn")


def _chapter(results: FollowerProfileResults) -> Chapter:
    """Formulas of the profile, its sizes, points and drawings."""
    drawings = (
        Illustration("cam-body", Sentence("The cam in its axes, with its follower at $phi = 0$")),
        Illustration("cam-curvature", _name_of_curves(results)),
    )
    sections = (
        Section(NOTHING, (*_formulas(results), *_second_routes(results.body))),
        Section(Sentence("Sizes"), (FactTable(tuple(_facts(results))), _undercut_check(results.body))),
        Section(Sentence("Points of the profile"), (_course(results),)),
        Section(Sentence("Drawings"), drawings),
    )
    return Chapter(Sentence("Profile of the cam"), sections)


def _formulas(results: FollowerProfileResults) -> Iterator[Block]:
    """Where the profile is, in letters, and one point with its numbers."""
    formulas = FollowerFormulas(results.body, results.shown)
    yield Paragraph(
        Sentence(
            "In the axes of the cam, which coincide with those of the frame at $phi = 0$, the follower moves "
            "round the cam opposite to the cam's rotation (kinematic inversion); the profile is the envelope of "
            "its positions."
        )
    )
    letters = [line[:2] for line in formulas.start()]
    rates = [line for line in formulas.radius() if line[0] in ("u_x", "u_y", "w_x", "w_y")]
    if not formulas.forms.flat:
        letters += [line[:2] for line in rates if line[0] in ("u_x", "u_y")]
        yield Paragraph(
            Sentence(
                "$(u_x; u_y)$ is the velocity coefficient of the roller's centre (the edge) relative to the cam, "
                "$(x_P; y_P)$ the contact point, both in the axes of the frame:"
            )
        )
    yield Formula((*letters, *formulas.aids(), *(line[:2] for line in formulas.place())))
    place = Number(results.shown, "rad", digits="")
    example = {
        "choice": Sentence("For example at the chosen angle, $phi$ = {angle}:", angle=place),
        "pressure angle": Sentence(
            "For example where the pressure angle is greatest, at $phi$ = {angle}:", angle=place
        ),
        "velocity": Sentence("For example where the velocity is greatest, at $phi$ = {angle}:", angle=place),
    }
    yield Paragraph(example[results.shown_by])
    # what has been in letters above has numbers alone here
    radius = [(line[0], line[-1]) if line in rates else line for line in formulas.radius()]
    point = [(line[0], line[-1]) for line in formulas.place()]
    yield Formula((*formulas.start(), *formulas.lift(), *formulas.pressure(), *radius, *point))


def _second_routes(body: FollowerCam) -> Iterator[Check]:
    """Points by the closed forms and by the instant centre against those of the envelope."""
    text = Sentence(
        "At {count} angles the formulas give the points of the envelope of the follower's positions, within "
        "{share} of $r_0$.",
        count=Number(len(TURN)),
    )
    yield Check(text, profile_difference(body), body.base_radius, ROUNDED)
    text = Sentence(
        "The normal through the instant centre of cam and follower on the line of their axes gives the same "
        "points, within {share} of $r_0$."
    )
    yield Check(text, instant_centre_difference(body), body.base_radius, ROUNDED)


def _undercut_check(body: FollowerCam) -> Check:
    """Whether the follower cuts the profile away."""
    if body.undercuts:
        text = Sentence(
            "The profile is undercut at {stretches}: there the law of the lift is not reproduced.",
            stretches=_stretches(body.undercuts),
        )
        return Check(text, 1.0, 1.0, 0.0)
    count = Number(len(TURN))
    text = Sentence("The profile is not undercut: at {count} angles $1 - r K$ stays positive.", count=count)
    if ClosedForms(body).flat:
        text = Sentence(
            "The profile is not undercut: at {count} angles the formula of $R$ stays positive.", count=count
        )
    return Check(text, 0.0 if is_never_undercut(body) else 1.0, 1.0, 0.0)


def _course(results: FollowerProfileResults) -> Table:
    """Points of the profile in both kinds of coordinates."""
    dataset = results.dataset
    dataset = dataset.assign({axis: dataset["profile"].sel(axis=axis) for axis in ("x", "y")})
    columns = [("x", "x"), ("y", "y"), ("profile_radius", "rho"), ("profile_angle", "chi")]
    if ClosedForms(results.body).has_pressure_angle:
        columns.append(("cam_pressure_angle", "alpha"))
    columns.append(("profile_bend", "R"))
    caption = Sentence(
        "Points of the profile in the axes of the cam, in polar form with the angle $chi$ from $y$ towards $x$, and the"
        " radius of curvature, negative where the profile is hollow"
    )
    return course(dataset, columns, caption)
