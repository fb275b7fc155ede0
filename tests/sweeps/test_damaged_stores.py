"""Stores that are damaged or foreign: bad blocks are named and computed again, anything else is refused."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.cli.main import main
from centrode.errors import DamageWarning
from centrode.sweeps import designs

pytest.importorskip("zarr", reason="stores need the extra sweeps")

VARY = {"links.AB.length": (3.2, 3.8, 4), "frame.points.D.x": [3.9, 4.0, 4.1]}
STUDY = """\
mechanism = "crank-rocker"
outputs = ["position.B", "angle.DB"]
samples = 7
[grid]
links.AB.length = { from = 3.2, to = 3.8, count = 4 }
"frame.points.D.x" = [3.9, 4.0, 4.1]
"""


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(designs, "BLOCK_POSITIONS", 1)  # every mechanism is a block


def swept(store: Path | None, **more: Any) -> xr.Dataset:
    asked = {"outputs": ["position.B", "angle.DB"], "samples": 7, **more}
    return ct.sweep(ct.example("crank-rocker"), ct.grid(VARY), store=store, **asked)


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store that is finished, twelve blocks."""
    place = tmp_path_factory.mktemp("finished") / "r.zarr"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(designs, "BLOCK_POSITIONS", 1)
        swept(place)
    return place


@pytest.fixture
def store(finished: Path, tmp_path: Path) -> Path:
    shutil.copytree(finished, tmp_path / "r.zarr")
    return tmp_path / "r.zarr"


def chunk(store: Path, column: str = "angle.DB", block: tuple[int, int] = (1, 2)) -> Path:
    """The chunk of a block in a column; the samples are in one chunk."""
    (file,) = (store / column / "c" / str(block[0]) / str(block[1])).rglob("0")
    return file if file.is_file() else file / "0"


def cut_off(store: Path) -> None:
    file = chunk(store)
    file.write_bytes(file.read_bytes()[:-9])


def emptied(store: Path) -> None:
    chunk(store).write_bytes(b"")


def taken_away(store: Path) -> None:
    chunk(store).unlink()


def one_bit_changed(store: Path) -> None:
    file = chunk(store)
    content = bytearray(file.read_bytes())
    content[11] ^= 1
    file.write_bytes(content)


def grown(store: Path) -> None:
    with chunk(store).open("r+b") as stream:
        stream.truncate(10**12)  # takes no room on the disk


def of_another_block(store: Path) -> None:
    shutil.copy(chunk(store, block=(0, 0)), chunk(store))


def as_a_pipe(store: Path) -> None:
    file = chunk(store)
    file.unlink()
    os.mkfifo(file)


def with_another_tally(store: Path) -> None:
    mark = store / "progress" / "done" / "0" / "5.json"
    told = json.loads(mark.read_text())
    told["tally"]["whole"] = 0
    mark.write_text(json.dumps(told))


def with_the_mark_of_another(store: Path) -> None:
    marks = store / "progress" / "done" / "0"
    shutil.copy(marks / "4.json", marks / "5.json")


DAMAGES = [
    cut_off, emptied, taken_away, one_bit_changed, grown, of_another_block, as_a_pipe, with_another_tally,
    with_the_mark_of_another,
]  # fmt: skip


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes and files with holes")
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_bad_block_is_named_and_computed_again(store: Path, damage: Callable[[Path], None]) -> None:
    damage(store)
    told = r"1 block is damaged and is computed again: 5 \(mechanisms 5 to 5\)"
    with pytest.warns(DamageWarning, match=told):
        found = swept(store)
    assert found.attrs["mechanisms_found"] == 11
    memory = swept(None)
    xr.testing.assert_equal(found, memory)
    assert {**found.attrs, "mechanisms_found": 0} == {**memory.attrs, "mechanisms_found": 0}
    assert swept(store).attrs["mechanisms_found"] == 12  # mended: nothing to tell any more
    with xr.open_zarr(store) as plain:
        xr.testing.assert_equal(plain, memory)


@pytest.mark.parametrize("damage", [cut_off, grown])
def test_a_bad_block_at_the_edge(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damage: Callable[[Path], None]
) -> None:
    """The last block is no whole chunk; what is in its place is not read when it is computed again."""
    monkeypatch.setattr(designs, "BLOCK_POSITIONS", 2000)
    asked = {
        "vary": ct.grid({"links.AB.length": np.linspace(3.2, 3.8, 7)}),
        "outputs": "angle.DB",
        "samples": 7,
    }
    store = tmp_path / "r.zarr"
    whole = ct.sweep(ct.example("crank-rocker"), **asked, store=store).load()
    chunks = sorted(store.glob("angle.DB/c/*/0"))
    step = xr.open_zarr(store)["angle.DB"].encoding["chunks"][0]
    assert len(chunks) > 1
    assert 7 % step
    monkeypatch.setattr(f"{__name__}.chunk", lambda _store: chunks[-1])
    damage(store)
    with pytest.warns(DamageWarning, match="1 block is damaged"):
        xr.testing.assert_equal(ct.sweep(ct.example("crank-rocker"), **asked, store=store), whole)


def test_many_bad_blocks(store: Path) -> None:
    shutil.rmtree(store / "position.B" / "c")
    with pytest.warns(
        DamageWarning,
        match=r"12 blocks are damaged .*: 0 \(mechanisms 0 to 0\), .* 4 \(mechanisms 4 to 4\), and 7 more",
    ):
        xr.testing.assert_equal(swept(store), swept(None))


def test_any_reader_tells_a_changed_chunk(store: Path) -> None:
    """Chunks carry a checksum of the format's own: xarray does not hand out wrong numbers either."""
    one_bit_changed(store)
    with xr.open_zarr(store) as plain, pytest.raises(ValueError, match="checksum"):
        plain["angle.DB"].load()


def test_the_command_names_a_bad_block(
    store: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("LANGUAGE", "en")
    (store.parent / "study.toml").write_text(STUDY)
    cut_off(store)
    command = ["sweep", str(store.parent / "study.toml"), "--out", str(store)]
    assert main(command) == 0
    assert capsys.readouterr().err == (
        f"note: {store}: 1 block is damaged and is computed again: 5 (mechanisms 5 to 5)\n"
        "11 mechanisms were computed in an earlier run\n"
    )
    assert main(command) == 0
    assert capsys.readouterr().err == "12 mechanisms were computed in an earlier run\n"


def test_what_a_killed_run_was_writing_is_removed(store: Path) -> None:
    partial = chunk(store).with_name("0." + "0123456789abcdef" * 2 + ".partial")
    partial.write_bytes(bytes(1000))
    assert swept(store).attrs["mechanisms_found"] == 12
    assert not partial.exists()


# what is no block: refused


def deep(_content: bytes) -> bytes:
    return b"[" * 200_000 + b"]" * 200_000


def changed(key: str, value: Any) -> Callable[[bytes], bytes]:
    def change(content: bytes) -> bytes:
        told = json.loads(content)
        told.pop(key)
        return json.dumps(told if value is None else {**told, key: value}).encode()

    return change


BOMB = {"name": "gzip", "configuration": {"level": 9}}
METADATA: list[tuple[str, str, Callable[[bytes], bytes]]] = [
    ("empty", "zarr.json", lambda _content: b""),
    ("binary", "zarr.json", lambda _content: bytes(range(256)) * 40),
    ("nested", "zarr.json", deep),
    ("another kind", "zarr.json", lambda _content: b"[1]"),
    ("without attributes", "zarr.json", changed("attributes", None)),
    ("an array, no group", "zarr.json", changed("node_type", "array")),
    ("empty array", "angle.DB/zarr.json", lambda _content: b""),
    ("nested array", "angle.DB/zarr.json", deep),
    ("array without attributes", "angle.DB/zarr.json", changed("attributes", None)),
    ("great shape", "angle.DB/zarr.json", changed("shape", [2**60, 3, 7])),
    ("negative shape", "angle.DB/zarr.json", changed("shape", [-4, 3, 7])),
    ("another type", "angle.DB/zarr.json", changed("data_type", "int8")),
    ("a codec that unpacks", "angle.DB/zarr.json", changed("codecs", [{"name": "bytes"}, BOMB])),
    ("a group, no array", "angle.DB/zarr.json", changed("node_type", "group")),
    ("coordinates", "drive_value/zarr.json", changed("shape", [10**12, 1])),
    ("great file", "zarr.json", lambda content: content + b" " * 50_000_000),
    ("empty study", "progress/study.json", lambda _content: b""),
    ("nested study", "progress/study.json", deep),
    ("study of another kind", "progress/study.json", lambda _content: b"3"),
    ("blocks of no extent", "progress/study.json", changed("blocks", [0, 0])),
    ("negative blocks", "progress/study.json", changed("blocks", [-1, 1])),
    ("infinite blocks", "progress/study.json", changed("blocks", [0, float("inf")])),
    ("files of another kind", "progress/study.json", changed("files", [1])),
]


@pytest.mark.parametrize(
    ("name", "change"), [case[1:] for case in METADATA], ids=[case[0] for case in METADATA]
)
def test_damaged_metadata_is_refused(
    store: Path, name: str, change: Callable[[bytes], bytes], capsys: pytest.CaptureFixture[str]
) -> None:
    file = store / name
    file.write_bytes(change(file.read_bytes()))
    before = {path: path.stat().st_mtime_ns for path in store.rglob("*")}
    with pytest.raises(ct.InputError, match=f"{name} in it is damaged; delete the folder, or give another"):
        swept(store)
    (store.parent / "study.toml").write_text(STUDY)
    assert main(["--lang", "en", "sweep", str(store.parent / "study.toml"), "--out", str(store)]) == 2
    assert "Traceback" not in capsys.readouterr().err
    assert {path: path.stat().st_mtime_ns for path in store.rglob("*")} == before


@pytest.mark.parametrize("name", ["zarr.json", "angle.DB/zarr.json", "sample/c/0", "progress/study.json"])
def test_a_folder_or_nothing_in_the_place_of_a_file(store: Path, name: str) -> None:
    if not (store / name).exists():
        name = next(str(p.relative_to(store)) for p in store.glob("drive_value/c/**/*") if p.is_file())
    (store / name).unlink()
    if name != "progress/study.json":  # without it the making was cut short
        with pytest.raises(ct.InputError, match="in it is damaged"):
            swept(store)
    (store / name).mkdir()
    with pytest.raises(ct.InputError, match="in it is damaged"):
        swept(store)


def foreign(path: Path, kind: str) -> None:
    """A folder or a file that no sweep made."""
    if kind == "binary":
        path.write_bytes(bytes(range(256)) * 100)
        return
    path.mkdir()
    if kind == "zarr of somebody else":
        xr.Dataset({"angle.DB": ("x", np.zeros(3))}).to_zarr(path, zarr_format=3, consolidated=False)
    if kind == "zarr in zarr":
        xr.Dataset({"a": ("x", np.zeros(3))}).to_zarr(
            path / "progress" / "r.zarr", zarr_format=3, consolidated=False
        )
    if kind == "no metadata":
        (path / "angle.DB").mkdir()
    if kind == "lock and study alone":
        (path / "progress").mkdir()
        (path / "progress" / "lock").touch()
        (path / "progress" / "study.json").write_text('{"study": {}, "blocks": [0, 1]}')


@pytest.mark.parametrize(
    "kind", ["binary", "zarr of somebody else", "zarr in zarr", "no metadata", "lock and study alone"]
)
def test_foreign_stores_are_refused(tmp_path: Path, kind: str) -> None:
    foreign(tmp_path / "r.zarr", kind)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(ct.InputError, match=r"is not a folder|holds something else|holds another sweep"):
        swept(tmp_path / "r.zarr")
    assert sorted(tmp_path.rglob("*")) == before


def test_a_study_with_blocks_that_take_all_memory_is_refused(tmp_path: Path, monkeypatch: Any) -> None:
    """A block is held in memory while it is computed: as great as a sweep makes them, no greater."""
    store = tmp_path / "r.zarr"
    swept(store)
    file = store / "progress" / "study.json"
    file.write_bytes(changed("blocks", [0, 4])(file.read_bytes()))
    monkeypatch.setattr(designs, "BLOCK_BYTES", 1000)
    with pytest.raises(ct.InputError, match=r"study\.json in it is damaged"):
        swept(store)


IN_LITTLE_MEMORY = """
import resource, shutil, sys
from centrode.cli.main import main
from centrode.sweeps import designs
import numpy, xarray, zarr, scipy.integrate
study, store, bomb, chunk, label = sys.argv[1:]
designs.BLOCK_POSITIONS = 1
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 400_000_000,) * 2)
for place in (chunk, label):
    shutil.copy(bomb, place)
    print(main(["--lang", "en", "sweep", study, "--out", store]), file=sys.stderr)
"""
LARGEST = 1 << 17
"""Bytes that one block of zstd can stand for."""


def bomb(size: int) -> bytes:
    """Some kB of zstd that unpack to as many bytes: blocks of four bytes that repeat a zero (RFC 8878)."""
    header = b"\x28\xb5\x2f\xfd" + bytes([0, (17 - 10) << 3])  # a window of 2^17, no size told
    repeated, last = 1 << 1, 1
    block, end = ((LARGEST << 3 | kind).to_bytes(3, "little") + b"\0" for kind in (repeated, repeated | last))
    return header + block * (size // LARGEST - 1) + end


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs /proc")
def test_what_unpacks_to_gigabytes_is_not_unpacked(store: Path, tmp_path: Path) -> None:
    """In the place of a chunk and of a label: 400 MB more than what is imported are enough."""
    assert len(bomb(2**30)) < 33_000
    (tmp_path / "study.toml").write_text(STUDY)
    (tmp_path / "bomb").write_bytes(bomb(2**30))
    label = next(path for path in store.glob("drive_value/c/**/*") if path.is_file())
    places = [str(tmp_path / "study.toml"), str(store), str(tmp_path / "bomb"), str(chunk(store)), str(label)]
    program = [sys.executable, "-c", IN_LITTLE_MEMORY, *places]
    done = subprocess.run(program, capture_output=True, encoding="utf-8", check=True)
    named, found, code, refused, last = done.stderr.splitlines()
    assert "1 block is damaged and is computed again: 5" in named
    assert (found, code, last) == ("11 mechanisms were computed in an earlier run", "0", "2")
    assert refused.startswith("Error: ")
    assert "in it is damaged" in refused


def test_the_bomb_is_one() -> None:
    """What the test above would unpack, if anything did."""
    codecs = pytest.importorskip("numcodecs.zstd")
    assert codecs.Zstd().decode(bomb(2**20)) == bytes(2**20)
