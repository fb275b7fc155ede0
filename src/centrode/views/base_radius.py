"""The choice of a cam's base radius: what the terminal, the summary and the document show."""

from __future__ import annotations

from collections.abc import Iterator
from math import tau
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.base_circle import chosen_admissible, has_bounds
from centrode.cams.followers.base_radius_results import NEAR, is_least, least_body, sized_cams, with_least
from centrode.cams.followers.closed_forms import TURN, ClosedForms
from centrode.cams.followers.motion_results import ROUNDED
from centrode.cams.followers.profile_results import curvature_difference, pressure_difference
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Deferred,
    Fact,
    FactTable,
    Failure,
    Formula,
    Paragraph,
    Scalar,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Expression, Joined, Name, Number, Sentence, Text
from centrode.views.follower_formulas import FollowerFormulas, length
from centrode.views.followers import angle, failed_checks

if TYPE_CHECKING:
    from centrode.cams.followers.base_circle import Least
    from centrode.cams.followers.base_radius_results import BaseRadiusResults
    from centrode.cams.followers.geometry import FollowerCam

BROKEN = 1e-9
"""By how much a bound may be missed: margins below are rounding."""
STILL = 1e-9
"""Share of the base radius below which an offset is rounding."""
DECIDES = {
    "pressure angle": Sentence("the pressure angle"),
    "curvature": Sentence("the radius of curvature"),
    "roller to curvature": Sentence(
        "the ratio of the roller's radius to the radius of curvature of its path"
    ),
    "roller to radius": Sentence("the ratio of the roller's radius to the least radius of its path"),
}
EVERYWHERE = ("roller to radius",)
"""What does not decide at an angle."""


def sheet(results: BaseRadiusResults) -> Sheet:
    """Everything there is to say about the choice of the base radius; without bounds a document alone says it."""
    bounded = has_bounds(results.cam)
    return Sheet(
        heading=Sentence("Choice of the base radius") if bounded else NOTHING,
        facts=tuple(_facts(results)) if bounded else (),
        scalars=_scalars(results),
        chapters=Deferred({"base-radius": lambda: _chapter(results)}),
        failure=_failure(results),
    )


# Facts


def _facts(results: BaseRadiusResults) -> Iterator[Fact]:
    """What is admissible, the least cam that keeps it, the best offset."""
    if bounds := tuple(_admissible(results)):
        yield Fact(Sentence("admissible"), Joined(bounds))
    if ratios := tuple(_admissible_roller(results)):
        yield Fact(Sentence("admissible roller"), Joined(ratios))
    label = Sentence("least base radius")
    if results.is_free:
        yield Fact(label, Sentence("none: no bound limits it"))
    elif results.least is not None:
        yield Fact(label, _deciding_bound(results.least))
    if results.refusal is not None:
        yield Fact(label, Name(results.refusal.what))
    if results.best is not None:
        radius, offset = length(results.best.base_radius), length(_offset(results.best))
        text = Sentence("{offset}: base radius of at least {radius}", offset=offset, radius=radius)
        if results.cam.follower.contact == "flat":
            text = Sentence("{offset}: the contact extends equally to both sides of the face", offset=offset)
        yield Fact(Sentence("best offset"), text)


def _admissible(results: BaseRadiusResults) -> Iterator[Text]:
    admissible, given = chosen_admissible(results.cam), results.cam.bounds
    if given.pressure_angle is not None:
        yield Sentence("pressure angle up to {angle}", angle=angle(admissible.pressure_angle))
    if given.return_pressure_angle is not None:
        yield Sentence("on the return up to {angle}", angle=angle(admissible.return_angle))
    if given.curvature_radius is not None:
        yield Sentence("radius of curvature from {radius}", radius=length(admissible.bend))


def _admissible_roller(results: BaseRadiusResults) -> Iterator[Text]:
    """The ratios that the roller keeps."""
    admissible = chosen_admissible(results.cam)
    if not results.cam.follower.roller_radius:
        return
    if admissible.roller_to_curvature < 1.0:
        ratio = Number(admissible.roller_to_curvature)
        yield Sentence("radius up to {ratio} of the radius of curvature of its path", ratio=ratio)
    if admissible.roller_to_radius < 1.0:
        ratio = Number(admissible.roller_to_radius)
        yield Sentence("radius up to {ratio} of the least radius of its path", ratio=ratio)


def _deciding_bound(least: Least) -> Text:
    if least.by in EVERYWHERE:
        return Sentence(
            "{radius}, determined by {bound}", radius=length(least.base_radius), bound=DECIDES[least.by]
        )
    return Sentence(
        "{radius}, determined by {bound} at {at}",
        radius=length(least.base_radius),
        bound=DECIDES[least.by],
        at=angle(least.at % tau),
    )


def _offset(best: Least) -> float:
    """The best offset [m] without rounding."""
    return best.offset if abs(best.offset) > STILL * best.base_radius else 0.0


def _scalars(results: BaseRadiusResults) -> dict[str, Scalar]:
    scalars = {}
    if results.least is not None and not results.is_free:
        scalars["cam_least_base_radius"] = Scalar(results.least.base_radius, "m")
    if results.best is not None:
        scalars["cam_best_offset"] = Scalar(results.best.offset, "m")
        if results.cam.follower.contact != "flat":
            scalars["cam_best_base_radius"] = Scalar(results.best.base_radius, "m")
    return scalars


def _failure(results: BaseRadiusResults) -> Failure | None:
    """No cam that keeps its bounds, or one that breaks them."""
    if results.body is None:
        assert results.refusal is not None
        return Failure(Name(results.refusal.what), Name(results.refusal.repair))
    if results.margin is None or results.margin.least >= -BROKEN:
        return None
    what = Sentence(
        "{bound} is not admissible at {at}", bound=DECIDES[results.margin.by], at=angle(results.margin.at)
    )
    if results.margin.by in EVERYWHERE:
        what = Sentence("{bound} is not admissible", bound=DECIDES[results.margin.by])
    if results.least is None or results.is_free:
        return Failure(what)
    return Failure(
        what, Sentence("choose a base radius of at least {least}", least=length(results.least.base_radius))
    )


# Chapter


def _chapter(results: BaseRadiusResults) -> Chapter:
    """What decides the size of the cam, with the numbers where it does, and other sizes beside it."""
    facts = (FactTable(tuple(_facts(results))),) if has_bounds(results.cam) else ()
    beginning: tuple[Block, ...] = (*facts, *failed_checks(_failure(results)))
    sections = [Section(NOTHING, beginning)]
    if results.body is not None:
        sections = [
            Section(NOTHING, (*_demands(results.body), *beginning)),
            Section(Sentence("The least base radius"), tuple(_least(results))),
            Section(
                Sentence("Comparison of base radii"),
                (_beside(results), *closed_form_checks(results.body)),
            ),
        ]
    return Chapter(Sentence("Choice of the base radius"), tuple(sections))


def _demands(body: FollowerCam) -> Iterator[Block]:
    """What grows and what shrinks with the cam."""
    formulas = FollowerFormulas(body, 0.0)
    if formulas.forms.has_pressure_angle:
        text = Sentence(
            "The smaller the cam, the greater the pressure angle $alpha$ between the normal and the follower's "
            "motion, and the smaller the radius of curvature $R$ of the profile where it is convex; at $R <= 0$ "
            "the profile is undercut."
        )
    else:
        text = Sentence(
            "Under a flat face perpendicular to the follower's motion the pressure angle is zero. The smaller "
            "the cam, the smaller the radius of curvature $R$ of its profile; at $R <= 0$ it is undercut."
        )
    yield Paragraph(text)
    lines = (*formulas.start(), *formulas.pressure(), *formulas.radius())
    yield Formula(tuple(line[:2] for line in lines if line[0] != "alpha"))


def _least(results: BaseRadiusResults) -> Iterator[Block]:
    """The least radius with its numbers, and how it compares with the one that is taken."""
    bounded = has_bounds(results.cam)
    if not bounded:
        results = with_least(results)
    least, refusal = results.least, results.refusal
    if least is None:
        assert refusal is not None
        yield Paragraph(Joined((Name(f"{refusal.what}."), Name(refusal.repair)), " "))
        return
    if results.is_free:
        free = Sentence(
            "No bounds are given, and no base radius undercuts the profile: the size of the cam is free."
        )
        kept = Sentence("No bound limits the base radius: every base radius satisfies them all.")
        yield Paragraph(kept if bounded else free)
        return
    admissible = Sentence("The bounds of the description determine it.")
    none = Sentence("No bounds are given: only undercutting of the profile is avoided.")
    yield Paragraph(admissible if bounded else none)
    yield Paragraph(_what_determines(results, least))
    formulas = FollowerFormulas(least_body(results), least.at % tau)
    if least.by == "roller to radius":
        ratio = Number(chosen_admissible(results.cam).roller_to_radius)
        yield Formula((("r_0", length(least.base_radius)), *formulas.start(), ("frac(r, r_0 + r)", ratio)))
    else:
        decisive = formulas.pressure() if least.by == "pressure angle" else formulas.radius()
        yield Formula((("r_0", length(least.base_radius)), *formulas.start(), *formulas.lift(), *decisive))
    statement = Sentence(
        "A base radius smaller by a fraction {part} violates a bound; one larger by the same fraction violates none.",
        part=Number(NEAR, digits=".1e"),
    )
    yield Check(statement, 0.0 if is_least(results) else 1.0, 1.0, 0.0)
    yield Paragraph(_taken(results, least))
    given, flat = results.cam.bounds, results.cam.follower.contact == "flat"
    if results.best is not None and given.pressure_angle is not None and not flat:
        yield Paragraph(_best_offset(results.best, least))


def _what_determines(results: BaseRadiusResults, least: Least) -> Sentence:
    """The least radius, and which bound determines it at which angle of the cam."""
    decided = {
        "radius": _measured_length(least.base_radius),
        "angle": Number(least.at % tau, "rad", digits=""),
    }
    if least.by == "pressure angle":
        return Sentence(
            "The least base radius is {radius}. The pressure angle determines it, at $phi$ = {angle}:",
            **decided,
        )
    if least.by == "curvature":
        return Sentence(
            "The least base radius is {radius}. The radius of curvature determines it, at $phi$ = {angle}:",
            **decided,
        )
    if least.by == "roller to curvature":
        return Sentence(
            "The least base radius is {radius}. The roller determines it: at $phi$ = {angle} its radius is {ratio} of "
            "the radius of curvature of its path:",
            **decided,
            ratio=Number(chosen_admissible(results.cam).roller_to_curvature),
        )
    return Sentence(
        "The least base radius is {radius}. The roller determines it: its radius is {ratio} of the least radius "
        "of its path:",
        radius=decided["radius"],
        ratio=Number(chosen_admissible(results.cam).roller_to_radius),
    )


def _measured_length(value: float) -> Number:
    """A length in a sentence of a document, which gives it its digits."""
    return Number(value, "m", digits="")


def _taken(results: BaseRadiusResults, least: Least) -> Text:
    """Which radius the cam has."""
    if results.cam.body.base_radius is None:
        return Sentence("The cam is made with this radius.")
    taken = results.cam.body.base_radius
    return Sentence(
        "The cam is made with a base radius of {radius}, {share} times the least one.",
        radius=_measured_length(taken),
        share=Number(taken / least.base_radius, digits=".4g"),
    )


def _best_offset(best: Least, least: Least) -> Text:
    """The offset with which the cam of a translating roller or edge may be least."""
    return Sentence(
        "With an offset of {offset} of the follower's axis the base radius could be {radius}, {share} less.",
        offset=_measured_length(_offset(best)),
        radius=_measured_length(best.base_radius),
        share=Number(1.0 - best.base_radius / least.base_radius, digits=".1%"),
    )


def _beside(results: BaseRadiusResults) -> Table:
    """Pressure angles and the least radius of curvature of cams of several sizes."""
    assert results.body is not None
    cams = sized_cams(results)
    columns: list[tuple[str, str, Text]] = [
        ("base_radius", "m", Expression("r_0")),
        ("rising", "rad", Sentence("$alpha$ where it rises")),
        ("falling", "rad", Sentence("$alpha$ where it falls")),
        ("bend", "m", Sentence("least $R$ where it is convex")),
    ]
    if not ClosedForms(results.body).has_pressure_angle:
        columns = [columns[0], columns[-1]]
    return Table(
        tuple(
            Column(name, np.array([getattr(one, name) for one in cams]), unit, head)
            for name, unit, head in columns
        ),
        Sentence(
            "Greatest pressure angles and least radius of curvature; a dash: the cam cannot drive the follower"
        ),
    )


def closed_form_checks(body: FollowerCam) -> Iterator[Check]:
    """Pressure angle and curvature by the closed forms against those of the envelope."""
    if ClosedForms(body).has_pressure_angle:
        text = Sentence(
            "At {count} angles the formula of $alpha$ and the normal of the envelope agree within {share} of a radian.",
            count=Number(len(TURN)),
        )
        yield Check(text, pressure_difference(body), 1.0, ROUNDED)
    apart, growth = curvature_difference(body)
    text = Sentence(
        "There the formula of $R$ and the curvature of the envelope agree within {share} of the curvature."
    )
    yield Check(text, apart, 1.0, ROUNDED * growth)
