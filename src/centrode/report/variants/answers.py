"""The answers of a variant, from the results that its report is made of, and the sheet of all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode import render
from centrode.assignments.answers import InstantAnswers, RepairedAnswers, VariantAnswers
from centrode.assignments.results import rotation_of
from centrode.dynamics.kinetostatics.reactions import reactions
from centrode.errors import CentrodeError
from centrode.kinematics.preparation import ready
from centrode.locale import _, chosen_language, ngettext
from centrode.model.settings import DIGITS
from centrode.render.document.blocks import Report
from centrode.render.document.chapters import document_chapter
from centrode.render.document.numbers import Numbers
from centrode.report.repaired_mechanism import proposed_repair, repaired_study
from centrode.report.study import Moment, moments_of
from centrode.topics.presentation import sheet_of
from centrode.version import __version__

if TYPE_CHECKING:
    from centrode.assignments.results import Variants
    from centrode.report.study import ReportStudy

OF_LINKS = ("angle", "angular_velocity", "angular_acceleration")
ON_SPHERE = ("joint_angle", "joint_velocity", "joint_acceleration")
OF_POINTS = ("velocity", "acceleration")


def answer_sheet(variants: Variants) -> Report:
    """Data, rotatability and the numbers at the instants of all variants, in the language that is spoken."""
    topology = variants.mechanism
    numbers, sheet = Numbers(topology.display, topology.report.digits or DIGITS), sheet_of(variants)
    title = _("Answers: {topology}").format(topology=_(topology.title) or _("Mechanism"))
    count = ngettext("{n} variant", "{n} variants", len(variants.rows)).format(n=len(variants.rows))
    made = _("Computed by centrode {version}").format(version=__version__)
    chapters = tuple(document_chapter(name, sheet, numbers) for name in sheet.chapters)
    return Report(title, f"{count}. {made}", chosen_language(), chapters)


def answers_of(study: ReportStudy) -> VariantAnswers:
    """The answers of a mechanism, in the words of the language that is spoken."""
    rotation, failure = rotation_of(ready(study.mechanism)), sheet_of(study.study).failure
    return VariantAnswers(
        rotation.turns_fully,
        rotation.limit,
        rotation.unit,
        rotation.group,
        rotation.cause,
        rotation.causes,
        study.check.mobility,
        study.check.formula,
        "" if failure is None else render.plain_text(failure.what, study.mechanism.display),
        tuple(_at(study, moment) for moment in moments_of(study)),
        _repaired_answers(study),
    )


def _repaired_answers(study: ReportStudy) -> RepairedAnswers | None:
    """The answers of the mechanism that the report proposes; None where there is none."""
    proposed = proposed_repair(study)
    if proposed is None:
        return None
    own = repaired_study(study, proposed)
    instants = tuple(_at(own, moment) for moment in moments_of(own))
    return RepairedAnswers(
        proposed.dimensions, proposed.changes, proposed.angle, proposed.least_angle, instants
    )


def _at(study: ReportStudy, moment: Moment) -> InstantAnswers:
    """One instant: angles and rates of the links, speeds of the points, what the drives give."""
    here = moment.data.isel(sample=moment.sample)
    links: dict[str, tuple[float, ...]] = {}
    points: dict[str, tuple[float, ...]] = {}
    if moment.is_reached:
        dimension, names = ("link", OF_LINKS) if study.is_planar else ("joint", ON_SPHERE)
        for label in here[dimension].values.tolist():
            links[label] = tuple(float(here[name].sel({dimension: label})) for name in names)
        for point in study.mechanism.moving_points:
            vectors = (here[name].sel(point=point).values for name in OF_POINTS)
            points[point] = tuple(float(np.linalg.norm(vector)) for vector in vectors)
    return InstantAnswers(
        moment.title,
        moment.is_reached,
        float(here["time"]),
        tuple(here["drive_value"].values.tolist()),
        links,
        points,
        _drives(study, moment) if moment.is_reached else {},
    )


def _drives(study: ReportStudy, moment: Moment) -> dict[str, float]:
    """What each drive has to give, where masses or loads are there and reactions can be found."""
    if study.study.reactions is None:
        return {}
    places, motion = [place.at for place in moments_of(study)], study.motion_of_forces
    try:
        found = study.once(
            "reactions at instants", lambda: reactions(study.mechanism, at=places, motion=motion)
        )
    except CentrodeError:
        return {}
    here = found.isel(sample=moment.sample)
    values = here["balancing"].values.tolist()
    balancing = dict(zip(here["drive"].values.tolist(), values, strict=True))
    return {name: value for name, value in balancing.items() if np.isfinite(value)}
