"""Settings of all tests: hypothesis repeats itself, and the code blocks of the documentation are run."""

from __future__ import annotations

import doctest
import functools
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
import traceback
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, nullcontext, redirect_stderr, redirect_stdout
from itertools import pairwise
from pathlib import Path
from typing import Any
from unittest import mock

import pytest
from hypothesis import HealthCheck, settings
from sybil import Document, Example, Region, Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser

import centrode as ct
from blank_canvas import blank_pictures, remember_mathematics
from centrode.animation import animate, cams
from centrode.cams.parameter_choice.search import choose_cam
from centrode.cli.main import main
from centrode.dynamics.simulation.routes import moves_freely
from centrode.locale import choose_language_of_process
from centrode.model.description import Description
from centrode.model.gear_pairs import GEAR_PAIRS
from centrode.model.gear_trains import GEAR_TRAINS
from centrode.sweeps.sweep import read_sweep
from centrode.synthesis.requests import SYNTHESES
from samples import few

# Matrices here are small, and a worker runs on every core: threads of the linear algebra would only wait for each
# other, at a hundred times the cost. It reads this as it is loaded, in workers and in the processes that tests start.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

settings.register_profile(
    "house",
    max_examples=few(30, 100),
    derandomize=True,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile(
    "explore", parent=settings.get_profile("house"), derandomize=False, max_examples=2000
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "house"))
remember_mathematics()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--blank", action="store_true", help="leave pictures blank in tests marked `drawn` too")


LOOSELY = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
OWN_PROCESS = ("README.md",)
"""Pages whose first command is started as a reader starts it, pictures and all; all others run here."""
FEW_FRAMES = {animate: ("FRAMES",), cams: ("FRAMES_OF_A_STEP", "FRAMES_OF_A_TURN")}
"""What `--animate` writes here where it would write 36 to 60; `centrode animate` is typed with its own numbers."""
FEW_DESIGNS = (3,)
"""How many points the front of a choice has here where it would have 15."""
FILE_NAME = re.compile(r"# ([\w-]+\.toml)\n")
ROW = re.compile(r"^\|.*\|$", re.MULTILINE)
COMMAND = re.compile(r"`(centrode [^`]+)`")
COMPLETE_TABLES = ("paths.md", "start.md")
"""Pages whose tables hold lines that can be typed as they are; in the tables of others FILE stands for a file."""


def run_console(example: Example) -> None:
    """Run the `$ centrode ...` lines of a console block and compare what they print with the lines below.

    A command may end in `# exit N`; `...` stands for anything, runs of blanks are alike. A command with
    nothing below it may print what it likes.
    """
    first = Path(example.path).name in OWN_PROCESS and not example.namespace.get("_started")
    for part in re.split(r"^\$ ", example.parsed, flags=re.MULTILINE)[1:]:
        line, _end, printed = part.partition("\n")
        command, _sign, expected = line.partition("# exit ")
        assert command.startswith("centrode "), f"only centrode is run here, not {command}"
        code, told = run_as_process(command) if first else run_here(command)
        first, example.namespace["_started"] = False, True
        assert code == int(expected or 0), f"{command}\n{told}"
        agrees = doctest.OutputChecker().check_output(printed.strip() + "\n", told.strip() + "\n", LOOSELY)
        assert agrees or not printed.strip(), f"{command}\n{told}"


def run_as_process(command: str) -> tuple[int, str]:
    """Exit code and output of a command line in a shell, in English."""
    done = subprocess.run(
        command.replace("centrode", f'"{sys.executable}" -m centrode', 1),
        shell=True, capture_output=True, text=True, encoding="utf-8", check=False,
        env={**os.environ, "LANGUAGE": "en"},
    )  # fmt: skip
    return done.returncode, done.stdout + done.stderr


@contextmanager
def few_frames() -> Iterator[None]:
    """Context in which animations have six frames."""
    with ExitStack() as stack:
        for module, names in FEW_FRAMES.items():
            stack.enter_context(mock.patch.multiple(module, **dict.fromkeys(names, 6)))
        yield


def run_here(command: str) -> tuple[int, str]:
    """What `run_as_process` returns, without the start of a process: about a second for each of a hundred commands.

    Pictures are written blank, animations and fronts are short, one process does the work of several: tests/cli and
    tests/render render pictures and start processes. The language and the environment are afterwards what they
    were. Words are split as a shell splits them; what a shell would do more than that is refused.
    """
    words = shlex.split(command, comments=True)
    unquoted = re.sub(r"'[^']*'|\"[^\"]*\"", "", command)
    assert not re.search(r"[|&;<>$`*?~\\]", unquoted), f"{command}: this page needs a shell, see OWN_PROCESS"
    streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8", newline="\n") for _stream in range(2)]
    with (
        few_frames() if "--animate" in words else nullcontext(),
        mock.patch.object(choose_cam, "__defaults__", FEW_DESIGNS),
        blank_pictures(),
        mock.patch.dict(os.environ, {"LANGUAGE": "en"}),
        redirect_stdout(streams[0]),
        redirect_stderr(streams[1]),
    ):
        try:
            code = main(["1" if option == "--jobs" else word for option, word in pairwise(words)])
        finally:
            choose_language_of_process("en")
    for stream in streams:
        stream.flush()
    return code, "".join(stream.buffer.getvalue().decode("utf-8") for stream in streams)


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
        read_sweep(named.group(1))
        return
    if "synthesis" in tables:
        SYNTHESES.parse(text, folder=Path.cwd())
        return
    if tables.get("kind") == "gear pair":
        pair = GEAR_PAIRS.parse(text)
        assert GEAR_PAIRS.parse(GEAR_PAIRS.text(pair)) == pair
        ct.gear_pair(pair)
        return
    if tables.get("kind") == "gear train":
        train = GEAR_TRAINS.parse(text)
        assert GEAR_TRAINS.parse(GEAR_TRAINS.text(train)) == train
        ct.gear_train(train)
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
    if moves_freely(mechanism):
        assert mechanism.simulation is not None
        ct.simulate(mechanism, mechanism.simulation.model_copy(update={"duration": 1e-3, "samples": 2}))
        return
    if not all(drive.has_law for drive in mechanism.drives):
        ct.equilibrium(mechanism)  # nothing says how it moves: it rests
        return
    ct.check(mechanism)


class PythonParser(PythonCodeBlockParser):
    """Blocks of Python: their pictures are blank and their animations short, as those of commands are."""

    def __call__(self, document: Document) -> Iterator[Region]:
        for region in super().__call__(document):
            evaluate = region.evaluator

            def run(example: Example, evaluate: Any = evaluate) -> str | None:
                with few_frames(), blank_pictures():
                    said: str | None = evaluate(example)
                return said

            region.evaluator = run
            yield region


def read_table_rows(document: Document) -> Iterator[Region]:
    """The commands that stand in a table, each as a console block of its own."""
    if Path(document.path).name in COMPLETE_TABLES:
        for row in ROW.finditer(document.text):
            for command in COMMAND.finditer(row.group()):
                place = row.start() + command.start()
                yield Region(place, place + len(command.group()), f"$ {command.group(1)}\n", run_console)


def write_table(example: Example) -> None:
    """Write a CSV block to the file that the text before it names last."""
    named = re.findall(r"`([\w-]+\.csv)`", example.document.text[: example.region.start])
    Path(named[-1]).write_text(example.parsed, encoding="utf-8")


def write_wrong_file(example: Example) -> None:
    """Write the wrong file of a block that says how it differs (-) from the right one (+), which is there."""
    wrong, right, *lines = str(example.parsed).splitlines()
    wrong, right = wrong.removeprefix("--- "), right.removeprefix("+++ ")
    before, after = (
        "".join(f"{line[1:]}\n" for line in lines if not line.startswith(sign)) for sign in ("+", "-")
    )
    text = Path(right).read_text(encoding="utf-8")
    assert text.count(after) == 1, f"{right} has not the lines {after}"
    Path(wrong).write_text(text.replace(after, before), encoding="utf-8")


def enter_folder(namespace: dict[str, Any]) -> None:
    namespace["_home"], namespace["_folder"] = Path.cwd(), tempfile.mkdtemp()
    os.chdir(namespace["_folder"])


def leave_folder(namespace: dict[str, Any]) -> None:
    os.chdir(namespace["_home"])
    shutil.rmtree(namespace["_folder"], ignore_errors=True)


def evaluate_or_tell(evaluate: Any, example: Example) -> str | None:
    """What an evaluator returns, or the text of its failure.

    Sybil cuts the frames of an exception's causes too, and ends the run where one of them has none of its own.
    """
    try:
        said: str | None = evaluate(example)
    except Exception:
        return traceback.format_exc()
    return said


def with_texts_of_failures(parser: Any) -> Any:
    """A parser of blocks whose failures are texts."""

    def parse(document: Document) -> Iterator[Region]:
        for region in parser(document):
            region.evaluator = functools.partial(evaluate_or_tell, region.evaluator)
            yield region

    return parse


pytest_collect_file = Sybil(
    parsers=[
        with_texts_of_failures(parser)
        for parser in (
            PythonParser(),
            CodeBlockParser("console", run_console),
            CodeBlockParser("toml", read_toml),
            CodeBlockParser("csv", write_table),
            CodeBlockParser("diff", write_wrong_file),
            read_table_rows,
        )
    ],
    patterns=["README.md", "docs/*.md", "docs/**/*.md", "docs/*/how-to/*.md"],
    setup=enter_folder,
    teardown=leave_folder,
).pytest()
