"""What holds of every answer about rotatability, and its record as files have it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from centrode.analysis.redesign.repair import Repair
from centrode.analysis.rotatability.rotatability import Rotatability
from centrode.render.files import write_record
from centrode.topics.presentation import sheet_of


def assert_swings(found: Rotatability) -> None:
    """Extremes of swings are numbers, and strokes are not negative."""
    for turning in found.drives:
        for swing in turning.swings:
            values = [extreme.value for extreme in swing.extremes]
            assert swing.stroke is None or swing.stroke >= 0.0
            assert np.isfinite(values).all()


def recorded(found: Rotatability | Repair, folder: Path) -> Any:
    """What is found, as it is read back from its JSON file."""
    record = sheet_of(found).record
    assert record is not None
    write_record(record, folder / "found.json")
    return json.loads((folder / "found.json").read_text(encoding="utf-8"))
