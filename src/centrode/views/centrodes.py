"""Centrodes of a link, and the curvature of the paths of its points: what the terminal, the files and drawings show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from centrode.errors import Status
from centrode.model.reading import FRAME
from centrode.sheets.scenes import (
    CarriedCurve,
    CurveKind,
    LineKind,
    Linkage,
    Mark,
    MarkKind,
    Scene,
    StraightLine,
)
from centrode.sheets.sheet import Column, Fact, FactTable, Sheet, Table
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Symbol, Text, Title
from centrode.views.centres import ABSENT, place_text
from centrode.views.columns import instant_columns
from centrode.views.instants import body_text, instant_place, pair_text

if TYPE_CHECKING:
    import xarray as xr

    from centrode.analysis.instant_centres.results import CentrodeResults

Array = NDArray[np.float64]
STEPS = 721
"""Places along the inflection circle; along the cubic four times as many."""


def sheet(results: CentrodeResults) -> Sheet:
    """Everything there is to say about the centrodes of a link, and the curvature at the instants."""
    bends = results.curvature
    count = 0 if bends is None else bends.sizes["sample"]
    return Sheet(
        facts=tuple(_rolling_facts(results)),
        tables={"centrodes": _file(results)},
        datasets={"centrodes": results.centrodes} | ({} if bends is None else {"curvature": bends}),
        pictures=dict(_pictures(results)),
        printed=tuple(FactTable(tuple(_bent(results, sample))) for sample in range(count)),
    )


def _rolling_facts(results: CentrodeResults) -> Iterator[Fact]:
    """Bodies, pieces, arcs rolled and what they differ by."""
    mechanism, found = results.mechanism, results.centrodes
    pieces = found["centrode_piece"].values
    arcs = [found[name].values for name in ("fixed_arc", "moving_arc")]
    rolled = [sum(_last(arc[pieces == piece]) for piece in np.unique(pieces[pieces >= 0])) for arc in arcs]
    if _goes_to_infinity(results):
        rolled = [math.inf, math.inf]
    slip = float(np.nanmax(np.abs(arcs[0] - arcs[1]), initial=0.0))
    unit = "m" if mechanism.space == "plane" else "rad"
    yield Fact(Sentence("bodies"), pair_text(mechanism, results.link, results.against))
    seen = Joined((Number(int((pieces >= 0).sum())), Number(pieces.size)), " / ")
    yield Fact(Sentence("samples with a centre"), seen)
    yield Fact(Sentence("pieces"), Number(int(pieces.max()) + 1))
    yield Fact(Sentence("arc of the fixed centrode"), _length(rolled[0], unit))
    yield Fact(Sentence("arc of the moving centrode"), _length(rolled[1], unit))
    yield Fact(Sentence("greatest difference"), _length(slip, unit))


def _goes_to_infinity(results: CentrodeResults) -> bool:
    """Whether the centre passes through infinity: where the relative rotation of a plane mechanism turns back.

    What the samples see of such an arc depends on how near to infinity they come.
    """
    if results.mechanism.space != "plane":
        return False
    found = results.centrodes
    pieces, status = found["centrode_piece"].values, found["status"].values
    turns_back = (pieces[1:] != pieces[:-1]) & (pieces[1:] >= 0) & (pieces[:-1] >= 0)
    absent = (pieces < 0) & np.isin(status, (Status.OK, Status.CUT_OFF))
    return bool(turns_back.any() or absent.any())


def _last(arc: Array) -> float:
    return float(arc[-1]) if arc.size else 0.0


def _length(value: float, unit: str = "m") -> Text:
    """A length or an arc, infinity, or a dash where there is none."""
    if math.isnan(value):
        return ABSENT
    return Symbol("∞") if math.isinf(value) else Number(value, unit, ".9g", degrees_too=True)


def _bent(results: CentrodeResults, sample: int) -> Iterator[Fact]:
    """Pole, inflection circle, Ball's point, and the radius of curvature of each point's path at one instant."""
    assert results.curvature is not None
    here = results.curvature.isel(sample=sample)
    yield Fact(Sentence("place"), instant_place(results.mechanism, results.curvature, sample))
    yield Fact(Sentence("pole"), place_text(here["pole"].values))
    yield Fact(Sentence("inflection pole"), place_text(here["inflection_pole"].values))
    yield Fact(Sentence("diameter of the inflection circle"), _length(float(here["inflection_diameter"])))
    yield Fact(Sentence("Ball's point"), place_text(here["ball_point"].values))
    bends, centres = here["path_curvature"].values, here["curvature_centre"].values
    for name, bend, centre in zip(here["point"].values, bends, centres, strict=True):
        # on the inflection circle the curvature is rounding, and its centre is not given
        straight = np.isfinite(bend) and not np.isfinite(centre).all()
        radius = math.inf if straight else 1.0 / float(bend)
        yield Fact(Sentence("radius of the path of {point}", point=Name(str(name))), _length(radius))


def _file(results: CentrodeResults) -> Table:
    """Both curves, one row a sample."""
    found, spherical = results.centrodes, results.mechanism.space == "sphere"
    unit, arc = ("1", "rad") if spherical else ("m", "m")
    pieces = found["centrode_piece"].values
    words = tuple(Name(Status(int(code)).word) for code in found["status"].values)
    return Table(
        (
            *instant_columns(found, np.arange(len(pieces))),
            *(
                Column(f"{name}_{axis}", found[name].values[:, number], unit)
                for name in ("fixed_centrode", "moving_centrode")
                for number, axis in enumerate("xyz" if spherical else "xy")
            ),
            Column("piece", np.where(pieces >= 0, pieces, np.nan), whole=True),
            *(Column(name, found[name].values, arc) for name in ("fixed_arc", "moving_arc")),
            Column("status", words),
        )
    )


def _pictures(results: CentrodeResults) -> Iterator[tuple[str, Scene]]:
    """Both curves, and one drawing of the curvature for each instant; numbered where there are several."""
    yield "centrodes", _rolling_scene(results)
    if results.instants is None:
        return
    count = results.instants.sizes["sample"]
    for sample, status in enumerate(results.instants["status"].values):
        if status in (Status.OK, Status.CUT_OFF):
            name = "curvature" if count == 1 else f"curvature-{sample + 1}"
            yield name, _curvature_scene(results, sample)


def _rolling_scene(results: CentrodeResults) -> Scene:
    """Both centrodes with the linkage, where one touches the other."""
    mechanism, found = results.mechanism, results.centrodes
    pieces = found["centrode_piece"].values.astype(np.intp)
    against, link = body_text(mechanism, results.against), body_text(mechanism, results.link)
    spherical = mechanism.space == "sphere"
    legend: tuple[Text, ...] = (
        Sentence("fixed centrode\n(of {name})", name=against),
        Sentence("moving centrode\n(of {name})", name=link),
    )
    if spherical:
        legend = (
            Sentence("fixed polode\n(of {name})", name=against),
            Sentence("moving polode\n(of {name})", name=link),
        )
    kinds = (CurveKind.FIXED, CurveKind.MOVING)
    bodies = ((results.against, "fixed_centrode"), (results.link, "moving_centrode"))
    return Scene(
        Sentence("Polodes") if spherical else Sentence("Centrodes"),
        Title(mechanism.title),
        Linkage(mechanism, results.motion),
        curves=tuple(
            CarriedCurve(kind, body, found[name].values, pieces)
            for kind, (body, name) in zip(kinds, bodies, strict=True)
        ),
        legend=tuple(zip(kinds, legend, strict=True)),
        contact=Sentence("axis") if spherical else Sentence("centre"),
    )


def _curvature_scene(results: CentrodeResults, sample: int) -> Scene:
    """What bends the paths: inflection circle, cubic of stationary curvature, Ball's point, centres of curvature.

    W is the inflection pole, U Ball's point; lines join points with the centres of curvature of their paths.
    """
    assert results.curvature is not None and results.instants is not None
    mechanism, here = results.mechanism, results.curvature.isel(sample=sample)
    names: dict[str, Text] = {
        "pole": Sentence("pole"),
        "inflection_pole": Symbol("W"),
        "ball_point": Symbol("U"),
    }
    places = {name: here[name].values for name in names}
    circle, cubic = _circle(places["pole"], places["inflection_pole"]), _cubic(here)
    return Scene(
        Sentence("Curvature of the paths of {link}", link=Name(results.link)),
        Title(mechanism.title),
        Linkage(mechanism, results.instants, sample),
        marks=tuple(
            Mark(place, MarkKind.POLE, names[name])
            for name, place in places.items()
            if np.isfinite(place).all()
        ),
        lines=tuple(_radii(results, here, sample)),
        curves=tuple(
            CarriedCurve(kind, FRAME, places, np.zeros(len(places), dtype=np.intp))
            for kind, places in ((CurveKind.INFLECTION, circle), (CurveKind.STATIONARY, cubic))
        ),
        legend=(
            (CurveKind.INFLECTION, Sentence("inflection circle")),
            (CurveKind.STATIONARY, Sentence("cubic of stationary\ncurvature")),
            (LineKind.RADIUS, Sentence("radii of curvature")),
            (MarkKind.POLE, Joined((Symbol("W"), Sentence("inflection pole")), ": ")),
            (MarkKind.POLE, Joined((Symbol("U"), Sentence("Ball's point")), ": ")),
        ),
    )


def _circle(pole: Array, end: Array) -> Array:
    """The circle with a diameter between two places."""
    turns = np.linspace(0.0, 2.0 * np.pi, STEPS)
    way = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return np.asarray(0.5 * (pole + end) + 0.5 * np.hypot(*(end - pole)) * way)


def _cubic(here: xr.Dataset) -> Array:
    """(x^2 + y^2)(a x + b y) = x y in the pole's axes, by the direction from the pole."""
    a, b = here["stationary_cubic"].values
    tangent = float(here["pole_tangent"])
    turns = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 4 * STEPS)
    slope = a * np.cos(turns) + b * np.sin(turns)
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = np.sin(turns) * np.cos(turns) / slope
    beyond = np.abs(np.diff(np.sign(slope), prepend=np.sign(slope[:1]))) > 0
    radius[beyond] = np.nan  # it goes to infinity along its asymptote
    angle = turns + tangent
    return np.asarray(
        here["pole"].values + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    )


def _radii(results: CentrodeResults, here: xr.Dataset, sample: int) -> Iterator[StraightLine]:
    """From points to the centres of curvature of their paths."""
    assert results.instants is not None
    fixed, moving = results.mechanism.frame.coordinates, results.instants["point"].values.tolist()
    for name, centre in zip(here["point"].values.tolist(), here["curvature_centre"].values, strict=True):
        place = (
            np.asarray(fixed[name], dtype=float)
            if name in fixed
            else results.instants["position"].sel(point=name).values[sample]
            if name in moving
            else np.full(2, np.nan)
        )
        if np.isfinite([place, centre]).all():
            ends = (Mark(place, MarkKind.POLE, NOTHING), Mark(centre, MarkKind.POLE, NOTHING))
            yield StraightLine(ends, LineKind.RADIUS)
