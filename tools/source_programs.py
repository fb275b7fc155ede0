"""Printed source files, run: results and statuses of many places, for many sets of dimensions, in each language."""

from __future__ import annotations

import ctypes
import json
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.export.code_files import source_text
from centrode.export.motion_program import MotionProgram
from centrode.numerics.source_languages import LANGUAGES

Array: TypeAlias = npt.NDArray[np.float64]

COMPILER, NODE, OCTAVE = (shutil.which(name) for name in ("gcc", "node", "octave-cli"))
PROGRAMS: Mapping[str, str | None] = {
    "c": COMPILER,
    "python": sys.executable,
    "matlab": OCTAVE,
    "javascript": NODE,
}
"""What runs a language; None where it is not installed."""


@dataclass(frozen=True)
class Places:
    """What a program is given: sets of dimensions (n, dimensions), and places (k, 3): drive, speed, acceleration."""

    dimensions: Sequence[Sequence[float]]
    places: Array


@dataclass(frozen=True)
class Answers:
    """What a program gives: statuses (n, k) and results (n, k, results)."""

    status: npt.NDArray[np.int64]
    result: Array


def answers_of(program: MotionProgram, language: str, given: Places, folder: Path) -> Answers:
    """Run the source file of a language in a folder."""
    path = folder / f"{program.name}{LANGUAGES[language].suffix}"
    path.write_text(source_text(program, LANGUAGES[language]), encoding="utf-8")
    shape = len(given.dimensions), len(given.places)
    numbers = _RUNNERS[language](program, path, given)
    found = np.asarray(numbers, dtype=np.float64).reshape(*shape, 1 + len(program.results))
    return Answers(found[:, :, 0].astype(np.int64), found[:, :, 1:])


def _by_c(program: MotionProgram, path: Path, given: Places) -> Array:
    assert COMPILER is not None
    library = path.with_suffix(".so")
    driver = f"""
void run_places(const double *dimensions, int sets, int length, const double *places, int count, double *out) {{
    static {program.name} m;
    for (int n = 0; n < sets; n++) {{
        {program.name}_prepare(&m, dimensions + n * length);
        for (int k = 0; k < count; k++) {{
            *out++ = {program.name}_at(&m, places[3 * k], places[3 * k + 1], places[3 * k + 2]);
            for (int r = 0; r < {program.name}_result_count; r++) *out++ = m.row[r];
        }}
    }}
}}
"""
    joined = path.with_name("driven.c")
    joined.write_text(f'#include "{path.name}"\n{driver}', encoding="utf-8")
    flags = ["-std=c99", "-O1", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    subprocess.run(
        [COMPILER, *flags, "-o", str(library), str(joined), "-lm"], check=True, capture_output=True, text=True
    )
    dimensions = np.array(given.dimensions, dtype=np.float64).reshape(len(given.dimensions), -1)
    out = np.empty((len(given.dimensions), len(given.places), 1 + len(program.results)))
    pointer = ctypes.POINTER(ctypes.c_double)

    def numbers(array: Array) -> object:
        return np.ascontiguousarray(array).ctypes.data_as(pointer)

    places = np.ascontiguousarray(given.places)
    ctypes.CDLL(str(library)).run_places(
        numbers(dimensions), *dimensions.shape, numbers(places), len(places), numbers(out)
    )
    return out


def _by_python(_program: MotionProgram, path: Path, given: Places) -> Array:
    names: dict[str, object] = {"__name__": "printed"}
    exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), names)
    prepare, at, results = names["prepare"], names["at"], names["RESULTS"]
    assert callable(prepare) and callable(at) and isinstance(results, list)
    found: list[float] = []
    for dimensions in given.dimensions:
        record = prepare(dimensions)
        for place in given.places:
            found += [float(at(record, *place)), *record.row[: len(results)]]
    return np.array(found)


def _by_node(program: MotionProgram, path: Path, given: Places) -> Array:
    assert NODE is not None
    script = f"""
const program = require({json.dumps(str(path))});
const {{ dimensions, places }} = JSON.parse(require("fs").readFileSync(0, "utf8"));
const found = [];
for (const each of dimensions) {{
  const m = program.prepare(each);
  for (const [drive, speed, acceleration] of places) {{
    found.push(program.at(m, drive, speed, acceleration), ...m.row.subarray(0, program.results.length));
  }}
}}
const bytes = Buffer.from(Float64Array.from(found).buffer);
for (let at = 0; at < bytes.length; ) at += require("fs").writeSync(1, bytes, at);
"""
    text = json.dumps({"dimensions": [list(x) for x in given.dimensions], "places": given.places.tolist()})
    ended = subprocess.run([NODE, "-e", script], input=text.encode(), capture_output=True, check=True)
    return np.frombuffer(ended.stdout, dtype=np.float64)


def _by_octave(program: MotionProgram, path: Path, given: Places) -> Array:
    assert OCTAVE is not None
    rows = [" ".join(repr(float(x)) for x in each) for each in given.dimensions]
    places = [" ".join(repr(float(x)) for x in each) for each in given.places]
    script = f"""
sets = {{{", ".join(f"[{row}]" for row in rows)}}};
places = [{"; ".join(places)}];
out = [];
for n = 1:numel(sets)
    [speeds, ~, which] = unique(places(:, 2:3), 'rows');
    found = zeros(size(places, 1), {1 + len(program.results)});
    for s = 1:size(speeds, 1)
        at = find(which == s);
        [status, result] = {program.name}(places(at, 1), sets{{n}}, speeds(s, 1), speeds(s, 2));
        found(at, :) = [status, result];
    end
    out = [out; found];
end
file = fopen('found.bin', 'w');
fwrite(file, out', 'double');
fclose(file);
"""
    path.with_name("driven.m").write_text(script, encoding="utf-8")
    subprocess.run(
        [OCTAVE, "--norc", "driven.m"], cwd=path.parent, check=True, capture_output=True, text=True
    )
    return np.fromfile(path.with_name("found.bin"), dtype=np.float64)


_RUNNERS: Mapping[str, Callable[[MotionProgram, Path, Places], Array]] = {
    "c": _by_c, "python": _by_python, "matlab": _by_octave, "javascript": _by_node,
}  # fmt: skip
