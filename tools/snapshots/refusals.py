"""What the program refuses: wrong descriptions, and wrong options of right ones."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path

DESCRIPTIONS = Path(__file__).with_name("descriptions")
PRESS = (DESCRIPTIONS / "press.toml").read_text(encoding="utf-8")
CHANGES = tomllib.loads((DESCRIPTIONS / "changes.toml").read_text(encoding="utf-8"))

OPTIONS = (DESCRIPTIONS / "options.txt").read_text(encoding="utf-8").splitlines()
"""A command a line, its words apart by blanks; behind a `|` stands one that may hold some."""


def _words(line: str) -> list[str]:
    found: list[str] = []
    for part in line.split(" --"):
        head, bar, tail = part.partition("|")
        words = (head if not found else f"--{head}").split()
        found += [*words, tail] if bar else words
    return found


REFUSALS: Mapping[str, tuple[Sequence[str], Mapping[str, str]]] = {
    **{line: (_words(line), {"press.toml": PRESS}) for line in OPTIONS},
    **{
        name: (
            ["run", "press.toml", "--no-figures", "--out", "out"],
            {"press.toml": PRESS.replace(one["replace"], one["by"], 1)},
        )
        for name, one in CHANGES.items()
    },
}
"""Name -> arguments and files."""
