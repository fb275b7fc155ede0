"""Plans of solvers on disk: what is taken has the same bits, and what is not to be trusted is not taken."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.kinematics.machine_code import frame_entries
from centrode.kinematics.machine_code.frame_plan import DirectPlan
from centrode.numerics.machine_code import PRESENT, cache
from centrode.sweeps import solver as solvers
from centrode.sweeps.solver import MotionFrame, Solver

pytestmark = pytest.mark.skipif(not PRESENT, reason="llvmlite is not installed")
FREE = {
    "crank-rocker": ["links.AB.length", "links.DB.length"],
    "six-bar-press": ["links.AB.points.B.x", "frame.points.C.x", "guides.H.direction"],
    "spherical-four-bar": ["links.AB.length", "frame.points.D.longitude"],
    "geared-five-bar": ["links.AB.length"],
    "two-link-arm": ["links.OA.length"],
    "slider-between-cranks-locked": ["links.OA.length"],
    "kite": ["links.AB.length"],
    "planetary-hypocycloid": ["rolling.planet.radius"],
}


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of the test's own."""
    folder = tmp_path / "kernels"
    monkeypatch.setenv(cache.FOLDER, str(folder))
    return folder


@pytest.fixture
def traced(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the mechanisms that are traced."""
    titles: list[str] = []
    trace = solvers.trace_motion

    def noted(ready, *others, **options):  # type: ignore[no-untyped-def]
        titles.append(ready.mechanism.title)
        return trace(ready, *others, **options)

    monkeypatch.setattr(solvers, "trace_motion", noted)
    return titles


def made(name: str = "crank-rocker") -> Solver:
    return ct.solver(name, FREE[name], 73)


def entry_of(solver: Solver) -> Path:
    name = frame_entries.entry_name(solver._free)
    place = cache.folder()
    assert name is not None
    assert place is not None
    return place / f"{name}{cache.SUFFIX}"


def assert_same(one: MotionFrame, other: MotionFrame) -> None:
    assert one.is_clear == other.is_clear
    np.testing.assert_array_equal(one.status, other.status)
    assert set(one.arrays) == set(other.arrays)
    for name, array in one.arrays.items():
        # as bytes: signs of zeros and of NaN too
        assert array.tobytes() == other.arrays[name].tobytes(), name


@pytest.mark.parametrize("name", FREE)
def test_a_plan_from_disk_gives_the_same_bits(name: str, traced: list[str]) -> None:
    first = made(name)
    is_kept = isinstance(first._plan, DirectPlan)
    again = made(name)
    assert len(traced) == (1 if is_kept else 2)
    for k in range(4):
        values = [x * (1.0 + 0.003 * k) for x in first.own]
        assert_same(first.move(values).copy(), again.move(values).copy())


@pytest.mark.parametrize("name", ["crank-rocker", "six-bar-press", "spherical-four-bar", "two-link-arm"])
def test_clear_mechanisms_are_kept(name: str) -> None:
    assert entry_of(made(name)).exists()


def test_another_process_neither_traces_nor_compiles() -> None:
    program = """
import numpy as np
import centrode as ct
from centrode.numerics.machine_code import kernels
from centrode.sweeps import solver as solvers
def refused(*given, **options):
    raise AssertionError("not from disk")
if {refuses}:
    solvers.trace_motion = kernels.object_code = kernels.function_text = refused
frame = ct.solver("six-bar-press", {free}, 73).move([2.0, 3.1, 0.01])
print(*(array.tobytes().hex() for array in frame.arrays.values()))
"""
    told = [
        subprocess.run(
            [sys.executable, "-c", program.format(refuses=refuses, free=FREE["six-bar-press"])],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for refuses in (False, True)
    ]
    assert told[0] == told[1]


def with_head(entry: Path, change: Callable[[dict], None]) -> None:  # type: ignore[type-arg]
    """Change what an entry says of its code, checksum and all: as another version of the package might have it."""
    content = entry.read_bytes()
    line, _end, code = content[len(cache.MARK) + 32 :].partition(b"\n")
    head = json.loads(line)
    change(head)
    payload = json.dumps(head).encode() + b"\n" + code
    entry.write_bytes(cache.MARK + cache._digest(entry.stem, payload) + payload)


@pytest.mark.parametrize(
    "change",
    [
        lambda head: head.pop("winders"),
        lambda head: head["quantities"].append(["more", 1000, [3]]),
        lambda head: head["scans"][2].update(outputs=2),
        lambda head: head["scans"][0].update(parameters=["no such variable"]),
        lambda head: head["scans"].pop(),
        lambda head: head.update(winders=[["no operation", 0]]),
        lambda head: head.update(bytes=[1, 2]),
        lambda head: head.update(quantities=3),
    ],
)
def test_an_entry_that_says_something_else_is_ignored(
    change: Callable[[dict], None], traced: list[str]
) -> None:  # type: ignore[type-arg]
    first = made()
    with_head(entry_of(first), change)
    again = made()
    assert len(traced) == 2
    assert_same(first.move(first.own), again.move(first.own))
    # and the right one is there again
    made()
    assert len(traced) == 2


@pytest.mark.parametrize(
    "spoil",
    [
        lambda content: b"",
        lambda content: content[:-1],
        lambda content: content[:200] + bytes([content[200] ^ 1]) + content[201:],
        lambda content: b"something else",
    ],
)
def test_a_damaged_entry_is_ignored(spoil: Callable[[bytes], bytes], traced: list[str]) -> None:
    first = made()
    entry = entry_of(first)
    entry.write_bytes(spoil(entry.read_bytes()))
    again = made()
    assert len(traced) == 2
    assert_same(first.move(first.own), again.move(first.own))


def test_an_entry_of_another_plan_is_not_taken(traced: list[str]) -> None:
    first, other = made(), made("six-bar-press")
    entry_of(first).write_bytes(entry_of(other).read_bytes())
    made()
    assert len(traced) == 3


@pytest.mark.skipif(sys.platform == "win32", reason="rights are lists there")
def test_an_entry_that_others_may_write_is_not_taken(traced: list[str]) -> None:
    entry = entry_of(made())
    entry.chmod(0o666)
    made()
    assert len(traced) == 2


@pytest.mark.parametrize("what", ["sources_digest", "code_circumstances", "__version__"])
def test_what_another_package_or_library_kept_is_not_taken(
    what: str, traced: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    made()
    others = {"sources_digest": lambda: "0", "code_circumstances": lambda: ("other",), "__version__": "0"}
    monkeypatch.setattr(frame_entries, what, others[what])
    made()
    assert len(traced) == 2


def test_without_sources_nothing_is_kept(monkeypatch: pytest.MonkeyPatch, traced: list[str]) -> None:
    monkeypatch.setattr(frame_entries, "sources_digest", lambda: None)
    made()
    made()
    assert len(traced) == 2


def test_the_digest_is_that_of_the_sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    take = frame_entries.sources_digest.__wrapped__
    monkeypatch.setattr(frame_entries, "PACKAGE", tmp_path)
    assert take() is None
    source = tmp_path / "numerics" / "jets.py"
    source.parent.mkdir()
    digests = []
    for text in ("a = 1", "a = 2"):
        source.write_text(text)
        digests.append(take())
    source.rename(source.with_name("other.py"))
    digests.append(take())
    assert len(set(digests)) == 3


def test_descriptions_paths_and_samples_have_entries_of_their_own() -> None:
    plain = ct.example("crank-rocker")
    # one unit in the last place of a number that is not free: it stands in the code
    close = ct.with_value(plain, "links.OA.length", np.nextafter(ct.value_at(plain, "links.OA.length"), 9.0))
    solvers_of = [
        ct.solver(plain, ["links.AB.length"], 73),
        ct.solver(close, ["links.AB.length"], 73),
        ct.solver(plain, ["links.DB.length"], 73),
        ct.solver(plain, ["links.AB.length"], 74),
    ]
    assert len({entry_of(x) for x in solvers_of}) == 4


def test_threads_make_and_take_the_same_plan() -> None:
    def moved(_k: int) -> MotionFrame:
        solver = made("six-bar-press")
        return solver.move(solver.own).copy()

    with ThreadPoolExecutor(4) as pool:
        frames = list(pool.map(moved, range(8)))
    for frame in frames[1:]:
        assert_same(frames[0], frame)


def test_nothing_is_kept_without_a_folder(monkeypatch: pytest.MonkeyPatch, traced: list[str]) -> None:
    monkeypatch.setenv(cache.FOLDER, "")
    made()
    made()
    assert len(traced) == 2
