"""Copies of random mechanisms moved, resized, renamed and reordered move alike; a value is the same in any company."""

from __future__ import annotations

import copy
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import Solved
from centrode.structure.groups import Newton
from growing import descriptions, mechanism_of
from mechanisms import EPS, Parts, conditioning, moved, solve_evenly
from samples import examples_at_hand, few

Complex: TypeAlias = npt.NDArray[np.complex128]

WIDTH = 0.8
SAMPLES = 9
NEAR = 1e8
"""A sample whose condition is worse lies on a limit, as far as rounding goes: its status may fall either way."""


def motion_about_the_start(parts: Parts, sense: float = 1.0) -> Solved:
    prepared = ready(mechanism_of(parts))
    q = prepared.kinematics.path.initial
    return solve_evenly(prepared, SAMPLES, q - sense * WIDTH, q + sense * WIDTH)


def alike(one: Solved, other: Solved, images: list[Complex], sense: float, size: float) -> None:
    """Statuses are equal and places, velocities and accelerations those expected, to rounding on both sides.

    `images` are the expected places and derivatives as complex numbers (samples, points).
    """
    condition = np.nan_to_num(conditioning(one, tries=4), nan=np.inf) + np.nan_to_num(
        conditioning(other, tries=4), nan=np.inf
    )
    clear = (condition[0] < NEAR) | (one.status[0] == ct.Status.OPEN)
    np.testing.assert_array_equal(one.status[0][clear], other.status[0][clear])
    good = clear & (one.status[0] == ct.Status.OK)
    for order in range(3):
        places = other.points[order, 0, :, :, 0] + 1j * other.points[order, 0, :, :, 1]
        error = np.max(np.abs(places * sense**order - images[order]), axis=1, initial=0.0)
        allowed = 8 * EPS * condition[order] * size
        assert (error[good] <= allowed[good]).all(), f"derivative {order}"


def images_of(solved: Solved, rotor: complex, mirrored: bool, shift: complex) -> list[Complex]:
    found: list[Complex] = []
    for order in range(3):
        z = solved.points[order, 0, :, :, 0] + 1j * solved.points[order, 0, :, :, 1]
        found.append(rotor * (np.conj(z) if mirrored else z) + (shift if order == 0 else 0.0))
    return found


@settings(max_examples=few(10, 40))
@given(descriptions(), st.floats(-3.1, 3.1), st.sampled_from([1e-6, 1e-3, 1.0, 1e3, 1e6]), st.booleans())
def test_turned_scaled_and_mirrored_copies(parts: Parts, turn: float, scale: float, mirrored: bool) -> None:
    sense = -1.0 if mirrored else 1.0
    one = motion_about_the_start(parts)
    other = motion_about_the_start(moved(parts, turn, scale=scale, mirrored=mirrored), sense)
    images = images_of(one, scale * np.exp(1j * turn), mirrored, 0j)
    alike(one, other, images, sense, scale * float(one.ready.structure.dimensions.scale))


@settings(max_examples=few(10, 20))
@given(descriptions(), st.floats(-9, 9), st.floats(-9, 9))
def test_shifted_copies(parts: Parts, x: float, y: float) -> None:
    one = motion_about_the_start(parts)
    other = motion_about_the_start(moved(parts, shift=(x, y)))
    # shifted places are rounded to the size of the shift, and so are the lengths between them
    size = float(other.ready.structure.dimensions.scale)
    alike(one, other, images_of(one, 1.0, False, complex(x, y)), 1.0, size * (1 + np.hypot(x, y)))


def renamed(parts: Parts, random: np.random.Generator) -> tuple[Parts, dict[str, str]]:
    """A copy with new names, its links and guides in another order; the map of the points' names."""
    points = dict.fromkeys(parts["frame"]["points"])
    points |= dict.fromkeys(p for link in parts["links"].values() for p in link["points"])
    points |= dict.fromkeys(guide["point"] for guide in parts["guides"])
    numbers = random.permutation(len(points))
    names = {name: f"Q{k}" for name, k in zip(points, numbers, strict=True)}
    bodies = {name: f"body-{k}" for k, name in enumerate(random.permutation(list(parts["links"])))}
    new = copy.deepcopy(parts)
    new["frame"]["points"] = {names[p]: v for p, v in parts["frame"]["points"].items()}
    shuffled = random.permutation(list(parts["links"]))
    new["links"] = {
        bodies[name]: {
            **parts["links"][name], "points": {names[p]: v for p, v in parts["links"][name]["points"].items()}
        }
        for name in shuffled
    }  # fmt: skip
    new["guides"] = [
        rewritten(parts["guides"][k], names, bodies) for k in random.permutation(len(parts["guides"]))
    ]
    for gear in new["gears"]:
        gear["links"] = [bodies.get(name, "frame") for name in gear["links"]]
        gear["carrier"] = bodies.get(gear["carrier"], "frame")
    for wheel in new["rolling"]:
        wheel |= {"link": bodies[wheel["link"]], "centre": names[wheel["centre"]]}
        wheel["on"] = bodies.get(wheel["on"], "frame")
    new["drives"][0]["link"] = bodies[parts["drives"][0]["link"]]
    return new, names


def rewritten(guide: Parts, names: dict[str, str], bodies: dict[str, str]) -> Parts:
    new = {**guide, "point": names[guide["point"]], "on": bodies.get(guide["on"], "frame")}
    if "link" in guide:
        new["link"] = bodies[guide["link"]]
    return new


@settings(max_examples=few(8, 30))
@given(descriptions(), st.integers(0, 2**31))
def test_renamed_and_reordered_copies(parts: Parts, seed: int) -> None:
    one = motion_about_the_start(parts)
    new, names = renamed(parts, np.random.default_rng(seed))
    other = motion_about_the_start(new)
    order = [
        one.layout.points.index(old)
        for point in other.layout.points
        for old, n in names.items()
        if n == point
    ]
    images = [image[:, order] for image in images_of(one, 1.0, False, 0j)]
    alike(one, other, images, 1.0, float(one.ready.structure.dimensions.scale))
    assert one.ready.mobility == other.ready.mobility == 1


@settings(max_examples=few(8, 30))
@given(descriptions(), st.integers(1, 6), st.integers(0, 5))
def test_a_value_is_the_same_bits_in_any_company(parts: Parts, stride: int, first: int) -> None:
    """Fewer samples, a part of the range, backwards: at the same value of the drive all numbers have the same bits."""
    prepared = ready(mechanism_of(parts))
    q = prepared.kinematics.path.initial
    whole = solve_evenly(prepared, 61, q - 1.0, q + 2.0)
    values = whole.span.parameter
    picked = list(range(first, 61, stride))
    part = solve_evenly(prepared, len(picked), float(values[picked[0]]), float(values[picked[-1]]))
    backwards = solve_evenly(prepared, 61, float(values[-1]), float(values[0]))
    compared = 0
    for other in (part, backwards):
        for k, value in enumerate(other.span.parameter):
            same = np.nonzero(values == value)[0]
            if len(same):
                same_bits(whole, int(same[0]), other, k)
                compared += 1
    assert compared > 2


def same_bits(one: Solved, sample: int, other: Solved, k: int) -> None:
    for name in ("points", "angles", "slides"):
        np.testing.assert_array_equal(getattr(one, name)[:, 0, sample], getattr(other, name)[:, 0, k])
    assert one.status[0, sample] == other.status[0, k]
    np.testing.assert_array_equal(one.residual[0, sample], other.residual[0, k])


BY_TIME = ("wiper", "two-link-arm", "cam-driven-linkage", "catapult", "door-closer", "vibrating-screen")
"""Driven by laws of time, or several drives: a value of the drive alone does not say where they are."""


@pytest.mark.parametrize("name", [n for n in examples_at_hand(ct.example_names()) if n not in BY_TIME])
def test_examples_give_the_same_bits_alone_and_together(name: str) -> None:
    prepared = ready(ct.example(name))
    study = prepared.mechanism.study
    low = study.start if study.start is not None else prepared.kinematics.path.initial
    high = study.stop if study.stop is not None else low + 7.0
    whole = solve_evenly(prepared, 97, low, high)
    # groups of higher class are followed anew for each value
    higher = any(isinstance(group, Newton) for group in prepared.structure.groups)
    for k in few((77,) if higher else (0, 50, 77), (0, 1, 17, 50, 77, 96)):
        q = float(whole.span.parameter[k])
        same_bits(whole, k, solve_evenly(prepared, 1, q, q), 0)


BATCHES: list[tuple[str, dict[str, list[float]]]] = [
    ("crank-rocker", {"links.AB.length": [3.4, 3.5, 3.7], "frame.points.D.x": [4.0, 4.1, 3.9]}),
    ("triple-rocker", {"links.OA.length": [1.9, 2.0, 2.2]}),
    ("slider-crank-offset", {"guides.B.through.y": [0.0, 0.3, 1.5], "links.OA.length": [1.0, 1.2, 2.0]}),
    ("whitworth-quick-return", {"links.OA.length": [1.95, 2.0], "links.lever.points.B.x": [-0.8, -0.5]}),
    ("elliptic-trammel", {"guides.B.direction": [1.58, 1.55, 1.6]}),
    ("parallelogram", {"links.OA.length": [1.0, 1.1], "links.DB.length": [1.0, 1.1]}),
]


@pytest.mark.parametrize(("name", "vary"), BATCHES, ids=[name for name, _vary in BATCHES])
def test_a_batch_is_its_mechanisms_one_by_one(name: str, vary: dict[str, list[float]]) -> None:
    mechanism = ct.example(name)
    start, stop = (-0.9, 0.9) if name == "elliptic-trammel" else (0.3, 6.5)
    batch = ct.motion(mechanism, 73, start=start, stop=stop, vary=vary)
    assert batch["position"].dims[0] == "mechanism"
    for k in range(len(next(iter(vary.values())))):
        one = mechanism
        for path, column in vary.items():
            one = ct.with_value(one, path, column[k])
            np.testing.assert_array_equal(batch[path], column)
        alone = ct.motion(one, 73, start=start, stop=stop)
        np.testing.assert_array_equal(batch["status"].to_numpy()[k], alone["status"].to_numpy())
        for variable in ("position", "velocity", "acceleration", "angle", "angular_velocity", "slide"):
            numbers, expected = batch[variable].to_numpy()[k], alone[variable].to_numpy()
            clear = alone["status"].to_numpy() != ct.Status.SINGULAR
            np.testing.assert_array_equal(numbers[clear], expected[clear])


def test_what_cannot_be_varied() -> None:
    mechanism = ct.example("crank-rocker")
    wrong: list[tuple[Any, str]] = [
        ({"links.AB.length": [1.0, 2.0], "links.OA.length": [1.0]}, "same number of values"),
        ({"links.AB.length": [1.0, np.nan]}, "finite"),
        ({"links.AB.length": [1.0, -2.0]}, "positive"),
        ({"links.AX.length": [1.0]}, "names no dimension"),
    ]
    for vary, message in wrong:
        with pytest.raises(ct.InputError, match=message):
            ct.motion(mechanism, 3, vary=vary)
