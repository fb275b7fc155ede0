"""Groups of higher class alone and together: the same bits, copies, batches, many turns."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from mechanisms import EPS, moved, parts_of, statuses
from redriven import answer
from samples import few

EXAMPLES = (
    "third-class-triad", "fourth-class-group", "stephenson-driven-at-rocker", "watt-driven-second-loop"
)  # fmt: skip
ROD = {
    "third-class-triad": "AB", "fourth-class-group": "BD", "stephenson-driven-at-rocker": "PR",
    "watt-driven-second-loop": "PR",
}  # fmt: skip
LOOKED_AT = few(EXAMPLES[:2], EXAMPLES)
NUMBERS = ("position", "velocity", "acceleration", "angle", "status")


def asked(mechanism: ct.Mechanism, count: int, beyond: float = 0.0) -> np.ndarray:
    study = mechanism.study
    start = study.start if study.start is not None else 0.0
    stop = study.stop if study.stop is not None else 2.0 * np.pi
    return np.linspace(start - beyond, stop + beyond, count)


@cache
def at_home(name: str) -> tuple[np.ndarray, xr.Dataset, np.ndarray]:
    """Seven values over an example's range, the motion there, and how much it answers to the dimensions."""
    mechanism = ct.example(name)
    values = asked(mechanism, 7)
    return values, ct.motion(mechanism, at=values), answer(mechanism, values)


@pytest.mark.parametrize("name", LOOKED_AT)
def test_the_same_bits_alone_and_together(name: str) -> None:
    """Whatever else is asked for: one sample, many, more mechanisms, those beyond a chunk."""
    mechanism = ct.example(name)
    values = asked(mechanism, 9, beyond=0.1)
    together = ct.motion(mechanism, at=values)
    path = f"links.{ROD[name]}.length"
    lengths = ct.value_at(mechanism, path) * np.linspace(0.99, 1.01, 151)
    batch = ct.motion(mechanism, at=values, vary={path: lengths})
    for k in few((0, 8), (0, 4, 8)):
        alone = ct.motion(mechanism, at=values[[k]])
        for number in NUMBERS:
            assert np.array_equal(alone[number][0], together[number][k], equal_nan=True), number
    for lane in few((0, 150), (0, 75, 150)):
        alone = ct.motion(mechanism, at=values[[3]], vary={path: lengths[[lane]]})
        for number in NUMBERS:
            assert np.array_equal(alone[number][0, 0], batch[number][lane, 3], equal_nan=True), (number, lane)


@pytest.mark.parametrize("name", LOOKED_AT)
def test_a_batch_is_its_mechanisms(name: str) -> None:
    mechanism = ct.example(name)
    values, path = asked(mechanism, 7), f"links.{ROD[name]}.length"
    lengths = ct.value_at(mechanism, path) * np.array(few([0.98, 1.02], [0.98, 1.0, 1.02]))
    batch = ct.motion(mechanism, at=values, vary={path: lengths})
    for lane, length in enumerate(lengths):
        single = ct.with_value(mechanism, path, float(length))
        one = ct.motion(single, at=values)
        allowed = 32 * EPS * answer(single, values)[0] * float(np.abs(one.position).max())
        ok = (one.status == ct.Status.OK).to_numpy()
        gap = np.abs(batch.position[lane] - one.position).max(dim=("point", "axis")).to_numpy()
        assert np.array_equal(batch.status[lane], one.status)
        assert np.all(gap[ok] <= allowed[ok])


def test_mechanisms_that_do_not_close_are_absent_and_the_others_as_they_are() -> None:
    """Rods from far too short to far too long: what has no initial position has no motion, and hurts nobody."""
    mechanism = ct.example("third-class-triad")
    lengths = np.linspace(2.0, 8.0, 61)
    data = ct.motion(mechanism, samples=9, vary={"links.AB.length": lengths})
    words = np.array([[ct.Status(code).word for code in row] for row in data.status.to_numpy()])
    own = int(np.argmin(np.abs(lengths - 5.0)))
    assert set(words[own]) == {"ok"}
    alone = ct.motion(mechanism, samples=9, vary={"links.AB.length": [5.0]})
    assert np.array_equal(data.position[own], alone.position[0])
    assert (words[0] != "ok").all()
    assert (words[-1] != "ok").all()
    assert np.isnan(data.position.to_numpy()[words == "unconverged"][:, -3:]).all()
    assert float(data.residual.max()) <= 1e-12


CHANGES = [{"scale": 1e-6}, {"scale": 1e6}, {"turn": 1.0}, {"mirrored": True}, {"shift": (3.0, -5.0)}]


@pytest.mark.parametrize(
    ("name", "change"),
    few(
        [(EXAMPLES[k % len(EXAMPLES)], change) for k, change in enumerate(CHANGES)],
        [(name, change) for name in EXAMPLES for change in CHANGES],
    ),
    ids=lambda x: x if isinstance(x, str) else next(iter(x)) + str(next(iter(x.values()))),
)
def test_copies_move_alike(name: str, change: dict) -> None:
    mechanism = ct.example(name)
    values, here, answered = at_home(name)
    parts = parts_of(mechanism)
    parts.pop("study", None)
    copy = ct.Mechanism(**moved(parts, **change))
    sense = -1.0 if change.get("mirrored") else 1.0
    turn = change.get("turn", 0.0)
    shift = turn if mechanism.drives[0].relative_to == "frame" else 0.0
    there = ct.motion(copy, at=sense * values + shift)
    size = 1.0 + max(map(abs, change.get("shift", (0.0,))))
    allowed = 32 * EPS * size * np.max(answered[0]) * 2.0 * np.pi
    assert set(statuses(there)) == {"ok"}
    assert np.max(np.abs(there.angle - sense * here.angle - turn)) <= allowed


def test_many_turns_repeat_the_first() -> None:
    mechanism = ct.example("third-class-triad")
    first = ct.motion(mechanism, at=asked(mechanism, 5))
    last = ct.motion(mechanism, at=asked(mechanism, 5) + 20 * np.pi)
    # the drive's own value is rounded to a unit of the greater turn
    allowed = (16 * EPS + 2 * np.spacing(22 * np.pi)) * answer(mechanism, asked(mechanism, 5))[0].max() * 10
    assert np.max(np.abs(last.position - first.position)) <= allowed
    assert np.max(np.abs(last.angle - first.angle).sel(link=["AB", "platform", "DC", "EF"])) <= allowed
