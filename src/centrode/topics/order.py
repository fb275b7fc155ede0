"""The order of commands and of chapters: those of topics of the registry among the others, new ones behind all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeVar

from centrode.locale import mark

Entry = TypeVar("Entry")

COMMANDS = (
    "run",
    "report",
    "page",
    "app",
    "animate",
    "check",
    "describe",
    "equations",
    "integrate",
    "rotatability",
    "reduce",
    "reactions",
    "polygons",
    "variants",
    "limits",
    "region",
    "flywheel",
    "simulate",
    "equilibrium",
    "modes",
    "balance",
    "tolerances",
    "cam",
    "gears",
    "trains",
    "synthesise",
    "improve",
    "centres",
    "centrodes",
    "diagrams",
    "plan",
    "angles",
    "sweep",
    "draw",
    "sheets",
    "export",
    "import",
    "chains",
    "examples",
    "schema",
)
"""As `centrode --help` lists them."""

CHAPTERS = (
    "synthesis",
    "data",
    "motion",
    "words",
    "structure",
    "equations",
    "derivation",
    "tables",
    "plots",
    "positions",
    "graphic",
    "centres",
    "integration",
    "rotatability",
    "repaired-mechanism",
    "axes",
    "masses-and-loads",
    "reduction",
    "flywheel",
    "real-motion",
    "simulation",
    "equilibria",
    "modes",
    "reactions",
    "force-polygons",
    "balance",
    "accuracy",
    "gear-geometry",
    "gear-contact",
    "blocking-contour",
    "gear-teeth",
    "train-choice",
    "train-conditions",
    "train-motion",
    "lift",
    "laws",
    "base-radius",
    "path",
    "series",
    "routes",
    "profile",
    "cam-forces",
    "walking",
    "contact",
    "choice",
    "conclusions",
)
"""As a document has them."""

STRUCTURE = mark("Structural analysis of the mechanism")
KINEMATICS = mark("Kinematic analysis of the mechanism")
DYNAMICS = mark("Dynamic analysis of the machine")
FORCES = mark("Force analysis of the mechanism")
PARTS: Mapping[str, str] = {
    **dict.fromkeys(("words", "structure"), STRUCTURE),
    **dict.fromkeys(("equations", "derivation", "tables", "plots", "positions", "graphic"), KINEMATICS),
    **dict.fromkeys(("centres", "integration", "rotatability", "axes"), KINEMATICS),
    **dict.fromkeys(
        ("masses-and-loads", "reduction", "flywheel", "real-motion", "simulation", "equilibria", "modes"),
        DYNAMICS,
    ),
    **dict.fromkeys(("reactions", "force-polygons", "balance"), FORCES),
}
"""Name of a chapter -> the part of an explanatory note that it belongs to; chapters of cams are parts themselves."""


def in_order(entries: Mapping[str, Entry], order: Sequence[str]) -> dict[str, Entry]:
    """Entries by name, in an order; those that it does not name stay behind all."""
    known = {name: entries[name] for name in order if name in entries}
    return known | dict(entries)
