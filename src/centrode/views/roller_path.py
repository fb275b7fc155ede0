"""The path of a cam's roller: what the terminal, the files, the figures and the document show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.roller_path import ends_of
from centrode.quantities import QUANTITIES
from centrode.sheets.outlines import OutlineRay, PathDrawing
from centrode.sheets.plots import AxisLabel, Curve, CurvePanel, Plot
from centrode.sheets.sheet import (
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
from centrode.sheets.texts import (
    NOTHING,
    Expression,
    Joined,
    Name,
    Number,
    Sentence,
    Symbol,
    Text,
    Title,
    Unit,
)
from centrode.views.curvature_cams import (
    ROUNDED,
    angle,
    carrier_table,
    course,
    on_both_sides,
    over_carrier,
    shortfall,
    stress,
)

if TYPE_CHECKING:
    from centrode.cams.cam import RollerPathResults
    from centrode.model.cam import Cam

VARIABLES = (
    "path_radius",
    "path_radius_slope",
    "path_radius_second",
    "cam_pressure_angle",
    "pressure_sine",
    "pressure_sine_slope",
    "pressure_sine_second",
    "pressure_cosine",
    "law_curvature",
    "law_curvature_slope",
    "drawn_curvature",
    "roller_centre",
)
DRAWN = ("path_radius", "cam_pressure_angle", "law_curvature")
RAYS = 15.0
"""Degrees between the rays of the path's drawing."""
NORMAL = 0.5
"""Length of a drawn normal over rho."""
GIGA = 1e-9
RETURNS = {"designed": Sentence("designed, without a kink"), "mirrored": Sentence("mirrored")}


def sheet(results: RollerPathResults) -> Sheet:
    """Everything there is to say about the path of a roller."""
    return Sheet(
        heading=Sentence("Path of the roller's centre"),
        facts=_facts(results, _printed_law(results.cam)),
        scalars=_scalars(results),
        tables=Deferred({"cam-path": lambda: carrier_table(results.dataset, VARIABLES)}),
        datasets={"cam-path": results.dataset},
        pictures=Deferred({"cam-path": lambda: _drawing(results), "cam-curves": lambda: _plot(results)}),
        chapters=Deferred({"data": lambda: _data(results.cam), "path": lambda: _chapter(results)}),
        failure=_failure(results),
    )


# Facts and numbers


def _facts(results: RollerPathResults, law: Text) -> tuple[Fact, ...]:
    """Law, start and range, sizes, stall, how the path closes."""
    cam = results.cam
    start = Sentence(
        "ρ = {radius}, pressure angle {angle}",
        radius=Number(cam.start.radius, "m", ".9g"),
        angle=angle(cam.start.pressure_angle),
    )
    low, high = ends_of(cam)
    return (
        Fact(Sentence("curvature law"), law),
        Fact(Sentence("start"), start),
        Fact(Sentence("range"), Sentence("{first} to {last}", first=angle(low), last=angle(high))),
        *_sizes(results),
        Fact(Sentence("stall"), _stall(results)),
        Fact(Sentence("closure"), _closure(results)),
        Fact(Sentence("curvature of the drawn curve"), _drawn(results)),
    )


def _printed_law(cam: Cam) -> Text:
    """The law as a terminal prints it, with its numbers."""
    law, k0 = cam.curvature, Number(cam.curvature.k0 or math.nan, "1/m", ".9g")
    slope = cam.curvature.k1 or 0.0
    by_angle = Number(slope, "1/rad", ".9g", unit_fixed=True)
    text: Text
    match law.law:
        case "constant":
            text = Expression("K = {k0}", k0=k0)
        case "exponential":
            text = Expression("K = k0 exp(k1 φ), k0 = {k0}, k1 = {k1}", k0=k0, k1=by_angle)
        case "linear":
            k1 = Number(slope, "1/m/rad", ".9g")
            text = Expression("K = k0 + k1 φ, k0 = {k0}, k1 = {k1}", k0=k0, k1=k1)
        case "spline":
            text = Sentence("K by the spline through {count} points", count=Number(len(law.points or ())))
        case "formula":
            text = _formula(cam)
    if law.symmetric:
        return Sentence("{law}, the same on both sides of φ = {zero}", law=text, zero=Number(0.0))
    return text


def _law(cam: Cam) -> Text:
    """The law as mathematics with its numbers, a formula of the user's own as it is written."""
    law, k0 = cam.curvature, Number(cam.curvature.k0 or math.nan, "1/m")
    slope = cam.curvature.k1 or 0.0
    match law.law:
        case "constant":
            return Expression("K = k_0, quad k_0 = {k0}", k0=k0)
        case "exponential":
            k1 = Number(slope, "1/rad")
            return Expression("K = k_0 e^(k_1 phi), quad k_0 = {k0}, quad k_1 = {k1}", k0=k0, k1=k1)
        case "linear":
            k1 = Number(slope, "1/m/rad")
            return Expression("K = k_0 + k_1 phi, quad k_0 = {k0}, quad k_1 = {k1}", k0=k0, k1=k1)
        case "spline":
            return Sentence("spline through {count} points", count=Number(len(law.points or ())))
        case "formula":
            return _formula(cam)


def _formula(cam: Cam) -> Text:
    return Joined((Symbol("K ="), Name(cam.curvature.formula or ""), Unit("1/m")), " ")


def _sizes(results: RollerPathResults) -> Iterator[Fact]:
    radius, bend = results.radius, results.curvature
    between = Sentence(
        "{least} at {least_at} to {greatest} at {greatest_at}",
        least=Number(radius.least, "m"),
        least_at=angle(radius.at_least),
        greatest=Number(radius.greatest, "m"),
        greatest_at=angle(radius.at_greatest),
    )
    yield Fact(Sentence("radius ρ"), between)
    steepest, at = results.steepest
    yield Fact(
        Sentence("greatest pressure angle"), Sentence("{angle} at {at}", angle=angle(steepest), at=angle(at))
    )
    ends = Sentence(
        "{least} to {greatest}",
        least=Number(1.0 / bend.greatest, "m"),
        greatest=Number(1.0 / bend.least, "m"),
    )
    yield Fact(Sentence("radius of curvature"), ends)


def _stall(results: RollerPathResults) -> Text:
    """Where the follower stalls, or would stall beyond the range."""
    if results.stalls:
        return Sentence("at {place}, inside the range", place=_stalls(results))
    if results.stall_beyond is None:
        return Sentence("none in the range")
    return Sentence(
        "none in the range; with this law the follower would stall at {place}",
        place=angle(results.stall_beyond, ".9g"),
    )


def _stalls(results: RollerPathResults) -> Text:
    places = [on_both_sides(results.cam, place, ".9g") for place in results.stalls]
    if len(places) == 1:
        return places[0]
    return Sentence("{first} and {last}", first=places[0], last=places[1])


def _closure(results: RollerPathResults) -> Text:
    """What parts the ends: over a whole turn from each other, else from their mirror image."""
    if results.kink is None:
        return Sentence("the path ends where the follower stalls")
    if results.gap is not None:
        return Sentence(
            "after a turn ρ is {gap} larger and the path has a kink of {kink}",
            gap=Number(results.gap, "m", ".4g"),
            kink=angle(results.kink, ".4g"),
        )
    return Sentence(
        "mirrored at {place} the path has a kink of {kink}",
        place=angle(results.path.stop),
        kink=angle(abs(results.kink), ".5g"),
    )


def _drawn(results: RollerPathResults) -> Text:
    if math.isnan(results.drawn_difference):
        return Sentence("three neighbouring places are needed")
    return Sentence(
        "within {share} of the law's (circles through three of {count} places)",
        share=Number(results.drawn_difference, digits=".2g"),
        count=Number(results.dataset.sizes["sample"], digits="d"),
    )


def _scalars(results: RollerPathResults) -> dict[str, Scalar]:
    steepest, at = results.steepest
    known = {
        "cam_least_radius": (results.radius.least, "m"),
        "cam_greatest_radius": (results.radius.greatest, "m"),
        "cam_greatest_pressure_angle": (abs(steepest), "rad"),
        "cam_greatest_pressure_angle_at": (at, "rad"),
        "cam_least_curvature_radius": (1.0 / results.curvature.greatest, "m"),
        "cam_greatest_curvature_radius": (1.0 / results.curvature.least, "m"),
        "cam_stall": (results.stall_beyond if results.path.stall is None else results.path.stall, "rad"),
    }
    if results.gap is not None:
        known["cam_gap"] = (results.gap, "m")
    elif results.kink is not None:
        known["cam_mirrored_kink"] = (abs(results.kink), "rad")
    if math.isfinite(results.drawn_difference):
        known["cam_drawn_curvature_difference"] = (results.drawn_difference, "1")
    return {name: Scalar(value, unit) for name, (value, unit) in known.items() if value is not None}


def _failure(results: RollerPathResults) -> Failure | None:
    if not results.stalls:
        return None
    right = Number(90.0, "deg", unit_fixed=True)
    return Failure(
        Sentence(
            "the follower stalls at {place}, where the pressure angle is {right}",
            place=_stalls(results),
            right=right,
        ),
        Sentence("end the range before that angle"),
    )


# Figures


def _plot(results: RollerPathResults) -> Plot:
    """Radius, pressure angle and curvature over the angle of the carrier."""
    rows = []
    for name in DRAWN:
        quantity = QUANTITIES[name]
        curve = Curve(Sentence(quantity.long_name), results.dataset[name].values, 0)
        label = AxisLabel(symbol=Symbol(quantity.symbol), unit=quantity.unit)
        rows.append((CurvePanel(label, (curve,), legend=False),))
    stall = results.path.stall
    return Plot(
        Sentence("Path of the roller's centre"),
        Title(results.cam.title),
        over_carrier(results.dataset),
        tuple(rows),
        places=() if stall is None else ((Sentence("stall"), stall),),
    )


def _drawing(results: RollerPathResults) -> PathDrawing:
    """The path about the cam's centre, with rays to it and the normals that the pressure angle is from."""
    return PathDrawing(
        Sentence("Path of the roller's centre, and its normals"),
        Title(results.cam.title),
        results.dataset["roller_centre"].values,
        Sentence("path of the roller's centre"),
        tuple(_rays(results)),
        Sentence("ray from the cam's centre"),
        Sentence("normal of the path"),
    )


def _rays(results: RollerPathResults) -> Iterator[OutlineRay]:
    """Rays at round angles, of a turn and more each once, with the normals of the samples nearest to them."""
    names = ("carrier_angle", "path_radius", "cam_pressure_angle")
    phi, radius, gamma = (results.dataset[name].values for name in names)
    known = np.isfinite(radius)
    if not known.any():
        return
    low, high = np.degrees(phi[known].min()), np.degrees(phi[known].max())
    for degrees in np.arange(RAYS * math.ceil(low / RAYS - 1e-9), high + 1e-9, RAYS).tolist():
        if degrees >= low + 360.0 - 1e-9:
            break
        nearest = int(np.argmin(np.abs(np.degrees(phi) - degrees) + np.where(known, 0.0, np.inf)))
        if abs(np.degrees(phi[nearest]) - degrees) > RAYS / 4:
            continue
        turn, rho = phi[nearest], radius[nearest]
        place = rho * np.array([math.sin(turn), math.cos(turn)])
        normal = np.array([math.sin(turn - gamma[nearest]), math.cos(turn - gamma[nearest])])
        yield OutlineRay(Number(degrees, "deg", ".0f", unit_fixed=True), place, place - NORMAL * rho * normal)


# Chapters


def _data(cam: Cam) -> Chapter:
    """What the cam is, and every number of its description."""
    text = Sentence(
        "A roller moves along a fixed cam, guided by a carrier that turns about the cam's centre. The curvature "
        "of the path of its centre is given."
    )
    blocks = (Paragraph(text), FactTable(tuple(_given(cam))))
    return Chapter(Sentence("Data"), (Section(NOTHING, blocks),))


def _given(cam: Cam) -> Iterator[Fact]:
    yield Fact(Sentence("curvature law"), _law(cam))
    if cam.curvature.symmetric:
        yield Fact(Sentence("symmetry"), Sentence("the same on both sides of $phi = 0$"))
    yield Fact(Sentence("radius at the start"), Number(cam.start.radius, "m", digits=""))
    yield Fact(Sentence("pressure angle at the start"), Number(cam.start.pressure_angle, "rad", digits=""))
    first, last = Number(cam.range.start, "rad", digits=""), Number(cam.range.stop, "rad", digits="")
    yield Fact(Sentence("range"), Sentence("{first} to {last}", first=first, last=last))
    if cam.roller is not None:
        yield Fact(Sentence("radius of the roller"), Number(cam.roller.radius, "m", digits=""))
    if cam.mover is not None:
        yield Fact(Sentence("legs of the wheel"), Number(cam.mover.legs))
        yield Fact(Sentence("post of a shoe"), Number(cam.mover.post, "m", digits=""))
    if cam.return_arc is not None:
        yield Fact(Sentence("return arc"), RETURNS[cam.return_arc.kind])
    yield from _contact(cam)


def _contact(cam: Cam) -> Iterator[Fact]:
    contact = cam.contact
    if contact is None:
        return
    yield Fact(Sentence("force along the follower"), Number(contact.force, "N", digits=""))
    yield Fact(Sentence("length of the line of contact"), Number(contact.width, "m", digits=""))
    materials = (
        (Sentence("material of the cam"), contact.cam),
        (Sentence("material of the roller"), contact.roller),
    )
    for label, material in materials:
        if material is not None:
            modulus = Number(GIGA * material.elasticity, "GPa")
            poisson = Number(material.poisson)
            yield Fact(
                label, Expression("E = {modulus}, quad nu = {poisson}", modulus=modulus, poisson=poisson)
            )
    if contact.admissible is not None:
        yield Fact(Sentence("admissible contact stress"), stress(contact.admissible))


def _chapter(results: RollerPathResults) -> Chapter:
    """Curvature law, equations, path, pressure angle, stall."""
    text = Sentence(
        "The curvature $K$ of the path of the roller's centre is given over the angle $phi$ of the carrier. With the"
        " pressure angle $gamma$ and $eta = sin gamma$ the path follows from"
    )
    equations = Formula(
        (
            ("tan gamma", "frac(rho', rho)"),
            ("K eta'' - K' eta' + K eta + K' sqrt(1 - eta^2)", "0"),
            ("rho", "frac(sqrt(1 - eta^2) - eta', K)"),
            ("x", "rho sin phi"),
            ("y", "rho cos phi"),
        )
    )
    variables = [
        ("path_radius", "rho"), ("path_radius_slope", "rho'"), ("cam_pressure_angle", "gamma"),
        ("pressure_sine", "eta"), ("pressure_sine_slope", "eta'"), ("law_curvature", "K"),
    ]  # fmt: skip
    residual, term = results.equation_residual
    holds = Sentence("The equation of $eta$ holds along the path within {share} of its greatest term.")
    over_range = (
        course(results.dataset, variables, Sentence("The path at equal steps of the carrier")),
        Check(holds, residual, term, ROUNDED),
    )
    captions = {
        "cam-path": Sentence("Path of the roller's centre"),
        "cam-curves": Sentence("Radius, pressure angle and curvature of the path"),
    }
    facts = FactTable(_facts(results, _law(results.cam)))
    sections = (
        Section(NOTHING, (Paragraph(text), equations, facts, *shortfall(_failure(results)))),
        Section(Sentence("Over the range"), over_range),
        illustrations(captions, captions),
    )
    return Chapter(Sentence("Path of the roller's centre"), sections)
