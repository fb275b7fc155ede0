"""Files that a command wrote, as artefacts."""

from __future__ import annotations

import csv
import hashlib
import io
import re
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import xarray as xr

from tools.snapshots.artefacts import HASH, Artefact
from tools.snapshots.stand_ins import MARK, Seen

EMBEDDED = re.compile(r"base64,([A-Za-z0-9+/=]{200,})")
NUMBER = re.compile(r"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?|nan|")
TEXTS = {".toml", ".json", ".xml", ".txt", ".tex", ".md", ".svg", ".dxf", ".html", ".pdf", ".typ"}


def file_artefact(path: Path, seen: Seen) -> Artefact:
    """A file by its ending; what is neither text nor table is known by its bytes alone."""
    match path.suffix:
        case ".csv":
            return table_artefact(path.read_text(encoding="utf-8-sig"))
        case ".nc":
            with xr.open_dataset(path, engine="scipy", decode_times=False) as dataset:
                return dataset_artefact(dataset)
        case ".xlsx":
            return workbook_artefact(path)
        case ".png" | ".svg" if path.read_bytes()[: len(MARK)] == MARK.encode():
            return seen.figures[int(path.read_text(encoding="utf-8").removeprefix(MARK))]
        case ending if ending in TEXTS:
            return text_artefact(path.read_text(encoding="utf-8"), seen.comma)
    made = Artefact()
    made.say(f"{path.suffix} file")
    return made


def text_artefact(text: str, comma: bool = False) -> Artefact:
    """A text; what is embedded in it as base64 by its hash."""
    made = Artefact(comma)
    made.say(EMBEDDED.sub(lambda found: f"base64 {_letters(found.group(1))}", text).rstrip("\n"))
    return made


def table_artefact(text: str) -> Artefact:
    """A CSV file: heads, cells that are no numbers, and a series a column."""
    head = text.partition("\n")[0]
    semicolons = ";" in head
    made = Artefact(semicolons)
    made.say("fields apart by " + (";" if semicolons else ","))
    rows = list(csv.reader(io.StringIO(text), delimiter=";" if semicolons else ","))
    made.say(f"{len(rows)} rows")
    for number, name in enumerate(rows[0] if rows else []):
        column = [row[number] if number < len(row) else "" for row in rows[1:]]
        if all(NUMBER.fullmatch(cell) for cell in column):
            made.say(f"column {name}" + (" with gaps" if "" in column else ""))
            made.add(name, [float(cell.replace(",", ".")) if cell else np.nan for cell in column])
        else:
            made.say(f"column {name}: {' | '.join(column)}")
    return made


def dataset_artefact(dataset: xr.Dataset) -> Artefact:
    """A labelled result: attributes, and of each variable type, dimensions, attributes and values."""
    made = Artefact()
    for name, size in sorted(dataset.sizes.items(), key=str):
        made.say(f"dimension {name} {size}")
    for name, value in dataset.attrs.items():
        made.say(f"attribute {name}: {_plain(value)}")
    for name in sorted(dataset.variables, key=str):
        variable = dataset.variables[name]
        made.say(f"variable {name} {variable.dtype} {' '.join(map(str, variable.dims))}")
        for key, value in variable.attrs.items():
            made.say(f"  {key}: {_plain(value)}")
        if variable.dtype.kind in "fiub":
            made.add(str(name), variable.values)
        elif variable.dtype.kind == "c":
            made.add(f"{name} real", variable.values.real)
            made.add(f"{name} imaginary", variable.values.imag)
        else:
            made.say("  " + " | ".join(_plain(value) for value in variable.values.ravel().tolist()))
    return made


def workbook_artefact(path: Path) -> Artefact:
    """Sheets of a workbook, a column after the other."""
    made = Artefact()
    book = openpyxl.load_workbook(path, read_only=True)
    for sheet in book.worksheets:
        made.say(f"sheet {sheet.title}")
        rows = list(sheet.iter_rows(values_only=True))
        for column in zip(*rows, strict=True):
            words = [str(cell) for cell in column if isinstance(cell, str)]
            made.say(" | ".join(words))
            made.add(words[0] if words else "", [cell for cell in column if isinstance(cell, (int, float))])
    book.close()
    return made


def bytes_of(path: Path) -> str:
    """Hash of what a file holds."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:HASH]


def _letters(text: str) -> str:
    """A hash in letters, which are no numbers."""
    return "".join(
        chr(ord("a") + int(digit, 16)) for digit in hashlib.sha256(text.encode()).hexdigest()[:HASH]
    )


def _plain(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(np.asarray(value).tolist())
