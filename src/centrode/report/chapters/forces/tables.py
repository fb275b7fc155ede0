"""Tables of a dataset's variables over its samples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from centrode.render.document.blocks import TableBlock

if TYPE_CHECKING:
    from centrode.render.document.numbers import Numbers

ROUNDING = 1e-12
"""What is below this share of the greatest of a column is zero."""


class ForceColumn(NamedTuple):
    """A head without its unit, the SI unit, and numbers in SI."""

    head: str
    unit: str
    values: np.ndarray


def over_samples(
    numbers: Numbers, columns: Sequence[ForceColumn], kept: Sequence[int], caption: str = ""
) -> TableBlock:
    """A table of some samples; what rounding has left of zero is shown as zero."""
    heads = tuple(numbers.head(one.head, one.unit) for one in columns)
    texts = []
    for one in columns:
        least = ROUNDING * float(np.max(np.abs(one.values), where=np.isfinite(one.values), initial=0.0))
        texts.append(numbers.column(one.values[list(kept)], one.unit, least))
    return TableBlock(heads, tuple(zip(*texts, strict=True)), caption, (True,) * len(heads))
