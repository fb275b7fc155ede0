"""What is said of variants in the language of the reader: summaries, which files hold, are English."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from centrode.errors import InputError
from centrode.kinematics.preparation import ready
from centrode.locale import chosen_language
from centrode.model.mechanism import Mechanism
from centrode.study.rotation import rotation_of
from centrode.study.variants.computing import REFUSED, VariantRow, cause_of, studied
from centrode.study.variants.tables import Table, Variant, read_variants


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
            studied(topology, variant)
        except InputError as refusal:
            return replace(row, cause=str(refusal))
    elif row.group:
        rotation = rotation_of(ready(variant.of(topology)))
        return replace(row, group=rotation.group, cause=cause_of(rotation))
    return row
