"""The program: at the same port again, with nothing left of it when it ends."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from centrode.app import service
from centrode.app.service import LOOPBACK, bound_socket, work_folder_of
from centrode.errors import InputError

from .served import free_port

BUSY = """
import multiprocessing
from centrode.app import workers

class Busy:
    def __init__(self, work):
        pass

    def answer(self, message):
        print("busy", flush=True)
        while True:
            pass

def serve(connection):
    workers.WORKBENCH = Busy
    workers.serve_messages(connection, None)

if __name__ == "__main__":
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    here, there = context.Pipe()
    process = context.Process(target=serve, args=(there,), daemon=True)
    process.start()
    here.send_bytes(b"{}")
    process.join()
"""
"""A server whose process computes without end."""
LONGEST = 120.0
"""Seconds after which what has not ended is a failure."""


def begun(arguments: list[str], folder: Path, **environment: str) -> subprocess.Popen[str]:
    """A program of its own, and all that it starts, which write into its pipes."""
    return subprocess.Popen(
        [sys.executable, *arguments],
        cwd=folder,
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
            **environment,
        },
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def port_of(listener: socket.socket) -> int:
    return int(listener.getsockname()[1])


def test_a_server_has_the_usual_port_and_the_next_one_the_next(monkeypatch: pytest.MonkeyPatch) -> None:
    first = free_port()
    monkeypatch.setattr(service, "PORTS", (first,))
    with bound_socket() as one, bound_socket() as other:
        assert port_of(one) == first != port_of(other)  # all usual ones are taken: any
        with pytest.raises(InputError, match=str(first)):
            bound_socket(first)
    with bound_socket() as again:
        assert port_of(again) == first


@pytest.mark.parametrize(
    ("name", "message"),
    [
        (
            "nofolder",
            "nofolder: there is no such folder, and no such file; make the folder first, or end the name of a new "
            "file in .toml",
        ),
        (
            "crank-rocker",
            "crank-rocker: there is no such folder, and no such file; write the built-in mechanism first: "
            "centrode examples crank-rocker --out crank-rocker.toml",
        ),
        ("nofolder/press.toml", "nofolder: there is no such folder; check the path"),
    ],
)
def test_a_folder_that_is_not_there_is_refused_before_anything_is_served(
    name: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError) as refusal:
        work_folder_of(Path(name))
    assert str(refusal.value) == message.replace("/", os.sep)
    assert refusal.value.exit_code == 2
    (tmp_path / "nofolder").mkdir()
    assert work_folder_of(Path("nofolder")).folder == (tmp_path / "nofolder").resolve()


def test_a_folder_that_cannot_be_read_is_refused_by_its_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert work_folder_of(tmp_path).names() == []

    def shut(_folder: Path) -> None:
        raise PermissionError(13, "Permission denied")

    with monkeypatch.context() as patch, pytest.raises(InputError) as refusal:
        patch.setattr(os, "scandir", shut)
        work_folder_of(tmp_path)
    assert refusal.value.where == str(tmp_path.resolve())
    assert "Permission denied" in refusal.value.what and refusal.value.repair == "check the path"


@pytest.mark.skipif(os.name != "posix", reason="Windows frees ports at once")
def test_the_port_of_a_server_that_has_just_ended_is_free() -> None:
    with bound_socket(0) as listener:
        port = port_of(listener)
        with socket.create_connection((LOOPBACK, port)) as browser:
            accepted, _address = listener.accept()
            accepted.close()  # who closes first keeps the port for a while
            assert browser.recv(1) == b""
    with bound_socket(port) as again:
        assert port_of(again) == port


def test_what_computes_ends_with_a_server_that_is_killed(tmp_path: Path) -> None:
    (tmp_path / "busy.py").write_text(BUSY, "utf-8")
    with begun(["busy.py"], tmp_path) as server:
        assert server.stdout is not None and server.stdout.readline() == "busy\n"
        server.kill()
        # the pipe ends when the last process that holds it has ended
        assert server.communicate(timeout=LONGEST) == ("", "")


@pytest.mark.skipif(os.name != "posix", reason="Windows has no groups of processes to interrupt")
def test_an_interrupt_ends_the_command_without_a_word(tmp_path: Path) -> None:
    with begun(["-m", "centrode", "app", "--no-browser", "--port", "0"], tmp_path) as command:
        assert command.stdout is not None
        address = command.stdout.readline().split()[-1]
        assert "Ctrl-C" in command.stdout.readline()
        # it answers; what computes still loads its libraries then
        with urllib.request.urlopen(address, timeout=LONGEST) as page:
            assert page.status == 200
        os.killpg(command.pid, signal.SIGINT)
        out, err = command.communicate(timeout=LONGEST)
        assert (command.returncode, out, err) == (0, "", "")


LOOKED = """#!/bin/sh
echo "$@" > "$0.part"
mv "$0.part" "$0.arguments"
"""


@pytest.mark.skipif(os.name != "posix", reason="the browser of this test is a script of a shell")
def test_what_starts_the_browser_is_good_once_and_does_not_hold_the_token(tmp_path: Path) -> None:
    """Every user of a machine can read the arguments of a browser."""
    program = tmp_path / "browser"
    program.write_text(LOOKED, "utf-8")
    program.chmod(0o755)
    arguments = program.with_name("browser.arguments")
    with begun(["-m", "centrode", "app", "--port", "0"], tmp_path, BROWSER=f"{program} %s") as command:
        assert command.stdout is not None
        printed = command.stdout.readline().split()[-1]
        token = printed.partition("token=")[2]
        assert len(token) >= 32
        until = time.monotonic() + LONGEST
        while not arguments.exists() and time.monotonic() < until:
            time.sleep(0.05)
        opened = arguments.read_text("utf-8").strip()
        assert opened.startswith("http://127.0.0.1:") and token not in opened
        with urllib.request.urlopen(opened, timeout=LONGEST) as page:
            assert token in page.read().decode()
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(opened, timeout=LONGEST)
        with urllib.request.urlopen(printed, timeout=LONGEST) as page:  # as often as one likes
            assert page.status == 200
        command.terminate()
        command.communicate(timeout=LONGEST)
