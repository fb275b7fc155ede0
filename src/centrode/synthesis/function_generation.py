"""Four-bar linkages whose rocker follows a given function of the crank.

With phi and psi the angles of crank and rocker from the frame, Freudenstein's equation K1 cos psi - K2 cos phi + K3 =
cos(phi - psi) is linear in K1 = d/a, K2 = d/c and K3 = (a^2 - b^2 + c^2 + d^2)/(2 a c) (F. Freudenstein, Trans. ASME
76, 1954, 483-492; 77, 1955, 853-861). Three precision points give the three numbers. Four are possible where a
determinant of four rows vanishes, which is c0 + c1 cos 2 psi0 + c2 sin 2 psi0 in the starting angle of the rocker;
five where two such determinants vanish, which leaves one equation of eighth degree in the starting angle of the
crank.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy.optimize import linprog

from centrode.synthesis.four_bars import Array

GRID = 48
"""Starting angles of each side that are tried."""
KEPT = 60
REFINED, LAST = 8, 2
SAMPLES = 61
LEAST_RATIO, GREATEST_RATIO = 0.02, 50.0
"""Of a link to the frame."""
KEPT_WITHIN = 1e-9
"""A margin that rounding makes negative is kept down to this."""
Margins: TypeAlias = Callable[[Array, Array], Array]
"""(starts, lengths) -> (lanes, constraints): by how much each constraint is kept, negative where it is not."""


def keeps(margins: Array) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Whether linkages keep all constraints, (lanes,)."""
    return np.asarray((np.nan_to_num(margins, nan=-1.0) >= -KEPT_WITHIN).all(axis=1))


@dataclass(frozen=True, eq=False)
class FunctionLinkages:
    """Linkages with the frame 1 from O = 0 to D = 1.

    Attributes
    ----------
    starts : (n, 2) first angles of crank and rocker [rad]
    lengths : (n, 3) crank, coupler, rocker
    side : (n,) of B from the line AD
    errors : (n, points) of the rocker's angle [rad]
    """

    starts: Array
    lengths: Array
    side: Array
    errors: Array


def rocker_angles(lengths: Array, side: Array, crank: Array) -> tuple[Array, Array]:
    """Angles of the rocker (lanes, n) [rad] at angles of the crank, and radicands, negative where it is open."""
    a, b, c = (lengths[:, k, None] for k in range(3))
    joint = a * np.exp(1j * crank)
    line = 1.0 - joint
    square = np.maximum(np.abs(line) ** 2, 1e-300)
    along = (square + b * b - c * c) / (2 * square)
    radicand = b * b / square - along * along
    end = joint + line * (along + 1j * side[:, None] * np.sqrt(np.maximum(radicand, 0.0)))
    return np.angle(end - 1.0), radicand


def from_freudenstein(
    numbers: Array, starts: Array
) -> tuple[Array, Array, np.ndarray[tuple[int, ...], np.dtype[np.bool_]]]:
    """Lengths (n, 3) and starting angles (n, 2) of K1, K2, K3 (n, 3), and whether there is such a linkage.

    A negative length is a positive one whose link starts half a turn later.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        a, c = 1 / numbers[:, 0], 1 / numbers[:, 1]
        square = a * a + c * c + 1 - 2 * a * c * numbers[:, 2]
        turned = np.pi * np.column_stack([a < 0, c < 0])
        b = np.sqrt(np.maximum(square, 0.0))
        lengths = np.column_stack([np.abs(a), b, np.abs(c)])
        good = (square > 0) & (lengths > LEAST_RATIO).all(axis=1) & (lengths < GREATEST_RATIO).all(axis=1)
    return lengths, starts + turned, good


def three_points(crank: Array, rocker: Array, starts: Array) -> FunctionLinkages:
    """Linkages through three pairs of angles, for each pair of starting angles (n, 2) [rad]."""
    phi, psi = crank + starts[:, :1], rocker + starts[:, 1:]
    system = np.stack([np.cos(psi), -np.cos(phi), np.ones_like(phi)], axis=-1)
    regular = np.abs(np.linalg.det(system)) > 1e-9
    system[~regular] = np.eye(3)
    numbers = np.linalg.solve(system, np.cos(phi - psi)[..., None])[..., 0]
    lengths, turned, good = from_freudenstein(numbers, starts)
    return _on_one_side(lengths[good & regular], turned[good & regular], crank, rocker)


def _on_one_side(lengths: Array, starts: Array, crank: Array, rocker: Array) -> FunctionLinkages:
    """Linkages of which one side of B meets all points; those of which some need the other one are left out."""
    kept = []
    for side in (1.0, -1.0):
        sides = np.full(len(lengths), side)
        errors = angle_errors(starts, lengths, sides, crank, rocker)
        good = np.abs(errors).max(axis=1, initial=0.0) < 1e-6
        kept.append((starts[good], lengths[good], sides[good], errors[good]))
    return FunctionLinkages(*(np.concatenate(part) for part in zip(*kept, strict=True)))


def angle_errors(starts: Array, lengths: Array, side: Array, crank: Array, rocker: Array) -> Array:
    """Angle of the rocker less what it should be (lanes, n) [rad]; infinite where the linkage is open."""
    found, radicand = rocker_angles(lengths, side, crank + starts[:, :1])
    errors = np.angle(np.exp(1j * (found - rocker - starts[:, 1:])))
    return np.where((radicand > 0).all(axis=1, keepdims=True), errors, np.inf)


def _determinant(crank: Array, rocker: Array, phi: float, psi: float) -> float:
    first, second = crank + phi, rocker + psi
    rows = [np.cos(second), -np.cos(first), np.ones(4), np.cos(first - second)]
    return float(np.linalg.det(np.stack(rows, axis=-1)))


def _harmonics(crank: Array, rocker: Array, phi: float) -> tuple[float, float, float]:
    """c0, c1, c2 of the determinant c0 + c1 cos 2 psi0 + c2 sin 2 psi0 at one starting angle of the crank."""
    at = [_determinant(crank, rocker, phi, k * np.pi / 4) for k in range(3)]
    mean = (at[0] + at[2]) / 2
    return mean, at[0] - mean, at[1] - mean


def four_points(crank: Array, rocker: Array, phi: Array) -> FunctionLinkages:
    """All linkages through four pairs of angles, for each starting angle of the crank [rad]."""
    starts = []
    for start in phi.tolist():
        mean, cosine, sine = _harmonics(crank, rocker, start)
        size = np.hypot(cosine, sine)
        if size <= abs(mean) or size == 0.0:
            continue
        middle, spread = np.arctan2(sine, cosine), np.arccos(-mean / size)
        starts += [(start, (middle + spread) / 2), (start, (middle - spread) / 2)]
    return _through(crank, rocker, np.array(starts).reshape(-1, 2))


def _through(crank: Array, rocker: Array, starts: Array) -> FunctionLinkages:
    """Linkages at starting angles at which the equations of all points agree; equations are solved in least squares."""
    phi, psi = crank + starts[:, :1], rocker + starts[:, 1:]
    system = np.stack([np.cos(psi), -np.cos(phi), np.ones_like(phi)], axis=-1)
    numbers = np.einsum("nij,nj->ni", np.linalg.pinv(system), np.cos(phi - psi))
    lengths, turned, good = from_freudenstein(numbers, starts)
    return _on_one_side(lengths[good], turned[good], crank, rocker)


def five_points(crank: Array, rocker: Array) -> FunctionLinkages:
    """All real linkages through five pairs of angles.

    Both determinants are linear in cos 2 psi0 and sin 2 psi0, whose squares add up to one: a trigonometric polynomial
    of fourth degree in 2 phi0, whose real roots are those of a polynomial of eighth degree on the unit circle.
    """
    first, second = [0, 1, 2, 3], [0, 1, 2, 4]
    count = 16
    values = np.empty(count)
    for k in range(count):
        values[k] = _resultant(crank, rocker, first, second, np.pi * k / count)
    coefficients = np.fft.fft(values) / count
    polynomial = [coefficients[k] for k in (4, 3, 2, 1, 0, -1, -2, -3, -4)]
    starts: list[Array] = []
    for root in np.roots(polynomial):
        if not 0.99 < abs(root) < 1.01:
            continue
        phi = float(np.angle(root)) / 2
        (a0, a1, a2), (b0, b1, b2) = (_harmonics(crank[i], rocker[i], phi) for i in (first, second))
        psi = 0.5 * np.arctan2(-a1 * b0 + b1 * a0, -a0 * b2 + b0 * a2) if a1 * b2 != a2 * b1 else 0.0
        if a1 * b2 - a2 * b1 < 0:
            psi += np.pi / 2
        place = _polish(crank, rocker, first, second, np.array([phi, psi]))
        near = any(np.abs(np.sin(place - other)).max() < 1e-7 for other in starts)
        if not near:
            starts.append(place)
    return _through(crank, rocker, np.array(starts).reshape(-1, 2))


def _resultant(crank: Array, rocker: Array, first: list[int], second: list[int], phi: float) -> float:
    (a0, a1, a2), (b0, b1, b2) = (_harmonics(crank[i], rocker[i], phi) for i in (first, second))
    return (-a0 * b2 + b0 * a2) ** 2 + (-a1 * b0 + b1 * a0) ** 2 - (a1 * b2 - a2 * b1) ** 2


def _polish(crank: Array, rocker: Array, first: list[int], second: list[int], place: Array) -> Array:
    """Newton's method for both determinants, with differences that rounding allows."""

    def values(at: Array) -> Array:
        return np.array([_determinant(crank[i], rocker[i], at[0], at[1]) for i in (first, second)])

    for _iteration in range(6):
        step = 1e-6
        slopes = np.column_stack(
            [(values(place + d) - values(place - d)) / (2 * step) for d in step * np.eye(2)]
        )
        if abs(np.linalg.det(slopes)) < 1e-14:
            break
        place = place - np.linalg.solve(slopes, values(place))
    return place


# Least errors over a whole range.


def least_errors(
    crank: Array,
    rocker: Array,
    margins: Margins,
    progress: Callable[[float], None] = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
) -> FunctionLinkages:
    """Linkages whose greatest error over given angles is locally least, best first.

    Parameters
    ----------
    crank, rocker : (n,) angles [rad] from their starts
    margins : of what is required
    """
    # Three precision points at Chebyshev's places give the starts of the search.
    share = 0.5 - 0.5 * np.cos(np.pi * np.array([1, 3, 5]) / 6)
    rows = np.rint(share * (len(crank) - 1)).astype(np.int64)
    grid = np.linspace(0.0, 2 * np.pi, GRID, endpoint=False)
    starts = np.stack(np.meshgrid(grid, grid[: GRID // 2], indexing="ij"), axis=-1).reshape(-1, 2)
    begun = three_points(crank[rows], rocker[rows], starts)
    errors = angle_errors(begun.starts, begun.lengths, begun.side, crank, rocker)
    worst = np.abs(errors).max(axis=1, initial=0.0)
    good = np.isfinite(worst) & keeps(margins(begun.starts, begun.lengths))
    order = np.flatnonzero(good)[np.argsort(worst[good], kind="stable")][: 4 * KEPT]
    variables = np.column_stack([begun.starts, begun.lengths])[order]
    side = begun.side[order]
    progress(0.2)
    fitted = _squares(variables, side, crank, rocker)
    progress(0.5)
    # what the fit has led beyond a constraint begins where it was
    variables = np.where(keeps(margins(fitted[:, :2], fitted[:, 2:]))[:, None], fitted, variables)
    worst = _worst(variables, side, crank, rocker)
    chosen: list[int] = []
    for k in np.argsort(worst, kind="stable").tolist():
        alike = (
            abs(worst[k] - worst[j]) < 1e-5 * worst[j]
            and np.allclose(variables[k, 2:], variables[j, 2:], rtol=1e-3)
            for j in chosen
        )
        if np.isfinite(worst[k]) and not any(alike):
            chosen.append(k)
        if len(chosen) == REFINED:
            break
    refined = []
    for count, k in enumerate(chosen):
        refined.append(_descend(variables[k], float(side[k]), crank, rocker, margins))
        progress(0.5 + 0.3 * (count + 1) / len(chosen))
        if stop():
            break
    chosen = chosen[: len(refined)]
    if not chosen:
        none = np.empty((0, len(crank)))
        return FunctionLinkages(np.empty((0, 2)), np.empty((0, 3)), np.empty(0), none)
    variables, side = np.stack(refined), side[chosen]
    order = np.argsort(_worst(variables, side, crank, rocker), kind="stable")
    variables, side = variables[order], side[order]
    for k in range(min(LAST, len(side))):
        if not stop():
            variables[k] = _least_greatest(variables[k], float(side[k]), crank, rocker, margins)
        progress(0.8 + 0.2 * (k + 1) / LAST)
    order = np.argsort(_worst(variables, side, crank, rocker), kind="stable")
    variables, side = variables[order], side[order]
    errors = angle_errors(variables[:, :2], variables[:, 2:], side, crank, rocker)
    return FunctionLinkages(variables[:, :2], variables[:, 2:], side, errors)


def _worst(variables: Array, side: Array, crank: Array, rocker: Array) -> Array:
    errors = angle_errors(variables[:, :2], variables[:, 2:], side, crank, rocker)
    worst: Array = np.abs(errors).max(axis=1, initial=0.0)
    return worst


def _error_slopes(variables: Array, side: Array, crank: Array) -> Array:
    """Derivatives (lanes, n, 5) of the errors by starting angles and lengths, from the closure differentiated once."""
    phi = crank + variables[:, :1]
    a, b, c = (variables[:, k, None] for k in (2, 3, 4))
    psi, _radicand = rocker_angles(variables[:, 2:], side, phi)
    turned, swung = np.exp(1j * phi), np.exp(1j * psi)
    bar = np.conj(1.0 + c * swung - a * turned)
    leverage = (bar * 1j * c * swung).real
    leverage = np.where(np.abs(leverage) < 1e-12, 1e-12, leverage)
    return np.stack(
        [
            (bar * 1j * a * turned).real / leverage,
            -np.ones_like(psi),
            (bar * turned).real / leverage,
            np.broadcast_to(b, psi.shape) / leverage,
            -(bar * swung).real / leverage,
        ],
        axis=-1,
    )


def _squares(variables: Array, side: Array, crank: Array, rocker: Array) -> Array:
    """Levenberg and Marquardt for all lanes at once: the least sum of squares of the errors."""
    damping = np.full(len(variables), 1e-3)
    errors = angle_errors(variables[:, :2], variables[:, 2:], side, crank, rocker)
    cost = (errors**2).sum(axis=1)
    for _iteration in range(60):
        slopes = _error_slopes(variables, side, crank)
        normal = np.einsum("lni,lnj->lij", slopes, slopes)
        gradient = np.einsum("lni,ln->li", slopes, errors)
        diagonal = np.einsum("lii->li", normal)
        diagonal += damping[:, None] * diagonal + 1e-14
        step = -np.linalg.solve(normal, gradient[..., None])[..., 0]
        proposed = variables + step
        proposed[:, 2:] = np.clip(proposed[:, 2:], LEAST_RATIO, GREATEST_RATIO)
        found = angle_errors(proposed[:, :2], proposed[:, 2:], side, crank, rocker)
        total = (found**2).sum(axis=1)
        better = total < cost
        variables = np.where(better[:, None], proposed, variables)
        errors = np.where(better[:, None], found, errors)
        cost = np.where(better, total, cost)
        damping = np.clip(np.where(better, damping * 0.3, damping * 5.0), 1e-14, 1e12)
    return variables


def _least_greatest(
    variables: Array,
    side: float,
    crank: Array,
    rocker: Array,
    margins: Margins,
) -> Array:
    """The least greatest error, by linear programs in a region that shrinks where a step does not help."""
    # A region that has shrunk at a corner is opened again as long as that helps.
    for _round in range(8):
        before = float(_worst(variables[None], np.array([side]), crank, rocker)[0])
        variables = _descend(variables, side, crank, rocker, margins)
        if _worst(variables[None], np.array([side]), crank, rocker)[0] > before * (1 - 1e-6):
            break
    return variables


def _descend(
    variables: Array,
    side: float,
    crank: Array,
    rocker: Array,
    margins: Margins,
) -> Array:
    sides = np.array([side])
    return lessen_greatest(
        variables,
        lambda at: angle_errors(at[None, :2], at[None, 2:], sides, crank, rocker)[0],
        lambda at: _error_slopes(at[None], sides, crank)[0],
        lambda at: bool(keeps(margins(at[None, :2], at[None, 2:]))[0]),
        lambda at: margins(at[None, :2], at[None, 2:])[0],
    )


def lessen_greatest(
    variables: Array,
    errors: Callable[[Array], Array],
    slopes: Callable[[Array], Array],
    keeps: Callable[[Array], bool],
    margins: Callable[[Array], Array] = lambda at: np.empty(0),
) -> Array:
    """Variables, the first two of them angles, from which no linear program lessens the greatest error.

    Parameters
    ----------
    errors : variables -> (n,), infinite where there are none
    slopes : variables -> (n, variables)
    keeps : whether variables keep what is required
    margins : by how much each constraint is kept, (constraints,); a program keeps to them as far as they are linear
    """
    region = 0.05
    count = len(variables)
    best = float(np.abs(errors(variables)).max())
    for _iteration in range(80):
        missed, by = errors(variables), slopes(variables)
        one = np.ones((len(missed), 1))
        left, rise = margins(variables), _slopes_of(margins, variables)
        free = np.zeros((len(left), 1))
        bound = np.vstack([np.hstack([by, -one]), np.hstack([-by, -one]), np.hstack([-rise, free])])
        limits = [(-region, region)] * 2 + [(-region * abs(x), region * abs(x)) for x in variables[2:]]
        solved = linprog(
            [*[0] * count, 1],
            A_ub=bound,
            b_ub=np.concatenate([-missed, missed, left]),
            bounds=[*limits, (0.0, None)],
            method="highs",
        )
        if not solved.success:
            break
        proposed = variables + solved.x[:count]
        worst = float(np.abs(errors(proposed)).max())
        if worst < best and keeps(proposed):
            small = best - worst < 1e-10 * best
            variables, best, region = proposed, worst, min(region * 2, 0.2)
            if small:
                break
        else:
            region /= 4
            if region < 1e-9:
                break
    return variables


def _slopes_of(margins: Callable[[Array], Array], variables: Array) -> Array:
    """Derivatives (constraints, variables) of margins, by differences that rounding allows."""
    step = 1e-6
    shifts = step * np.eye(len(variables))
    return np.column_stack([(margins(variables + d) - margins(variables - d)) / (2 * step) for d in shifts])
