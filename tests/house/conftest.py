from __future__ import annotations

import gettext
import os
import subprocess
import sys
from collections.abc import Callable, Iterator

import pytest

from centrode.cli.main import main
from centrode.locale import choose_language

Run = Callable[..., subprocess.CompletedProcess[str]]
SPEECH = ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG")


@pytest.fixture
def process() -> Run:
    """Run `centrode ARGUMENTS` in a process of its own, in English unless the environment given says otherwise."""

    def run(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        base = {name: value for name, value in os.environ.items() if name not in SPEECH}
        return subprocess.run(
            [sys.executable, "-m", "centrode", *arguments],
            env={**base, "PYTHONIOENCODING": "utf-8", **environment},
            capture_output=True,
            encoding="utf-8",
            check=False,
        )

    return run


@pytest.fixture
def centrode(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Iterator[Run]:
    """The same in this process: language, environment and gettext's domain are afterwards what they were."""
    domain = gettext.textdomain()

    def run(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        for (
            name
        ) in SPEECH:  # set before it is deleted, so that it is put back although the command sets it too
            monkeypatch.setenv(name, "")
            monkeypatch.delenv(name)
        for name, value in {"COLUMNS": "80", **environment}.items():  # as wide as help is without a terminal
            monkeypatch.setenv(name, value)
        capsys.readouterr()
        code = main(list(arguments))
        printed = capsys.readouterr()
        return subprocess.CompletedProcess(arguments, code, printed.out, printed.err)

    yield run
    gettext.textdomain(domain)
    choose_language("en")
