"""The record: a file of digests for each subject, a line for each artefact."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from tools.snapshots.artefacts import Digest

FOLDER = Path(__file__).with_name("record")
SAME = "="
"""Before the name of an earlier artefact with the same digest."""


def write_record(folder: Path, subject: str, digests: Mapping[str, Digest]) -> None:
    """Write the digests of a subject; the file is there whole or not at all."""
    folder.mkdir(parents=True, exist_ok=True)
    first: dict[str, str] = {}
    lines = []
    for name, digest in digests.items():
        text = str(digest)
        lines.append(f"{name} | {SAME} {first[text]}" if text in first else f"{name} | {text}")
        first.setdefault(text, name)
    draft = folder / f".{subject}.draft"
    draft.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    os.replace(draft, folder / f"{subject}.txt")


def read_record(folder: Path, subject: str) -> dict[str, Digest]:
    """The digests of a subject; none where it has no record."""
    file = folder / f"{subject}.txt"
    found: dict[str, Digest] = {}
    for line in file.read_text(encoding="utf-8").splitlines() if file.exists() else []:
        name, _bar, digest = line.rpartition(" | ")
        found[name] = (
            found[digest.removeprefix(f"{SAME} ")] if digest.startswith(SAME) else Digest.parse(digest)
        )
    return found
