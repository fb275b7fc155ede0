"""Sweeps on a cluster of processes of this machine: the same bytes whoever computes, nothing lost or doubled."""

from __future__ import annotations

import json
import logging
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
from tools.campaigns.clusters.cases import contents
from tools.campaigns.clusters.processes import SCHEDULER

import centrode as ct
from centrode.assignments.tables import Variant
from centrode.cli.main import main
from centrode.errors import CentrodeError
from centrode.model.files import mechanism_text
from centrode.numerics.machine_code.targets import baseline
from centrode.render.table_files import TableSpelling
from centrode.report.variants.files import VariantReport, row_of_report_text
from centrode.report.variants.folders import VariantTask, task_of_text, task_text
from centrode.sweeps import clusters, designs
from centrode.sweeps.cluster_blocks import compute_block
from centrode.sweeps.clusters import answer, libraries, open_cluster
from samples import few

pytest.importorskip("zarr", reason="stores need the extra sweeps")
dask = pytest.importorskip("dask", reason="clusters need the extra cluster")
distributed = pytest.importorskip("distributed", reason="clusters need the extra cluster")

# `distributed` leaves sockets of processes that ended to the collector
pytestmark = pytest.mark.filterwarnings(
    "ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)

VARY = {"links.AB.length": ("3.2 m", "3.8 m", 15), "frame.points.D.x": [3.9, 4.0, 4.1]}
OUTPUTS = ["position.B", "angle"]


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(designs, "BLOCK_BYTES", 4_000)  # three mechanisms


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Two workers, which end with the tests."""
    with open_cluster(2) as opened:
        opened.client.wait_for_workers(2)
        yield opened.client


def swept(store: Path | str | None, **more: Any) -> xr.Dataset:
    asked: dict[str, Any] = {"outputs": OUTPUTS, "samples": 19, "vary": ct.grid(VARY), **more}
    return ct.sweep(ct.example("crank-rocker"), **asked, store=store)


needs_x86 = pytest.mark.skipif(clusters.libraries()["llvmlite"] is None, reason="needs the extra fast")


DESIGNS: dict[str, Any] = {
    "listed": {"vary": {"links.AB.length": np.linspace(1.6, 3.8, 9)}},
    "formulas and a table": {
        "outputs": {"error": "mean((position_B_x - target)^2)"},
        "tables": {"target": [*np.linspace(0.1, 0.3, 18), np.nan]},
        "start": "10 deg",
        "stop": np.float64(3.0),
        "reduce": None,
    },
    "drawn": {"vary": ct.sample({"links.AB.length": ("3.2 m", "3.8 m")}, 11), "reduce": "mean"},
    "drawn block by block": {"vary": ct.sample({"links.AB.length": ("3.2 m", "3.8 m")}, 11, "sobol", 3)},
}


@pytest.mark.parametrize("kind", DESIGNS)
def test_a_worker_has_the_plan_from_its_text(
    tmp_path: Path, cluster: Any, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    if kind == "drawn block by block":
        monkeypatch.setattr(designs, "DRAWN", 10)
    alone = swept(tmp_path / "0.zarr", **DESIGNS[kind])
    found = swept(tmp_path / "1.zarr", **DESIGNS[kind], cluster=cluster)
    xr.testing.assert_identical(found, alone)
    assert contents(tmp_path / "1.zarr") == contents(tmp_path / "0.zarr")


def test_a_worker_that_is_killed_costs_nothing(tmp_path: Path, cluster: Any) -> None:
    swept(tmp_path / "0.zarr")
    reports: list[int] = []

    def kill(done: int, of: int) -> None:
        reports.append(done)
        if len(reports) == 2:
            worker = next(iter(cluster.run(os.getpid).values()))
            os.kill(worker, signal.SIGKILL)

    found = swept(tmp_path / "1.zarr", cluster=cluster, progress=kill)
    assert found.attrs["mechanisms"] == 45
    assert reports == sorted(set(reports))
    assert reports[-1] == 45
    assert contents(tmp_path / "1.zarr") == contents(tmp_path / "0.zarr")


def test_an_interrupted_run_goes_on(tmp_path: Path, cluster: Any) -> None:
    def stop(done: int, of: int) -> None:
        if done > 10:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        swept(tmp_path / "1.zarr", cluster=cluster, progress=stop)
    assert 0 < len(list((tmp_path / "1.zarr").glob("progress/done/*/*.json"))) <= 15
    # a worker may still be at a block that was begun; the lock is free, and the bytes are the same
    found = swept(tmp_path / "1.zarr", cluster=cluster)
    assert found.attrs["mechanisms_found"] > 10
    assert found.attrs["mechanisms"] == 45
    swept(tmp_path / "0.zarr")
    assert contents(tmp_path / "1.zarr") == contents(tmp_path / "0.zarr")
    again = swept(tmp_path / "1.zarr", cluster=cluster)
    assert again.attrs["mechanisms_found"] == 45


def test_a_client_that_is_killed_leaves_a_store_that_goes_on(tmp_path: Path, cluster: Any) -> None:
    program = f"""
import os, signal, sys
import centrode as ct
from centrode.sweeps import designs
designs.BLOCK_BYTES = 4_000
def tell(done, of):
    if done > 5:
        os.kill(os.getpid(), signal.SIGKILL)
ct.sweep(ct.example("crank-rocker"), ct.grid({VARY!r}), {OUTPUTS!r}, 19, store=sys.argv[1], cluster=sys.argv[2],
         progress=tell)
"""
    arguments = [
        sys.executable,
        "-W",
        "ignore",
        "-c",
        program,
        str(tmp_path / "1.zarr"),
        cluster.scheduler.address,
    ]
    assert subprocess.run(arguments, check=False, stderr=subprocess.DEVNULL).returncode == -signal.SIGKILL
    found = swept(tmp_path / "1.zarr", cluster=cluster)
    assert found.attrs["mechanisms_found"] > 5
    swept(tmp_path / "0.zarr")
    assert contents(tmp_path / "1.zarr") == contents(tmp_path / "0.zarr")


def test_the_library_of_clusters_writes_nothing_of_its_own(cluster: Any) -> None:
    """Its client would print a traceback where a scheduler goes away: its loggers have levels of their own."""
    logger = logging.getLogger("distributed.client")
    before = logger.level
    with clusters.open_cluster(cluster.scheduler.address):
        assert not logger.isEnabledFor(logging.ERROR)
    assert logger.level == before


def test_a_scheduler_that_goes_away_or_was_never_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(clusters, "CONNECTING", 3.0)
    arguments = [sys.executable, "-W", "ignore", "-c", SCHEDULER]
    with subprocess.Popen(
        arguments, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, encoding="utf-8"
    ) as scheduler:
        assert scheduler.stdout is not None
        address = scheduler.stdout.readline().strip()
        with pytest.raises(ct.InputError, match=r"the scheduler went away; finished results are kept"):
            swept(tmp_path / "1.zarr", cluster=address, progress=lambda done, of: scheduler.kill())
    with pytest.raises(
        ct.InputError, match=rf"{address}: no scheduler answers there: .*; look at the address, or start one"
    ):
        swept(tmp_path / "1.zarr", cluster=address)
    study = tmp_path / "study.toml"
    study.write_text('mechanism = "crank-rocker"\noutputs = "angle"\n[vary]\nlinks.AB.length = [3.4, 3.5]\n')
    store = str(tmp_path / "2.zarr")
    assert main(["sweep", str(study), "--out", store, "--scheduler", address]) == 2
    assert "no scheduler answers there" in capsys.readouterr().err
    # nothing is lost: one process goes on
    assert swept(tmp_path / "1.zarr").attrs["mechanisms"] == 45


def test_a_worker_with_other_versions_is_refused_by_both_names() -> None:
    wanted = {**libraries(), "centrode": "0.0.9", "NumPy": "2.9.9"}
    told = json.loads(answer(compute_block, wanted, "{}"))
    assert told["refused"] == {"centrode": ct.__version__, "NumPy": np.__version__}
    with pytest.raises(ct.InputError) as refused:
        raise clusters._refusal(told["worker"], told["refused"], wanted)
    assert f"centrode {ct.__version__}, 0.0.9 is needed" in str(refused.value)
    assert f"NumPy {np.__version__}, 2.9.9 is needed; install the same versions on all workers" in str(
        refused.value
    )


def test_versions_are_looked_at_on_the_worker(
    tmp_path: Path, cluster: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = {**libraries(), "centrode": "0.0.9"}
    monkeypatch.setattr("centrode.sweeps.sweep.wanted_libraries", lambda **_more: other)
    monkeypatch.setattr("centrode.sweeps.cluster_blocks.libraries", lambda: other)
    with pytest.raises(ct.InputError, match=rf"worker .*: centrode {ct.__version__}, 0\.0\.9 is needed"):
        swept(tmp_path / "1.zarr", cluster=cluster)
    # the store that the other version began is refused to this one, by both names
    monkeypatch.undo()
    monkeypatch.setattr(designs, "BLOCK_BYTES", 4_000)
    with pytest.raises(
        ct.InputError, match=rf"begun with centrode 0\.0\.9; here is centrode {ct.__version__}"
    ):
        swept(tmp_path / "1.zarr", cluster=cluster)
    with pytest.raises(ct.InputError, match=r"begun with centrode 0\.0\.9"):
        swept(tmp_path / "1.zarr")


def test_other_kernels_of_numpy_are_told_with_what_makes_them_the_same() -> None:
    with pytest.raises(ct.InputError, match=r'NPY_DISABLE_CPU_FEATURES="X86_V4" for all workers'):
        raise clusters._refusal(
            "n1", {clusters.NUMPY_KERNELS: "X86_V3"}, {clusters.NUMPY_KERNELS: "X86_V3 X86_V4"}
        )


def test_a_store_that_workers_do_not_reach(tmp_path: Path, cluster: Any) -> None:
    store = tmp_path / "1.zarr"

    def take_away(done: int, of: int) -> None:
        if not done:
            (store / "progress" / "work.json").unlink()

    # a path of this machine is not there on another one
    with pytest.raises(
        ct.InputError, match="the store of the sweep is not there; name a store that all workers reach"
    ):
        swept(store, cluster=cluster, progress=take_away)


@needs_x86
def test_a_processor_that_a_worker_lacks_is_refused_by_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("centrode.sweeps.sweep_plans.lacking_features", lambda name: ("avx9",))
    with pytest.raises(
        ct.InputError, match=r"cannot run code for x86-64-v4: it has no avx9; name another processor"
    ):
        swept(tmp_path / "1.zarr", target="x86-64-v4")


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "no workers": ({"cluster": 0}, "0 is not a valid number of workers; give a whole number from 1 to 256"),
    "a truth value": (
        {"cluster": True},
        "is no cluster; give a number of workers, an address such as tcp://",
    ),
    "another address": ({"cluster": "http://x:1"}, 'cluster: "http://x:1" is no cluster'),
    "a list": ({"cluster": [1]}, "is no cluster"),
    "threads": ({"cluster": 1, "threads": 2}, "threads: workers of a cluster have one thread each"),
    "a processor": ({"target": "x86-64-v9"}, 'target: unknown processor "x86-64-v9"'),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_what_is_no_cluster(tmp_path: Path, kind: str) -> None:
    asked, message = REFUSED[kind]
    with pytest.raises(ct.InputError) as refused:
        swept(tmp_path / "1.zarr", **asked)
    assert message in str(refused.value)
    assert not (tmp_path / "1.zarr").exists()


def test_a_cluster_needs_a_store_and_its_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ct.InputError, match="workers write to a store, which is missing"):
        swept(None, cluster=1)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(ct.InputError, match=r'needs distributed, .*pip install -e "\.\[cluster\]"'):
        swept(tmp_path / "1.zarr", cluster=1)
    with pytest.raises(
        ct.InputError, match=r'needs fsspec and zarr, .*pip install -e "\.\[cluster,sweeps\]"'
    ):
        swept("s3://bucket/1.zarr")
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_owns_the_store_keeps_others_out(tmp_path: Path, cluster: Any) -> None:
    refused: list[str] = []

    def intrude(done: int, of: int) -> None:
        if not refused:
            with pytest.raises(CentrodeError) as busy:
                swept(tmp_path / "1.zarr", cluster=cluster)
            refused.append(str(busy.value))

    swept(tmp_path / "1.zarr", cluster=cluster, progress=intrude)
    assert "another run is writing into it; wait until it ends, or give another path" in refused[0]


STUDY = """\
mechanism = "crank-rocker"
outputs = "angle"
samples = 19
[grid]
links.AB.length = { from = "3.2 m", to = "3.8 m", count = 60 }
"""

INTERRUPTED = """
import os, signal, sys
from centrode.cli import sweep
from centrode.cli.main import main
from centrode.cli.progress import Progress
from centrode.sweeps import designs
if __name__ == "__main__":
    # a process that a shell runs in the background begins with Ctrl-C ignored
    signal.signal(signal.SIGINT, signal.default_int_handler)
    designs.BLOCK_BYTES, designs.BLOCK_SECONDS = 4_000, 1e-9  # a mechanism a block, however fast they are
    class Interrupting(Progress):
        def say(self, what, done=0, of=0):
            # as a terminal does: to all processes of the group
            if 0 < done < of:
                os.killpg(os.getpgid(0), signal.SIGINT)
    sweep.Progress = Interrupting
    sys.exit(main(["sweep", "study.toml", "--workers", "1"]))
"""


def test_ctrl_c_ends_the_command_and_the_store_goes_on(
    tmp_path: Path, cluster: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(STUDY, encoding="utf-8")
    # a file, as workers read the program again
    Path("interrupted.py").write_text(INTERRUPTED, encoding="utf-8")
    ended = subprocess.run(
        [sys.executable, "interrupted.py"], start_new_session=True, capture_output=True, encoding="utf-8", check=False
    )  # fmt: skip
    assert ended.returncode == 130
    assert (
        "finished results stay in study.zarr; the same command resumes from there\ninterrupted\n"
        in ended.stderr
    )
    # workers end without a word of their own
    assert "Traceback" not in ended.stderr
    assert main(["sweep", "study.toml", "--scheduler", cluster.scheduler.address]) == 0
    captured = capsys.readouterr()
    assert "mechanisms were computed in an earlier run" in captured.err
    assert "wrote study.zarr" in captured.out
    assert main(["sweep", "study.toml", "--workers", "2", "--scheduler", "tcp://x:1"]) == 2
    assert "give one of the two options" in capsys.readouterr().err
    Path("reduced.toml").write_text('reduce = "mean"\n' + STUDY, encoding="utf-8")
    assert main(["sweep", "reduced.toml", "--workers", "1", "--out", "x.csv"]) == 2
    assert "workers write to a store" in capsys.readouterr().err


@pytest.fixture
def certificates(tmp_path: Path) -> dict[str, str]:
    """Files of an authority, a certificate and a key made for the test; by the names that settings give them."""
    pytest.importorskip("cryptography", reason="certificates need cryptography")
    made = distributed.Security.temporary()
    content = {"ca-file": made.tls_ca_file, "cert": made.tls_client_cert, "key": made.tls_client_key}
    for name, text in content.items():
        (tmp_path / f"{name}.pem").write_text(text, encoding="ascii")
    return {name: str(tmp_path / f"{name}.pem") for name in content}


def test_a_scheduler_behind_certificates(
    tmp_path: Path,
    certificates: dict[str, str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(STUDY.replace("60", "7"), encoding="utf-8")
    authority, certificate, key = certificates.values()
    security = distributed.Security(
        tls_ca_file=authority, require_encryption=True,
        **{f"tls_{role}_{part}": file for role in ("client", "scheduler", "worker")
           for part, file in (("cert", certificate), ("key", key))},
    )  # fmt: skip
    # a worker in this process: what is tried are the connections
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, protocol="tls://", security=security,
        dashboard_address="127.0.0.1:0", host="127.0.0.1",
    ) as machines:  # fmt: skip
        address = machines.scheduler_address
        assert address.startswith("tls://")
        command = ["sweep", "study.toml", "--out", "1.zarr", "--scheduler", address]
        assert main(command) == 2
        assert "an address of this kind needs certificates; name their files" in capsys.readouterr().err
        settings = {
            "distributed.comm.tls.ca-file": authority,
            "distributed.comm.tls.client.cert": certificate,
            "distributed.comm.tls.client.key": str(tmp_path / "study.toml"),
        }
        with dask.config.set(settings):
            assert main(command) == 2
            assert "the certificates cannot be read" in capsys.readouterr().err
        with dask.config.set({**settings, "distributed.comm.tls.client.key": key}):
            assert main(command) == 0
            found = swept("2.zarr", cluster=address)
        with distributed.Client(address, security=security, set_as_default=False) as client:
            again = swept("2.zarr", cluster=client)
    assert found.attrs["mechanisms"] == again.attrs["mechanisms_found"] == 45
    swept("0.zarr")
    assert contents(tmp_path / "2.zarr") == contents(tmp_path / "0.zarr")


def test_studies_of_simulations_have_the_same_numbers(cluster: Any) -> None:
    asked: dict[str, Any] = {
        "vary": {"links.OA.length": [0.347, 20.0, 0.35]},
        "compute": "reactions",
        "samples": 7,
    }
    mechanism = ct.example("six-bar-press")
    alone, reports = ct.sweep(mechanism, **asked), list[int]()
    found = ct.sweep(mechanism, **asked, cluster=cluster, progress=lambda done, of: reports.append(done))
    xr.testing.assert_identical(found, alone)
    assert found["computed"].values.tolist() == [1, 0, 1]
    assert reports == [1, 2, 3]


def test_variants_have_the_same_files(tmp_path: Path, cluster: Any) -> None:
    rows = [{"variant": "long", "links.AB.length": 3.6}, {"variant": "none", "links.AB.length": 100.0}]
    reports: list[int] = []
    for name, more in (
        ("alone", {}),
        ("cluster", {"cluster": cluster, "progress": lambda n, of: reports.append(n)}),
    ):
        found = ct.write_variants(ct.example("crank-rocker"), rows, tmp_path / name, **more)
        assert [row.variant for row in found.rows] == ["long", "none"]
    files = {
        file.relative_to(tmp_path / "alone") for file in (tmp_path / "alone").rglob("*") if file.is_file()
    }
    assert any(file.name == "motion.csv" for file in files)
    for file in files:
        assert (tmp_path / "cluster" / file).read_bytes() == (tmp_path / "alone" / file).read_bytes(), file
    assert reports == [0, 1, 2]


def test_a_report_of_a_variant_is_told_as_text(tmp_path: Path) -> None:
    more = VariantReport(("html", "pdf"), "uk")
    variant = Variant("a", {"links.AB.length": 0.1 + 0.2})
    topology = mechanism_text(ct.example("crank-rocker"))
    task = VariantTask(
        topology, variant, tmp_path / "variant-a", True, more, TableSpelling(comma=True), "reactions"
    )
    text = task_text(task)
    assert task_of_text(text, VariantReport(**{**more.told, "formats": tuple(more.told["formats"])})) == task
    assert more.work is row_of_report_text
    with pytest.raises(
        ct.InputError, match="the folder of the results is not there; name a folder that all workers"
    ):
        row_of_report_text(text.replace(str(tmp_path), str(tmp_path / "elsewhere")))


@needs_x86
def test_any_number_of_workers_gives_the_bytes_of_one_process(tmp_path: Path, cluster: Any) -> None:
    asked: dict[str, Any] = {
        "executor": "machine code",
        "outputs": "angle",
        "reduce": "range",
        "target": baseline(),
    }
    alone = swept(tmp_path / "0.zarr", **asked)
    for count in few((1,), (2, 3, 1)):  # two workers have computed what stands above
        cluster.cluster.scale(count)
        cluster.sync(cluster.cluster._correct_state)
        cluster.wait_for_workers(count)
        found = swept(tmp_path / f"{count}.zarr", **asked, cluster=cluster)
        assert contents(tmp_path / f"{count}.zarr") == contents(tmp_path / "0.zarr")
        assert found.attrs == alone.attrs
    told = json.loads((tmp_path / "1.zarr/progress/work.json").read_text(encoding="utf-8"))
    assert told["target"] == baseline()
    assert told["libraries"]["centrode"] == ct.__version__
