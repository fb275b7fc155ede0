"""Programs of pages run by Node: frames of many sets of numbers as arrays, and how long a recompute takes."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.page.program import PageProgram

Array: TypeAlias = npt.NDArray[np.float64]

NODE = shutil.which("node")
"""The program itself; None where there is none."""
MISSING = "node is not installed"
PRELUDE = """
"use strict";
const fs = require("fs"), vm = require("vm");
const { javascript, data, cases, rounds, acting } = JSON.parse(fs.readFileSync(0, "utf8"));
// as in a browser: one classic script whose constants are global
vm.runInThisContext(javascript);
const mechanism = vm.runInThisContext("createMechanism")(data);
"""
FRAMES = """
const rows = (x) => (x instanceof Float64Array ? [x] : x.flatMap(rows));
const numbers = [], told = [];
for (const values of cases) {
  const frame = mechanism.recompute(values);
  const quantities = data.quantities.map((each) => rows(frame.quantities[each.name]));
  const centres = data.space === "plane" ? data.links.map((_name, k) => mechanism.centre(k)) : [];
  const acting = mechanism.reactions();
  quantities.push(...data.reactions.map((each) => rows(acting[each.name])));
  const all = [...quantities.flat(), ...centres.flatMap(({ fixed, moving }) => [...fixed, ...moving])];
  for (const row of [Float64Array.from(frame.status), frame.residual, frame.misfit, ...all]) numbers.push(row.slice());
  const { events, signsChange, possible } = frame;
  // JSON has no infinite numbers
  told.push({ events, signsChange, possible, reach: Array.from(frame.reach, String) });
}
const head = Buffer.from(JSON.stringify(told));
const size = Buffer.alloc(4);
size.writeUInt32LE(head.length);
const body = Buffer.concat(numbers.map((row) => Buffer.from(row.buffer, row.byteOffset, row.byteLength)));
fs.writeSync(1, Buffer.concat([size, head]));
for (let at = 0; at < body.length; ) at += fs.writeSync(1, body, at);
"""
TIMES = """
const times = [];
for (let round = 0; round < rounds; round++) {
  const values = cases[round % cases.length], start = performance.now();
  mechanism.recompute(values);
  if (acting) mechanism.reactions();
  times.push(performance.now() - start);
}
console.log(JSON.stringify(times));
"""


@dataclass(frozen=True)
class PageFrame:
    """What a page computes of one set of numbers.

    Attributes
    ----------
    status, residual, misfit : (samples,)
    quantities : name -> (samples, ...), as a motion and its reactions have them
    centres : link of the plane -> fixed and moving centrode (samples, 4)
    events : as the page has them
    """

    status: npt.NDArray[np.int8]
    residual: Array
    misfit: Array
    quantities: dict[str, Array]
    centres: dict[str, Array]
    events: Sequence[dict[str, Any]]
    signs_change: bool
    possible: bool
    reach: tuple[float, float]


def _run(
    body: str, program: PageProgram, cases: Sequence[Sequence[float]], rounds: int = 0, acting: bool = False
) -> bytes:
    assert NODE is not None, MISSING
    given = {"javascript": program.javascript, "data": program.data, "cases": cases, "rounds": rounds}
    given["acting"] = acting
    text = json.dumps(given, allow_nan=False).encode()
    ended = subprocess.run([NODE, "-e", PRELUDE + body], input=text, capture_output=True, check=False)
    if ended.returncode:
        raise RuntimeError(ended.stderr.decode()[-2000:])
    return ended.stdout


def page_frames(program: PageProgram, cases: Sequence[Sequence[float]]) -> list[PageFrame]:
    """The frames of sets of numbers, one after the other by one mechanism."""
    output = _run(FRAMES, program, cases)
    size = int.from_bytes(output[:4], "little")
    told = json.loads(output[4 : 4 + size])
    samples = program.data["samples"]
    rows = np.frombuffer(output[4 + size :], dtype=np.float64).reshape(len(cases), -1, samples)
    return [_frame(program, which, of_case) for which, of_case in zip(told, rows, strict=True)]


def _frame(program: PageProgram, told: dict[str, Any], rows: Array) -> PageFrame:
    quantities, first = {}, 3
    for each in [*program.data["quantities"], *program.data["reactions"]]:
        shape = np.shape(each["rows"])
        count = int(np.prod(shape, dtype=int))
        quantities[each["name"]] = np.moveaxis(rows[first : first + count].reshape(*shape, -1), -1, 0)
        first += count
    centres = {
        link: rows[first + 4 * k : first + 4 * k + 4].T for k, link in enumerate(program.data["links"])
    }
    low, high = (float(end.replace("Infinity", "inf")) for end in told["reach"])
    signs_change, possible, events = told["signsChange"], told["possible"], told["events"]
    status = rows[0].astype(np.int8)
    return PageFrame(
        status, rows[1], rows[2], quantities, centres, events, signs_change, possible, (low, high)
    )


def recompute_times(
    program: PageProgram, cases: Sequence[Sequence[float]], rounds: int, acting: bool = False
) -> Array:
    """Milliseconds that each of so many recomputes takes, with reactions if `acting`; one process does them all."""
    return np.array(json.loads(_run(TIMES, program, cases, rounds, acting)))
