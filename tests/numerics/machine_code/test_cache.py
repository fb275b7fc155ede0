"""Kernels on disk and in memory: found again, rebuilt when they cannot be trusted, never missed."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from centrode.numerics.expressions import variable
from centrode.numerics.machine_code import cache
from centrode.numerics.scans import Scan

NEEDS = "machine code needs llvmlite: pip install 'centrode[fast]'"
kernels = pytest.importorskip("centrode.numerics.machine_code.kernels", reason=NEEDS)

x = variable("x")
SCAN = Scan(("x",), (), {"y": x * x + 0.25})


def works() -> bool:
    found = kernels.kernel_of(SCAN).run(np.arange(20.0)[None], None).outputs
    return bool(np.array_equal(found[0, 0], np.arange(20.0) ** 2 + 0.25))


def entries(folder: Path) -> list[Path]:
    return sorted(folder.glob("*")) if folder.is_dir() else []


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The texts that have been compiled since."""
    texts: list[str] = []
    original = kernels.object_code

    def counting(text: str, target: Any) -> bytes:
        texts.append(text)
        return bytes(original(text, target))

    monkeypatch.setattr(kernels, "object_code", counting)
    return texts


def test_a_kernel_is_compiled_once(own_cache: Path, compiled: list[str]) -> None:
    assert kernels.kernel_of(SCAN) is kernels.kernel_of(Scan(("x",), (), {"y": 0.25 + variable("x") * x}))
    assert (len(compiled), len(entries(own_cache))) == (1, 1)
    kernels.forget()
    assert works()
    assert len(compiled) == 1


@pytest.mark.parametrize(
    "other",
    [
        lambda: kernels.kernel_of(SCAN, width=2),
        lambda: kernels.kernel_of(SCAN, "float32"),
        lambda: kernels.kernel_of(SCAN, lanes_inside=True),
        lambda: kernels.kernel_of(Scan(("x",), (), {"y": x * x + 0.5})),
        lambda: kernels.kernel_of(Scan((), ("x",), {"y": variable("x") * x + 0.25})),
    ],
)
def test_another_kernel_is_another_entry(
    own_cache: Path, compiled: list[str], other: Callable[[], Any]
) -> None:
    kernels.kernel_of(SCAN)
    other()
    assert (len(compiled), len(entries(own_cache))) == (2, 2)


def test_names_depend_on_every_part() -> None:
    names = {
        cache.name_of(*parts) for parts in (("a", "b"), ("ab", ""), ("a", "c"), ("", "ab"), ("a", "b", ""))
    }
    assert len(names) == 5
    host = kernels.host()
    assert cache.name_of("text", kernels.VERSIONS, repr(host)) == cache.name_of(
        "text", kernels.VERSIONS, repr(host)
    )


@pytest.mark.parametrize(
    "spoil",
    [
        lambda content: b"",
        lambda content: content[:-1],
        lambda content: content + b"\0",
        lambda content: content[:60] + bytes([content[60] ^ 1]) + content[61:],
        lambda content: content.replace(b"kernel 1", b"kernel 0"),
        lambda content: b"\x7fELF" + bytes(200),
        lambda content: bytes(cache.GREATEST + 2),
    ],
)
def test_a_corrupt_entry_is_rebuilt(
    own_cache: Path, compiled: list[str], spoil: Callable[[bytes], bytes]
) -> None:
    kernels.kernel_of(SCAN)
    (entry,) = entries(own_cache)
    whole = entry.read_bytes()
    entry.write_bytes(spoil(whole))
    kernels.forget()
    assert works()
    assert len(compiled) == 2
    assert entries(own_cache) == [entry]
    assert entry.read_bytes() == whole


def test_an_entry_under_another_name_is_not_taken(own_cache: Path, compiled: list[str]) -> None:
    kernels.kernel_of(Scan(("x",), (), {"y": x - 1.0}))
    (foreign,) = entries(own_cache)
    kernels.kernel_of(SCAN)
    (entry,) = set(entries(own_cache)) - {foreign}
    entry.write_bytes(foreign.read_bytes())
    kernels.forget()
    assert works()
    assert len(compiled) == 3


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="files have no owners here")
def test_an_entry_of_somebody_else_is_not_taken(
    own_cache: Path, compiled: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    kernels.kernel_of(SCAN)
    kernels.forget()
    me = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: me + 1)
    assert works()
    assert len(compiled) == 2


def forged(entry: Path) -> None:
    """Other code under the name of an entry, with a checksum computed for it."""
    payload = b"native code of somebody else"
    entry.write_bytes(cache.MARK + cache._digest(entry.stem, payload) + payload)


def in_a_folder_for_a_group(folder: Path, _entry: Path) -> None:
    folder.chmod(0o770)


def in_a_folder_for_everybody(folder: Path, _entry: Path) -> None:
    folder.chmod(0o1777)


def in_a_file_for_a_group(_folder: Path, entry: Path) -> None:
    entry.chmod(0o660)


def in_a_file_for_everybody(_folder: Path, entry: Path) -> None:
    entry.chmod(0o606)


def in_a_folder_that_anybody_may_rename(folder: Path, _entry: Path) -> None:
    folder.parent.chmod(0o777)


def behind_a_linked_entry(folder: Path, entry: Path) -> None:
    entry.rename(folder.parent / "elsewhere")
    entry.symlink_to(folder.parent / "elsewhere")


def behind_a_linked_folder(folder: Path, _entry: Path) -> None:
    folder.rename(folder.parent / "elsewhere")
    folder.symlink_to(folder.parent / "elsewhere")
    (folder.parent / "elsewhere").chmod(0o777)


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="rights are no bits here")
@pytest.mark.parametrize(
    "open_to_others",
    [
        in_a_folder_for_a_group,
        in_a_folder_for_everybody,
        in_a_file_for_a_group,
        in_a_file_for_everybody,
        in_a_folder_that_anybody_may_rename,
        behind_a_linked_entry,
        behind_a_linked_folder,
    ],
)
def test_what_others_may_write_is_not_run(
    own_cache: Path, compiled: list[str], open_to_others: Callable[[Path, Path], None]
) -> None:
    kernels.kernel_of(SCAN)
    (entry,) = entries(own_cache)
    forged(entry)
    assert cache.read_entry(entry.stem) == b"native code of somebody else"  # the checksum is right
    open_to_others(own_cache, entry)
    assert cache.read_entry(entry.stem) is None
    kernels.forget()
    assert works()
    assert len(compiled) == 2


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="rights are no bits here")
def test_a_private_folder_behind_a_link_is_used(own_cache: Path, compiled: list[str]) -> None:
    kernels.kernel_of(SCAN)
    own_cache.rename(own_cache.parent / "elsewhere")
    own_cache.symlink_to("elsewhere")
    kernels.forget()
    assert works()
    assert len(compiled) == 1


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="rights are no bits here")
def test_nothing_is_kept_where_others_may_write(own_cache: Path) -> None:
    own_cache.mkdir()
    own_cache.chmod(0o777)
    assert works()
    assert entries(own_cache) == []


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_in_the_place_of_an_entry_is_not_waited_for(own_cache: Path, compiled: list[str]) -> None:
    kernels.kernel_of(SCAN)
    (entry,) = entries(own_cache)
    entry.unlink()
    os.mkfifo(entry, 0o600)
    kernels.forget()
    assert works()
    assert len(compiled) == 2


def test_a_folder_in_the_place_of_an_entry(own_cache: Path, compiled: list[str]) -> None:
    kernels.kernel_of(SCAN)
    (entry,) = entries(own_cache)
    entry.unlink()
    (entry / "inside").mkdir(parents=True)
    kernels.forget()
    assert works()
    assert entries(own_cache) == [entry]  # and nothing temporary beside it


def test_a_folder_that_cannot_be_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv(cache.FOLDER, str(tmp_path / "file" / "kernels"))
    assert works()


def test_a_disk_that_is_full(own_cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*arguments: Any, **words: Any) -> Any:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(cache.tempfile, "mkstemp", full)
    assert works()
    assert entries(own_cache) == []


def test_nothing_is_kept_where_that_is_wanted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.FOLDER, "")
    monkeypatch.chdir(tmp_path)
    assert cache.folder() is None
    assert works()
    assert list(tmp_path.iterdir()) == []


def test_a_process_without_a_home(monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv(cache.FOLDER)
    monkeypatch.setattr(Path, "home", homeless)
    assert cache.folder() is None
    assert works()


@pytest.mark.parametrize("platform", ["linux", "darwin", "win32"])
def test_folders_by_platform(platform: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv(cache.FOLDER)
    monkeypatch.setattr(sys, "platform", platform)
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    folder = cache.folder()
    assert folder is not None
    assert folder.is_relative_to(tmp_path)
    assert "centrode" in folder.parts


def test_the_newest_are_kept(own_cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "ENTRIES", 3)
    for k in range(6):
        cache.write(f"entry{k}", b"payload")
        for i, entry in enumerate(sorted(own_cache.glob("*"))):
            os.utime(entry, (1000 + i, 1000 + i))
    assert [entry.stem for entry in entries(own_cache)] == ["entry3", "entry4", "entry5"]
    assert cache.read_entry("entry5") == b"payload"
    assert cache.read_entry("entry0") is None


def test_memory_keeps_the_last_asked_for(compiled: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernels, "REMEMBERED", 2)
    monkeypatch.setenv(cache.FOLDER, "")
    scans = [Scan(("x",), (), {"y": x + float(k)}) for k in range(1, 4)]
    for scan in (scans[0], scans[1], scans[0], scans[2], scans[0]):
        kernels.kernel_of(scan)
    assert len(compiled) == 3
    kernels.kernel_of(scans[1])
    assert len(compiled) == 4


def test_threads_and_processes_share_a_cache(own_cache: Path) -> None:
    program = (
        "import numpy as np\n"
        "from centrode.numerics.expressions import variable\n"
        "from centrode.numerics.machine_code.kernels import kernel_of\n"
        "from centrode.numerics.scans import Scan\n"
        "x = variable('x')\n"
        "for k in range(4):\n"
        "    found = kernel_of(Scan(('x',), (), {'y': x + (k + 0.5)})).run([np.zeros(9)], None).outputs\n"
        "    assert (found == k + 0.5).all()\n"
    )
    running = [subprocess.Popen([sys.executable, "-c", program]) for _ in range(2)]
    wrong: list[BaseException] = []

    def here() -> None:
        try:
            for k in range(4):
                found = (
                    kernels.kernel_of(Scan(("x",), (), {"y": x + (k + 0.5)})).run([np.zeros(9)], None).outputs
                )
                assert (found == k + 0.5).all()
        except BaseException as error:
            wrong.append(error)

    threads = [threading.Thread(target=here) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [process.wait(60) for process in running] == [0, 0]
    assert wrong == []
    assert len(entries(own_cache)) == 4
