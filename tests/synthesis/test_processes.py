"""A search on several processes has the answers of one, to the last bit, and is stopped with what there is."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.synthesis import path_synthesis, start_candidates, synthesise
from centrode.synthesis.processes import HERE, Processes, processes

PATH = [
    [np.cos(t), 0.5 * np.sin(t) + 0.1 * np.cos(2 * t)] for t in np.linspace(0, 2 * np.pi, 12, endpoint=False)
]
WANTED: dict[str, Any] = {
    "topology": "crank-rocker", "kind": "path", "targets": PATH, "closed": True, "answers": 3,
    "constraints": {"crank": "OA", "length_ratio": 6, "transmission": "30 deg"},
}  # fmt: skip


@pytest.fixture(autouse=True)
def few_candidates(monkeypatch: pytest.MonkeyPatch) -> None:
    few = functools.partial(start_candidates.closed_candidates, count=100)
    monkeypatch.setattr(path_synthesis, "closed_candidates", few)


@pytest.fixture(scope="module")
def two() -> Iterator[Processes]:
    """Two processes that have imported what they need: the tests share them."""
    with processes(2) as started:
        yield started


@pytest.fixture
def shared(two: Processes, monkeypatch: pytest.MonkeyPatch) -> None:
    """A search for which two processes are asked has those of the tests."""
    here = {1: HERE, 2: two}
    monkeypatch.setattr(synthesise, "processes", lambda jobs: nullcontext(here[jobs]))


@pytest.mark.usefixtures("shared")
def test_two_processes_answer_as_one() -> None:
    shares: list[float] = []
    alone = ct.synthesise({"synthesis": WANTED})
    several = ct.synthesise({"synthesis": WANTED}, progress=shares.append, jobs=2)
    assert len(alone.answers) == len(several.answers) > 0
    for one, other in zip(alone.answers, several.answers, strict=True):
        assert one.mechanism == other.mechanism
        assert one.error == other.error and (one.drive == other.drive).all()
    assert shares == sorted(shares) and shares[-1] == 1.0


@pytest.mark.usefixtures("shared")
def test_a_search_on_several_processes_is_stopped() -> None:
    shares: list[float] = []
    found = ct.synthesise(
        {"synthesis": {**WANTED, "constraints": {"order": False}}},
        progress=shares.append,
        stop=lambda: bool(shares),
        jobs=2,
    )
    assert not found.complete and found.answers


def test_shares_that_are_left_out(two: Processes) -> None:
    """Once it is stopped, what has not begun is left out, here as in other processes."""
    assert dict(HERE.compute(doubled, [1, 2], lambda: False)) == {0: 2, 1: 4}
    assert dict(HERE.compute(doubled, [1, 2], lambda: True)) == {}
    assert dict(two.compute(doubled, [1, 2, 3], lambda: False)) == {0: 2, 1: 4, 2: 6}
    assert dict(two.compute(doubled, [1, 2, 3], lambda: True)) == {}


def doubled(number: int, stop: object = None) -> int:
    return 2 * number


@pytest.mark.parametrize("jobs", [0, 65, True, 1.5])
def test_numbers_of_processes(jobs: Any) -> None:
    with pytest.raises(ct.InputError, match="processes are given"):
        ct.synthesise({"synthesis": WANTED}, jobs=jobs)
