"""Makes `oracle.json`: motions of every kind of group to fifty digits, by Newton's method on loop equations.

The equations are written in angles and coordinates of the links, apart from the formulas of centrode; derivatives are
differences of fourth order in 60-digit arithmetic. Run `python tests/oracle/make_oracle.py` to write the file anew.
"""

from __future__ import annotations

import json
import random
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mpmath as mp
from oracle_cases import CASES
from oracle_drives import DRIVES
from oracle_more_cases import MORE
from oracle_parts import Case

DIGITS = 60
STEP = mp.mpf(10) ** -9
SAMPLES = 4
WIDTH = 0.6
"""Samples lie at random within this of the initial value of the drive (rad, s, or times the case's own unit)."""


def newton(case: Case, q: Any, guess: Sequence[Any]) -> list[Any]:
    """The unknowns of a case at a value of the drive."""
    x = list(guess)
    if not x:
        return x
    small = mp.mpf(10) ** -25
    for _ in range(60):
        value = mp.matrix(case.equations(q, x))
        columns = []
        for k in range(len(x)):
            ahead, behind = list(x), list(x)
            ahead[k], behind[k] = x[k] + small, x[k] - small
            change = mp.matrix(case.equations(q, ahead)) - mp.matrix(case.equations(q, behind))
            columns.append(change / (2 * small))
        matrix = mp.matrix(len(x), len(x))
        for k, column in enumerate(columns):
            matrix[:, k] = column
        step = mp.lu_solve(matrix, value)
        x = [a - b for a, b in zip(x, step, strict=True)]
        if mp.norm(step) < mp.mpf(10) ** -55:
            return x
    raise ArithmeticError(f"{case.name} does not converge at {q}")


def followed(case: Case, q: Any, start: Sequence[Any]) -> list[Any]:
    """The unknowns at a value reached from the initial one in small steps."""
    x = list(start)
    for k in range(1, 25):
        x = newton(case, case.start + (q - case.start) * k / 24, x)
    return x


def derivatives(case: Case, q: Any, x: Sequence[Any]) -> dict[str, list[str]]:
    """Outputs with first and second derivative, 30 digits."""
    at = [case.outputs(q + k * STEP, newton(case, q + k * STEP, x)) for k in (-2, -1, 0, 1, 2)]
    found = {}
    for name in at[2]:
        a, b, c, d, e = (outputs[name] for outputs in at)
        first = (a - 8 * b + 8 * d - e) / (12 * STEP)
        second = (-a + 16 * b - 30 * c + 16 * d - e) / (12 * STEP**2)
        found[name] = [mp.nstr(v, 30) for v in (c, first, second)]
    return found


def record(case: Case) -> dict[str, Any]:
    """The mechanism with its initial angles, and the samples."""
    start = newton(case, mp.mpf(case.start), [mp.mpf(g) for g in case.guess])
    parts = json.loads(json.dumps(case.parts))
    for name, value in case.outputs(mp.mpf(case.start), start).items():
        kind, label = name.split(":")
        if kind == "angle" and label not in case.driven:
            parts["links"][label]["angle"] = float(mp.nstr(value, 7))
    chance = random.Random(case.name)
    samples = []
    for _ in range(SAMPLES):
        q = float(f"{case.start + WIDTH * case.unit * chance.uniform(-1, 1):.12f}")
        exact = mp.mpf(q)
        samples.append({"at": q, "outputs": derivatives(case, exact, followed(case, exact, start))})
    return {"parts": parts, "samples": samples}


def main() -> None:
    """Write the file."""
    with mp.workdps(DIGITS):
        records = {case.name: record(case) for case in (*CASES, *MORE, *DRIVES)}
    Path(__file__).with_name("oracle.json").write_text(_text(records), encoding="utf-8")


def _text(records: dict[str, Any]) -> str:
    """JSON with a line for each mechanism and each output of a sample."""
    lines = []
    for name, found in records.items():
        samples = ",\n".join(_sample_text(sample) for sample in found["samples"])
        lines.append(
            f'{json.dumps(name)}: {{"parts": {json.dumps(found["parts"])}, "samples": [\n{samples}\n]}}'
        )
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _sample_text(sample: dict[str, Any]) -> str:
    outputs = ",\n".join(f"  {json.dumps(name)}: {json.dumps(v)}" for name, v in sample["outputs"].items())
    return f' {{"at": {sample["at"]!r}, "outputs": {{\n{outputs}\n }}}}'


if __name__ == "__main__":
    main()
