"""Answers of a synthesis: what the terminal, the files, the figures and the document show."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from centrode.model.files import mechanism_text
from centrode.model.reading import two_points
from centrode.sheets.curve_maps import CurveMap, MapCurve, MapPanel
from centrode.sheets.pictures import Picture
from centrode.sheets.plots import Abscissa, AxisLabel, Curve, CurvePanel, Plot
from centrode.sheets.sheet import (
    Column,
    Deferred,
    Fact,
    Formula,
    Scalar,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Counted, Name, Number, Sentence, Symbol, Text, Title
from centrode.views.columns import ROUNDING
from centrode.views.synthesis_chapter import synthesis_chapter

if TYPE_CHECKING:
    from centrode.synthesis.answers import Answer, SynthesisResults

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]

KINDS = {
    "path": Sentence("a path of a point"),
    "function": Sentence("a function of the crank"),
    "motion": Sentence("poses of a link"),
    "strokes": Sentence("strokes"),
}
NUMBERS = {
    "turn_error": Sentence("greatest error of the turn"),
    "time_ratio": Sentence("time ratio"),
    "stroke": Sentence("stroke"),
    "swing": Sentence("swing"),
    "dwell_spread": Sentence("motion during the dwell"),
    "limit_angle": Sentence("angle of the crank between the limit positions"),
}


def sheet(results: SynthesisResults) -> Sheet:
    """What was wanted, the answers as a table and as pictures, and a chapter."""
    facts = tuple(_facts(results))
    table = _table(results)
    pictures = dict(_pictures(results))
    construction, notes = tuple(_construction(results)), tuple(_notes(results))
    return Sheet(
        facts=facts,
        scalars=_scalars(results),
        tables=Deferred({"answers": lambda: table, **_curve_tables(results)}),
        pictures=Deferred({name: lambda picture=picture: picture for name, picture in pictures.items()}),  # type: ignore[misc]
        printed=(table, *construction),
        files=dict(_files(results)),
        notes=notes,
        chapters=Deferred(
            {
                "synthesis": lambda: synthesis_chapter(
                    results, facts, table, construction, pictures.keys(), notes
                )
            }
        ),
    )


def _error_unit(results: SynthesisResults) -> str:
    return "rad" if results.task.synthesis.kind == "function" or _on_sphere(results) else "m"


def _on_sphere(results: SynthesisResults) -> bool:
    return results.mechanism.space == "sphere"


def error_shown(results: SynthesisResults, error: float) -> float:
    """An error, or zero where it is no more than rounding of what it is an error of: of lengths, or of a radian.

    Targets that are met exactly would be told to be missed by what the last digits of the places are.
    """
    if _error_unit(results) == "rad":
        size = 1.0
    else:
        places = [*results.targets, *results.answers[0].met]
        size = max((abs(one) for one in places if np.isfinite(one)), default=0.0)
    return 0.0 if abs(error) < ROUNDING * size else error


def _facts(results: SynthesisResults) -> Iterator[Fact]:
    wanted, best = results.task.synthesis, results.answers[0]
    yield Fact(Sentence("wanted"), KINDS[wanted.kind])
    if len(results.targets):
        yield Fact(Sentence("targets"), Number(len(results.targets), digits="d"))
    if wanted.kind == "path":
        yield Fact(Sentence("path"), Sentence("closed") if results.closed else Sentence("open"))
    if results.examined:
        yield Fact(Sentence("linkages examined"), Number(results.examined, digits="d"))
    yield Fact(Sentence("answers"), Number(len(results.answers), digits="d"))
    unit = _error_unit(results)

    def error(value: float) -> Number:
        return Number(error_shown(results, value), unit, digits=".4g")

    if wanted.kind != "strokes":
        yield Fact(Sentence("root mean square error of the best"), error(best.error))
        yield Fact(Sentence("greatest error of the best"), error(best.greatest))
    if wanted.kind == "path":
        yield Fact(
            Sentence("sum of squared errors of the best"),
            Number(
                best.sum_of_squares if error_shown(results, best.greatest) else 0.0, f"{unit}^2", digits=".6g"
            ),
        )
    if math.isfinite(best.transmission):
        yield Fact(Sentence("least transmission angle of the best"), Number(best.transmission, "rad"))
    for name, (value, its_unit) in best.numbers.items():
        yield Fact(NUMBERS[name], Number(value, its_unit))
    yield Fact(Sentence("defects of the best"), _defects(best))


def _defects(answer: Answer) -> Text:
    if answer.defects.none:
        return Sentence("none")
    if answer.defects.order:
        return Sentence("order")
    return Sentence("branch") if answer.defects.branch else Sentence("the crank does not turn fully")


def _scalars(results: SynthesisResults) -> dict[str, Scalar]:
    best, unit = results.answers[0], _error_unit(results)
    found = {
        "answers": Scalar(float(len(results.answers)), "1"),
        "error": Scalar(best.error, unit),
        "greatest_error": Scalar(best.greatest, unit),
        "transmission": Scalar(best.transmission, "rad"),
    }
    return {name: scalar for name, scalar in found.items() if math.isfinite(scalar.value)}


def _table(results: SynthesisResults) -> Table:
    """One row an answer."""
    answers, unit = results.answers, _error_unit(results)
    count = np.arange(1, len(answers) + 1)
    columns = [Column("answer", count.astype(float), head=Sentence("answer"), whole=True)]
    if results.task.synthesis.kind != "strokes":
        columns += [
            Column(
                "error",
                np.array([error_shown(results, one.error) for one in answers]),
                unit,
                head=Sentence("r.m.s. error"),
            ),
            Column(
                "greatest_error",
                np.array([error_shown(results, one.greatest) for one in answers]),
                unit,
                head=Sentence("greatest error"),
            ),
        ]
    transmission = np.array([one.transmission for one in answers])
    if np.isfinite(transmission).any():
        columns.append(Column("transmission", transmission, "rad", head=Sentence("least transmission angle")))
    width, height = np.array([one.size for one in answers]).T
    if np.isfinite(width).any():
        columns += [
            Column("width", width, "m", head=Sentence("width")),
            Column("height", height, "m", head=Sentence("height")),
        ]
    columns.append(Column("defects", tuple(_defects(one) for one in answers), head=Sentence("defects")))
    for link in answers[0].mechanism.links:
        values = np.array([_length(one, link) for one in answers])
        if np.isfinite(values).any():
            of_length = "rad" if _on_sphere(results) else "m"
            columns.append(Column(f"length_{link}", values, of_length, head=Name(link)))
    return Table(tuple(columns), Sentence("Answers"))


def _construction(results: SynthesisResults) -> Iterator[Section]:
    """The equations of the triangle that O makes with both limit positions."""
    wanted = results.task.synthesis
    if wanted.kind != "strokes" or wanted.time_ratio is None:
        return
    lines = [("theta", "pi (K - 1)/(K + 1)")]
    if wanted.topology == "shaper":
        lines += [("a", "d sin(theta/2)"), ("l", "H/(2 sin(theta/2))")]
    elif wanted.topology == "whitworth-quick-return":
        lines += [("d", "a sin(theta/2)"), ("l", "H/2")]
    else:
        if wanted.topology != "slider-crank-offset":
            lines.append(("s", "2 c sin(psi/2)"))
        stroke = "H" if wanted.topology == "slider-crank-offset" else "s"
        lines += [
            ("b + a", f"{stroke} sin(beta + theta)/sin(theta)"),
            ("b - a", f"{stroke} sin(beta)/sin(theta)"),
        ]
    yield Section(Sentence("Construction"), (Formula(tuple(lines)),))


def _length(answer: Answer, name: str) -> float:
    """Length of a link between the points it is named by, else between its first two; NaN of a missing one."""
    link = answer.mechanism.links.get(name)
    if link is None:
        return math.nan
    named = two_points(name)
    at = link.coordinates
    if answer.mechanism.space == "sphere":
        # A lies at longitude 0 of the coupler's axes, B on their equator
        return float(link.length or at["B"][0])
    places = [at[end] for end in named] if named and set(named) <= set(at) else list(at.values())
    return math.dist(places[0], places[1]) if len(places) > 1 else math.nan


def _curve_tables(results: SynthesisResults) -> dict[str, Callable[[], Table]]:
    """The curve of each answer, and the curves of poses."""
    tables: dict[str, Callable[[], Table]] = {}
    for number, answer in enumerate(results.answers, 1):
        if len(answer.curve):
            tables[f"curve-{number}"] = partial(_places_table, answer.curve, on_sphere=_on_sphere(results))
    for name, places in results.curves.items():
        tables[name.replace("_", "-")] = partial(_places_table, places)
    return tables


def _places_table(
    places: np.ndarray[tuple[int, ...], np.dtype[np.complex128]], on_sphere: bool = False
) -> Table:
    if on_sphere:
        columns = [("longitude", places.real.copy()), ("latitude", places.imag.copy())]
        return Table(tuple(Column(name, values, "rad") for name, values in columns))
    return Table((Column("x", places.real.copy(), "m"), Column("y", places.imag.copy(), "m")))


def _files(results: SynthesisResults) -> Iterator[tuple[str, str]]:
    """Every answer and its cognates as descriptions."""
    for number, answer in enumerate(results.answers, 1):
        yield f"answer-{number}.toml", mechanism_text(answer.mechanism)
        for place, cognate in enumerate(answer.cognates, 1):
            yield f"answer-{number}-cognate-{place}.toml", mechanism_text(cognate)


def _notes(results: SynthesisResults) -> Iterator[Text]:
    if not results.complete:
        yield Sentence("the search was stopped: there may be better answers")
    others = sum(len(answer.cognates) for answer in results.answers)
    if others:
        yield Counted(
            "{n} cognate with a crank draws the same curve as an answer",
            "{n} cognates with a crank draw the same curves as answers",
            others,
        )


# Pictures


def _pictures(results: SynthesisResults) -> Iterator[tuple[str, Picture]]:
    title = Title(results.task.title)
    if any(len(answer.curve) for answer in results.answers):
        yield "answers", _map(results, title)
    if results.curves:
        yield "curves", _pose_curves(results, title)
    if results.construction is not None:
        yield "construction", _limit_positions(results, title)
    if results.values is not None:
        yield "errors", _errors(results, title)


def _planar(places: np.ndarray[tuple[int, ...], np.dtype[np.complex128]]) -> Array:
    return np.column_stack([places.real, places.imag])


def _labels(results: SynthesisResults) -> tuple[AxisLabel, AxisLabel]:
    if _on_sphere(results):
        return AxisLabel(Sentence("longitude"), unit="rad"), AxisLabel(Sentence("latitude"), unit="rad")
    return AxisLabel(symbol=Symbol("x"), unit="m"), AxisLabel(symbol=Symbol("y"), unit="m")


def _map(results: SynthesisResults, title: Title) -> CurveMap:
    panels = []
    for number, answer in enumerate(results.answers, 1):
        if not len(answer.curve):
            continue
        places = answer.curve
        if _on_sphere(results):
            # at longitude 180 deg the map has its edge
            jump = np.append(np.abs(np.diff(places.real)) > np.pi, False)
            places = np.where(jump, complex(np.nan, np.nan), places)
        curve = MapCurve(Sentence("path of the point"), _planar(places), 0)
        panels.append(
            MapPanel(
                Sentence("answer {number}", number=Number(number, digits="d")),
                (curve,),
                _planar(results.targets),
                tuple(_skeleton(answer)),
                np.array(list(answer.mechanism.frame.points.values()), dtype=np.float64)[:, :2],
                _arrows(results),
            )
        )
    return CurveMap(
        Sentence("Answers with their curves"), title, *_labels(results), Sentence("targets"), tuple(panels)
    )


def _skeleton(answer: Answer) -> Iterator[Array]:
    """Links where the first target is met: those of a four-bar linkage by the angle of the crank."""
    if answer.links:
        yield from map(_planar, answer.links)
        return
    mechanism = answer.mechanism
    links = mechanism.links
    if mechanism.space != "plane" or set(links) != {"OA", "AB", "DB"} or not len(answer.drive):
        return
    at = np.array([mechanism.frame.points[name] for name in ("O", "D")], dtype=np.float64)
    fixed, other = at[:, 0] + 1j * at[:, 1]
    crank = _length(answer, "OA")
    joint = fixed + crank * np.exp(1j * answer.drive[0])
    local = {name: complex(*place[:2]) for name, place in links["AB"].coordinates.items()}
    point = next((name for name in local if name not in ("A", "B", "Q")), None)
    if point is None or not abs(local[point]) > 0:
        return
    direction = (answer.met[0] - joint) / local[point] if len(answer.met) else 1.0
    end = joint + direction * local["B"]
    yield _planar(np.array([fixed, joint]))
    yield _planar(np.array([joint, end, answer.met[0]]))
    yield _planar(np.array([other, end]))


def _arrows(results: SynthesisResults) -> Array | None:
    """Directions of the poses as arrows."""
    if results.task.synthesis.kind != "motion":
        return None
    rows = np.array(results.task.synthesis.rows, dtype=np.float64)
    spread = float(np.abs(results.targets - results.targets.mean()).max()) or 1.0
    ends = results.targets + 0.3 * spread * np.exp(1j * rows[: len(results.targets), 2])
    return np.stack([_planar(results.targets), _planar(ends)], axis=1)


def _limit_positions(results: SynthesisResults, title: Title) -> CurveMap:
    """Both limit positions of the best answer, with the circle from which the stroke is seen at one angle."""
    drawn = results.construction
    assert drawn is not None
    curves = [MapCurve(Sentence("circle of the crank's pin"), _planar(drawn.pin), 0)]
    if len(drawn.sight):
        curves.append(MapCurve(Sentence("circle that sees the stroke at theta"), _planar(drawn.sight), 1))
    panel = MapPanel(
        NOTHING, tuple(curves), _planar(drawn.ends), tuple(map(_planar, drawn.links)), _planar(drawn.fixed)
    )
    return CurveMap(
        Sentence("Limit positions"), title, *_labels(results), Sentence("ends of the stroke"), (panel,)
    )


def _pose_curves(results: SynthesisResults, title: Title) -> CurveMap:
    """Centre point and circle point curves around the poses."""
    names = {
        "centres": Sentence("centre point curve"),
        "circle_points": Sentence("circle point curve, in the first pose"),
    }
    middle = complex(results.targets.mean())
    reach = 4.0 * float(np.abs(results.targets - middle).max())
    curves = []
    for place, (name, places) in enumerate(results.curves.items()):
        near = np.abs(places - middle) < reach
        # neighbours far apart are not joined
        jump = np.append(np.abs(np.diff(places)) > 0.25 * reach, False)
        shown = np.where(near & ~jump, places, complex(np.nan, np.nan))
        curves.append(MapCurve(names[name], _planar(shown), place))
    panel = MapPanel(NOTHING, tuple(curves), _planar(results.targets), arrows=_arrows(results))
    return CurveMap(
        Sentence("Centre points and circle points"), title, *_labels(results), Sentence("poses"), (panel,)
    )


def _errors(results: SynthesisResults, title: Title) -> Plot:
    """Errors of the answers over the angle of the crank."""
    values = results.values
    assert values is not None
    curves = []
    for number, answer in enumerate(results.answers):
        if answer.deviations is not None:
            name = Sentence("answer {number}", number=Number(number + 1, digits="d"))
            curves.append(Curve(name, answer.deviations, number))
    count = np.arange(len(values), dtype=np.intp)
    label = AxisLabel(Sentence("angle of the crank from its start"), unit="rad")
    panel = CurvePanel(AxisLabel(Sentence("error of the rocker's angle"), unit="rad"), tuple(curves))
    return Plot(Sentence("Errors of the function"), title, Abscissa(label, values[:, 0], count), ((panel,),))
