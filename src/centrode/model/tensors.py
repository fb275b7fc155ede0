"""Tensors of inertia: as a description gives them, and their principal moments and axes."""

from __future__ import annotations

import math

from centrode.locale import _
from centrode.model.problems import Problem, shown
from centrode.model.values import READING, not_negative, si

Row = tuple[float, ...]
Tensor = tuple[Row, ...]
Inertia = float | Row | Tensor
"""A moment; on the sphere also three principal ones, or a tensor."""

PLAUSIBLE = 1e-9
"""A tensor may miss the rules of inertia by this share of its trace: it is given in decimals."""
SWEEPS = 30
LEAST = 1e-300


def read_inertia(value: object) -> Inertia:
    """A moment of inertia, not negative; on the sphere also [a, b, c] or a tensor that some body has."""
    if READING.get().space != "sphere" or not isinstance(value, list | tuple):
        return not_negative(value, "inertia")
    if len(value) != 3:
        form = _("a number, principal moments [a, b, c], or a tensor of three rows")
        raise Problem(_("expected {form}, got {value}").format(form=form, value=shown(value)))
    found: Row | Tensor
    if not any(isinstance(row, list | tuple) for row in value):
        found = tuple(si(entry, "inertia") for entry in value)
    else:
        found = tuple(_row(row) for row in value)
        _check_symmetric(found)
    _check_of_a_body(found)
    return found


def _row(value: object) -> Row:
    if not isinstance(value, list | tuple) or len(value) != 3:
        form = _("a number, principal moments [a, b, c], or a tensor of three rows")
        raise Problem(_("expected {form}, got {value}").format(form=form, value=shown(value)))
    return tuple(si(entry, "inertia") for entry in value)


def tensor_of(inertia: Inertia) -> Tensor:
    """The tensor in the link's own axes: a number is the same about all axes, three are principal moments."""
    if not isinstance(inertia, tuple):
        inertia = (inertia,) * 3
    if isinstance(inertia[0], tuple):
        return inertia
    return tuple(tuple(float(inertia[i]) if i == j else 0.0 for j in range(3)) for i in range(3))


def _check_symmetric(tensor: Tensor) -> None:
    slack = PLAUSIBLE * sum(abs(x) for row in tensor for x in row)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        if abs(tensor[i][j] - tensor[j][i]) > slack:
            what = _("a tensor of inertia is symmetric, but it has {one:.6g} across from {other:.6g}")
            text = what.format(one=tensor[i][j], other=tensor[j][i])
            raise Problem(
                text, _("give the products of inertia, which are negative sums of x y, on both sides")
            )


def _check_of_a_body(inertia: Inertia) -> None:
    low, middle, high = moments = sorted(principal(tensor_of(inertia))[0])
    slack = PLAUSIBLE * sum(abs(x) for x in moments)
    listed = ", ".join(f"{x:.6g}" for x in moments)
    if low < -slack:
        what = _("it is not positive definite: its principal moments are {moments}").format(moments=listed)
        raise Problem(what, _("correct it: no moment of inertia is negative"))
    if high > low + middle + slack:
        what = _("no body has the principal moments {moments}").format(moments=listed)
        repair = _(
            "correct it: the greatest one never exceeds the sum of the two others, here by {excess:.6g}"
        )
        raise Problem(what, repair.format(excess=high - low - middle))


def principal(tensor: Tensor) -> tuple[Row, Tensor]:
    """Principal moments of a symmetric tensor, and their axes as rows: Jacobi's rotations, to rounding.

    Source: Golub and Van Loan, Matrix Computations, section 8.5.
    """
    a = [[0.5 * (tensor[i][j] + tensor[j][i]) for j in range(3)] for i in range(3)]
    axes = [[float(i == j) for j in range(3)] for i in range(3)]
    for _sweep in range(SWEEPS):
        if a[0][1] == a[0][2] == a[1][2] == 0.0:
            break
        for p, q in ((0, 1), (0, 2), (1, 2)):
            _rotate(a, axes, p, q)
    return tuple(a[i][i] for i in range(3)), tuple(tuple(axis) for axis in axes)


def _rotate(a: list[list[float]], axes: list[list[float]], p: int, q: int) -> None:
    """Turn two axes so that the element between them vanishes; one that rounding cannot tell from zero is dropped."""
    across = a[p][q]
    if all(abs(a[k][k]) + abs(across) == abs(a[k][k]) for k in (p, q)) or abs(across) <= LEAST:
        a[p][q] = a[q][p] = 0.0
        return
    ratio = (a[q][q] - a[p][p]) / (2.0 * across)
    tangent = math.copysign(1.0, ratio) / (abs(ratio) + math.hypot(1.0, ratio))
    cosine = 1.0 / math.hypot(1.0, tangent)
    sine = tangent * cosine
    a[p][p] -= tangent * across
    a[q][q] += tangent * across
    a[p][q] = a[q][p] = 0.0
    r = 3 - p - q
    a[r][p], a[r][q] = cosine * a[r][p] - sine * a[r][q], sine * a[r][p] + cosine * a[r][q]
    a[p][r], a[q][r] = a[r][p], a[r][q]
    for k in range(3):
        axes[p][k], axes[q][k] = (
            cosine * axes[p][k] - sine * axes[q][k],
            sine * axes[p][k] + cosine * axes[q][k],
        )
