"""The command line in this process: a folder of its own, English, and what it said."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from blank_canvas import blank_pictures
from centrode.cli.main import main
from centrode.locale import choose_language
from computed_once import computed_once

FOUR_BAR = """\
title = "Press"
[frame.points]
O = [0, 0]
D = [4, 0]
[links.OA]
length = 1
[links.AB]
length = 3.5
[links.DB]
length = 3
[[drives]]
link = "OA"
start = 1
speed = 1
[assembly]
sides = { B = "left" }
"""


@dataclass(frozen=True)
class Done:
    """How a command ended and what it said."""

    code: int
    out: str
    err: str

    @property
    def rows(self) -> dict[str, str]:
        """Label and text of the rows of the table a command printed; rows without a label left out."""
        cut = (line.partition("  ") for line in self.out.splitlines())
        return {label: text.strip() for label, _gap, text in cut if label and text}


def inside(folder: Path) -> dict[str, str | None]:
    """Everything below a folder: path -> text of a small file."""
    return {
        str(path.relative_to(folder)): path.read_text(encoding="latin-1") if small(path) else None
        for path in sorted(folder.rglob("*"))
    }


def small(path: Path) -> bool:
    return path.is_file() and path.stat().st_size < 10_000


Centrode = Callable[..., Done]
Refused = Callable[..., str]


@pytest.fixture
def four_bar() -> str:
    return FOUR_BAR


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty current folder, English, no settings from outside."""
    for name in ("LC_ALL", "LC_MESSAGES", "LANG", "CENTRODE_DEBUG"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("LANGUAGE", "en")
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    choose_language("en")


@pytest.fixture(autouse=True)
def pictures(request: pytest.FixtureRequest) -> Iterator[None]:
    """Pictures are made but not rendered, except in tests marked `drawn`: some of each command, and all that look."""
    if request.node.get_closest_marker("drawn") and not request.config.getoption("--blank"):
        yield
        return
    with blank_pictures():
        yield


@pytest.fixture(autouse=True)
def shared() -> Iterator[None]:
    """What reports and variants compute of a mechanism is computed once for all tests."""
    with computed_once():
        yield


@pytest.fixture
def centrode(capsys: pytest.CaptureFixture[str]) -> Centrode:
    def run(*arguments: str | Path) -> Done:
        capsys.readouterr()
        code = main([str(argument) for argument in arguments])
        printed = capsys.readouterr()
        return Done(code, printed.out, printed.err)

    return run


@pytest.fixture
def refused(centrode: Centrode, folder: Path) -> Refused:
    """Run a description that must be refused (None: what stands there); returns the message without `Error: `."""

    def refuse(
        content: str | bytes | None, *arguments: str | Path, mechanism: str | Path = "press.toml"
    ) -> str:
        if content is not None:
            (folder / "press.toml").write_bytes(content.encode() if isinstance(content, str) else content)
        before = inside(folder)
        out = () if "--out" in arguments else ("--out", "result")
        done = centrode("run", mechanism, "--no-figures", *out, *arguments)
        assert done.code == 2, done
        assert done.out == ""
        assert done.err.startswith("Error: ")
        assert "Traceback" not in done.err
        assert inside(folder) == before
        return done.err.removeprefix("Error: ").rstrip("\n")

    return refuse
