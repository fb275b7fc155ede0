"""Results in a folder: a run that is cut short goes on, and nothing is lost, doubled or mixed."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.files.locks import hold_lock
from centrode.sweeps import designs
from samples import few

pytest.importorskip("zarr", reason="stores need the extra sweeps")

Process = Callable[..., subprocess.CompletedProcess[str]]
VARY = {"links.AB.length": ("3.2 m", "3.8 m", 15), "frame.points.D.x": [3.9, 4.0, 4.1]}
OUTPUTS = ["position.B", "angle"]


def crank_rocker() -> ct.Mechanism:
    return ct.example("crank-rocker")


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(designs, "BLOCK_POSITIONS", 6_000)


def markers(store: Path) -> dict[str, int]:
    """Blocks marked as done, with the time of their marks."""
    return {file.name: file.stat().st_mtime_ns for file in store.glob("progress/done/*/*.json")}


def same(one: Path, other: Path) -> None:
    """Two stores hold the same bits."""
    with xr.open_zarr(one) as first, xr.open_zarr(other) as second:
        assert set(first.variables) == set(second.variables)
        for name in first.variables:
            assert first[name].dims == second[name].dims
            assert first[name].to_numpy().tobytes() == second[name].to_numpy().tobytes() or (
                first[name].dtype.kind not in "fi"
                and (first[name].to_numpy() == second[name].to_numpy()).all()
            )
        assert first.attrs == second.attrs


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("reduce", [None, "range", {"swing": "range(angle_DB)"}])
def test_a_store_holds_what_memory_holds(tmp_path: Path, reduce: Any) -> None:
    outputs = None if isinstance(reduce, dict) else OUTPUTS
    stored = ct.sweep(crank_rocker(), ct.grid(VARY), outputs, 19, reduce=reduce, store=tmp_path / "r.zarr")
    memory = ct.sweep(crank_rocker(), ct.grid(VARY), outputs, 19, reduce=reduce)
    assert len(markers(tmp_path / "r.zarr")) > 3
    xr.testing.assert_equal(stored, memory)
    assert {**stored.attrs, "mechanisms_found": 0} == {**memory.attrs, "mechanisms_found": 0}
    assert list(stored.data_vars) == list(memory.data_vars)
    for name in memory.data_vars:
        assert stored[name].attrs == memory[name].attrs
    with xr.open_zarr(tmp_path / "r.zarr") as plain:
        xr.testing.assert_equal(plain, memory)
        assert plain["samples_ok"].dtype == np.int32


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("shape", [(50,), (3, 17), (17, 3), (2, 3, 5), (1, 40), (40, 1)])
def test_blocks_of_every_shape(tmp_path: Path, shape: tuple[int, ...]) -> None:
    paths = ["links.AB.length", "frame.points.D.x", "links.DB.length"]
    own = {path: ct.value_at(crank_rocker(), path) for path in paths}
    ranges = {p: own[p] * np.linspace(0.99, 1.01, n) for p, n in zip(paths, shape, strict=False)}
    design = ct.grid(ranges)
    stored = ct.sweep(crank_rocker(), design, "angle.DB", 5, store=tmp_path / "r.zarr")
    xr.testing.assert_equal(stored, ct.sweep(crank_rocker(), design, "angle.DB", 5))


def test_a_killed_run_goes_on(tmp_path: Path, study: Path, process: Process) -> None:
    """Killed where it touches the store, at places drawn at random, in its making, its blocks, its markers."""
    whole = process(study, tmp_path / "whole.zarr")
    assert whole.returncode == 0, whole.stderr
    touches = int(whole.stdout.split()[-1])
    random = np.random.default_rng(11)
    store = tmp_path / "killed.zarr"
    before: dict[str, int] = {}
    early, late = random.integers(2, 30, 2), random.integers(touches // 8, touches // 4, 3)
    for last in few((early[0], late[0]), (early[0], *late, early[1])):
        killed = process(study, store, int(last))
        assert killed.returncode == -signal.SIGKILL, "it was never at work so long"
        now = markers(store)
        assert {name: now.get(name) for name in before} == before, "what was done was done again, or lost"
        before = now
    assert before, "it was never killed after a block"
    ended = process(study, store)
    assert ended.returncode == 0, ended.stderr
    assert "were computed in an earlier run" in ended.stderr
    same(store, tmp_path / "whole.zarr")
    after = markers(store)
    assert {name: after[name] for name in before} == before
    assert set(after) == set(markers(tmp_path / "whole.zarr"))
    first, second = (text.partition("\nwrote ")[0] for text in (whole.stdout, ended.stdout))
    assert first == second, "the summary counts every mechanism once"


@pytest.mark.usefixtures("small_blocks")
def test_a_block_without_its_marker_is_computed_again(tmp_path: Path) -> None:
    store = tmp_path / "r.zarr"
    whole = ct.sweep(crank_rocker(), ct.grid(VARY), OUTPUTS, 19, store=store).load()
    marks = sorted(store.glob("progress/done/*/*.json"))
    marks[0].unlink()
    marks[1].write_text("{", encoding="utf-8")
    calls: list[int] = []
    again = ct.sweep(
        crank_rocker(), ct.grid(VARY), OUTPUTS, 19, store=store, progress=lambda done, of: calls.append(done)
    )
    assert len(calls) == 2
    assert calls[-1] == 45
    xr.testing.assert_equal(again, whole)
    assert again.attrs["mechanisms_found"] < 45
    assert again.attrs["mechanisms"] == 45


@pytest.mark.usefixtures("small_blocks")
def test_an_interrupted_run_goes_on(tmp_path: Path) -> None:
    def stop(done: int, of: int) -> None:
        if done > of / 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ct.sweep(crank_rocker(), ct.grid(VARY), OUTPUTS, 19, store=tmp_path / "r.zarr", progress=stop)
    part = xr.open_zarr(tmp_path / "r.zarr")
    assert 0 < int((part["samples_ok"] >= 0).sum()) < 45
    ended = ct.sweep(crank_rocker(), ct.grid(VARY), OUTPUTS, 19, store=tmp_path / "r.zarr")
    xr.testing.assert_equal(ended, ct.sweep(crank_rocker(), ct.grid(VARY), OUTPUTS, 19))


@pytest.mark.usefixtures("small_blocks")
def test_blocks_of_another_size_go_on_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(done: int, of: int) -> None:
        if done > of / 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ct.sweep(crank_rocker(), ct.grid(VARY), OUTPUTS, 19, store=tmp_path / "r.zarr", progress=stop)
    monkeypatch.setattr(designs, "BLOCK_POSITIONS", 20_000)
    ended = ct.sweep(crank_rocker(), ct.grid(VARY), OUTPUTS, 19, store=tmp_path / "r.zarr")
    xr.testing.assert_equal(ended, ct.sweep(crank_rocker(), ct.grid(VARY), OUTPUTS, 19))


OTHERS: list[tuple[str, dict[str, Any]]] = [
    ("vary", {"vary": ct.grid({**VARY, "frame.points.D.x": [3.9, 4.0, 4.2]})}),
    ("vary", {"vary": ct.grid({"frame.points.D.x": [4.0]})}),
    ("samples", {"samples": 21}),
    ("samples", {"stop": 3.0}),
    ("outputs", {"outputs": ["angle", "position.B"]}),
    ("reduce", {"reduce": "mean"}),
    ("mechanism", {"mechanism": ct.with_value(ct.example("crank-rocker"), "links.DB.length", 3.01)}),
]


@pytest.mark.parametrize(("what", "change"), OTHERS)
def test_another_sweep_is_refused(tmp_path: Path, what: str, change: dict[str, Any]) -> None:
    asked: dict[str, Any] = {
        "mechanism": crank_rocker(),
        "vary": ct.grid(VARY),
        "outputs": OUTPUTS,
        "samples": 19,
    }
    store = tmp_path / "r.zarr"
    ct.sweep(**asked, store=store)
    before = {file: file.read_bytes() for file in store.rglob("*") if file.is_file()}
    with pytest.raises(ct.InputError, match=f"holds another sweep; what differs: .*{what}"):
        ct.sweep(**{**asked, **change}, store=store)
    assert {file: file.read_bytes() for file in store.rglob("*") if file.is_file()} == before


def test_a_store_of_another_version_is_refused(tmp_path: Path) -> None:
    store = tmp_path / "r.zarr"
    ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=store)
    file = store / "progress" / "study.json"
    told = json.loads(file.read_text(encoding="utf-8"))
    told["study"]["version"] = "0.0.0"
    file.write_text(json.dumps(told), encoding="utf-8")
    with pytest.raises(ct.InputError, match="what differs: version"):
        ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=store)
    file.write_text("{}", encoding="utf-8")
    with pytest.raises(ct.InputError, match="is damaged"):
        ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=store)


def test_folders_that_are_no_store(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("years of work")
    (tmp_path / "file").write_text("x")
    for name, message in (
        ("mine", "holds something else"),
        ("file", "is not a folder"),
        ("file/r.zarr", "cannot be written"),
    ):
        with pytest.raises(ct.InputError, match=message):
            ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=tmp_path / name)
    assert [file.name for file in (tmp_path / "mine").rglob("*")] == ["thesis.txt"]
    # a folder that looks begun, with something in it that is not ours, is not cleared away
    (tmp_path / "mine" / "progress").mkdir()
    (tmp_path / "mine" / "progress" / "lock").touch()
    with pytest.raises(ct.InputError, match="holds something else"):
        ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=tmp_path / "mine")
    assert (tmp_path / "mine" / "thesis.txt").read_text() == "years of work"
    (tmp_path / "empty").mkdir()
    ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=tmp_path / "empty")


def test_a_making_that_was_cut_short_is_made_again(tmp_path: Path) -> None:
    store = tmp_path / "r.zarr"
    (store / "progress").mkdir(parents=True)
    (store / "angle" / "c").mkdir(parents=True)
    for name in (
        "progress/lock",
        "zarr.0c5dc6be.partial",
        "zarr.json",
        "progress/zarr.json",
        "angle/zarr.json",
    ):
        (store / name).touch()
    found = ct.sweep(crank_rocker(), ct.grid(VARY), OUTPUTS, 19, store=store)
    xr.testing.assert_equal(found, ct.sweep(crank_rocker(), ct.grid(VARY), OUTPUTS, 19))
    assert not list(store.glob("*.partial"))


def test_two_runs_at_once_are_refused_and_a_dead_one_is_not_feared(tmp_path: Path) -> None:
    store = tmp_path / "r.zarr"
    (store / "progress").mkdir(parents=True)
    holder = subprocess.Popen(
        [
            sys.executable,
            "-c",
            "import sys, pathlib\n"
            "from centrode.files.locks import hold_lock\n"
            "with hold_lock(pathlib.Path(sys.argv[1]), ''):\n"
            "    print('held', flush=True)\n"
            "    sys.stdin.read()\n",
            str(store / "progress" / "lock"),
        ],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        encoding="utf-8",
    )
    with holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(ct.InputError, match="another run is writing into it"):
            ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=store)
        holder.kill()
    found = ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=store)
    assert found.attrs["mechanisms"] == 45
    with hold_lock(store / "progress" / "lock", ""), pytest.raises(ct.InputError, match="another run"):
        ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=store)


def test_without_zarr_the_extra_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(ct.InputError, match=r'pip install -e "\.\[sweeps\]"'):
        ct.sweep(crank_rocker(), ct.grid(VARY), "angle", 5, store=tmp_path / "r.zarr")
    assert list(tmp_path.iterdir()) == []
