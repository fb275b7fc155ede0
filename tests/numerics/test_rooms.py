"""Memory of results: pages that are there are handed out again, and never while anything refers to them."""

from __future__ import annotations

import os
import re
from pathlib import Path

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


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no forks")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_fork_writes_into_memory_of_its_own() -> None:
    """Results of a process are not those of its forks, whether they are kept or given back."""
    kept, _blank = fresh_room(NUMBERS)
    gone, _blank = fresh_room(2 * NUMBERS)
    kept[:] = 7.0
    del gone
    child = os.fork()
    if not child:
        kept[:] = 3.0
        os._exit(0 if (kept == 3.0).all() else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert (kept == 7.0).all()
    again, _blank = fresh_room(2 * NUMBERS)
    again[:] = 5.0
    other = os.fork()
    if not other:
        again[:] = 1.0
        os._exit(0)
    os.waitpid(other, 0)
    assert (again == 5.0).all()


@pytest.mark.skipif(not Path("/proc/self/smaps").exists(), reason="the system says nothing of its pages")
def test_pages_are_huge_where_the_system_has_any() -> None:
    """Memory of a sweep is as fast as NumPy's own: shared memory had small pages."""
    allowed = Path("/sys/kernel/mm/transparent_hugepage/enabled")
    if not allowed.exists() or "[never]" in allowed.read_text(encoding="utf-8"):
        pytest.skip("the system has no huge pages")
    room, _blank = fresh_room(2_000_000)
    room[:] = 1.0
    text = Path("/proc/self/smaps").read_text(encoding="utf-8")
    place = room.ctypes.data
    for block in re.split(r"\n(?=[0-9a-f]+-[0-9a-f]+ )", text):
        first, last = (int(x, 16) for x in block.split(maxsplit=1)[0].split("-"))
        if first <= place < last:
            assert block.split()[1] == "rw-p"
            return
    raise AssertionError("the memory is not among that of the process")
