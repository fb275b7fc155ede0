"""Variants of one topology: the same study of every row of a table, none of which stops the others."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any, TypeAlias

from centrode.analysis.operation import first_limits
from centrode.analysis.rotatability.rotatability import rotatability
from centrode.assignments.answers import VariantAnswers
from centrode.assignments.tables import Table, Variant, read_variants
from centrode.dynamics.motion_results import MotionResults, study
from centrode.equations.integration import integrate_both
from centrode.errors import CentrodeError, InputError
from centrode.kinematics.preparation import ready
from centrode.locale import _, chosen_language, speaking
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.printed_results import PrintsSummary
from centrode.quantities import display_unit
from centrode.sheets.texts import Joined, Name, Number, Sentence
from centrode.views.rotatability import cause_text

if TYPE_CHECKING:
    import xarray as xr

    from centrode.analysis.rotatability.causes import Cause
    from centrode.kinematics.preparation import Ready
    from centrode.model.settings import Display
    from centrode.sheets.texts import Text

# Whether a drive turns fully, and what stops it first: what a summary in one row says of it.


@dataclass(frozen=True)
class Rotation:
    """What bounds the motion from the initial position.

    Attributes
    ----------
    turns_fully : None where there are several drives, or the drive is no angle
    limit : float or None
        Value of the drive at which it stops first, in the sense in which it moves; where it is free in that sense,
        the limit in the other one [rad or m].
    unit : of the limit
    group, cause, condition : which group stops it, why in words, and in symbols; empty where nothing does
    causes : the causes as data
    """

    turns_fully: bool | None
    limit: float | None = None
    unit: str = ""
    group: str = ""
    cause: str = ""
    condition: str = ""
    causes: tuple[Cause, ...] = ()


def rotation_of(prepared: Ready) -> Rotation:
    """What a drive meets on its way."""
    found = rotatability(prepared.mechanism)
    if len(found.drives) != 1:
        return Rotation(found.turns_fully)
    met = first_limits(found, forward=prepared.kinematics.path.forward > 0)
    if not met:
        return Rotation(found.turns_fully)
    display = prepared.mechanism.display
    return Rotation(
        found.turns_fully,
        met[0].value,
        found.one.unit,
        _join(limit.group for limit in met),
        _join(_cause_words(cause_text(limit.cause), display) for limit in met),
        _join(str(limit.condition) for limit in met),
        tuple(dict.fromkeys(limit.cause for limit in met)),
    )


def _join(texts: Iterable[str]) -> str:
    return "; ".join(dict.fromkeys(texts))


def _cause_words(text: Text, display: Display) -> str:
    """The sentence of a cause in the language that is spoken."""
    match text:
        case Name(name):
            return name
        case Number(value, unit, digits):
            factor, shown = display_unit(unit, display.length, display.angle)
            return f"{value * factor:{digits}} {shown}"
        case Joined(parts, between):
            return between.join(_cause_words(part, display) for part in parts)
        case Sentence(message, values):
            return _(message).format(**{hole: _cause_words(value, display) for hole, value in values.items()})
    raise TypeError(type(text).__name__)


Progress: TypeAlias = Callable[[int, int], None]

# what analyses of machines need is not loaded for motions
_studies = functools.partial(importlib.import_module, "centrode.sweeps.parameter_studies")

STEPS = 100
"""Fixed steps of the integration beside the motion, as the assignment has them."""
COMPUTED, LOCKS, REFUSED, FAULT = "ok", "locks", "refused", "fault"


@dataclass(frozen=True)
class VariantRow:
    """One row of the summary, in SI and in English.

    Attributes
    ----------
    variant : its name
    turns_fully : None where that cannot be said
    limit : value of the drive at which the variant locks first [rad or m]
    unit : of the limit
    group, cause : which group locks, and the sentence that tells it; why a variant was not computed
    refusal : why the analysis of each variant was refused for this one; empty where it was not
    status : "ok", "locks" (within the range of the study), "refused" (it is no mechanism that moves), "fault"
    numbers : name -> value and SI unit, of an analysis of each variant; empty without one, or where it is refused
    """

    variant: str
    turns_fully: bool | None
    limit: float | None
    unit: str
    group: str
    cause: str
    status: str
    numbers: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    refusal: str = ""

    @property
    def is_computed(self) -> bool:
        """Whether the variant is a mechanism whose motion is known, as far as it gets."""
        return self.status in (COMPUTED, LOCKS)

    def as_dict(self) -> dict[str, Any]:
        """As a marker holds it."""
        return asdict(self)


@dataclass(frozen=True)
class VariantResults:
    """A variant with everything that is computed of it; only `row` where it was refused.

    `integration` is None as well where the equations of the mechanism cannot be integrated; `note` then says why.
    `adaptive` is the same by the adaptive method, which judges the fixed steps and which reports show.
    """

    row: VariantRow
    mechanism: Mechanism | None = None
    study: MotionResults | None = None
    integration: xr.Dataset | None = None
    note: str = ""
    adaptive: xr.Dataset | None = None


@dataclass(frozen=True, repr=False)
class Variants(PrintsSummary):
    """Every variant of a table.

    Attributes
    ----------
    mechanism : the topology, whose numbers the table varies
    given : the rows of the table
    rows : one a variant, in the order of the table
    results : everything about each, where it is kept in memory; empty of variants that are written into folders
    answers : name of a variant -> what a teacher checks of it, where reports have been written
    compute : the analysis whose numbers the rows have; None without one
    """

    mechanism: Mechanism
    given: tuple[Variant, ...]
    rows: tuple[VariantRow, ...]
    results: tuple[VariantResults, ...] = ()
    answers: Mapping[str, VariantAnswers] = field(default_factory=dict)
    compute: str | None = None


def variants(
    topology: MechanismSource, table: Table, progress: Progress | None = None, compute: str | None = None
) -> Variants:
    """The study, the rotatability and the integrated motion of every variant of a topology.

    Parameters
    ----------
    topology : Mechanism
        What all variants share; what it places is placed anew for each.
    table : path of a CSV file, or sequence of mappings from header to value
        A row a variant, a column a number (docs: assignment).
    progress : called with (variants done, variants in all)
    compute : None, "simulate", "steady_motion", "flywheel" or "reactions"
        The analysis whose extremes, their places and unevenness each row has besides (docs: parameter studies).

    Raises
    ------
    InputError
        The table is wrong, there is no such analysis. A variant that is not a mechanism has the status "refused"
        instead.

    Examples
    --------
    >>> import centrode as ct
    >>> rows = [{"variant": "long", "links.AB.length": 3.6}, {"variant": "short", "links.AB.length": 3.4}]
    >>> [row.turns_fully for row in ct.variants(ct.example("crank-rocker"), rows).rows]
    [True, True]
    """
    topology = mechanism_of(topology)
    if compute is not None:
        _studies().check_analysis(compute)
    given = read_variants(topology, table)
    results = []
    for number, variant in enumerate(given, start=1):
        results.append(compute_variant(topology, variant, compute))
        if progress is not None:
            progress(number, len(given))
    rows = tuple(result.row for result in results)
    return Variants(topology, given, rows, tuple(results), compute=compute)


def compute_variant(topology: Mechanism, variant: Variant, compute: str | None = None) -> VariantResults:
    """One variant, with the numbers of an analysis; what it says in words is English, as files are."""
    with speaking("en"):
        try:
            mechanism, results, rotation = study_variant(topology, variant)
        except InputError as refusal:
            return VariantResults(VariantRow(variant.name, None, None, "", "", str(refusal), REFUSED))
        try:
            integration, adaptive = integrate_both(mechanism, STEPS)
            note = ""
        except InputError as refusal:
            integration, adaptive, note = None, None, str(refusal)
        row = _row(variant.name, rotation, results)
        if compute is not None:
            row = _with_numbers(row, mechanism, compute)
        return VariantResults(row, mechanism, results, integration, note, adaptive)


def _with_numbers(row: VariantRow, mechanism: Mechanism, compute: str) -> VariantRow:
    """A row with the numbers of an analysis; where it is refused, with the reason."""
    try:
        return replace(row, numbers=_studies().study_numbers(mechanism, compute))
    except CentrodeError as refusal:
        return replace(row, refusal=str(refusal))


def study_variant(topology: Mechanism, variant: Variant) -> tuple[Mechanism, MotionResults, Rotation]:
    """A variant's mechanism, its study and rotatability; raises InputError where it is none that moves."""
    mechanism = variant.of(topology)
    prepared = ready(mechanism)
    return mechanism, study(mechanism), rotation_of(prepared)


def _row(name: str, rotation: Rotation, results: MotionResults) -> VariantRow:
    status = LOCKS if results.unreached_samples else COMPUTED
    cause = cause_of(rotation)
    return VariantRow(
        name, rotation.turns_fully, rotation.limit, rotation.unit, rotation.group, cause, status
    )


def cause_of(rotation: Rotation) -> str:
    """Why a variant locks, in words and in symbols."""
    return f"{rotation.cause}: {rotation.condition}" if rotation.condition else rotation.cause


# Variants in the language of the reader: summaries, which files hold, are English.


def spoken_variants(variants: Variants) -> Variants:
    """The same with the groups and causes of its rows in the language that is spoken.

    Why a variant or its analysis was refused, and where it locks, is computed anew: some 0.1 s each. Faults of the
    program stay English.
    """
    if chosen_language() == "en":
        return variants
    given = {variant.name: variant for variant in variants.given}
    rows = (_spoken(variants, given[row.variant], row) for row in variants.rows)
    return replace(variants, rows=tuple(rows))


def _spoken(variants: Variants, variant: Variant, row: VariantRow) -> VariantRow:
    topology = variants.mechanism
    if row.refusal and variants.compute is not None:
        row = _with_numbers(row, variant.of(topology), variants.compute)
    if row.status == REFUSED:
        try:
            study_variant(topology, variant)
        except InputError as refusal:
            return replace(row, cause=str(refusal))
    elif row.group:
        rotation = rotation_of(ready(variant.of(topology)))
        return replace(row, group=rotation.group, cause=cause_of(rotation))
    return row
