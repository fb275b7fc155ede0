"""Macros of FreeCAD: what they build is looked at by a recorder, and solved by FreeCAD itself where it is installed."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.errors import Status
from centrode.export.freecad import freecad_macro
from centrode.model.files import parse_mechanism
from samples import ALL

PROGRAM = shutil.which("freecadcmd") or shutil.which("freecadcmd-python3")
NAMES = ("crank-rocker", "klann-leg", "six-bar-press", "pantograph")
PLANAR = tuple(name for name in ct.example_names() if ct.example(name).space == "plane")
IN_FREECAD = PLANAR if ALL else (*NAMES, "three-crank-parallelogram")


class Recorder:
    """Modules of FreeCAD that keep what a macro asks of them."""

    def __init__(self) -> None:
        self.lines: list[tuple[Any, Any]] = []
        self.constraints: list[tuple[Any, ...]] = []
        self.bodies: dict[str, Any] = {}

    def run(self, text: str) -> dict[str, Any]:
        def vector(x: float, y: float, z: float) -> Any:
            return SimpleNamespace(x=x, y=y, z=z, Length=math.hypot(x, y, z))

        def add_object(kind: str, _name: str) -> Any:
            if kind.startswith("Sketcher"):
                return SimpleNamespace(
                    addGeometry=self._add_line, addConstraint=self.constraints.append, solve=lambda: 0
                )
            body = SimpleNamespace()
            self.bodies[str(len(self.bodies))] = body
            return body

        document = SimpleNamespace(addObject=add_object, recompute=lambda: None)
        modules = {
            "FreeCAD": {"Vector": vector, "newDocument": lambda _name: document, "GuiUp": False,
                        "Placement": lambda base, turn: (base, turn),
                        "Rotation": lambda _axis, angle: math.radians(angle)},
            "Part": {"LineSegment": lambda a, b: (a, b), "makeCylinder": lambda *x: x, "makeCompound": list},
            "Sketcher": {"Constraint": lambda *x: x},
        }  # fmt: skip
        names: dict[str, Any] = {}
        kept = {name: sys.modules.get(name) for name in modules}
        try:
            for name, held in modules.items():
                module = ModuleType(name)
                vars(module).update(held)
                sys.modules[name] = module
            exec(compile(text, "macro", "exec"), names)
        finally:
            for name, module in kept.items():
                sys.modules.pop(name)
                if module is not None:
                    sys.modules[name] = module
        return names

    def _add_line(self, line: tuple[Any, Any], _construction: bool) -> int:
        self.lines.append(line)
        return len(self.lines) - 1

    def ends(self) -> np.ndarray:
        """All coordinates of the sketch: line, end, axis."""
        return np.array([[[end.x, end.y] for end in line] for line in self.lines])

    def residuals(self, ends: np.ndarray) -> np.ndarray:
        """How far the constraints are from holding."""
        found: list[float] = []
        for kind, *what in self.constraints:
            if kind == "Coincident":
                one, a, other, b = what
                found += list(ends[one, a - 1] - ends[other, b - 1])
            elif kind == "Distance":
                one, a, other, b, length = what
                found.append(float(np.hypot(*(ends[one, a - 1] - ends[other, b - 1]))) - length)
            elif kind == "PointOnObject":
                one, a, line = what
                way = ends[line, 1] - ends[line, 0]
                off = ends[one, a - 1] - ends[line, 0]
                found.append(float(way[0] * off[1] - way[1] * off[0]) / float(np.hypot(*way)))
            else:
                _origin, _at, line, a, value = what
                found.append(float(ends[line, a - 1, "XY".index(kind[-1])]) - value)
        return np.array(found)


@pytest.mark.parametrize("name", NAMES)
def test_a_sketch_holds_and_is_as_mobile_as_the_linkage(name: str) -> None:
    recorder = Recorder()
    names = recorder.run(freecad_macro(name))
    ends = recorder.ends()
    size = float(np.ptp(ends.reshape(-1, 2), axis=0).max())
    assert np.abs(recorder.residuals(ends)).max() <= 1e-12 * size
    # rank by differences: what is left is the mobility, and one more for each slider that the sketch does not guide
    step = 1e-6 * size
    flat = ends.ravel()
    columns = []
    for k in range(flat.size):
        moved = flat.copy()
        moved[k] += step
        columns.append((recorder.residuals(moved.reshape(ends.shape)) - recorder.residuals(ends)) / step)
    rank = np.linalg.matrix_rank(np.array(columns), tol=1e-4)
    mechanism = ct.example(name)
    assert flat.size - rank == ct.check(mechanism).mobility + len(mechanism.guides)
    assert set(names["PLACEMENTS"]) == {side[0] for side in names["SIDES"]}


@pytest.mark.parametrize("name", NAMES)
def test_bars_move_as_the_motion(name: str) -> None:
    names = Recorder().run(freecad_macro(name, 13))
    motion = ct.motion(name, 13)
    there = motion.status.values == Status.OK
    for link, moves in names["PLACEMENTS"].items():
        points = {point for side in names["SIDES"] if side[0] == link for point in side[1:3]}
        for point in points:
            x, y = names["PLACES"][point]
            found = [
                (dx + math.cos(a) * x - math.sin(a) * y, dy + math.sin(a) * x + math.cos(a) * y)
                for dx, dy, a in moves
            ]
            wanted = 1000.0 * motion.position.sel(point=point).values[there]
            assert np.abs(np.array(found) - wanted).max() <= 1e-9 * 1000.0 * 5.0


LOOKED_AT = """
import json

solved = sketch.solve()
document.recompute()
found = {"solved": solved, "state": [str(word) for word in sketch.State], "kinds": [], "lines": [], "bars": {}}
for constraint in sketch.Constraints:
    found["kinds"].append(constraint.Type)
for line in sketch.Geometry:
    found["lines"].append([[end.x, end.y] for end in (line.StartPoint, line.EndPoint)])
for k in range(0, POSITIONS, 2):
    show(k)
    document.recompute()
    for link, first, second, _base in SIDES:
        for point in (first, second) if link in PLACEMENTS else ():
            place = bodies[link].Placement.multVec(V(*PLACES[point], 0))
            found["bars"].setdefault(point, {})[k] = [place.x, place.y, place.z]
print("FOUND", json.dumps(found))
"""


@pytest.mark.skipif(PROGRAM is None, reason="FreeCAD is not installed")
@pytest.mark.parametrize("name", IN_FREECAD)
def test_freecad_solves_the_sketch_and_moves_the_bars(name: str, tmp_path: Path) -> None:
    assert PROGRAM is not None
    macro, text = tmp_path / "macro.py", freecad_macro(name, 13)
    motion = ct.motion(name, 13)
    reached = motion.position.values[motion.status.values == Status.OK]
    macro.write_text(f"{text}\nPOSITIONS = {len(reached)}\n{LOOKED_AT}", encoding="utf-8")
    ended = subprocess.run(
        [PROGRAM, str(macro)], input="", capture_output=True, text=True, timeout=120, check=False
    )
    (line,) = [line for line in ended.stdout.splitlines() if "FOUND {" in line]
    found = json.loads(line.partition("FOUND ")[2])
    assert (found["solved"], found["state"]) == (0, ["Up-to-date"])
    names = Recorder().run(text)
    size = float(np.ptp(np.array(list(names["PLACES"].values())), axis=0).max())
    # solved, the sketch stands where it is drawn, fixed points above all
    ends = np.array([[names["PLACES"][x] for x in side[1:3]] for side in names["SIDES"]])
    assert np.abs(np.array(found["lines"]) - ends).max() <= 1e-9 * size
    drawn = {point for side in names["SIDES"] for point in side[1:3]}
    assert found["kinds"].count("DistanceY") == len(drawn & set(names["FIXED"]))
    assert set(found["bars"]) == {
        point for side in names["SIDES"] if side[0] in names["PLACEMENTS"] for point in side[1:3]
    }
    for point, places in found["bars"].items():
        wanted = 1000.0 * reached[:, list(motion.point.values).index(point)]
        for k, (x, y, z) in places.items():
            assert np.abs(np.array([x, y]) - wanted[int(k)]).max() <= 1e-9 * size and z == 0.0, (point, k)


def test_hostile_titles_are_comments() -> None:
    mechanism = parse_mechanism(
        """
        title = 'QUOTES \\ import os'
        frame.points = { O = [0, 0], D = [4, 0] }
        links = { OA.length = 1, AB.length = 3.5, DB.length = 3 }
        drives = [{ link = "OA", start = 0, speed = 1 }]
        assembly.sides = { B = "left" }
        """.replace("QUOTES", '"""')
    )
    text = freecad_macro(mechanism)
    (line,) = [line for line in text.splitlines() if "import os" in line]
    assert line.startswith("# ") and Recorder().run(text)["SIDES"]


def test_the_sphere_is_refused() -> None:
    with pytest.raises(ct.NotComputedYet, match="planar linkages"):
        freecad_macro("hookes-joint")
