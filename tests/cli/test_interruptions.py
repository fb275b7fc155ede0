"""Commands that are interrupted, terminated or killed at work: nothing stays, or the next run removes it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from centrode.files import drafts
from centrode.files.locks import taken
from centrode.interruption import is_command_line

Centrode = Callable[..., Any]

posix = pytest.mark.skipif(os.name != "posix", reason="needs signals that processes send each other")

PROGRAM = """
import signal, sys, time
from pathlib import Path
from centrode.cli.progress import Progress
from centrode.cli.main import main

def say(self, what, done=0, of=0):
    # At work, a draft beside the result: tell so, and go on when the file appears that says so.
    if done == 3 or what == "writing tables":
        (draft,) = Path().glob(".centrode-*")
        (draft / "content" / "half").write_bytes(bytes(1000))
        print("at work", flush=True)
        while not Path("go on").exists():
            time.sleep(0.01)
        (draft / "content" / "half").unlink(missing_ok=True)
        Progress.say = lambda *anything: None

Progress.say = say
# Tests that a shell runs in the background ignore SIGINT, and so do their processes.
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.exit(main(sys.argv[1:]))
"""
ANIMATE = ("animate", "crank-rocker", "--frames", "5", "--size", "64x64", "--out", "long.gif")
RUN = ("run", "kite", "--samples", "3", "--no-figures", "--out", "result")


@contextmanager
def at_work(folder: Path, *command: str) -> Iterator[subprocess.Popen[bytes]]:
    """A process that runs a command and waits in the midst of it, its draft begun."""
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, *command],
        cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    with process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"at work\n"
        assert list(folder.glob(".centrode-*/content/half"))
        try:
            yield process
        finally:
            process.kill()


@posix
@pytest.mark.parametrize(("command", "number"), [(ANIMATE, "SIGINT"), (RUN, "SIGINT"), (RUN, "SIGTERM")])
def test_a_signal_leaves_nothing(folder: Path, command: tuple[str, ...], number: str) -> None:
    with at_work(folder, *command) as process:
        process.send_signal(getattr(signal, number))
        out, err = process.communicate()
    assert (process.returncode, out, err) == (130, b"", b"interrupted\n")
    assert list(folder.iterdir()) == []


COMMAND_LINE = """
import signal, sys
from importlib.abc import MetaPathFinder

MODULE = sys.argv.pop()

class Interrupts(MetaPathFinder):
    # Ctrl-C when a module is looked for; where Python lets nothing out, it comes when an object goes
    def find_spec(self, name, path, target=None):
        if name == MODULE:
            signal.raise_signal(signal.SIGINT)
        if name + "!" == MODULE:
            Goes()

class Goes:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)

signal.signal(signal.SIGINT, signal.default_int_handler)
sys.meta_path.insert(0, Interrupts())
sys.argv[0] = "centrode"
from centrode.__main__ import main
sys.exit(main())
"""


@pytest.mark.parametrize(
    ("module", "said"),
    [
        ("lazy_loader", b""),
        ("centrode.cli.main", b""),
        ("centrode.kinematics.check", b"interrupted\n"),
        ("centrode.kinematics.check!", b"interrupted\n"),
    ],
)
def test_ctrl_c_while_modules_are_imported(folder: Path, module: str, said: bytes) -> None:
    done = subprocess.run(
        [sys.executable, "-c", COMMAND_LINE, "check", "kite", module],
        cwd=folder, capture_output=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", said)


@pytest.mark.parametrize(
    ("arguments", "of_python", "ours"),
    [
        (["/bin/centrode", "check"], ["python", "/bin/centrode", "check"], True),
        (["-m", "check", "kite"], ["python", "-m", "centrode", "check", "kite"], True),
        (["-m"], ["python", "-Bm", "centrode"], True),
        (["-m", "check"], ["python", "-W", "error", "-mcentrode", "check"], True),
        (["-m", "-m", "centrode"], ["python", "-m", "tool.run", "-m", "centrode"], False),
        (["-m", "centrode"], ["python", "-mtool", "centrode"], False),
        (["tool.py", "centrode"], ["python", "tool.py", "centrode"], False),
        ([], [], False),
    ],
)
def test_whose_command_line_it_is(arguments: list[str], of_python: list[str], ours: bool) -> None:
    assert is_command_line(arguments, of_python) == ours


def test_ctrl_c_of_another_program_is_its_own(folder: Path) -> None:
    """A package that imports this one, while Python looks for a module of it, is interrupted as ever."""
    (folder / "own").mkdir()
    (folder / "own" / "__init__.py").write_text(
        "import signal\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "import centrode\n"
        "print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)\n"
    )
    (folder / "own" / "run.py").touch()
    done = subprocess.run(
        [sys.executable, "-m", "own.run", "-m", "centrode"],
        cwd=folder, capture_output=True, check=False,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)},
    )  # fmt: skip
    assert (done.stdout.split(), done.stderr) == ([b"True"], b"")


REPORT = """
import signal, sys, time
from centrode.report import pdf_document
from centrode.__main__ import main

def typesetting(report):
    def work():
        print("at work", flush=True)
        time.sleep(600)
    return work

pdf_document.typesetting = typesetting
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.argv = ["centrode", "report", "kite", "--chapters", "data", "--format", "pdf", "--out", "report"]
sys.exit(main())
"""


@posix
def test_ctrl_c_while_a_document_is_set(folder: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", REPORT], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"at work\n"
        process.send_signal(signal.SIGINT)
        try:
            out, err = process.communicate(timeout=60)
        finally:
            process.kill()
    assert (process.returncode, out, err) == (130, b"", b"interrupted\n")
    assert list(folder.iterdir()) == []


@posix
def test_what_a_kill_left_is_removed_by_the_next_run(centrode: Centrode, folder: Path) -> None:
    with at_work(folder, *RUN) as process:
        process.kill()
        process.communicate()
    assert process.returncode == -signal.SIGKILL
    assert [path.name for path in folder.glob("*/content/half")] == ["half"]
    done = centrode(*RUN)
    assert (done.code, done.err) == (0, "")
    assert [path.name for path in folder.iterdir()] == ["result"]


@posix
def test_the_draft_of_a_run_at_work_is_left_alone(centrode: Centrode, folder: Path) -> None:
    with at_work(folder, *RUN) as process:
        assert centrode(*RUN[:-1], "another").code == 0
        assert list(folder.glob(".centrode-*/content/half"))
        (folder / "go on").touch()
        out, err = process.communicate()
        assert (process.returncode, err) == (0, b"")
        assert b"motion.csv" in out
    assert sorted(path.name for path in folder.iterdir()) == ["another", "go on", "result"]


def test_what_is_no_draft_is_left_alone(folder: Path) -> None:
    for name in (".centrode-mine", ".centrode-abcdefgh.txt", ".centrode"):
        (folder / name).mkdir()
    (folder / ".centrode-abcd1234").write_text("a file")
    (folder / "elsewhere").mkdir()
    (folder / ".centrode-linked__").symlink_to("elsewhere")
    before = sorted(folder.rglob("*"))
    drafts.clear_drafts(folder)
    assert sorted(folder.rglob("*")) == before
    (folder / ".centrode-abcdefgh" / "content").mkdir(parents=True)  # killed before it had its lock
    drafts.clear_drafts(folder)
    assert sorted(folder.rglob("*")) == before


def test_an_input_in_a_draft_is_left_alone(centrode: Centrode, folder: Path, four_bar: str) -> None:
    """What a killed run was writing may be what somebody reads now."""
    rescued = folder / ".centrode-abcdefgh" / "content" / "press.toml"
    rescued.parent.mkdir(parents=True)
    rescued.write_text(four_bar)
    assert centrode("run", rescued, "--samples", "3", "--no-figures", "--out", "result").code == 0
    assert rescued.read_text() == four_bar


def test_a_lock_is_taken_once(folder: Path) -> None:
    held = taken(folder / "lock")
    assert held is not None
    assert taken(folder / "lock") is None
    held.close()
    with pytest.raises(FileNotFoundError):
        taken(folder / "gone" / "lock")


@pytest.mark.skipif(sys.platform == "win32", reason="an open file cannot be removed there")
def test_a_lock_that_was_removed_before_it_was_taken(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between opening a file and locking it: the lock of a file that nobody sees any more holds nothing."""
    take = drafts.taken.__globals__["_take"]

    def late(handle: int) -> None:
        (folder / "lock").unlink()
        take(handle)

    monkeypatch.setitem(drafts.taken.__globals__, "_take", late)
    assert taken(folder / "lock") is None


def test_a_draft_that_another_run_removed_too_soon(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between making a draft and locking it: the next one is made."""
    make, names = drafts.tempfile.mkdtemp, ["removed", "kept"]

    def once(**words: Any) -> str:
        name = str(make(**words))
        if names.pop(0) == "removed":
            drafts.clear_drafts(folder)
        return name

    monkeypatch.setattr(drafts.tempfile, "mkdtemp", once)
    with drafts.draft_file(folder / "a.txt") as draft:
        draft.write_text("whole")
    assert names == []
    assert {path.name: path.read_text() for path in folder.iterdir()} == {"a.txt": "whole"}


def test_where_nothing_can_be_locked_files_are_written_all_the_same(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unsupported(_file: Path) -> None:
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(drafts, "taken", unsupported)
    (folder / ".centrode-abcdefgh").mkdir()
    with drafts.draft_file(folder / "a.txt") as draft:
        draft.write_text("whole")
    assert sorted(path.name for path in folder.iterdir()) == [".centrode-abcdefgh", "a.txt"]
