"""What is run: commands with their options, for every example, and beside the examples."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tools.snapshots.refusals import REFUSALS

DESCRIPTIONS = Path(__file__).with_name("descriptions")
LANGUAGES = ("en", "ru", "uk")
FEW = ("--samples", "25")
"""Samples in the other languages, whose numbers are spelled anew but are the same."""
SIZE = ("--frames", "2", "--size", "160x120")

EVERY_ROOM = ("crank-rocker", "five-bar-two-drives", "spherical-crank-rocker", "valve-cam")
"""Examples that enter every room and are recorded: their pictures, reports and animations in every language.

Of the others `texts` has pictures and animations in English, reports in English and by turns in another language.
"""
BESIDE = ("face", "help", "refusals", "studies")
"""Subjects that are no examples."""
RECORDED = (*EVERY_ROOM, *BESIDE)


@dataclass(frozen=True)
class Case:
    """One run of the command line.

    Attributes
    ----------
    name : unique within its subject
    words : arguments
    files : texts that lie in the folder where it runs, by their names
    """

    name: str
    words: Sequence[str]
    files: Mapping[str, str] = field(default_factory=dict)


def linkage_cases(name: str, text: str, language: str) -> Iterator[Case]:
    """Commands for a linkage; those that do not apply to it are refused, which is recorded too."""
    tables = tomllib.loads(text)
    first = language == "en"
    few = () if first else FEW
    spelled: tuple[str, ...] = {"en": (), "ru": ("--decimal-comma",), "uk": ("--xlsx",)}[language]
    plain = () if first or name in EVERY_ROOM else ("--no-figures",)
    out = ("--out", "out", *plain)
    at = ("--at", _instant(tables))
    for command in ("check", "describe", "equations", "rotatability", "examples"):
        yield Case(command, [command, name])
    yield Case("limits", ["limits", name])
    yield Case("export", ["export", name, "--format", "mjcf"])
    yield Case("draw dxf", ["draw", name, "--out", "drawing.dxf"])
    yield Case("draw svg", ["draw", name, "--path", "all", "--out", "drawing.svg"])
    yield Case("run", ["run", name, *out, *spelled, *few])
    for command in ("reduce", "reactions", "flywheel", "simulate", "balance", "angles"):
        yield Case(command, [command, name, *out, *spelled, *few])
    yield Case("polygons", ["polygons", name, *at, *out])
    yield Case("plan", ["plan", name, *out])
    yield Case("centres", ["centres", name, *out, *spelled])
    yield Case("centrodes", ["centrodes", name, "--link", _link(tables), *out, *spelled, *few])
    yield Case("diagrams", ["diagrams", name, *at, *out, *spelled])
    yield Case("integrate", ["integrate", name, *out, *spelled, *(() if first else ("--steps", "25"))])
    yield Case("region", ["region", name, *out, *spelled, "--samples", "9"])
    if _speaks(name, language):
        yield Case("report", ["report", name, "--out", "out"])
    if first:
        yield Case("animate", ["animate", name, *SIZE, "--show", "paths,velocities,accelerations"])
    elif name in EVERY_ROOM:
        yield Case("animate", ["animate", name, *SIZE, "--show", "velocities", "--dark"])


def cam_cases(name: str, _text: str, language: str) -> Iterator[Case]:
    """Commands for a cam."""
    few = () if language == "en" else FEW
    spelled: tuple[str, ...] = {"en": (), "ru": ("--decimal-comma",), "uk": ("--xlsx",)}[language]
    yield Case("examples", ["examples", name])
    plain = () if not few or name in EVERY_ROOM else ("--no-figures",)
    yield Case("cam", ["cam", name, "--out", "out", *spelled, *few, *plain])
    yield Case("cam groove", ["cam", name, "--groove", *few])
    yield Case("cam laws", ["cam", name, "--laws", "--out", "out", "--no-figures", *few])
    yield Case("cam terms", ["cam", name, "--terms", "8", *few])
    if _speaks(name, language):
        yield Case("report", ["report", name, "--out", "out"])
        yield Case("animate", ["animate", name, *SIZE])
    for command in ("run", "check", "reactions"):
        yield Case(command, [command, name])


def help_cases(commands: Sequence[str]) -> Iterator[Case]:
    """Help of every command, lists and schemas."""
    yield Case("help", ["--help"])
    yield Case("version", ["--version"])
    for command in commands:
        yield Case(f"help {command}", [command, "--help"])
        if command != "app":  # without a file the workbench opens and serves until it is stopped
            yield Case(f"nothing {command}", [command])
    yield Case("examples", ["examples"])
    yield Case("schema", ["schema"])
    yield Case("schema cam", ["schema", "--cam"])


def study_cases() -> Iterator[Case]:
    """Sweeps and variants."""
    files = {
        path.name: path.read_text(encoding="utf-8")
        for path in sorted(DESCRIPTIONS.iterdir())
        if path.is_file()
    }
    for study in sorted(name for name in files if name.startswith("sweep-")):
        yield Case(study, ["sweep", study, "--out", "found.csv"], files)
        yield Case(
            f"{study} spelled", ["sweep", study, "--out", "found.csv", "--decimal-comma", "--xlsx"], files
        )
    words = ["variants", "variants.csv", "--topology", "slider-between-cranks", "--out", "out"]
    yield Case("variants", words, files)
    yield Case("variants figures", [*words, "--figures"], files)
    yield Case("variants report", [*words, "--report"], files)


def refusal_cases() -> Iterator[Case]:
    """What the program refuses."""
    for name, (words, files) in REFUSALS.items():
        yield Case(name, words, files)


def _speaks(name: str, language: str) -> bool:
    """Whether the report of an example is recorded in a language."""
    return name in EVERY_ROOM or language == LANGUAGES[0] or language == LANGUAGES[1 + sum(name.encode()) % 2]


def _instant(tables: Mapping[str, Any]) -> str:
    """A value of the drive a little after its start, or a time, for commands that need one."""
    drive = tables["drives"][0]
    if len(tables["drives"]) > 1 or "law" in drive:
        return "0.1 s"
    start = drive.get("start", 0.0)
    if isinstance(start, str):
        return start
    return f"{start + 0.7} rad" if "link" in drive else f"{start} m"


def _link(tables: Mapping[str, Any]) -> str:
    """A link that does not turn about a point of the frame, where there is one: its centrodes are curves."""
    ground = set(tables.get("frame", {}).get("points", {}))
    for name, link in tables.get("links", {}).items():
        points = link.get("points")
        names = set(points) if isinstance(points, (dict, list)) else set(name)
        if not names & ground:
            return str(name)
    return str(next(iter(tables.get("links", {"": None}))))
