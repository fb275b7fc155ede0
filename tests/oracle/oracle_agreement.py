"""Compares the equations of bodies with the loop equations behind `oracle.json`: two oracles, written apart."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
from oracle_conditions import differences
from oracle_drives import law
from oracle_fields import DIGITS, FLOATS
from oracle_solving import Higher, Vector, jacobian, newton

LAWS = {
    "drives of two links, one relative to the other": (lambda t: t, lambda t: mp.sin(2 * t) / 2),
    "drive by a law of time": (lambda t: law(t) - mp.mpf(0.5),),
}


def disagreement() -> tuple[int, Any]:
    """How many values of `oracle.json` were compared, and the greatest difference."""
    with mp.workdps(60):
        return _disagreement()


def _disagreement() -> tuple[int, Any]:
    text = Path(__file__).with_name("oracle.json").read_text(encoding="utf-8")
    compared, worst = 0, mp.mpf(0)
    for name, record in json.loads(text).items():
        case = Higher(name, record["parts"], {}, laws=LAWS.get(name, ()))
        for sample in record["samples"]:
            found = _sample(case, mp.mpf(sample["at"]))
            for output, digits in sample["outputs"].items():
                apart = [abs(a - mp.mpf(d)) for a, d in zip(found[output], digits, strict=True)]
                compared += len(apart)
                worst = max(worst, *apart)
    return compared, worst


def _sample(case: Higher, q: Any) -> dict[str, list[Any]]:
    """Outputs at a value of the drive, reached in small steps from the initial angles of the description."""
    model = case.model(DIGITS)

    def f(at: Any, y: Vector) -> Vector:
        return model.equations(case.values(at), y, {})

    x = _laid(case)
    for k in range(25):
        at = case.start + (q - case.start) * k / 24
        x = newton(lambda y, at=at: f(at, y), x)
    return differences(case, f, q, x, mp.inverse(jacobian(lambda y: f(q, y), x)).tolist())


def _laid(case: Higher) -> Vector:
    """Bodies at their initial angles, the rest of their coordinates by least squares."""
    angles = {name: link.get("angle") for name, link in case.parts["links"].items()}
    for drive in case.parts["drives"]:
        if "link" in drive:
            angles[drive["link"]] = drive["start"] + (angles.get(drive.get("relative_to")) or 0)
    model = case.model(FLOATS)
    known = [3 * i + 2 for i, angle in enumerate(angles.values()) if angle is not None]
    x = np.ones(model.size)
    x[known] = [angle for angle in angles.values() if angle is not None]
    free = np.delete(np.arange(model.size), known)

    def f(y: Any) -> Any:
        return np.array(model.equations([float(v) for v in case.values(case.start)], list(y), {}))

    for _ in range(40):
        slopes = np.array([(f(x + h) - f(x - h)) / 2e-6 for h in 1e-6 * np.eye(model.size)[free]]).T
        x[free] -= np.linalg.lstsq(slopes, f(x))[0]
    return [mp.mpf(float(v)) for v in x]
