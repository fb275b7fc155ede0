"""Descriptions of pairs of gears as texts."""

from __future__ import annotations

import tomli_w

from centrode.model.files import in_short_lines
from centrode.model.gear_pairs import GearPair, gear_pair_from
from centrode.model.links import part_tables
from centrode.model.toml import with_unit


def gear_pair_text(pair: GearPair) -> str:
    """The pair as TOML in SI, without defaults; `parse_gear_pair` gives exactly it back."""
    tables = part_tables(pair)
    if pair.display.refuses_bare_angles:
        tables = with_unit(part_tables(gear_pair_from(tables, bare_angles="marked")))
    return in_short_lines(tomli_w.dumps(tables))
