"""What a teacher checks of a variant: whether it turns, and its motion and forces at the instants of a report.

Answers are plain numbers in SI, kept as JSON beside the report of their variant. The sheet of all is made from these
files, so that a run that was cut short goes on where it was.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from centrode.analysis.redesign.repair import Change
from centrode.analysis.redesign.single_changes import Dimension
from centrode.analysis.rotatability.causes import Cause, CauseKind, Tracer


@dataclass(frozen=True)
class InstantAnswers:
    """One instant; nothing but its place where the mechanism does not reach it.

    Attributes
    ----------
    title : in the language of the report
    reached : whether the mechanism gets there
    time : [s]
    values : of the drives [rad or m]
    links : name -> angle, angular velocity and acceleration [rad, rad/s, rad/s^2]; on the sphere those of hinges
    points : name -> speed and acceleration [m/s, m/s^2; on the sphere 1/s, 1/s^2]
    drives : name -> moment or force that the drive must give [N m or N]
    """

    title: str
    reached: bool
    time: float
    values: tuple[float, ...]
    links: Mapping[str, tuple[float, ...]]
    points: Mapping[str, tuple[float, ...]]
    drives: Mapping[str, float]


@dataclass(frozen=True)
class RepairedAnswers:
    """The answers of the mechanism that a report proposes in place of one that locks.

    Attributes
    ----------
    dimensions, changes : what is changed, and its values before and after
    angle, least_angle : transmission angle that every group keeps at least, and the exact least one [rad]
    instants : as of `VariantAnswers`
    """

    dimensions: tuple[Dimension, ...]
    changes: tuple[Change, ...]
    angle: float
    least_angle: float
    instants: tuple[InstantAnswers, ...]


@dataclass(frozen=True)
class VariantAnswers:
    """The answers of a variant.

    Attributes
    ----------
    turns_fully, limit, unit, group, cause, causes : as of `Rotation`, in the language of the report
    mobility, formula : of the mechanism, and its structure by Assur groups
    failure : why it cannot do what its study wants, in a sentence; empty if it can
    instants : one for each that the report has
    repaired : of the repaired mechanism; None where the variant makes its motion, or no repair was found
    """

    turns_fully: bool | None
    limit: float | None
    unit: str
    group: str
    cause: str
    causes: tuple[Cause, ...]
    mobility: int
    formula: str
    failure: str
    instants: tuple[InstantAnswers, ...]
    repaired: RepairedAnswers | None = None

    def json_text(self) -> str:
        """As the file of a variant holds them."""
        return json.dumps(asdict(self), indent=1, ensure_ascii=False) + "\n"


def read_answers(text: str) -> VariantAnswers:
    """The answers that `VariantAnswers.json_text` has written."""
    entries: dict[str, Any] = json.loads(text)
    causes = tuple(_cause(entry) for entry in entries.pop("causes"))
    instants = tuple(_instant(**entry) for entry in entries.pop("instants"))
    repaired = _repaired_answers(entries.pop("repaired", None))
    return VariantAnswers(**entries, causes=causes, instants=instants, repaired=repaired)


def _repaired_answers(entry: dict[str, Any] | None) -> RepairedAnswers | None:
    if entry is None:
        return None
    return RepairedAnswers(
        tuple(Dimension(**one) for one in entry["dimensions"]),
        tuple(Change(**one) for one in entry["changes"]),
        entry["angle"],
        entry["least_angle"],
        tuple(_instant(**one) for one in entry["instants"]),
    )


def _instant(
    values: list[float], links: dict[str, list[float]], points: dict[str, list[float]], **others: Any
) -> InstantAnswers:
    orders, speeds = ({name: tuple(numbers) for name, numbers in of.items()} for of in (links, points))
    return InstantAnswers(values=tuple(values), links=orders, points=speeds, **others)


def _cause(entry: dict[str, Any]) -> Cause:
    bodies = tuple((Tracer(tracer), name) for tracer, name in entry["bodies"])
    return Cause(
        CauseKind(entry["kind"]), bodies, tuple(entry["points"]), entry["stretched"], entry["distance"]
    )
