"""Transmission angles of dyads as formulas of the motion, so that they have derivatives as any output has."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator

from centrode.kinematics.preparation import Ready
from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.groups import Aim, CylinderCircle, Group, Meet, Rail, Rod, Slot
from centrode.sweeps.outputs import identifier

NAME = "transmission_angle"
"""First word of an output that is the transmission angle of a group: transmission_angle.AB-DB."""


def transmission_formulas(prepared: Ready, varied: Container[str]) -> dict[str, str]:
    """Group -> formula of its transmission angle [rad], of dyads alone.

    Parameters
    ----------
    varied : paths that vary, whose numbers a formula names; of others it holds the number itself

    Notes
    -----
    Angles of two links run from 0 to pi, others are acute, as those of `transmission_angles`. On the sphere groups are
    known whose centres are hinges.
    """
    sphere = prepared.mechanism.space == "sphere"
    found = {}
    for group in prepared.structure.groups:
        formula = _on_sphere(group) if sphere else _in_plane(prepared, group, varied)
        if formula is not None:
            found["-".join(group.links or group.points)] = formula
    return found


def with_transmission_angles(text: str, formulas: dict[str, str]) -> str:
    """An output in which names of transmission angles are replaced by their formulas."""
    head, _dot, group = text.partition(".")
    if head == NAME and group in formulas:
        return formulas[group]
    for group, formula in formulas.items():
        text = re.sub(rf"\b{re.escape(identifier(NAME, group))}\b", lambda _match, f=formula: f"({f})", text)  # type: ignore[misc]
    return text


Pair = tuple[str, str]


def _in_plane(prepared: Ready, group: Group, varied: Container[str]) -> str | None:
    if isinstance(group, Aim) and group.contact is None:
        # the arm's end moves square to it: the angle is that between the arm's normal and the guide
        arm = _arm(group.pivot, group.target)
        return _acute(*_crossing_angle(arm, _guide(prepared, group.link, group.guide, varied)))
    if not isinstance(group, Meet) or group.has_stop:
        return None
    arms, lines = [], []
    for locus in group.loci:
        if isinstance(locus, (Rod, CylinderCircle)):
            arms.append(_arm(locus.centre, locus.point))
        elif isinstance(locus, Rail):
            lines.append(_guide(prepared, locus.on, locus.guide, varied))
        elif isinstance(locus, Slot) and group.carriage is not None:
            lines.append(_guide(prepared, group.carriage, locus.guide, varied))
    if len(arms) == 2:
        return f"atan2(abs({_cross(*arms)}), {_dot(*arms)})"
    if len(arms) == 1 and len(lines) == 1:
        return _acute(*_crossing_angle(arms[0], lines[0]))
    if len(lines) == 2:
        return _acute(_cross(*lines), _dot(*lines))
    return None


def _acute(sine: str, cosine: str) -> str:
    return f"atan2(abs({sine}), abs({cosine}))"


def _crossing_angle(arm: Pair, line: Pair) -> Pair:
    """Sine and cosine of the angle between the normal of an arm and a line."""
    return _dot(arm, line), _cross(arm, line)


def _arm(centre: str, point: str) -> Pair:
    x, y = (
        f"({identifier('position', point, axis)} - {identifier('position', centre, axis)})" for axis in "xy"
    )
    return x, y


def _guide(prepared: Ready, body: str, guide: str, varied: Container[str]) -> Pair:
    """Direction of a guide's line in the frame."""
    mechanism: Mechanism = prepared.mechanism
    path = f"guides.{guide}.direction"
    own = mechanism.guide(guide).direction_angle
    angle = identifier(path) if path in varied else repr(own)
    if body != FRAME:
        angle = f"({identifier('angle', body)} + {angle})"
    elif path not in varied:
        x, y = mechanism.guide(guide).unit
        return f"({float(x)!r})", f"({float(y)!r})"
    return f"cos({angle})", f"sin({angle})"


def _cross(one: Pair, other: Pair) -> str:
    return f"{one[0]}*{other[1]} - {one[1]}*{other[0]}"


def _dot(one: Pair, other: Pair) -> str:
    return f"{one[0]}*{other[0]} + {one[1]}*{other[1]}"


def _on_sphere(group: Group) -> str | None:
    if not isinstance(group, Meet) or len(group.points) != 1:
        return None
    rods = [locus for locus in group.loci if isinstance(locus, Rod)]
    if len(rods) != 2:
        return None
    pin, one, other = (_place(point) for point in (group.points[0], rods[0].centre, rods[1].centre))
    # the two arcs' normals: their product has the triple product as its length
    sine = " + ".join(f"{a}*({b})" for a, b in zip(pin, _products(one, other), strict=True))
    cosine = f"({_scalar(one, other)}) - ({_scalar(pin, one)})*({_scalar(pin, other)})"
    return f"atan2(abs({sine}), {cosine})"


def _place(point: str) -> list[str]:
    return [identifier("position", point, axis) for axis in "xyz"]


def _scalar(one: list[str], other: list[str]) -> str:
    return " + ".join(f"{a}*{b}" for a, b in zip(one, other, strict=True))


def _products(one: list[str], other: list[str]) -> Iterator[str]:
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        yield f"{one[i]}*{other[j]} - {one[j]}*{other[i]}"
