"""Built-in examples against the closed forms that their headers state: value and two derivatives by the drive."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import centrode as ct
from mechanisms import rounding, solved_at
from samples import few

Form = Callable[[Any], Any]

DIGITS = 40
"""Of the closed forms: their derivatives are taken by differences in this precision."""


def turn(angle: Any) -> Any:
    return mp.expjpi(angle / mp.pi)


def hoeken(q: Any) -> Any:
    return 2 + mp.sqrt((20 + 4 * mp.cos(q)) / (5 - 4 * mp.cos(q))) * (mp.sin(q) + 1j * (2 - mp.cos(q)))


def whitworth_lever(q: Any) -> Any:
    return mp.atan2(1 + 2 * mp.sin(q), 2 * mp.cos(q))


def offset_slider(q: Any) -> Any:
    return mp.cos(q) + mp.sqrt(9 - (mp.mpf("0.3") - mp.sin(q)) ** 2) + mp.mpc(0, "0.3")


def slot_angle(q: Any) -> Any:
    """Lever of the inverted slider-crank: the direction D -> A less what the offset 0.2 turns it by."""
    a = turn(q) - 3
    return mp.arg(a * mp.mpc(mp.sqrt(abs(a) ** 2 - mp.mpf("0.2") ** 2), "-0.2"))


def shaper_ram(q: Any) -> Any:
    lever = mp.atan2(2 + mp.sin(q), mp.cos(q))
    b = mp.mpf("3.8") * turn(lever) - 2j
    return b.real + mp.sqrt(mp.mpf("1.5") ** 2 - (mp.mpf("1.6") - b.imag) ** 2) + mp.mpc(0, "1.6")


def whitworth_ram(q: Any) -> Any:
    b = -mp.mpf("0.8") * turn(whitworth_lever(q)) - 1j
    return b.real + mp.sqrt(9 - (b.imag + 1) ** 2) - 1j


def lift(x: Any) -> Any:
    return mp.sqrt(1 - x * x)


def cylinder(q: Any) -> Any:
    return turn(q) / 10 - mp.mpf("0.4")


POINTS: dict[str, dict[str, Form]] = {
    "hoeken": {"P": hoeken},
    "chebyshev-straight-line": {"P": hoeken},
    "elliptic-trammel": {"B": lambda x: 1j * lift(x), "P": lambda x: mp.mpf("0.75") * x + 0.25j * lift(x)},
    "galloway": {
        "B": lambda q: (mp.cos(q / 2) + mp.sqrt(4 - mp.sin(q / 2) ** 2)) * turn(q / 2),
    },
    "kite": {"B": lambda q: 4 * mp.sin(q) / (5 - 4 * mp.cos(q)) * (mp.sin(q) + 1j * (2 - mp.cos(q)))},
    "pantograph": {
        "P": lambda q: mp.mpc("3.75", "1.25") + mp.mpf("0.75") * turn(q),
    },
    "parallelogram": {"A": turn, "B": lambda q: 2 + turn(q)},
    "peaucellier": {
        "P": lambda q: mp.mpf(16) / 3 * (1 + 1j * mp.tan(q / 2)),
        "C": lambda q: mp.mpf(3) / 2 * (1 + turn(q)),
    },
    "scissor-lift": {
        "A": lambda x: x,
        "B": lambda x: 1j * lift(x),
        "C": lambda x: x + 1j * lift(x),
        "E": lambda x: x + 2j * lift(x),
        "F": lambda x: 2j * lift(x),
        "T": lambda x: mp.mpf("1.2") + 2j * lift(x),
    },
    "scotch-yoke": {"H": lambda q: mp.cos(q) / 2},
    "scott-russell": {"B": lambda q: 2 * mp.cos(q), "C": lambda q: 2j * mp.sin(q)},
    "shaper": {"E": shaper_ram},
    "slider-crank-offset": {"B": offset_slider},
    "tangent-mechanism": {"P": lambda q: 1 + 1j * mp.tan(q)},
    "three-crank-parallelogram": {"E": lambda q: turn(q) + mp.mpf("0.8"), "B": lambda q: turn(q) + 2},
    "whitworth-quick-return": {"E": whitworth_ram},
}
ANGLES: dict[str, dict[str, Form]] = {
    "antiparallelogram": {"DB": lambda q: 2 * mp.atan(-3 * mp.tan(q / 2))},
    "inverted-slider-crank": {"lever": slot_angle},
    "oscillating-cylinder": {"cylinder": lambda q: mp.arg(cylinder(q)), "rod": lambda q: mp.arg(cylinder(q))},
    "parallelogram": {"AB": lambda q: 0 * q, "DB": lambda q: q},
    "scissor-lift": {"platform": lambda x: 0 * x},
    "scotch-yoke": {"yoke": lambda q: 0 * q},
    "scott-russell": {"BC": lambda q: mp.pi - q},
    "shaper": {"lever": lambda q: mp.atan2(2 + mp.sin(q), mp.cos(q))},
    "whitworth-quick-return": {"lever": whitworth_lever},
}
SLIDES: dict[str, dict[str, Form]] = {
    "inverted-slider-crank": {"A": lambda q: mp.sqrt(10 - 6 * mp.cos(q) - mp.mpf("0.2") ** 2)},
    "oscillating-cylinder": {"A": lambda q: abs(cylinder(q))},
    "scotch-yoke": {"A": lambda q: mp.sin(q) / 2},
    "tangent-mechanism": {"P": mp.tan},
}
RANGES = {
    "chebyshev-straight-line": (1.6, 7.8),
    "elliptic-trammel": (-0.9, 0.9),
    "peaucellier": (-1.6, 1.6),
    "scissor-lift": (0.3, 0.97),
    "tangent-mechanism": (-1.4, 1.4),
}
NAMES = sorted({*POINTS, *ANGLES, *SLIDES})


def values_of(name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Values of the drive, none round and none next to a change point (those have a file of their own)."""
    low, high = RANGES.get(name, (0.0, 2 * np.pi))
    return np.asarray(low + (high - low) * (np.arange(7)[:: few(3, 1)] + 0.31) / 7)


@pytest.mark.parametrize("name", NAMES)
def test_closed_forms_of_the_headers(name: str) -> None:
    for q, solved in zip(values_of(name), solved_at(ct.example(name), values_of(name)), strict=True):
        assert solved.status[0, 0] == ct.Status.OK
        size = float(solved.ready.structure.dimensions.scale)
        for order in range(3):
            allowed = rounding(solved)[order, 0]
            for kind, forms in (("point", POINTS), ("link", ANGLES), ("guide", SLIDES)):
                for label, form in forms.get(name, {}).items():
                    found, unit = _found(solved, kind, label, order), 1.0 if kind == "link" else size
                    with mp.workdps(DIGITS):
                        difference = found - mp.diff(form, mp.mpf(q), order)
                        if kind == "link" and order == 0:
                            difference = mp.fmod(difference + 3 * mp.pi, 2 * mp.pi) - mp.pi
                    per_drive = unit / _drive_unit(solved) ** order
                    assert abs(difference) <= allowed * per_drive, f"{label}, derivative {order}, at {q}"


def _drive_unit(solved: Any) -> float:
    return float(solved.ready.kinematics.path.unit)


def _found(solved: Any, kind: str, label: str, order: int) -> Any:
    layout = solved.layout
    if kind == "point":
        x, y = solved.points[order, 0, 0, layout.points.index(label)]
        return mp.mpc(x, y)
    if kind == "link":
        return mp.mpf(solved.angles[order, 0, 0, layout.links.index(label)])
    return mp.mpf(solved.slides[order, 0, 0, layout.guides.index(label)])
