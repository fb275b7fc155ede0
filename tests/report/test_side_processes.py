"""Work of reports in other processes: what it makes, how it fails, warns and ends are those of one process."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct
from centrode.cli.main import main
from centrode.errors import InputError
from centrode.render.document import chapters
from centrode.report import document as report_document
from centrode.report import side_processes
from centrode.report.files import document
from centrode.report.side_processes import begin
from centrode.report.study import ReportOptions

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only there processes are forked")

HERE = os.getpid()
DRAWN = ReportOptions(chapters=("structure", "plots", "positions"))


@pytest.fixture
def several(monkeypatch: pytest.MonkeyPatch) -> None:
    """Processes, though tests before have loaded typst: nothing that is begun here uses it."""
    monkeypatch.setattr(side_processes, "_may_fork", lambda: True)


def is_here() -> bool:
    return os.getpid() == HERE


@pytest.mark.usefixtures("several")
def test_more_work_than_processes_gives_each_its_result() -> None:
    with side_processes.side_processes(2):
        begun = [begin(lambda k=k: (k, os.getpid(), "x" * 200_000)) for k in range(7)]  # type: ignore[misc]
        made = [one.result() for one in begun]
        assert [one.result() for one in begun] == made
    assert [k for k, _process, _text in made] == list(range(7))
    assert made[0][1] != HERE
    assert len({process for _k, process, _text in made}) > 2


def fail() -> bool:
    raise InputError("figure", "no ink", "buy some")


def die() -> bool:
    if not is_here():
        os.kill(os.getpid(), signal.SIGKILL)
    return True


def nothing_to_send() -> Callable[[], bool]:
    return lambda: is_here()


@pytest.mark.usefixtures("several")
def test_a_failure_is_that_of_one_process() -> None:
    with side_processes.side_processes(1), pytest.raises(InputError) as failure:
        begin(fail).result()
    assert str(failure.value) == "figure: no ink; buy some"
    assert failure.traceback[-1].name == "fail"


@pytest.mark.usefixtures("several")
def test_a_warning_is_told_here() -> None:
    with side_processes.side_processes(1):
        begun = begin(lambda: warnings.warn("pale", RuntimeWarning, stacklevel=1))
        with pytest.warns(RuntimeWarning, match="pale"):
            begun.result()


@pytest.mark.usefixtures("several")
def test_what_is_killed_or_cannot_be_sent_is_made_here() -> None:
    with side_processes.side_processes(1):
        assert begin(die).result()
        assert begin(nothing_to_send).result()()


@pytest.mark.usefixtures("several")
def test_what_nobody_waits_for_is_ended() -> None:
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt), side_processes.side_processes(1):
        begun = begin(lambda: time.sleep(600))
        raise KeyboardInterrupt
    assert begun.process is not None
    assert begun.process.exitcode == -signal.SIGKILL
    assert time.monotonic() - start < 300


@pytest.mark.parametrize("most", [0, None])
def test_without_other_processes_work_is_done_here_in_its_turn(
    most: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    if most is None:
        monkeypatch.setattr(side_processes, "_may_fork", lambda: False)
    done: list[int] = []
    with side_processes.side_processes(most):
        assert not side_processes.has_side_processes()
        begun = begin(lambda: done.append(os.getpid()))
        assert done == []
        begun.result()
    assert done == [HERE]


@pytest.mark.drawn
@pytest.mark.usefixtures("several")
@pytest.mark.parametrize("language", ["ru", "uk"])
def test_a_report_of_several_processes_has_the_bytes_of_one(language: str) -> None:
    said: dict[int, list[tuple[str, int, int]]] = {0: [], 1: []}
    mechanism, pages = ct.example("six-bar-press"), []
    for most in (0, 1):
        with side_processes.side_processes(most):
            made = ct.report(mechanism, DRAWN, language=language, said=lambda *one: said[most].append(one))  # noqa: B023
        assert not any(chapter.missing for chapter in made.chapters)
        pages.append([document(made, kind) for kind in ("html", "pdf")])
    assert pages[0] == pages[1]
    assert said[0] == said[1]
    assert len(said[0]) == len(DRAWN.chapters or ())


@pytest.mark.usefixtures("several")
def test_a_figure_that_fails_is_told_in_the_same_words(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_picture(*_figure: Any, **_options: Any) -> Any:
        raise InputError("figure", "no ink", "buy some")

    monkeypatch.setattr(chapters, "picture", no_picture)
    monkeypatch.setattr(report_document, "opening_of", lambda *_study: ())
    told = []
    for most in (0, 1):
        with side_processes.side_processes(most):
            made = ct.report(ct.example("crank-rocker"), ReportOptions(chapters=("structure", "plots")))
        told.append([(chapter.name, chapter.missing) for chapter in made.chapters])
    assert told[0] == told[1] == [("structure", ""), ("plots", "figure: no ink; buy some")]


@pytest.mark.usefixtures("several")
def test_a_fault_stays_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_figure: Any, **_options: Any) -> Any:
        raise RuntimeError("broken")

    monkeypatch.setattr(chapters, "picture", broken)
    with side_processes.side_processes(1), pytest.raises(RuntimeError, match="broken"):
        ct.report(ct.example("crank-rocker"), ReportOptions(chapters=("plots",)))


@pytest.mark.drawn
def test_the_command_writes_the_bytes_of_one_process(tmp_path: Path) -> None:
    # the command has a process of its own and begins others; where another program calls it there are none
    arguments = ["report", "crank-rocker", "--chapters", "structure,plots", "--lang", "uk", "--out"]
    own = subprocess.run(
        [sys.executable, "-m", "centrode", *arguments, str(tmp_path / "own")], capture_output=True, check=True
    )
    assert own.stderr == b""
    assert main([*arguments, str(tmp_path / "called")]) == 0
    for name in ("report.html", "report.pdf"):
        assert (tmp_path / "own" / name).read_bytes() == (tmp_path / "called" / name).read_bytes()
