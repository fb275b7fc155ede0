"""Which functions of the package each test file calls, and what the file costs: a plugin of pytest that watches.

`python -m pytest -p reach`, with this folder on the path, writes one file a process into the folder that
`CENTRODE_REACH` names.
"""

from __future__ import annotations

import importlib.util
import json
import os
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, Self

import pytest

FOLDER = "CENTRODE_REACH"


@dataclass
class Reach:
    """Functions `file:qualified.name` by test file, and processor time by test file [s]."""

    functions: dict[str, set[str]] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)

    @classmethod
    def read(cls, folder: Path) -> Self:
        """What all processes wrote."""
        found = cls()
        for file in sorted(folder.glob("reach-*.json")):
            for name, part in json.loads(file.read_text(encoding="utf-8")).items():
                found.functions.setdefault(name, set()).update(part["functions"])
                found.seconds[name] = found.seconds.get(name, 0.0) + part["seconds"]
        return found

    def files(self, source: str, function: str) -> list[str]:
        """Test files that call a function, the cheapest first; those that call anything of its file where none does."""
        named = [name for name, known in self.functions.items() if f"{source}:{function}" in known]
        if not named:
            beginning = f"{source}:"
            named = [n for n, known in self.functions.items() if any(f.startswith(beginning) for f in known)]
        return sorted(named, key=lambda name: (self.seconds[name], name))


class Watcher:
    """Keeps the code that runs, for the test file that runs it."""

    def __init__(self, folder: Path) -> None:
        found = importlib.util.find_spec("centrode")
        assert found is not None and found.origin is not None
        self.folder, self.package = folder, Path(found.origin).parent
        self.codes: set[CodeType] = set()
        self.reach = Reach()

    def trace(self, frame: FrameType, _event: str, _argument: Any) -> None:
        """Called at every call; returns nothing, so that lines are not watched."""
        self.codes.add(frame.f_code)

    def watch(self, path: Path, root: Path) -> Iterator[None]:
        """Everything that is called meanwhile belongs to a test file."""
        began, self.codes = time.process_time(), set()
        before = sys.gettrace()
        threading.settrace(self.trace)
        sys.settrace(self.trace)
        yield
        sys.settrace(before)
        threading.settrace(before)
        name = path.relative_to(root).as_posix() if path.is_relative_to(root) else str(path)
        known = self.reach.functions.setdefault(name, set())
        for code in self.codes:
            source = Path(code.co_filename)
            if source.is_relative_to(self.package):
                # a comprehension or lambda belongs to the function around it
                function = code.co_qualname.split(".<locals>.<")[0]
                known.add(f"{source.relative_to(self.package).as_posix()}:{function}")
        spent = time.process_time() - began
        self.reach.seconds[name] = self.reach.seconds.get(name, 0.0) + spent

    def write(self) -> None:
        """Leave what was seen in a file of this process."""
        self.folder.mkdir(parents=True, exist_ok=True)
        plain = {
            name: {"functions": sorted(known), "seconds": self.reach.seconds[name]}
            for name, known in self.reach.functions.items()
        }
        (self.folder / f"reach-{os.getpid()}.json").write_text(json.dumps(plain), encoding="utf-8")

    @pytest.hookimpl(hookwrapper=True)
    def pytest_make_collect_report(self, collector: pytest.Collector) -> Iterator[None]:
        """Mechanisms that a test file names as parameters are read while it is collected."""
        yield from self.watch(Path(collector.path), Path(collector.config.rootpath))

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """A test with its fixtures."""
        yield from self.watch(Path(item.path), Path(item.config.rootpath))

    def pytest_sessionfinish(self) -> None:
        """All tests of this process have run."""
        self.write()


def pytest_configure(config: pytest.Config) -> None:
    """Watch, where a folder is named."""
    folder = os.environ.get(FOLDER)
    if folder:
        config.pluginmanager.register(Watcher(Path(folder)))
