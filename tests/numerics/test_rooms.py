"""Memory of results: pages that are there are handed out again, and never while anything refers to them."""

from __future__ import annotations

import numpy as np
import pytest

from centrode.numerics import rooms
from centrode.numerics.rooms import fresh_room

NUMBERS = 10_000


@pytest.fixture(autouse=True)
def _of_any_size(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rooms, "BLANK", 0)
    monkeypatch.setattr(rooms, "_given_back", rooms._GivenBack())


def test_memory_is_handed_out_again_when_nothing_refers_to_it() -> None:
    first, blank = fresh_room(NUMBERS)
    assert blank
    assert not first.any()
    first[:] = 7.0
    place, part = first.ctypes.data, first.reshape(10, -1)[3:5].T
    del first
    # a view refers to it still
    second, blank = fresh_room(NUMBERS)
    assert blank
    assert not np.shares_memory(part, second)
    second[:] = 3.0
    assert (part == 7.0).all()
    del part
    third, blank = fresh_room(NUMBERS - 100)
    assert not blank
    assert third.ctypes.data == place
    assert len(third) == NUMBERS - 100


@pytest.mark.parametrize("numbers", [NUMBERS + 1000, NUMBERS // 3])
def test_other_sizes_get_memory_of_their_own(numbers: int) -> None:
    first, _blank = fresh_room(NUMBERS)
    first[:] = 7.0
    del first
    other, blank = fresh_room(numbers)
    assert blank
    assert not other.any()


def test_more_than_is_kept_is_fresh(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rooms, "KEPT", 8 * NUMBERS - 1)
    for _again in range(2):
        room, blank = fresh_room(NUMBERS)
        assert blank
        assert not room.any()
        room[:] = 7.0
        del room
