"""Motions of every kind of group against fifty digits (tests/oracle), with first and second derivatives."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mpmath as mp
import pytest

import centrode as ct
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import Solved
from centrode.structure.plan import structure_of
from mechanisms import rounding, solve_evenly

ORACLE: dict[str, Any] = json.loads(
    (Path(__file__).parents[1] / "oracle" / "oracle.json").read_text(encoding="utf-8")
)
LAWS = ("drives of two links, one relative to the other", "drive by a law of time")
KINDS = {"crank", "rigid point", "parallel link", "RRR", "RRP", "RPR", "PRP", "RPP"}
"""A link by two points comes with redundant constraints only: the example of three cranks has one."""


def test_every_kind_of_group_has_an_oracle() -> None:
    groups = [g for record in ORACLE.values() for g in structure_of(ct.Mechanism(**record["parts"])).groups]
    assert {group.kind for group in groups} == KINDS


@pytest.mark.parametrize("name", ORACLE)
def test_motion_against_fifty_digits(name: str) -> None:
    prepared = ready(ct.Mechanism(**ORACLE[name]["parts"]))
    for sample in ORACLE[name]["samples"]:
        solved = solve_evenly(prepared, 1, sample["at"], sample["at"])
        assert solved.status[0, 0] == ct.Status.OK
        allowed = rounding(solved)[:, 0]
        by_law = name == "drive by a law of time"
        for output, digits in sample["outputs"].items():
            found, unit = values(solved, output)
            if by_law:
                found, allowed_here = in_time(solved, found, allowed)
            else:
                allowed_here = list(allowed)
            for order in range(3):
                with mp.workdps(40):
                    difference = found[order] - mp.mpf(digits[order])
                    if output.startswith("angle") and order == 0:
                        difference -= 2 * mp.pi * mp.nint(difference / (2 * mp.pi))
                per_drive = unit / prepared.kinematics.path.unit**order
                assert abs(difference) <= allowed_here[order] * per_drive, f"{output}, derivative {order}"


def values(solved: Solved, output: str) -> tuple[list[Any], float]:
    """Value and derivatives of an output, and the unit of its errors."""
    kind, label = output.split(":")
    size = float(solved.ready.structure.dimensions.scale)
    layout = solved.layout
    if kind == "angle":
        return [mp.mpf(v) for v in solved.angles[:, 0, 0, layout.links.index(label)]], 1.0
    if kind == "slide":
        return [mp.mpf(v) for v in solved.slides[:, 0, 0, layout.guides.index(label)]], size
    axis = 0 if kind == "x" else 1
    return [mp.mpf(v) for v in solved.points[:, 0, 0, layout.points.index(label), axis]], size


def in_time(solved: Solved, found: list[Any], allowed: Any) -> tuple[list[Any], list[float]]:
    """Derivatives by time from those by the drive's value (chain rule), and what rounding may do to them."""
    rate, change = float(solved.span.rate[0]), float(solved.span.second_rate[0])
    by_time = [found[0], found[1] * rate, found[2] * rate**2 + found[1] * change]
    errors = [allowed[0], allowed[1] * abs(rate), allowed[2] * rate**2 + allowed[1] * abs(change)]
    # the drive's rates are the law's, to some eps of their own; places answer to them by their derivatives
    return by_time, [4 * e for e in errors]
