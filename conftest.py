"""Settings of all tests: hypothesis repeats itself, and the code blocks of the documentation are run."""

from __future__ import annotations

import doctest
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, settings
from sybil import Example, Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser

import centrode as ct
from centrode.model.description import Description

settings.register_profile(
    "house", derandomize=True, deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile(
    "explore", parent=settings.get_profile("house"), derandomize=False, max_examples=2000
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "house"))

LOOSELY = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
FILE_NAME = re.compile(r"# ([\w-]+\.toml)\n")


def run_console(example: Example) -> None:
    """Run the `$ centrode ...` lines of a console block and compare what they print with the lines below.

    A command may end in `# exit N`; `...` stands for anything, runs of blanks are alike. A command with
    nothing below it may print what it likes.
    """
    for part in re.split(r"^\$ ", example.parsed, flags=re.MULTILINE)[1:]:
        line, _end, printed = part.partition("\n")
        command, _sign, expected = line.partition("# exit ")
        assert command.startswith("centrode "), f"only centrode is run here, not {command}"
        done = subprocess.run(
            command.replace("centrode", f'"{sys.executable}" -m centrode', 1),
            shell=True, capture_output=True, text=True, encoding="utf-8", check=False,
            env={**os.environ, "LANGUAGE": "en"},
        )  # fmt: skip
        told = done.stdout + done.stderr
        assert done.returncode == int(expected or 0), f"{command}\n{told}"
        agrees = doctest.OutputChecker().check_output(printed.strip() + "\n", told.strip() + "\n", LOOSELY)
        assert agrees or not printed.strip(), f"{command}\n{told}"


def read_toml(example: Example) -> None:
    """Read a TOML block: a whole mechanism (it has a drive) has to assemble, a cam to have a path; of others each part.

    A block that begins with `# NAME.toml` is written to that file, for the blocks after it; a study of `sweep` may
    stand there too.
    """
    text = str(example.parsed)
    named = FILE_NAME.match(text)
    if named:
        Path(named.group(1)).write_text(text, encoding="utf-8")
    tables = tomllib.loads(text)
    if named and "mechanism" in tables:
        ct.read_sweep(named.group(1))
        return
    if tables.get("kind") == "cam":
        cam = ct.parse_cam(text)
        assert ct.parse_cam(ct.cam_text(cam)) == cam
        ct.cam(cam, samples=2)
        return
    if not {"links", "drives"} <= tables.keys():
        Description(**{"links": {}, **tables})
        return
    mechanism = ct.parse_mechanism(text)
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
    ct.check(mechanism)


def enter_folder(namespace: dict[str, Any]) -> None:
    namespace["_home"], namespace["_folder"] = Path.cwd(), tempfile.mkdtemp()
    os.chdir(namespace["_folder"])


def leave_folder(namespace: dict[str, Any]) -> None:
    os.chdir(namespace["_home"])
    shutil.rmtree(namespace["_folder"], ignore_errors=True)


pytest_collect_file = Sybil(
    parsers=[
        PythonCodeBlockParser(),
        CodeBlockParser("console", run_console),
        CodeBlockParser("toml", read_toml),
    ],
    patterns=["README.md", "docs/*.md", "docs/**/*.md"],
    setup=enter_folder,
    teardown=leave_folder,
).pytest()
