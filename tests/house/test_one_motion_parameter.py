"""Kind and unit of a drive's value, and whether one drive runs at constant speed, are decided in one module.

Every other module asks `MotionParameter`. The rules below are looked for in the syntax of the sources; a made-up source
shows that each is found.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

SOURCES = Path(__file__).parents[2] / "src" / "centrode"
OWNER = SOURCES / "model" / "motion_parameter.py"
UNITS = {
    "rad",
    "m",
    "s",
    "rad/s",
    "m/s",
    "N",
    "N m",
    "angle",
    "arc",
    "length",
    "time",
    "angular speed",
    "speed",
}
OF_A_DRIVE = re.compile(r"drive|\.speed\b|\bby_(time|value|law)\b|uniform|Uniform")


def texts_between(node: ast.IfExp) -> list[object]:
    """The constants that a conditional expression chooses between."""
    ends: list[ast.expr] = [node.body, node.orelse]
    if isinstance(node.orelse, ast.IfExp):
        return [
            *texts_between(node.orelse),
            *(end.value for end in ends[:1] if isinstance(end, ast.Constant)),
        ]
    return [end.value for end in ends if isinstance(end, ast.Constant)]


def rules_of(source: str) -> Iterator[str]:
    """What of a source decides about the parameter of a motion, with its line."""
    # writing a node out again is what takes the time: only where the words of its rule are
    written = (
        (ast.IfExp, ast.BoolOp, ast.Compare) if "speed" in source or "drive_kind" in source else ast.IfExp
    )
    for node in ast.walk(ast.parse(source)):
        asks_type = (
            isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "isinstance"
        )
        text = ast.unparse(node) if asks_type or isinstance(node, written) else ""
        if isinstance(node, ast.IfExp):
            chosen = texts_between(node)
            if chosen and set(chosen) <= UNITS and OF_A_DRIVE.search(ast.unparse(node.test)):
                yield f"{node.lineno}: a unit or a kind by the drive: {text}"
            if "drive_value" in ast.unparse(node.body) + ast.unparse(node.orelse) and "['time']" in text:
                yield f"{node.lineno}: values of the drive or times: {text}"
        if isinstance(node, ast.BoolOp) and re.search(r"len\([^()]*drives\)", text) and ".speed" in text:
            yield f"{node.lineno}: one drive at constant speed: {text}"
        if asks_type and re.search(r"\bUniform\b", text):
            yield f"{node.lineno}: a constant speed by its law: {text}"
        if isinstance(node, ast.Compare) and re.search(r"drives\[0\]\.speed|drive_kind", text):
            yield f"{node.lineno}: the law of the first drive: {text}"


def test_no_other_module_has_a_rule_of_its_own() -> None:
    found = {
        str(path.relative_to(SOURCES)): list(rules_of(source))
        for path in sorted(SOURCES.rglob("*.py"))
        if path != OWNER and OF_A_DRIVE.search(source := path.read_text(encoding="utf-8"))
    }
    assert {path: rules for path, rules in found.items() if rules} == {}


@pytest.mark.parametrize(
    "rule",
    [
        'unit = "rad" if drive.kind == "angle" else "m"',
        'unit = "s" if path.by_time else unit_of(drive)',
        'unit = "s" if not uniform else "rad" if drive.kind == "angle" else "m"',
        'force = "N m" if drive.kind == "angle" else "N"',
        "uniform = len(mechanism.drives) == 1 and mechanism.drives[0].speed is not None",
        "late = len(mechanism.drives) > 1 or drive.speed is None",
        'places = data["drive_value"] if even else data["time"]',
        "even = isinstance(law, Uniform)",
        "even = mechanism.drives[0].speed is not None",
    ],
)
def test_such_rules_are_found(rule: str) -> None:
    assert list(rules_of(rule))
