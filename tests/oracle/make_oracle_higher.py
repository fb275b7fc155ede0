"""Makes `oracle_higher.json`: groups of higher class, gears, wheels, cylinders and the sphere to thirty digits.

The equations are written once for all mechanisms, in the coordinates of bodies (`oracle_bodies.py`) and in unit
vectors of points (`oracle_sphere.py`), apart from the formulas of centrode and from the loop equations of
`oracle.json`, with which they are compared first. Run `python tests/oracle/make_oracle_higher.py` to write the file
anew; it takes some minutes.
"""

from __future__ import annotations

import copy
import json
import random
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import mpmath as mp
from oracle_agreement import disagreement
from oracle_conditions import limit_condition, sampled, scale, unit
from oracle_cylinder_cases import CYLINDERS
from oracle_fields import DIGITS
from oracle_gear_cases import GEARS
from oracle_higher_cases import HIGHER
from oracle_rolling_cases import ROLLING
from oracle_solving import Higher, Started, Trace, equations, limit, newton, started
from oracle_sphere_cases import SPHERE

CASES = (*HIGHER, *GEARS, *ROLLING, *CYLINDERS, *SPHERE)
PROCESSES = 2
SAMPLES = 2
"""At random; one more lies near a limit, where there is one."""
NEAR = 0.02
"""How near, in the distance of the limit from the initial position."""
AGREEMENT = mp.mpf(10) ** -25
ROUGH = 4
"""Decimals of initial angles [rad]: 0.003 deg."""


def described(case: Higher, start: Started) -> dict[str, Any]:
    """The description with its initial angles."""
    parts = copy.deepcopy(case.parts)
    exact = dict(case.meshing.values())
    driven = {drive.get("link") for drive in parts["drives"]}
    for name, value in case.model(DIGITS).outputs(start.x).items():
        kind, link = name.split(":")
        if kind != "angle" or link in driven or exact.get(name) == 0:
            continue
        parts["links"][link]["angle"] = exact.get(
            name, float(value) if case.exact else round(float(value), ROUGH)
        )
    return parts


def limits(case: Higher, start: Started, trace: Trace) -> list[tuple[Any, float]]:
    """The nearest limits below and above, with their conditions; at most one turn (four greatest lengths) away."""
    found = []
    if not case.laws:
        for way in (-1.0, 1.0):
            place = trace.limit(way, 6.3 if unit(case) == 1 else 4 * unit(case))
            if place is not None:
                x, q, _direction = limit(case, start, *place)
                found.append((q, limit_condition(case, start, x, q)))
    return found


def places(case: Higher, ends: list[Any]) -> list[float]:
    """Values of the drive to sample at: inside the limits, one near the last of them."""
    width = case.width * unit(case)
    low, high = case.start - width, case.start + width
    for end in (float(v) for v in ends):
        low, high = (max(low, end), high) if end < case.start else (low, min(high, end))
    chance = random.Random(case.name)
    inner = [low + (high - low) * chance.uniform(0.05, 0.95) for _ in range(SAMPLES)]
    near = [float(end) + NEAR * (case.start - float(end)) for end in ends[-1:]]
    return [float(f"{q:.12f}") for q in inner + near]


def record(case: Higher) -> dict[str, Any]:
    """The mechanism, its limits and its samples."""
    start = started(case)
    trace = Trace(case, start)
    ends = limits(case, start, trace)
    samples = []
    for q in places(case, [at for at, _ in ends]):
        x = newton(equations(case, start, mp.mpf(q)), [mp.mpf(float(v)) for v in trace.walked(q)])
        found, condition = sampled(case, start, mp.mpf(q), x)
        outputs = {name: [mp.nstr(v, 28) for v in row] for name, row in found.items()}
        samples.append({"at": q, "condition": [float(f"{c:.3g}") for c in condition], "outputs": outputs})
    return {
        "parts": described(case, start),
        "scale": scale(case),
        "limits": [{"at": mp.nstr(q, 32), "condition": float(f"{c:.3g}")} for q, c in ends],
        "samples": samples,
    }


def main() -> None:
    """Write the file; with parts of names as arguments, only show these cases."""
    asked = sys.argv[1:]
    chosen = [i for i, case in enumerate(CASES) if not asked or any(part in case.name for part in asked)]
    if not asked:
        compared, worst = disagreement()
        print(f"{compared} values of oracle.json agree to {mp.nstr(worst, 3)}", flush=True)
        if worst > AGREEMENT:
            raise ArithmeticError("the two oracles differ")
    records = {}
    with ProcessPoolExecutor(PROCESSES) as pool:
        for i, found in zip(chosen, pool.map(_numbered, chosen), strict=True):
            records[CASES[i].name] = found
            print(CASES[i].name, [m["at"][:9] for m in found["limits"]], flush=True)
    if asked:
        print(_text(records))
    else:
        Path(__file__).with_name("oracle_higher.json").write_text(_text(records), encoding="utf-8")


def _numbered(index: int) -> dict[str, Any]:
    with mp.workdps(60):
        return record(CASES[index])


def _text(records: dict[str, Any]) -> str:
    """JSON with a line for each mechanism, its limits, and each output of a sample."""
    lines = []
    for name, found in records.items():
        samples = ",\n".join(_sample_text(sample) for sample in found["samples"])
        head = ", ".join(f"{json.dumps(k)}: {json.dumps(found[k])}" for k in ("parts", "scale", "limits"))
        lines.append(f'{json.dumps(name)}: {{{head}, "samples": [\n{samples}\n]}}')
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _sample_text(sample: dict[str, Any]) -> str:
    outputs = ",\n".join(f"  {json.dumps(name)}: {json.dumps(v)}" for name, v in sample["outputs"].items())
    head = f'"at": {sample["at"]!r}, "condition": {json.dumps(sample["condition"])}'
    return f' {{{head}, "outputs": {{\n{outputs}\n }}}}'


if __name__ == "__main__":
    main()
