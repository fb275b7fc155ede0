"""Sweeps into an object store: a server of its own on loopback, which fails now and then."""

from __future__ import annotations

import gc
import io
import json
import socket
import threading
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.cli.main import main
from centrode.sweeps import designs, storage
from centrode.sweeps.storage import ObjectStorage, storage_of

pytest.importorskip("zarr", reason="stores need the extra sweeps")
s3fs = pytest.importorskip("s3fs", reason="object stores need the extra cluster")
distributed = pytest.importorskip("distributed", reason="clusters need the extra cluster")
moto = pytest.importorskip("moto.server", reason="the server of the tests needs moto and flask")
serving = pytest.importorskip("werkzeug.serving")

pytestmark = pytest.mark.filterwarnings(
    "ignore::ResourceWarning", "ignore::DeprecationWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)

VARY = {"links.AB.length": ("3.2 m", "3.8 m", 7), "frame.points.D.x": [3.9, 4.0, 4.1]}
OUTPUTS = ["position.B", "angle"]
Application = Callable[[dict[str, Any], Callable[..., Any]], Iterable[bytes]]


class Failing:
    """The server of moto; of the requests that write or read objects every `each`-th fails, whole or after its work."""

    def __init__(self, served: Application) -> None:
        self.served = served
        self.each = 0
        self.refuses = False
        self.failed = 0
        self.asked = 0

    def __call__(self, environment: dict[str, Any], begin: Callable[..., Any]) -> Iterable[bytes]:
        writes = environment["REQUEST_METHOD"] == "PUT" and environment["PATH_INFO"].count("/") > 1
        if writes and self.refuses:
            return _answered(environment, begin, "403 Forbidden", b"<Error><Code>AccessDenied</Code></Error>")
        if self.each and environment["PATH_INFO"].count("/") > 1:
            self.asked += 1
            if self.asked % self.each == 0:
                self.failed += 1
                # every other failure comes after the work is done: the answer alone is lost
                if self.failed % 2 and writes:
                    b"".join(self.served(environment, lambda *_: io.BytesIO().write))
                    # its body is read: to wait for more of it would take until the client gives up
                    environment["CONTENT_LENGTH"] = "0"
                return _answered(environment, begin, "503 Slow Down", b"<Error><Code>SlowDown</Code></Error>")
        return self.served(environment, begin)


def _answered(
    environment: dict[str, Any], begin: Callable[..., Any], status: str, body: bytes
) -> Iterable[bytes]:
    environment["wsgi.input"].read(int(environment.get("CONTENT_LENGTH") or 0))
    # what may be left of the request does not come before the next one: each has a connection of its own then
    head = [("Content-Type", "application/xml"), ("Content-Length", str(len(body))), ("Connection", "close")]
    begin(status, head)
    return [body]


@pytest.fixture(scope="module")
def server() -> Iterator[Failing]:
    """The server, with a bucket; its address and rights stand in the environment, as workers have them."""
    served = Failing(moto.DomainDispatcherApplication(moto.create_backend_app))
    running = serving.make_server("127.0.0.1", 0, served, threaded=True)
    serving_thread = threading.Thread(target=running.serve_forever)
    serving_thread.start()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{running.server_port}")
        patch.setenv("AWS_ACCESS_KEY_ID", "of-a-test")
        patch.setenv("AWS_SECRET_ACCESS_KEY", "of-a-test")
        patch.setenv("AWS_DEFAULT_REGION", "us-east-1")
        patch.setenv("NO_PROXY", "127.0.0.1")
        s3fs.S3FileSystem.clear_instance_cache()
        s3fs.S3FileSystem().mkdir("sweeps")
        yield served
        s3fs.S3FileSystem.clear_instance_cache()
    running.shutdown()
    serving_thread.join()
    # sessions that nobody closes: their warnings belong to these tests
    gc.collect()


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(designs, "BLOCK_BYTES", 4_000)  # three mechanisms


def swept(store: Path | str | None, **more: Any) -> xr.Dataset:
    asked: dict[str, Any] = {"outputs": OUTPUTS, "samples": 19, "vary": ct.grid(VARY), **more}
    return ct.sweep(ct.example("crank-rocker"), **asked, store=store)


def folder_contents(folder: Path) -> dict[str, bytes]:
    return {
        file.relative_to(folder).as_posix(): file.read_bytes()
        for file in folder.rglob("*")
        if file.is_file() and file.name not in {"lock", "work.json"}
    }


def object_contents(url: str) -> dict[str, bytes]:
    files, root = s3fs.S3FileSystem(), url.removeprefix("s3://")
    files.invalidate_cache()
    found = {path.removeprefix(root + "/"): files.cat_file(path) for path in files.find(root)}
    return {
        name: text for name, text in found.items() if "owners" not in name and not name.endswith("work.json")
    }


def test_the_same_objects_as_in_a_folder(tmp_path: Path, server: Failing) -> None:
    url = "s3://sweeps/plain.zarr"
    inside, outside = swept(tmp_path / "0.zarr"), swept(url)
    xr.testing.assert_identical(outside.load(), inside.load())
    assert object_contents(url) == folder_contents(tmp_path / "0.zarr")
    assert swept(url).attrs["mechanisms_found"] == 21
    with pytest.raises(ct.InputError, match="holds another sweep; what differs: outputs"):
        swept(url, outputs="angle")
    # a block whose mark is gone is computed again
    s3fs.S3FileSystem().rm("sweeps/plain.zarr/progress/done/0/2.json")
    assert swept(url).attrs["mechanisms_found"] == 18
    assert object_contents(url) == folder_contents(tmp_path / "0.zarr")


def test_workers_write_to_a_store_that_fails_now_and_then(tmp_path: Path, server: Failing) -> None:
    url = "s3://sweeps/failing.zarr"
    swept(tmp_path / "0.zarr")
    server.each = 9
    try:
        # a worker in this process: what fails is the server
        with distributed.Client(
            n_workers=1,
            threads_per_worker=1,
            processes=False,
            dashboard_address="127.0.0.1:0",
            set_as_default=False,
        ) as client:
            found = swept(url, cluster=client)
    finally:
        server.each = 0
    assert server.failed > 3
    assert found.attrs["mechanisms"] == 21
    assert object_contents(url) == folder_contents(tmp_path / "0.zarr")
    assert json.loads(s3fs.S3FileSystem().cat_file(f"{url}/progress/owners/0"))["alive"] is False


def test_a_place_without_rights_or_reach(
    server: Failing, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    study = tmp_path / "study.toml"
    study.write_text('mechanism = "crank-rocker"\noutputs = "angle"\n[vary]\nlinks.AB.length = [3.4, 3.5]\n')
    server.refuses = True
    try:
        assert main(["sweep", str(study), "--out", "s3://sweeps/refused.zarr"]) == 2
    finally:
        server.refuses = False
    told = capsys.readouterr().err
    assert "s3://sweeps/refused.zarr: cannot be written: " in told
    assert "Traceback" not in told
    with pytest.raises(
        ct.InputError, match=r"s3://no-such-bucket/x\.zarr: cannot be written: .*; look at the address"
    ):
        swept("s3://no-such-bucket/x.zarr")
    with pytest.raises(
        ct.InputError, match=r"of no kind that is known: .*gopher.*; give a folder, or an address such"
    ):
        swept("gopher://sweeps/x.zarr")
    s3fs.S3FileSystem().pipe_file("sweeps/other/thesis.txt", b"years of work")
    with pytest.raises(ct.InputError, match="the place holds something else; give another path"):
        swept("s3://sweeps/other")


def test_only_one_run_owns_a_place(server: Failing, monkeypatch: pytest.MonkeyPatch) -> None:
    url = "s3://sweeps/owned.zarr"
    place = storage_of(url)
    assert isinstance(place, ObjectStorage)
    with (
        place.lock(),
        pytest.raises(ct.InputError, match="another run is writing into it; wait until it ends"),
    ):
        swept(url)
    swept(url)
    files = s3fs.S3FileSystem()

    def owner(**told: Any) -> None:
        number = (
            max(int(name.rpartition("/")[2]) for name in files.ls(f"{url}/progress/owners", refresh=True)) + 1
        )
        files.pipe_file(f"{url}/progress/owners/{number}", json.dumps(told).encode())

    now = storage.time.time()
    owner(host="elsewhere", process=1, alive=True, time=now)
    with pytest.raises(ct.InputError, match="another run is writing into it"):
        swept(url)
    # one that has not been heard of for long, one that ended, and a process that is no more hold nothing
    owner(host="elsewhere", process=1, alive=True, time=now - storage.LEASE - 1.0)
    assert swept(url).attrs["mechanisms_found"] == 21
    owner(host=socket.gethostname(), process=2**22 + 1, alive=True, time=now)
    assert swept(url).attrs["mechanisms_found"] == 21
    # two that find it free at once: one of them has it
    last = place._owners()[-1]
    monkeypatch.setattr(ObjectStorage, "_owners", lambda self: [last - 1])
    with pytest.raises(ct.InputError, match="another run is writing into it"), place.lock():
        pass


def test_values_of_the_result_are_read_when_they_are_used(server: Failing) -> None:
    url = "s3://sweeps/lazy.zarr"
    found = swept(url, reduce="range")
    whole = swept(None, reduce="range")
    assert np.array_equal(found["angle"][2, 1].values, whole["angle"][2, 1].values, equal_nan=True)
    with xr.open_zarr(url, chunks=None) as plain:
        xr.testing.assert_equal(plain.load(), whole)
