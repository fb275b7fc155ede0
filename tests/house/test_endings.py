"""How the command line ends: exit codes and messages, never a traceback."""

from __future__ import annotations

import errno
import io
import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import click
import pytest

from centrode.cli import main as command_line
from centrode.cli.progress import announce_samples, announce_turns
from centrode.errors import InputError, MotionError
from centrode.locale import choose_language

Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(autouse=True)
def same_process(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    for name in ("LC_ALL", "LC_MESSAGES", "LANG", "CENTRODE_DEBUG"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("LANGUAGE", "en")
    yield
    choose_language("en")


def ends(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], work: Callable[[], object]
) -> tuple[int, str]:
    command = click.Command("work", callback=work)
    monkeypatch.setattr(command_line, "COMMANDS", (command,))
    code = command_line.main(["work"])
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "Traceback" not in printed.err
    return code, printed.err


def raising(failure: BaseException) -> Callable[[], None]:
    def work() -> None:
        raise failure

    return work


@pytest.mark.parametrize(
    ("failure", "code", "message"),
    [
        (InputError("press.toml", "no drive", "add one"), 2, "Error: press.toml: no drive; add one\n"),
        (MotionError("", "locks at 1.8 rad"), 3, "Error: locks at 1.8 rad\n"),
        (InputError("a\x1b[2Jb", "bad"), 2, "Error: a\\x1b[2Jb: bad\n"),
        (KeyboardInterrupt(), 130, "interrupted\n"),
        (
            OSError(28, "No space left on device"),
            2,
            "operating system refused: [Errno 28] No space left on device\n",
        ),
        (ValueError("boom"), 70, "Error: this is an error in centrode: ValueError: boom; please report it"),
        (RecursionError("deep"), 70, "error in centrode: RecursionError: deep"),
        (MemoryError(), 70, "error in centrode: MemoryError"),
        (click.UsageError("no"), 2, "Error: no\n"),
        (SystemExit(5), 5, ""),
    ],
)
def test_every_failure_is_a_message_and_a_code(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    failure: BaseException,
    code: int,
    message: str,
) -> None:
    ended, said = ends(monkeypatch, capsys, raising(failure))
    assert ended == code
    assert message in said


@pytest.mark.parametrize("kind", [InputError, MotionError])
def test_failures_cross_processes_whole(kind: type[InputError | MotionError]) -> None:
    failure = pickle.loads(pickle.dumps(kind("press.toml", "no drive", "add one")))
    assert type(failure) is kind
    assert (failure.where, failure.what, failure.repair) == ("press.toml", "no drive", "add one")
    assert str(failure) == "press.toml: no drive; add one"


def test_a_command_may_return_its_exit_code(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert ends(monkeypatch, capsys, lambda: 3) == (3, "")
    assert ends(monkeypatch, capsys, lambda: None) == (0, "")


def test_debugging_prints_the_traceback(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("CENTRODE_DEBUG", "1")
    monkeypatch.setattr(
        command_line, "COMMANDS", (click.Command("work", callback=raising(ValueError("boom"))),)
    )
    assert command_line.main(["work"]) == 70
    assert "Traceback" in capsys.readouterr().err


def test_help_lists_commands_in_reading_order(centrode: Run) -> None:
    listed = centrode("--help").stdout.partition("Commands:")[2].split("\n\n")[0]
    names = [line.split()[0] for line in listed.splitlines() if line.strip()]
    assert names == [command.name for command in command_line.COMMANDS]


def test_help_of_every_command_fits_its_line(centrode: Run) -> None:
    for language in ("en", "ru", "uk"):
        told = centrode("--lang", language, "--help").stdout.partition("\n  ")[2]
        assert "..." not in told
        first, last = (told.index(f"\n  {command} ") for command in ("run", "schema"))
        rows = told[first:last].splitlines()[1:]
        assert [row for row in rows if not row[2:].strip() or row[2] == " "] == []  # one line each


@pytest.mark.parametrize(
    "arguments", [["nothing"], ["--nothing"], ["examples", "a", "b"], ["examples", "--out"], []]
)
def test_usage_errors_end_with_2_and_print_nothing(centrode: Run, arguments: list[str]) -> None:
    done = centrode(*arguments)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Usage:" in done.stderr or done.stderr.startswith("Error: ")


def test_version(process: Run) -> None:
    assert process("--version").stdout == "centrode, version 0.1.0\n"


PIPED = """
import sys
from centrode.cli import main as command_line
import click
def work():
    for line in range(100_000):
        click.echo("x" * 80)
command_line.COMMANDS = (click.Command("work", callback=work),)
sys.exit(command_line.main(["work"]))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no such pipes")
def test_a_reader_that_goes_away_is_no_failure() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", PIPED], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as writer:
        assert writer.stdout is not None
        assert writer.stderr is not None
        assert writer.stdout.readline() == b"x" * 80 + b"\n"
        writer.stdout.close()
        assert writer.stderr.read() == b""
        assert writer.wait() == command_line.READER_GONE


FULL = pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
SHELL = pytest.mark.skipif(sys.platform == "win32", reason="needs a shell that closes streams")


@FULL
def test_a_full_disk_is_told() -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "centrode", "--lang", "en", "--help"],
            stdout=full, stderr=subprocess.PIPE, encoding="utf-8", check=False,
        )  # fmt: skip
    assert done.returncode == 2
    assert "operating system refused" in done.stderr
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr


@SHELL
@pytest.mark.parametrize(
    ("words", "streams", "code", "told"),
    [
        ("examples nothing", "2>&-", 2, ""),
        ("examples nothing", ">&- 2>&-", 2, ""),
        ("examples", ">&-", 0, ""),
        ("--help", ">&- 2>&-", 0, ""),
        ("--nothing", ">&-", 2, "Usage: "),
        pytest.param("examples nothing", "2>/dev/full", 2, "", marks=FULL),
        pytest.param("examples", "2>/dev/full", 0, "andrews-mechanism", marks=FULL),
        pytest.param("--nothing", "2>/dev/full", 2, "", marks=FULL),
        pytest.param("examples", ">/dev/full 2>&1", 2, "", marks=FULL),
        pytest.param("examples", ">/dev/full 2>&-", 2, "", marks=FULL),
    ],
)
def test_streams_that_are_closed_or_full(words: str, streams: str, code: int, told: str) -> None:
    """The exit code is that of the work, or of the output that is lost; nothing is printed about the streams."""
    command = f'"{sys.executable}" -m centrode --lang en {words} {streams}'
    done = subprocess.run(command, shell=True, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == code
    assert (done.stdout + done.stderr).startswith(told)
    assert told or done.stdout + done.stderr == ""


TELLING = """
import os, sys
from centrode.cli import main as command_line, output
import click
def work():
    output.tell("a note")
    click.echo("result")
command_line.COMMANDS = (click.Command("work", callback=work),)
sys.exit(command_line.main(["work"]))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no such pipes")
def test_notes_that_nobody_reads_are_no_failure() -> None:
    """The reader of stderr is gone before anything is written; the work is done all the same."""
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, "-c", TELLING], stdout=subprocess.PIPE, stderr=writer, encoding="utf-8", check=False
    )
    os.close(writer)
    assert (done.returncode, done.stdout) == (0, "result\n")


@pytest.mark.skipif(sys.platform == "win32", reason="no such pipes")
def test_a_reader_that_is_gone_before_the_first_line() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, "-m", "centrode", "examples"],
        stdout=writer, stderr=subprocess.PIPE, encoding="utf-8", check=False,
    )  # fmt: skip
    os.close(writer)
    assert (done.returncode, done.stderr) == (command_line.READER_GONE, "")


@pytest.mark.skipif(sys.platform == "win32", reason="no such pipes")
@pytest.mark.parametrize(("words", "stream", "code"), [("", "stdout", 2), ("nothing", "stderr", 2)])
def test_a_pipe_that_is_full_and_does_not_wait(words: str, stream: str, code: int) -> None:
    """Nobody reads, and the pipe refuses instead of waiting: a message where one can be read, and no traceback."""
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    with pytest.raises(BlockingIOError):
        while True:
            os.write(writer, bytes(512))
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, stream: writer}
    # without its buffer Python loses what such a pipe refuses, and says nothing
    buffered = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    done = subprocess.run(
        [sys.executable, "-m", "centrode", "--lang", "en", "examples", *words.split()],
        env=buffered, encoding="utf-8", check=False, **streams,
    )  # fmt: skip
    os.close(writer)
    os.close(reader)
    assert done.returncode == code
    told = "" if stream == "stderr" else "Error: the operating system refused: "
    assert ((done.stdout or "") + (done.stderr or "")).startswith(told)
    assert "Traceback" not in f"{done.stderr}"


def test_an_announcement_that_nobody_can_read_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a long run announces on stderr is no reason to fail where that is full."""

    class Full(io.StringIO):
        def write(self, text: str) -> int:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(sys, "stderr", Full())
    announce_turns(1e3)
    announce_samples(1_000_000)
