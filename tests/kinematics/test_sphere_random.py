"""Random spherical mechanisms: assembled where they were drawn, moving as rigid bodies do, copies moving alike."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import numpy.typing as npt
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import centrode as ct
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import Solved, solve
from growing_sphere import Growing, angle_at, coordinates, mechanisms, unit
from mechanisms import EPS, Parts, conditioning, solve_evenly
from samples import few

Array = npt.NDArray[np.float64]
ONE_DRIVE = ("RRR", "RRP", "RPR", "PRP", "rigid point")
WIDTH, SAMPLES = 0.3, 7
WORTH = 1e5
"""Positions whose condition is worse than this prove nothing about formulas and are passed over."""


@settings(max_examples=few(10, 60))
@given(mechanisms())
def test_mechanisms_assemble_where_they_were_drawn(grown: Growing) -> None:
    """Also with links driven against others; angles are those that were measured."""
    prepared = ready(ct.Mechanism(**grown.parts()))
    drives = len(grown.drives)
    assert prepared.mobility == drives
    solved = solve(prepared, grid_at(prepared.kinematics.path, at_start(prepared.kinematics.path.initial)))
    condition = conditioning(solved, tries=4)[0, 0] if drives == 1 else WORTH
    assume(condition <= WORTH)
    at = prepared.assembled.positions
    allowed = 64 * EPS * condition
    for name, place in grown.places.items():
        assert np.max(np.abs(np.subtract(at.points[name], place))) <= allowed
    for name, axes in grown.axes.items():
        assert np.max(np.abs(np.column_stack(at.poses[name]) - axes)) <= allowed * 8
    for k, name in enumerate(solved.layout.angles):
        first, second = list(grown.links[name]["points"])[:2]
        towards = grown.links[name]["reference"][1]
        arms = [grown.places[p] for p in (second, towards)]
        near = min(np.linalg.norm(np.cross(grown.places[first], arm)) for arm in arms)
        measured = angle_at(grown.places[first], grown.places[towards], grown.places[second])
        off = (solved.angles[0, 0, 0, k] - measured + np.pi) % (2 * np.pi) - np.pi
        assert abs(off) <= allowed * 8 / near


def at_start(initial: float) -> Array:
    return np.array([initial])


def moving(parts: Parts, sense: float = 1.0) -> Solved:
    prepared = ready(ct.Mechanism(**parts))
    q = prepared.kinematics.path.initial
    return solve_evenly(prepared, SAMPLES, q - sense * WIDTH, q + sense * WIDTH)


@settings(max_examples=few(8, 50))
@given(mechanisms(ONE_DRIVE))
def test_links_move_as_rigid_bodies_about_the_centre(grown: Growing) -> None:
    """v = w x r and a = e x r + w x v; points on guides keep their arcs to poles; the drive has its rate."""
    solved = moving(grown.parts())
    condition = conditioning(solved, tries=4)
    good = (solved.status[0] == ct.Status.OK) & (condition[0] < WORTH)
    assume(good.any())
    assert solved.spins is not None
    allowed = 64 * EPS * condition
    names = [*grown.frame, *solved.layout.points]
    r, v, a = ({name: solved.all_points[k, 0, :, i] for i, name in enumerate(names)} for k in range(3))
    still = np.zeros((SAMPLES, 3))
    w, e = {"frame": still}, {"frame": still}
    for k, link in enumerate(solved.layout.links):
        w[link], e[link] = solved.spins[:, 0, :, k]
    speed = 1 + np.max([np.abs(x).max(axis=1) for x in w.values()], axis=0)
    first, second = (
        allowed[1] + speed * allowed[0],
        allowed[2] + 2 * speed * allowed[1] + speed**2 * allowed[0],
    )
    assert (solved.residual[0][good] <= allowed[0][good] * 4).all()
    for link, body in grown.links.items():
        for p in body["points"]:
            at_once = np.abs(v[p] - np.cross(w[link], r[p])).max(axis=1)
            then = np.abs(a[p] - np.cross(e[link], r[p]) - np.cross(w[link], v[p])).max(axis=1)
            assert (at_once[good] <= 4 * first[good]).all()
            assert (then[good] <= 8 * second[good]).all()
    for guide in grown.guides:
        on, p = guide["on"], guide["point"]
        pole = poles(solved, grown, on, guide["pole"])
        turning = np.cross(w[on], pole)
        bending = np.cross(e[on], pole) + np.cross(w[on], turning)
        once = np.sum(v[p] * pole + r[p] * turning, axis=1)
        twice = np.sum(a[p] * pole + 2 * v[p] * turning + r[p] * bending, axis=1)
        assert (np.abs(once)[good] <= 4 * first[good]).all()
        assert (np.abs(twice)[good] <= 8 * second[good]).all()
    crank = solved.layout.angles.index("link0")
    exact = np.stack([solved.span.parameter, np.ones(SAMPLES), np.zeros(SAMPLES)])
    arm = least_arms(solved, grown)[good][:, crank]
    off = np.abs(solved.angles[:, 0, :, crank] - exact)[:, good]
    assert (off <= 64 * EPS * (1 + np.abs(exact[:, good])) / arm).all()


def poles(solved: Solved, grown: Growing, on: str, pole: list[float]) -> Array:
    """Where a pole of a body is at the samples: on the frame it stays, on a link it follows two of its points."""
    if on == "frame":
        return np.tile(unit(pole), (SAMPLES, 1))
    k = solved.layout.links.index(on)
    numbers = solved.ready.structure.dimensions
    inside = numbers.local[on]
    first, second = (np.array([unit([*map(float, inside[p])])]) for p in list(inside)[:2])
    names = [*grown.frame, *solved.layout.points]
    places = [solved.all_points[0, 0, :, names.index(p)] for p in list(inside)[:2]]
    assert k >= 0
    local = np.stack([first[0], second[0], np.cross(first[0], second[0])])
    weights = np.linalg.solve(local.T, unit(pole))
    return np.asarray(
        weights[0] * places[0] + weights[1] * places[1] + weights[2] * np.cross(places[0], places[1])
    )


def image(parts: Parts, rotation: Array, mirrored: bool) -> Parts:
    """A copy turned about the centre as a whole, after a reflection in the equator if asked."""
    new = copy.deepcopy(parts)

    def local(at: list[float]) -> list[float]:
        return [at[0], -at[1]] if mirrored else at

    new["frame"]["points"] = {
        name: coordinates(rotation @ unit(local(at))) for name, at in new["frame"]["points"].items()
    }
    for link in new["links"].values():
        if isinstance(link["points"], dict):
            link["points"] = {name: local(at) for name, at in link["points"].items()}
        if "angle" in link and mirrored:
            link["angle"] = -link["angle"]
    for guide in new["guides"]:
        pole = local(guide["pole"])
        guide["pole"] = coordinates(rotation @ unit(pole)) if guide["on"] == "frame" else pole
    if mirrored:
        for drive in new["drives"]:
            drive["start"], drive["speed"] = -drive["start"], -drive["speed"]
        other = {"left": "right", "right": "left"}
        new["assembly"]["sides"] = {name: other[side] for name, side in new["assembly"]["sides"].items()}
    return new


@settings(max_examples=few(8, 40))
@given(mechanisms(ONE_DRIVE), st.integers(0, 1000), st.booleans())
def test_turned_and_mirrored_copies(grown: Growing, seed: int, mirrored: bool) -> None:
    """Places are those of the original, turned and reflected; angles those, or opposite."""
    rotation = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    sense = -1.0 if mirrored else 1.0
    one = moving(grown.parts())
    other = moving(image(grown.parts(), rotation, mirrored), sense)
    condition = conditioning(one, tries=4) + conditioning(other, tries=4)
    good = (one.status[0] == ct.Status.OK) & (condition[0] < WORTH)
    assume(good.any())
    np.testing.assert_array_equal(one.status[0][good], other.status[0][good])
    whole = rotation @ np.diag([1.0, 1.0, sense])
    for order in range(3):
        # the drive of a mirrored copy runs the other way: a first derivative by it has the other sign
        found, expected = sense**order * other.points[order, 0], one.points[order, 0] @ whole.T
        error = np.max(np.abs(found - expected), axis=(1, 2))
        assert (error[good] <= 64 * EPS * condition[order][good]).all()
    turned = np.remainder(other.angles[0, 0] - sense * one.angles[0, 0] + np.pi, 2 * np.pi) - np.pi
    arms = least_arms(one, grown)
    assert (np.abs(turned)[good] <= 256 * EPS * condition[0][good][:, None] / arms[good]).all()


def least_arms(solved: Solved, grown: Growing) -> Any:
    """Sines of the shortest arcs between which each angle is measured: (samples, angles)."""
    names = [*grown.frame, *solved.layout.points]
    place = {name: solved.all_points[0, 0, :, k] for k, name in enumerate(names)}
    found = []
    for link in solved.layout.angles:
        first, second = list(grown.links[link]["points"])[:2]
        towards = grown.links[link]["reference"][1]
        sines = [np.linalg.norm(np.cross(place[first], place[p]), axis=1) for p in (second, towards)]
        found.append(np.minimum(*sines))
    return np.stack(found, axis=1)
