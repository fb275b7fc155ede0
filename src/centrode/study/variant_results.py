"""Variants of one topology: the same study of every row of a table, none of which stops the others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

from centrode.dynamics.motion_results import MotionResults, study
from centrode.equations.integration import integrate
from centrode.errors import InputError
from centrode.kinematics.preparation import ready
from centrode.locale import _, chosen_language, mark, ngettext, speaking
from centrode.model.mechanism import Mechanism
from centrode.study.rotation import Rotation, rotation_of
from centrode.study.variant_tables import Table, Variant, read_variants

if TYPE_CHECKING:
    import xarray as xr

Progress: TypeAlias = Callable[[int, int], None]

STEPS = 100
"""Fixed steps of the integration beside the motion, as the assignment has them."""
COMPUTED, LOCKS, REFUSED, FAULT = "ok", "locks", "refused", "fault"
NOT_COMPUTED = (REFUSED, FAULT)
SHOWN = 5
"""Causes told together; all stand in the summary."""
STATUS_WORDS: Mapping[str, str] = {
    COMPUTED: mark("ok"),
    LOCKS: mark("locks"),
    REFUSED: mark("refused"),
    FAULT: mark("fault"),
}


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
    status : "ok", "locks" (within the range of the study), "refused" (it is no mechanism that moves), "fault"
    """

    variant: str
    turns_fully: bool | None
    limit: float | None
    unit: str
    group: str
    cause: str
    status: str

    def as_dict(self) -> dict[str, str | float | bool | None]:
        """As a marker holds it."""
        return asdict(self)


@dataclass(frozen=True)
class VariantResults:
    """A variant with everything that is computed of it; only `row` where it was refused.

    `integration` is None as well where the equations of the mechanism cannot be integrated; `note` then says why.
    """

    row: VariantRow
    mechanism: Mechanism | None = None
    study: MotionResults | None = None
    integration: xr.Dataset | None = None
    note: str = ""


def variants(
    topology: Mechanism, table: Table, progress: Progress | None = None
) -> tuple[VariantResults, ...]:
    """The study, the rotatability and the integrated motion of every variant of a topology.

    Parameters
    ----------
    topology : Mechanism
        What all variants share; what it places is placed anew for each.
    table : path of a CSV file, or sequence of mappings from header to value
        A row a variant, a column a number (docs: assignment).
    progress : called with (variants done, variants in all)

    Raises
    ------
    InputError
        The table is wrong. A variant that is no mechanism has the status "refused" instead.
    """
    rows = read_variants(topology, table)
    found = []
    for number, variant in enumerate(rows, start=1):
        found.append(compute_variant(topology, variant))
        if progress is not None:
            progress(number, len(rows))
    return tuple(found)


def compute_variant(topology: Mechanism, variant: Variant) -> VariantResults:
    """One variant; what it says in words is English, as files are."""
    with speaking("en"):
        try:
            mechanism, results, rotation = study_variant(topology, variant)
        except InputError as refusal:
            return VariantResults(VariantRow(variant.name, None, None, "", "", str(refusal), REFUSED))
        try:
            integration, note = integrate(mechanism, steps=STEPS), ""
        except InputError as refusal:
            integration, note = None, str(refusal)
        return VariantResults(_row(variant.name, rotation, results), mechanism, results, integration, note)


def study_variant(topology: Mechanism, variant: Variant) -> tuple[Mechanism, MotionResults, Rotation]:
    """A variant's mechanism, its study and rotatability; raises InputError where it is none that moves."""
    mechanism = variant.of(topology)
    prepared = ready(mechanism)
    return mechanism, study(mechanism), rotation_of(prepared)


def _row(name: str, rotation: Rotation, results: MotionResults) -> VariantRow:
    status = LOCKS if results.unreached else COMPUTED
    cause = cause_of(rotation)
    return VariantRow(
        name, rotation.turns_fully, rotation.limit, rotation.unit, rotation.group, cause, status
    )


def cause_of(rotation: Rotation) -> str:
    """Why a variant locks, in words and in symbols."""
    return f"{rotation.cause}: {rotation.condition}" if rotation.condition else rotation.cause


def variants_summary(rows: Sequence[VariantRow]) -> tuple[str, str | None]:
    """How many variants there are of each status; and why some were not computed, None where all were."""
    found = Counter(row.status for row in rows)
    said = ", ".join(f"{_(word)} {found[status]}" for status, word in STATUS_WORDS.items() if found[status])
    summary = ngettext("{n} variant", "{n} variants", len(rows)).format(n=len(rows)) + f": {said}"
    missing = [row for row in rows if row.status in NOT_COMPUTED]
    if not missing:
        return summary, None
    what = ngettext("{n} variant was not computed", "{n} variants were not computed", len(missing))
    causes = [f"{row.variant}: {row.cause}" for row in missing[:SHOWN]]
    return summary, "\n".join([what.format(n=len(missing)), *causes])


def variant_rows(rows: Iterable[VariantRow]) -> list[tuple[str, str, str, str, str]]:
    """What `centrode variants` prints of each variant: name, full turn, limit, group, status."""
    words = {True: _("yes"), False: _("no"), None: ""}
    return [
        (
            row.variant,
            words[row.turns_fully],
            "" if row.limit is None else f"{row.limit:.9g} {row.unit}",
            row.group,
            _(STATUS_WORDS[row.status]),
        )
        for row in rows
    ]


# What is said of variants in the language of the reader: summaries, which files hold, are English.


def spoken_variants(topology: Mechanism, table: Table, rows: Sequence[VariantRow]) -> tuple[VariantRow, ...]:
    """Rows of a summary with groups and causes in the language that is spoken.

    What a variant was refused for, or where it locks, is asked for anew: some 0.1 s each. Faults of the program
    stay English.

    Parameters
    ----------
    topology, table : as of `variants`
    rows : those that were computed of them, or some of these
    """
    if chosen_language() == "en":
        return tuple(rows)
    variants = {variant.name: variant for variant in read_variants(topology, table)}
    return tuple(_spoken(topology, variants[row.variant], row) for row in rows)


def _spoken(topology: Mechanism, variant: Variant, row: VariantRow) -> VariantRow:
    if row.status == REFUSED:
        try:
            study_variant(topology, variant)
        except InputError as refusal:
            return replace(row, cause=str(refusal))
    elif row.group:
        rotation = rotation_of(ready(variant.of(topology)))
        return replace(row, group=rotation.group, cause=cause_of(rotation))
    return row
