"""What the cases of the oracle share: equations of lines and loops, and the four-bar that many of them stand on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath as mp

Parts = dict[str, Any]
Unknowns = Sequence[Any]


@dataclass(frozen=True)
class Case:
    """A mechanism, its equations in the value of the drive (or time) and the unknowns, and what is compared.

    Outputs are named "x:B", "y:B", "angle:AB" or "slide:B"; `driven` are links whose angle the drive gives.
    """

    name: str
    parts: Parts
    start: float
    guess: tuple[float, ...]
    equations: Callable[[Any, Unknowns], list[Any]]
    outputs: Callable[[Any, Unknowns], Mapping[str, Any]]
    driven: tuple[str, ...] = ("OA",)
    unit: float = 1.0


def z(v: Sequence[float]) -> Any:
    """A point as a complex number."""
    return mp.mpc(v[0], v[1])


def e(angle: Any) -> Any:
    """The rotor of an angle."""
    return mp.mpc(mp.cos(angle), mp.sin(angle))


def off(point: Any, through: Sequence[float], direction: Sequence[float]) -> Any:
    """Distance of a point from a line."""
    d = z(direction)
    return (mp.conj(d) * (point - z(through))).imag / abs(d)


def along(point: Any, through: Sequence[float], direction: Sequence[float]) -> Any:
    """Displacement of a point along a line."""
    d = z(direction)
    return (mp.conj(d) * (point - z(through))).real / abs(d)


def both(value: Any) -> list[Any]:
    """Real and imaginary part: two equations."""
    return [value.real, value.imag]


def xy(**points: Any) -> dict[str, Any]:
    """Outputs of points."""
    found = {}
    for name, value in points.items():
        found[f"x:{name}"], found[f"y:{name}"] = mp.re(value), mp.im(value)
    return found


def drive(start: float, link: str = "OA") -> list[Parts]:
    return [{"link": link, "start": start, "speed": 1.0}]


D = (3.9, 0.3)
P = (1.4, 0.9)
RAIL = ((0.3, -0.6), (3.0, 0.8))
SLOT = ((0.2, 1.1), (1.0, 0.25))
LOW = (1.8, -1.2)
FOUR_BAR: Parts = {
    "frame": {"points": {"O": [0, 0], "D": list(D)}},
    "links": {
        "OA": {"length": 1.1},
        "K": {"points": {"A": [0, 0], "B": [3.2, 0], "P": list(P)}},
        "DB": {"length": 2.7},
    },
    "drives": drive(0.7),
}


def loop(q: Any, theta: Any, psi: Any) -> list[Any]:
    """The four-bar closes: OA + AB = OD + DB."""
    return both(mp.mpf(1.1) * e(q) + mp.mpf(3.2) * e(theta) - z(D) - mp.mpf(2.7) * e(psi))


def pin(q: Any) -> Any:
    return mp.mpf(1.1) * e(q)


def on_four_bar(links: Parts, guides: Sequence[Parts] = (), **frame: list[float]) -> Parts:
    points = {**FOUR_BAR["frame"]["points"], **frame}
    return {
        **FOUR_BAR,
        "frame": {"points": points},
        "links": {**FOUR_BAR["links"], **links},
        "guides": list(guides),
    }


def one_crank(links: Parts, guides: Sequence[Parts], start: float, **frame: list[float]) -> Parts:
    return {
        "frame": {"points": {"O": [0, 0], **frame}},
        "links": {"OA": {"length": 1.1}, **links},
        "guides": list(guides),
        "drives": drive(start),
    }


def angles(**values: Any) -> dict[str, Any]:
    return {f"angle:{name}": value for name, value in values.items()}


def in_coupler(q: Any, theta: Any, point: Any) -> Any:
    """A place in the axes of the four-bar's coupler."""
    return (point - pin(q)) * e(-theta)
