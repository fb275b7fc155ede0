"""Variants of a gear pair or of a train: every row of a table, none of which stops the others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from centrode.assignments.gear_tables import GearDescription, GearVariant, read_gear_variants
from centrode.assignments.results import COMPUTED, REFUSED
from centrode.assignments.tables import Table
from centrode.errors import CentrodeError, InputError
from centrode.gears.results import GearPairResults, gear_pair
from centrode.gears.train_results import GearTrainResults, gear_train
from centrode.locale import _
from centrode.model.examples.catalogue import load_description
from centrode.model.gear_pairs import GearPair
from centrode.model.gear_trains import GearTrain
from centrode.printed_results import PrintsSummary


@dataclass(frozen=True)
class GearVariantResults:
    """A variant with what is computed of it.

    Attributes
    ----------
    variant : its name and its description
    result : None where it was refused
    refusal : why: the row describes nothing, no train has its ratio
    """

    variant: GearVariant
    result: GearPairResults | GearTrainResults | None
    refusal: str = ""

    @property
    def is_faulty(self) -> bool:
        """Whether it is a pair that is computed but cannot work."""
        return isinstance(self.result, GearPairResults) and bool(self.result.faults)

    @property
    def status(self) -> str:
        """Either "ok" or "refused", which is also said of a pair that has numbers but cannot work."""
        return COMPUTED if self.result is not None and not self.is_faulty else REFUSED


@dataclass(frozen=True, repr=False)
class GearVariants(PrintsSummary):
    """Every variant of a table.

    Attributes
    ----------
    described : the description whose keys the table varies
    results : one a variant, in the order of the table
    """

    described: GearDescription
    results: tuple[GearVariantResults, ...]


def gear_variants(
    source: GearDescription | str, table: Table, progress: Callable[[int, int], None] | None = None
) -> GearVariants:
    """Every variant of a gear pair or of a train.

    Parameters
    ----------
    source : GearPair or GearTrain, or the name of its file or of a built-in one
        What the rows have in common.
    table : path of a CSV file, or sequence of mappings from header to value
        A row a variant (docs: gears).
    progress : called with (variants done, variants in all)

    Raises
    ------
    InputError
        The table is wrong. A row that describes no pair or train is refused alone.

    Examples
    --------
    >>> from centrode.assignments.gear_variants import gear_variants
    >>> rows = [{"variant": "1", "m": "3 mm", "z1": 12}, {"variant": "2", "m": "4 mm", "z1": 14}]
    >>> [one.result.geometry.teeth for one in gear_variants("shifted-gear-pair", rows).results]
    [(12, 24), (14, 24)]
    """
    described = load_description(source) if isinstance(source, str) else source
    if not isinstance(described, GearPair | GearTrain):
        what = _("this table varies a gear pair or a train")
        raise InputError("", what, _("name its file, or a built-in one"))
    given = read_gear_variants(described, table)
    results = []
    for number, variant in enumerate(given, start=1):
        results.append(_compute(variant))
        if progress is not None:
            progress(number, len(given))
    return GearVariants(described, tuple(results))


def _compute(variant: GearVariant) -> GearVariantResults:
    described = variant.described
    if described is None:
        return GearVariantResults(variant, None, variant.refusal)
    try:
        result = gear_pair(described) if isinstance(described, GearPair) else gear_train(described)
    except CentrodeError as refusal:
        return GearVariantResults(variant, None, str(refusal))
    return GearVariantResults(variant, result)
