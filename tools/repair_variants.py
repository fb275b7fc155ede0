"""Repair of the 30 variants of the course assignment on its worked topology: what stops each, and what was found.

    python tools/repair_variants.py ["20 deg"]

The argument is the least transmission angle; 1 degree if left out.
"""

from __future__ import annotations

import csv
import sys
import time
import tomllib
from pathlib import Path

import centrode as ct
from centrode.model.examples import example_text
from centrode.render.terminal import plain_text
from centrode.views.rotatability import impossibility_text

ROWS = Path(__file__).parents[1] / "tests" / "reference" / "planar-variants.csv"
LINKS = ("AC", "CB", "BD")


def variant(row: dict[str, str]) -> ct.Mechanism:
    """The worked mechanism with a row's lengths and initial angles."""
    parts = tomllib.loads(example_text("slider-between-cranks"))
    for k, link in enumerate(LINKS, start=2):
        parts["links"][link] |= {"length": float(row[f"l{k}_m"]), "angle": float(row[f"phi{k}_0_rad"])}
    return ct.Mechanism(**parts)


def line(row: dict[str, str], least_angle: str | None) -> str:
    """What is found for one variant."""
    began = time.perf_counter()
    found = ct.repair(variant(row), least_transmission_angle=least_angle)
    limits = ", ".join(f"{limit.value:.4f} ({limit.condition})" for limit in found.before.limits)
    if not found.changes:
        said = "as it is" if found.found else "none found"
        if found.impossible is not None:
            said = plain_text(impossibility_text(found.impossible), found.mechanism.display)
    else:
        angles = ", ".join(f"{change.after:.4f}" for change in found.changes)
        said = f"change {found.size:.4f}: phi2, phi3, phi4 = {angles}"
    seconds = time.perf_counter() - began
    return f"{row['variant']:>2}  {limits or 'turns'}; {said}; {found.tried} candidates, {seconds:.1f} s"


def main() -> None:
    """Print one line a variant."""
    least_angle = sys.argv[1] if len(sys.argv) > 1 else None
    with ROWS.open(encoding="utf-8", newline="") as stream:
        for row in csv.DictReader(stream):
            print(line(row, least_angle), flush=True)


if __name__ == "__main__":
    main()
