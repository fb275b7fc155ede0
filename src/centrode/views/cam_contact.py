"""The contact of roller and cam: the greatest stress by both formulas, the strip there, what is admissible."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.sheets.plots import AxisLabel, Curve, CurvePanel, CurveRole, Plot
from centrode.sheets.sheet import (
    Chapter,
    Deferred,
    Fact,
    FactTable,
    Formula,
    Paragraph,
    Scalar,
    Section,
    Sheet,
    illustrations,
)
from centrode.sheets.texts import NOTHING, Joined, Number, Sentence, Symbol, Text, Title
from centrode.views.curvature_cams import (
    MEGA,
    angle,
    carrier_table,
    course,
    on_both_sides,
    over_carrier,
    stress,
)

if TYPE_CHECKING:
    from centrode.cams.results import CamContactResults

VARIABLES = (
    "contact_stress",
    "contact_stress_by_source",
    "contact_shear",
    "contact_depth",
    "contact_half_width",
    "cam_curvature_radius",
)
MILLI = 1e3
"""Millimetres in a metre: strips are fractions of one, whatever the unit of the display."""
ADMISSIBLE = Sentence("admissible stress")


def sheet(results: CamContactResults) -> Sheet:
    """Everything there is to say about the contact of roller and cam."""
    return Sheet(
        heading=Sentence("Contact of roller and cam"),
        facts=tuple(_facts(results)),
        scalars=_scalars(results),
        tables=Deferred({"cam-contact": lambda: carrier_table(results.dataset, VARIABLES)}),
        datasets={"cam-contact": results.dataset},
        pictures=Deferred({"cam-contact": lambda: _plot(results)}),
        chapters=Deferred({"contact": lambda: _chapter(results)}),
    )


def _facts(results: CamContactResults) -> Iterator[Fact]:
    """The greatest contact stress by both formulas, and the strip there."""
    facts, label = results.dataset.attrs, Sentence("greatest contact stress")
    if math.isinf(facts["greatest_stress"]):
        endless = Sentence(
            "unbounded towards {angle}, where the follower stalls",
            angle=angle(facts["greatest_stress_at"]),
        )
        yield Fact(label, endless)
        return
    if math.isnan(facts["greatest_stress"]):
        yield Fact(label, Sentence("none: the cam is undercut everywhere"))
        return
    greatest = Sentence(
        "{value} at {at}",
        value=stress(facts["greatest_stress"]),
        at=on_both_sides(results.cam, facts["greatest_stress_at"]),
    )
    yield Fact(label, _beside_admissible(greatest, facts["greatest_stress"], facts.get("admissible_stress")))
    source = Sentence(
        "{stress} by the source's formula, with {factor}",
        stress=stress(facts["greatest_stress_by_source"]),
        factor=Number(0.418),
    )
    yield Fact(NOTHING, source)
    yield Fact(Sentence("strip there"), _strip(results))
    if results.missing:
        none = Sentence(
            "no contact at {n} of {of} samples: the cam is undercut there",
            n=Number(results.missing, digits="d"),
            of=Number(results.dataset.sizes["sample"], digits="d"),
        )
        yield Fact(NOTHING, none)


def _beside_admissible(text: Text, greatest: float, admissible: float | None) -> Text:
    if admissible is None:
        return text
    if greatest <= admissible:
        return Sentence("{text}, admissible {stress}", text=text, stress=stress(admissible))
    return Sentence("{text}, more than the admissible {stress}", text=text, stress=stress(admissible))


def _strip(results: CamContactResults) -> Sentence:
    worst = results.dataset.isel(sample=results.worst)
    return Sentence(
        "{width} wide; greatest shear stress {shear} at a depth of {depth}",
        width=_millimetres(2.0 * MILLI * float(worst["contact_half_width"])),
        shear=stress(float(worst["contact_shear"])),
        depth=_millimetres(MILLI * float(worst["contact_depth"])),
    )


def _millimetres(value: float) -> Number:
    return Number(value, "mm", ".4g", unit_fixed=True)


def _scalars(results: CamContactResults) -> dict[str, Scalar]:
    facts = results.dataset.attrs
    scalars = {
        "greatest_contact_stress": Scalar(facts["greatest_stress"], "Pa"),
        "greatest_contact_stress_at": Scalar(facts["greatest_stress_at"], "rad"),
        "greatest_contact_stress_by_source": Scalar(facts["greatest_stress_by_source"], "Pa"),
    }
    return {name: scalar for name, scalar in scalars.items() if math.isfinite(scalar.value)}


def _plot(results: CamContactResults) -> Plot:
    """Stress by both formulas with its greatest value, shear, half width and depth of the strip."""
    data, facts = results.dataset, results.dataset.attrs
    stresses = {
        "contact_stress": Sentence("greatest pressure (Hertz)"),
        "contact_stress_by_source": Sentence("by the source's formula ({factor})", factor=Number(0.418)),
        "contact_shear": Sentence("greatest shear stress below the contact"),
    }
    strip = {
        "contact_half_width": Sentence("half width of the strip"),
        "contact_depth": Sentence("depth of the greatest shear stress"),
    }
    upper = [
        Curve(name, MEGA * data[variable].values, place, approximate=variable.endswith("source"))
        for place, (variable, name) in enumerate(stresses.items())
    ]
    if "admissible_stress" in facts:
        level = np.full(data.sizes["sample"], MEGA * facts["admissible_stress"])
        upper.append(Curve(ADMISSIBLE, level, len(upper), role=CurveRole.LEVEL))
    lower = [
        Curve(name, MILLI * data[variable].values, len(stresses) + 1 + place)
        for place, (variable, name) in enumerate(strip.items())
    ]
    dots = []
    greatest, at = MEGA * facts["greatest_stress"], facts["greatest_stress_at"]
    if math.isfinite(greatest):
        name = Sentence("{value} at {at}", value=Number(greatest, "MPa", ".5g"), at=Number(at, "rad", ".5g"))
        dots.append((name, at, greatest))
    pressures = AxisLabel(Joined((Symbol("σ"), Symbol("τ"))), unit="MPa", unit_fixed=True)
    lengths = AxisLabel(Joined((Symbol("a"), Symbol("z"))), unit="mm", unit_fixed=True)
    return Plot(
        Sentence("Contact of roller and cam"),
        Title(results.cam.title),
        over_carrier(data),
        (
            (CurvePanel(pressures, tuple(upper), dots=tuple(dots), from_zero=True),),
            (CurvePanel(lengths, tuple(lower), from_zero=True),),
        ),
    )


def _chapter(results: CamContactResults) -> Chapter:
    """Hertzian stress between roller and cam."""
    text = Sentence(
        "Roller and cam touch along a line of the length $b$; the force $P$ along the follower causes the normal "
        r"force $P \/ cos gamma$. With the curvature $K$ of the path"
    )
    relative = ("kappa", "1/r + 1/R", "frac(1, r (1 - r K))")
    if results.cam.contact is not None and results.cam.contact.outer:
        relative = ("kappa", "1/r - 1/R", "frac(1, r (1 + r K))")
    equations = Formula(
        (
            ("w", "frac(P, b cos gamma)"),
            relative,
            ("1/E^*", "frac(1 - nu_1^2, E_1) + frac(1 - nu_2^2, E_2)"),
            ("sigma", "sqrt(frac(w kappa E^*, pi))"),
            ("a", "sqrt(frac(4 w, pi kappa E^*))"),
        )
    )
    columns = [
        ("cam_curvature_radius", "R"), ("contact_half_width", "a"), ("contact_stress", "sigma"),
        ("contact_shear", "tau"),
    ]  # fmt: skip
    table = course(results.dataset, columns, Sentence("The contact over the working arc"))
    caption = Sentence("Contact stress over the working arc")
    sections = (
        Section(NOTHING, (Paragraph(text), equations, FactTable(tuple(_facts(results))))),
        Section(Sentence("Over the working arc"), (table,)),
        illustrations(["cam-contact"], {"cam-contact": caption}),
    )
    return Chapter(Sentence("Contact of roller and cam"), sections)
