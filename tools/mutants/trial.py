"""A mutant is tried: its source put into a copy of the tree, and the test files that call it run until one fails."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tools.mutants import reach as reach_plugin
from tools.mutants.mutation import Mutant
from tools.mutants.reach import FOLDER, Reach

ROOT = Path(__file__).parents[2]
PARTS = (
    "src", "tests", "docs", "tools", "benchmarks", "conftest.py", "pyproject.toml", "Makefile", "README.md",
    "CHANGELOG.md", "CITATION.cff",
)  # fmt: skip
FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+)", re.MULTILINE)
PATIENCE = 6.0
"""How many times as long as without a fault tests may take, before they count as hanging."""
START = 60.0
"""Time allowed for a start of pytest [s]."""


@dataclass(frozen=True)
class Verdict:
    """What became of a mutant: `killed` by a test, or not (`survived`), or no test file calls it (`untouched`)."""

    word: str
    by: str
    files: int
    seconds: float

    def plain(self) -> dict[str, Any]:
        """The verdict as JSON has it."""
        return {"verdict": self.word, "by": self.by, "files": self.files, "seconds": round(self.seconds, 1)}


@dataclass(frozen=True)
class Tree:
    """A copy of the sources and tests in a folder of its own."""

    folder: Path

    @classmethod
    def make(cls, folder: Path, revision: str | None) -> Tree:
        """A copy of the working tree, or of a revision of it."""
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        if revision is None:
            for part in PARTS:
                source = ROOT / part
                if source.is_dir():
                    ignored = shutil.ignore_patterns("__pycache__", "_build")
                    shutil.copytree(source, folder / part, ignore=ignored)
                elif source.exists():
                    shutil.copy2(source, folder / part)
        else:
            packed = subprocess.run(
                ["git", "-C", str(ROOT), "archive", revision], capture_output=True, check=True
            )
            subprocess.run(["tar", "-x", "-C", str(folder)], input=packed.stdout, check=True)
        return cls(folder)

    @property
    def package(self) -> Path:
        return self.folder / "src" / "centrode"

    def fingerprint(self) -> str:
        """Of the package and its tests: verdicts of two states are not mixed."""
        found = hashlib.sha256()
        for part in ("src", "tests"):
            for file in sorted((self.folder / part).rglob("*.py")):
                found.update(file.relative_to(self.folder).as_posix().encode() + b"\0" + file.read_bytes())
        return found.hexdigest()

    def pytest(
        self, words: Sequence[str], limit: float | None = None, reach: Path | None = None
    ) -> tuple[int, str]:
        """Run pytest in the copy; returns its exit code and what it printed, -1 where it took too long."""
        environment = {**os.environ, "PYTHONPATH": str(self.folder / "src"), "PYTHONDONTWRITEBYTECODE": "1"}
        if reach is not None:
            environment[FOLDER] = str(reach)
            # the plugin is this tree's, also where a revision is tried that has none; `tools` stays the copy's
            environment["PYTHONPATH"] += os.pathsep + str(Path(__file__).parent)
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *words]
        with subprocess.Popen(
            command, cwd=self.folder, env=environment, text=True, encoding="utf-8",
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True,
        ) as running:  # fmt: skip
            try:
                told, _errors = running.communicate(timeout=limit)
            except subprocess.TimeoutExpired:
                os.killpg(running.pid, 9)  # with the processes that its tests have started
                running.communicate()
                return -1, ""
        return running.returncode, told


def watch_tests(tree: Tree, folder: Path, words: Sequence[str]) -> Reach:
    """Which functions each test file calls, by one run of the tests without a fault."""
    shutil.rmtree(folder, ignore_errors=True)
    code, told = tree.pytest(["-p", Path(reach_plugin.__file__).stem, *words], reach=folder)
    if code != 0:
        shutil.rmtree(folder, ignore_errors=True)
        raise RuntimeError(f"the tests fail without a fault:\n{told[-3000:]}")
    return Reach.read(folder)


def try_mutant(tree: Tree, mutant: Mutant, reach: Reach, most: float) -> Verdict:
    """Run the test files that call the function with a fault, the cheapest first, until one test fails.

    Files are left out from the one on with which they would cost more than `most` seconds without a fault.
    """
    began = time.monotonic()
    function = mutant.function.removesuffix(".<locals>")
    files: list[str] = []
    cost = 0.0
    for name in reach.files(mutant.file, function):
        cost += reach.seconds[name]
        if files and cost > most:
            break
        files.append(name)
    if not files:
        return Verdict("untouched", "", 0, 0.0)
    source = tree.package / mutant.file
    content = source.read_bytes()
    try:
        source.write_bytes(mutant.source(content))
        limit = START + PATIENCE * min(cost, most)
        code, told = tree.pytest(["-x", "-n", "0", *files], limit)
    finally:
        source.write_bytes(content)
    seconds = time.monotonic() - began
    if code == 0:
        return Verdict("survived", "", len(files), seconds)
    failed = FAILED.search(told)
    by = "time" if code == -1 else failed.group(1) if failed else f"exit code {code}"
    return Verdict("killed", by, len(files), seconds)
