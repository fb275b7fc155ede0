"""Sweeps on a cluster of processes of this machine: the same bits whoever computes, nothing lost or doubled."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.cli.main import main
from centrode.sweeps import designs
from centrode.sweeps.clusters import libraries, open_cluster

pytest.importorskip("zarr", reason="stores need the extra sweeps")
distributed = pytest.importorskip("distributed", reason="clusters need the extra cluster")

# `distributed` leaves sockets to the collector when workers are killed
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")

VARY = {"links.AB.length": ("3.2 m", "3.8 m", 15), "frame.points.D.x": [3.9, 4.0, 4.1]}
OUTPUTS = ["position.B", "angle"]


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(designs, "BLOCK_BYTES", 2_000)  # some mechanisms


@pytest.fixture(scope="module")
def workers() -> Iterator[Any]:
    """A client with two workers, which end with the tests."""
    with open_cluster(2) as cluster:
        cluster.client.wait_for_workers(2)
        yield cluster.client


def swept(store: Path | str | None, **more: Any) -> xr.Dataset:
    asked: dict[str, Any] = {"outputs": OUTPUTS, "samples": 19, "vary": ct.grid(VARY), **more}
    return ct.sweep(ct.example("crank-rocker"), **asked, store=store)


def contents(store: Path) -> dict[str, bytes]:
    """What a store holds, its lock apart."""
    return {
        file.relative_to(store).as_posix(): file.read_bytes()
        for file in sorted(store.rglob("*"))
        if file.is_file() and file.name != "lock"
    }


def test_one_two_and_three_workers_give_the_same_bits(tmp_path: Path, workers: Any) -> None:
    asked: dict[str, Any] = {"executor": "machine code", "reduce": "range", "outputs": "angle", "gradient": True}
    plain = swept(None, executor="machine code", reduce="range", outputs="angle", gradient=True, target="x86-64-v2")
    alone = swept(tmp_path / "0.zarr", **asked, target="x86-64-v2")
    xr.testing.assert_identical(alone.drop_attrs(), plain.drop_attrs())
    asked["target"] = "x86-64-v2"
    addresses = list(workers.scheduler_info()["workers"])
    found = swept(tmp_path / "2.zarr", **asked, cluster=workers)
    with distributed.get_task_stream(workers), workers.as_current():
        workers.retire_workers(addresses[:1], close_workers=False)
    assert found.attrs["mechanisms_found"] == 0
    xr.testing.assert_identical(found.drop_attrs(), plain.drop_attrs())
