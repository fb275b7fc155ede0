"""The motion of a mechanism: what the terminal, the files, the figures and the document show of `run`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import lazy_loader
import numpy as np

from centrode.errors import STATUSES_OF_MOTION, CentrodeError, Status
from centrode.sheets.linkages import MechanismPicture, PathsPicture
from centrode.sheets.players import MotionPlayer
from centrode.sheets.plots import Plot
from centrode.sheets.sheet import (
    Chapter,
    Deferred,
    Fact,
    FactTable,
    Illustration,
    Paragraph,
    Scalar,
    Section,
    Sheet,
)
from centrode.sheets.texts import NOTHING, Counted, Joined, Name, Number, Sentence, Text, Title
from centrode.views import structure
from centrode.views.abscissa import CHANGE_POINT, LIMIT, events, motion_abscissa, over_drive, reached_part
from centrode.views.columns import coefficients_table, counted_statuses, motion_table, without_rounding
from centrode.views.instants import place_number
from centrode.views.limits import reached_text, unreached_failure
from centrode.views.motion_plots import (
    PlottedMotion,
    panels_of_coefficients,
    panels_of_guides,
    panels_of_hinges,
    panels_of_joints,
    panels_of_links,
    panels_of_points,
    turning_links,
)
from centrode.views.motion_tables import tables_chapter
from centrode.views.reactions import self_locking_samples, self_locking_text

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.motion_results import MotionResults
    from centrode.kinematics.check import MechanismCheck
    from centrode.model.mechanism import Mechanism
    from centrode.sheets.pictures import Picture
    from centrode.sheets.plots import Abscissa
    from centrode.sheets.sheet import Block, Table
    from centrode.views.motion_plots import Rows

# what conclusions rest on is too much for a command that only prints
_conclusions_view = partial(lazy_loader.load, "centrode.views.conclusions", suppress_warning=True)

EVENT_NAMES = {LIMIT: "limit", CHANGE_POINT: "change_point"}
"""Kind of an event -> what a scalar is called that has its place."""


PRESCRIBED = Sentence(
    "the motion is prescribed, loads do not change it: centrode reduce reduces them to the drive"
)


def sheet(results: MotionResults) -> Sheet:
    """Structure, range, statuses and notes of a motion, its tables and figures; its parts have sheets of their own."""
    mechanism, exact = results.mechanism, results.instants
    values = (
        mechanism.study.instants if exact is None else mechanism.motion_parameter.instants(exact).tolist()
    )
    pictures = motion_pictures(mechanism, results.motion, values, exact)
    datasets = {"motion": results.motion}
    chapters = {
        "motion": partial(_motion_chapter, results),
        "plots": partial(_plots_chapter, results, pictures),
        "conclusions": partial(_conclusions, results),
    }
    if results.shown is not None:
        chapters["tables"] = partial(_tables_chapter, results, results.shown)
    if results.coefficients is not None:
        datasets["coefficients"] = results.coefficients
    return Sheet(
        facts=(*structure.facts(results.check), *_facts(results)),
        scalars=dict(_scalars(results)),
        tables=_tables(results),
        datasets=datasets,
        pictures=pictures,
        chapters=Deferred(chapters),
        failure=unreached_failure(mechanism, results.motion["status"], results.limits),
        notes=(*_notes(results), *_omissions(results)),
    )


# Facts, notes, numbers


def _facts(results: MotionResults) -> Iterator[Fact]:
    """Range, events, statuses and worst residual."""
    status = results.motion["status"].values
    yield Fact(Sentence("range"), _range(results))
    if results.unreached_samples:
        yield Fact(Sentence("reached part"), reached_text(results))
    yield Fact(Sentence("limits"), _events(results, LIMIT))
    yield Fact(Sentence("change points"), _events(results, CHANGE_POINT))
    samples = Joined((Number(len(status), digits="d"), counted_statuses(status)), ": ")
    yield Fact(Sentence("samples"), samples)
    residual = Sentence(
        "{value} of the greatest length ({constraint})",
        value=Number(results.motion.attrs["worst_residual"], digits=".1e"),
        constraint=Name(results.worst_constraint),
    )
    yield Fact(Sentence("worst residual"), residual)


def _range(results: MotionResults) -> Text:
    """From where to where, and how long that takes; times and extremes of the drives where a law drives."""
    parameter, (first, last) = results.mechanism.motion_parameter, _ends(results, "time")
    if parameter.is_uniform:
        values = parameter.values(results.motion)
        if parameter.constant_speed == 0.0:
            return Sentence(
                "{first} to {last}, at rest in each position",
                first=place_number(float(values[0]), parameter.variable.unit),
                last=place_number(float(values[-1]), parameter.variable.unit),
            )
        return Sentence(
            "{first} to {last} in {duration}",
            first=place_number(float(values[0]), parameter.variable.unit),
            last=place_number(float(values[-1]), parameter.variable.unit),
            duration=Number(abs(last - first), "s"),
        )
    reached = [
        Sentence(
            "{drive} between {low} and {high}",
            drive=Name(name),
            low=place_number(low, unit),
            high=place_number(high, unit),
        )
        for name, unit, low, high in _extremes(results)
    ]
    return Sentence(
        "{first} to {last}, {drives}",
        first=place_number(first, "s"),
        last=place_number(last, "s"),
        drives=Joined(reached),
    )


def _ends(results: MotionResults, variable: str) -> tuple[float, float]:
    values = results.motion[variable].values
    return float(values[0]), float(values[-1])


def _extremes(results: MotionResults) -> Iterator[tuple[str, str, float, float]]:
    """Name, unit, least and greatest value of each drive among the samples."""
    values = results.motion["drive_value"].values
    for drive, one in zip(results.mechanism.motion_parameter.drives, values.T, strict=True):
        low, high = without_rounding([np.min(one), np.max(one)]).tolist()
        yield drive.label, drive.unit, low, high


def _events(results: MotionResults, kind: int) -> Text:
    """Places of the events of one kind, each once."""
    unit = results.mechanism.motion_parameter.variable.unit
    places = [place_number(place, unit) for place in _places(results, kind)]
    return Joined(places, "; ") if places else Sentence("none")


def _places(results: MotionResults, kind: int) -> list[float]:
    return list(dict.fromkeys(place for place, which in events(results.motion) if which == kind))


def _notes(results: MotionResults) -> Iterator[Text]:
    """What is singular, what is left out and why, what does not come back, what loads do not do."""
    mechanism = results.mechanism
    singular = int((results.motion["status"] == Status.SINGULAR).sum())
    if singular:
        yield Counted(
            "{n} sample is singular: its position is given, its derivatives do not exist",
            "{n} samples are singular: their positions are given, their derivatives do not exist",
            singular,
        )
    if len(mechanism.drives) > 1 and results.coefficients is None:
        yield Sentence(
            "kinematic coefficients by each drive are omitted; choose at most {most} samples",
            most=Number(results.most_samples, digits="d"),
        )
    if not results.comes_back:
        yield Sentence("after one turn of the drive the mechanism does not return to its initial position")
    if mechanism.loads and mechanism.machine is None:
        yield PRESCRIBED
    if results.reactions is not None and (locked := self_locking_samples(results.reactions.reactions)):
        yield self_locking_text(locked)


def _omissions(results: MotionResults) -> Iterator[Text]:
    """Why results of the motion are omitted; in a document their own chapters say it."""
    if (refusal := results.refusals.get("flywheel")) is not None:
        yield Sentence("the machine is omitted: {reason}", reason=_reason(refusal))
    if (refusal := results.refusals.get("reactions")) is not None:
        yield Sentence("reactions are omitted: {reason}", reason=_reason(refusal))


def _reason(refusal: CentrodeError) -> Name:
    """What an error says, as it stands."""
    what = f"{refusal.where}: {refusal.what}" if refusal.where else refusal.what
    return Name(f"{what}; {refusal.repair}" if refusal.repair else what)


def _scalars(results: MotionResults) -> Iterator[tuple[str, Scalar]]:
    """Numbers of structure and motion, as `summary.json` holds them."""
    data, parameter = results.motion, results.mechanism.motion_parameter
    unit, values, status = parameter.variable.unit, parameter.values(data), data["status"].values
    yield from _scalars_of_structure(results.check)
    yield "samples", Scalar(len(status), "1")
    yield "first_value", Scalar(float(values[0]), unit)
    yield "last_value", Scalar(float(values[-1]), unit)
    first, last = _ends(results, "time")
    yield "duration", Scalar(abs(last - first), "s")
    if not parameter.is_uniform:
        yield "first_time", Scalar(first, "s")
        yield "last_time", Scalar(last, "s")
        for name, own, low, high in _extremes(results):
            yield f"least_{name}", Scalar(low, own)
            yield f"greatest_{name}", Scalar(high, own)
    yield "worst_residual", Scalar(data.attrs["worst_residual"], "1")
    for code in STATUSES_OF_MOTION:
        yield f"samples_{code.name.lower()}", Scalar(int(np.sum(status == code)), "1")
    for kind, event in EVENT_NAMES.items():
        for number, place in enumerate(_places(results, kind), start=1):
            yield f"{event}_{number}", Scalar(place, unit)


def _scalars_of_structure(checked: MechanismCheck) -> Iterator[tuple[str, Scalar]]:
    count = checked.count
    yield "mobility", Scalar(checked.mobility, "1")
    yield "mobility_by_chebyshev", Scalar(count.mobility, "1")
    yield "moving_links", Scalar(count.moving_links, "1")
    yield "lower_pairs", Scalar(count.lower_pairs, "1")
    yield "higher_pairs", Scalar(count.higher_pairs, "1")
    yield "redundant_constraints", Scalar(len(checked.redundant), "1")
    yield "loops", Scalar(count.loops, "1")
    yield "initial_residual", Scalar(checked.initial_residual, "1")


def _tables(results: MotionResults) -> dict[str, Table]:
    points = results.mechanism.moving_points
    tables = {"motion": motion_table(results.motion, points)}
    if results.instants is not None:
        tables["instants"] = motion_table(results.instants, points)
    if results.coefficients is not None:
        tables["coefficients"] = coefficients_table(results.coefficients, points)
    return tables


# Figures


def motion_pictures(
    mechanism: Mechanism,
    motion: xarray.Dataset,
    values: Sequence[float] = (),
    instants: xarray.Dataset | None = None,
) -> Mapping[str, Picture]:
    """The mechanism, the paths of its points, and curves of everything that moves.

    Parameters
    ----------
    motion : Dataset
        Of `motion`, without batch dimensions.
    values : sequence of float [rad or m; s with a law or several drives]
        At which the mechanism is drawn, each at the nearest sample; in the initial position without any.
    instants : Dataset
        The motion exactly there.
    """
    return Deferred(dict(_pictures(mechanism, motion, tuple(values), instants)))


def _pictures(
    mechanism: Mechanism, motion: xarray.Dataset, values: tuple[float, ...], instants: xarray.Dataset | None
) -> Iterator[tuple[str, Callable[[], Picture]]]:
    title = Sentence("Mechanism")
    # of an instant that is not reached the picture says so: only the exact motion there has it then
    shown = motion if values and instants is None else reached_part(motion)
    yield "mechanism", partial(MechanismPicture, title, mechanism, shown, values, instants)
    yield "paths", partial(_paths, mechanism, motion)
    parameter = mechanism.motion_parameter
    plotted = PlottedMotion(mechanism, motion, parameter.drives[0].speed if parameter.is_uniform else 1.0)
    for name, (title, rows) in _curves(plotted).items():
        yield name, partial(_plot, plotted, title, rows)
    if not mechanism.motion_parameter.by_time and "velocity_coefficient" in motion:
        rows, title = partial(panels_of_coefficients, plotted), Sentence("Kinematic coefficients")
        yield "kinematic-coefficients", partial(_plot, plotted, title, rows, over_drive)


def _paths(mechanism: Mechanism, motion: xarray.Dataset) -> PathsPicture:
    motion = reached_part(motion)
    abscissa = motion_abscissa(mechanism, motion)
    return PathsPicture(Sentence("Paths of the points"), mechanism, motion, mechanism.moving_points, abscissa)


def _curves(motion: PlottedMotion) -> Mapping[str, tuple[Sentence, Callable[[], Rows]]]:
    """Name -> title and panels of the figures that have something to show."""
    found: dict[str, tuple[Sentence, Callable[[], Rows]]] = {}
    if motion.joints:
        found |= {
            "joint-angles": (
                Sentence("Angles from the reference arcs"),
                partial(panels_of_joints, motion, "joint_angle"),
            ),
            "joint-velocities": (
                Sentence("Angular velocities from the reference arcs"),
                partial(panels_of_joints, motion, "joint_velocity"),
            ),
            "joint-accelerations": (
                Sentence("Angular accelerations from the reference arcs"),
                partial(panels_of_joints, motion, "joint_acceleration"),
            ),
        }
    if motion.hinges:
        found["hinge-angles"] = (
            Sentence("Angles between links at their hinges"),
            partial(panels_of_hinges, motion),
        )
    if turning_links(motion.mechanism):
        if len(motion.components) == 2:
            found["angles"] = (Sentence("Angles of the links"), partial(panels_of_links, motion, "angle"))
        found |= {
            "angular-velocities": (
                Sentence("Angular velocities of the links"),
                partial(panels_of_links, motion, "angular_velocity"),
            ),
            "angular-accelerations": (
                Sentence("Angular accelerations of the links"),
                partial(panels_of_links, motion, "angular_acceleration"),
            ),
        }
    if motion.places["point"]:
        found |= {
            "velocities": (
                Sentence("Velocities of the points"),
                partial(panels_of_points, motion, "velocity"),
            ),
            "accelerations": (
                Sentence("Accelerations of the points"),
                partial(panels_of_points, motion, "acceleration"),
            ),
        }
    if motion.places["guide"]:
        slides = ("slide", "slide_velocity", "slide_acceleration")
        found["slides"] = (Sentence("Motion along the guides"), partial(panels_of_guides, motion, slides))
    return found


def _plot(
    motion: PlottedMotion,
    title: Sentence,
    rows: Callable[[], Rows],
    across: Callable[[Mechanism, xarray.Dataset], Abscissa] = motion_abscissa,
) -> Plot:
    mechanism = motion.mechanism
    return Plot(title, Title(mechanism.title), across(mechanism, motion.dataset), rows())


# Chapters

CAPTIONS = {
    "mechanism": Sentence("The mechanism"),
    "paths": Sentence("Paths of the points"),
    "angles": Sentence("Angles of the links"),
    "joint-angles": Sentence("Angles of the links in their hinges"),
    "joint-velocities": Sentence("Angular velocities in the hinges"),
    "joint-accelerations": Sentence("Angular accelerations in the hinges"),
    "hinge-angles": Sentence(
        "Angles between links at their hinges, with relative angular velocities and accelerations"
    ),
    "angular-velocities": Sentence("Angular velocities of the links"),
    "angular-accelerations": Sentence("Angular accelerations of the links"),
    "velocities": Sentence("Velocities of the points"),
    "accelerations": Sentence("Accelerations of the points"),
    "slides": Sentence("Motion along the guides"),
    "kinematic-coefficients": Sentence("Kinematic coefficients"),
}
"""Of the figures in a document."""
ON_SPHERE = {
    "mechanism": Sentence("The mechanism from outside; hidden lines are dashed"),
    "slides": Sentence("Motion along the circles"),
}
"""Those that differ on the sphere."""
DETAILS = ("mechanism", "kinematic-coefficients")
"""Those that only the full form of a document shows."""


def _motion_chapter(results: MotionResults) -> Chapter:
    """The mechanism in motion, which a page plays and a PDF shows in its initial position."""
    player = MotionPlayer(results.mechanism, results.motion)
    return Chapter(Sentence("Motion"), (Section(NOTHING, (player,)),))


def _conclusions(results: MotionResults) -> Chapter:
    """What follows from the results."""
    chapter: Chapter = _conclusions_view().conclusions_chapter(results)
    return chapter


TOGETHER: Mapping[tuple[str, ...], Sentence] = {
    ("angles", "angular-velocities", "angular-accelerations"): Sentence(
        "Angles, angular velocities and angular accelerations of the links"
    ),
    ("joint-angles", "joint-velocities", "joint-accelerations"): Sentence(
        "Angles, angular velocities and angular accelerations in the hinges"
    ),
}
"""Figures that a document shows as one where each has one panel."""


def _plots_chapter(results: MotionResults, pictures: Mapping[str, Picture]) -> Chapter:
    """The figures that a run draws, those of the links one below the other."""
    mechanism = results.mechanism
    captions = CAPTIONS | (ON_SPHERE if mechanism.space == "sphere" else {})
    joined: dict[str, Illustration | None] = {}
    for names, caption in TOGETHER.items():
        plots = [plot for name in names if name in pictures and isinstance(plot := pictures[name], Plot)]
        if len(plots) == len(names) and all(len(plot.rows) == 1 for plot in plots):
            rows = tuple(row for plot in plots for row in plot.rows)
            joined |= dict.fromkeys(names) | {
                names[0]: Illustration(replace(plots[0], title=caption, rows=rows))
            }
    figures = (joined.get(name, Illustration(name, captions[name], name in DETAILS)) for name in pictures)
    blocks: tuple[Block, ...] = (
        *(Paragraph(text, clause=True) for text in _reach(results)),
        *(one for one in figures if one is not None),
    )
    return Chapter(Sentence("Plots of the motion"), (Section(NOTHING, blocks),))


def _reach(results: MotionResults) -> Iterator[Text]:
    """Which part of the motion a document shows where the mechanism locks."""
    if results.unreached_samples:
        yield Sentence("tables and plots cover what is reached: {part}", part=reached_text(results))


def _tables_chapter(results: MotionResults, shown: xarray.Dataset) -> Chapter:
    facts = tuple(_facts(results))[:-1]  # the worst residual is among the checks
    failure = unreached_failure(results.mechanism, results.motion["status"], results.limits)
    sentences = [] if failure is None else [failure.what]
    # which command goes on is no part of a document
    notes = (note for note in _notes(results) if note != PRESCRIBED)
    head: tuple[Block, ...] = (
        FactTable(facts, Sentence("Range of the motion")),
        *(Paragraph(text, clause=True) for text in (*sentences, *_reach(results), *notes)),
    )
    return tables_chapter(results, shown, head)
