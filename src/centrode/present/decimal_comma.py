"""CSV as spreadsheets and MathCAD read it where the decimal sign is a comma: fields apart by semicolons."""

from __future__ import annotations

import csv
import re
from pathlib import Path

NUMBER = re.compile(r"[+-]?\d+\.\d+(?:[eE][+-]?\d+)?|[+-]?\d+[eE][+-]?\d+")


def spell_with_comma(path: Path) -> None:
    """Rewrite a CSV file of this project with decimal commas and semicolons; text is left as it is.

    A mark of byte order goes before it: without one spreadsheets take UTF-8 for a code page of theirs.
    """
    with path.open(encoding="utf-8", newline="") as file:
        rows = [[_spelled(field) for field in row] for row in csv.reader(file)]
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        csv.writer(file, delimiter=";", lineterminator="\n").writerows(rows)


def _spelled(field: str) -> str:
    return field.replace(".", ",") if NUMBER.fullmatch(field) else field
