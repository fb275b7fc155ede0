"""What the page of recipes says is done in a copy of the package, and its commands run there."""

from __future__ import annotations

import functools
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from contextlib import closing
from math import acos, degrees
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct

PAGE = Path(__file__).parents[2] / "docs" / "recipes.md"
BLOCK = re.compile(r"```\{code-block\} (\w+)\n(?::caption: ([^\n]+)\n)?\n?(.*?)```", re.DOTALL)
PLACE = re.compile(r'(\S+), (before|behind|in place of) "(.*)"$')
RECIPES = dict(
    (part.partition("\n")[0], part)
    for part in re.split(r"^## ", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
)


def follow(text: str, root: Path) -> list[str]:
    """Write the files of a recipe and put its lines where they belong; the blocks of commands."""
    commands = []
    for language, caption, body in BLOCK.findall(text):
        if language == "console":
            commands.append(body)
            continue
        place = PLACE.match(caption)
        if place is None:
            assert not (root / caption).exists()
            (root / caption).write_text(body, encoding="utf-8")
            continue
        file, where, line = place.groups()
        old = (root / file).read_text(encoding="utf-8")
        if where == "in place of":
            assert old.count(line) == 1
            (root / file).write_text(old.replace(line, body.rstrip("\n")), encoding="utf-8")
            continue
        at = old.index(line) if where == "before" else old.index("\n", old.index(line)) + 1
        (root / file).write_text(old[:at] + body + old[at:], encoding="utf-8")
    return commands


WORKER = """\
import io, json, sys
from contextlib import redirect_stderr, redirect_stdout
import numpy as np
import centrode as ct
from centrode.cli.main import main

for line in sys.stdin:
    task, printed, code = json.loads(line), io.TextIOWrapper(io.BytesIO(), encoding="utf-8"), 0
    with redirect_stdout(printed), redirect_stderr(printed):
        if "expression" in task:
            mechanism, samples = ct.read_mechanism(task["file"]), task["samples"]
            print(json.dumps(np.asarray(eval(task["expression"])).tolist()))
        else:
            code = main(task["arguments"])
    printed.flush()
    print(json.dumps([code, printed.buffer.getvalue().decode("utf-8")]), flush=True)
"""


class Copy:
    """A copy of the package in a folder, in which recipes are followed and one process runs what they say."""

    def __init__(self, root: Path) -> None:
        package = Path(ct.__file__).parent
        # with what Python has compiled: a changed module is compiled anew by its time, the others are not
        shutil.copytree(package, root / "src" / "centrode")
        self.root = root
        self.environment = os.environ | {
            "PYTHONPATH": str(root / "src"),
            "LANG": "C.UTF-8",
            "LANGUAGE": "en",
            "MPLBACKEND": "agg",
        }

    @functools.cached_property
    def worker(self) -> subprocess.Popen[str]:
        """Runs commands and expressions one after the other: most of what a process takes is its start."""
        return subprocess.Popen(
            [sys.executable, "-c", WORKER],
            cwd=self.root,
            env=self.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )

    def close(self) -> None:
        """End the process, where there is one."""
        if "worker" in vars(self):
            self.worker.communicate()

    def ask(self, **task: object) -> str:
        """What the process prints for a task."""
        assert self.worker.stdin is not None and self.worker.stdout is not None
        self.worker.stdin.write(json.dumps(task) + "\n")
        self.worker.stdin.flush()
        code, printed = json.loads(self.worker.stdout.readline())
        assert code == 0, printed
        return str(printed)

    def centrode(self, *arguments: str) -> str:
        """What the command prints for these arguments."""
        return self.ask(arguments=arguments)

    def python(self, *arguments: str) -> str:
        """What Python prints for these arguments, in a process of its own."""
        done = subprocess.run(
            [sys.executable, *arguments],
            cwd=self.root,
            env=self.environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    def compute(self, file: str, samples: int, expression: str) -> npt.NDArray[np.float64]:
        """An array by an expression of the `mechanism` of a file and of a number of `samples`."""
        return np.array(json.loads(self.ask(file=file, samples=samples, expression=expression)))


def transmission_angles_of_the_report(copy: Copy) -> None:
    """Those of a crank-rocker are extreme where the crank lies along the frame: by the law of cosines."""
    crank, coupler, rocker, frame = 1.0, 3.5, 3.0, 4.0
    cosines = [
        (coupler**2 + rocker**2 - base**2) / (2 * coupler * rocker) for base in (frame - crank, frame + crank)
    ]
    least = min(degrees(acos(abs(cosine))) for cosine in cosines)
    page = (copy.root / "transmission" / "report.html").read_text(encoding="utf-8")
    cells = [float(number) for number in re.findall(r">([\d.]+)</td>", page)]
    # the page prints five digits
    assert cells == pytest.approx([least, 90.0 - least], abs=0.5e-3)


def moment_and_energy_of_the_buffer(copy: Copy) -> None:
    """By the law of cosines; kinetic and stored energy together stay what they were."""
    stiffness, free, crank, frame, inertia, speed = 100.0, 1.5, 1.0, 2.0, 0.5, 3.0
    computed = copy.compute(
        "buffer.toml",
        37,
        "(lambda one: [*one.reduced_moment, *one.jumps])(ct.reduce(mechanism, samples=samples))",
    )
    moment, kinks = computed[:37], computed[37:]

    def length(angle: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.sqrt(crank**2 + frame**2 - 2 * crank * frame * np.cos(angle))

    angle = np.linspace(0.0, 2 * np.pi, 37)
    force = stiffness * np.maximum(free - length(angle), 0.0)
    expected = force * crank * frame * np.sin(angle) / length(angle)
    np.testing.assert_allclose(moment, expected, rtol=0, atol=1e-13 * stiffness)
    bend = acos((crank**2 + frame**2 - free**2) / (2 * crank * frame))
    np.testing.assert_allclose(kinks, [bend, 2 * np.pi - bend], rtol=1e-14)
    turned, rate = copy.compute(
        "buffer.toml", 37, "(lambda one: [one.drive_value[:, 0], one.drive_speed])(ct.simulate(mechanism))"
    )
    energy = inertia * rate**2 / 2 + stiffness * np.maximum(free - length(turned), 0.0) ** 2 / 2
    began = inertia * speed**2 / 2 + stiffness * (free - (frame - crank)) ** 2 / 2
    # steps are exact to 1e-9 of their own, and there are some hundred
    np.testing.assert_allclose(energy, began, rtol=1e-7)


def motion_of_the_boom(copy: Copy) -> None:
    """The closed form stands in the plan, and gives -s(t) exp(i t) with its derivatives."""
    time = np.linspace(0.0, 2 * np.pi, 9)
    stroke, turn = 0.5 + 0.1 * time, np.exp(1j * time)
    expected = [-stroke * turn, -(0.1 + 1j * stroke) * turn, -(0.2j - stroke) * turn]
    motion = copy.compute(
        "boom.toml",
        9,
        "(lambda motion: [motion[name].sel(point='A').transpose(..., 'axis').to_numpy() for name in"
        " ('position', 'velocity', 'acceleration')])(ct.motion(mechanism, samples=samples))",
    )
    np.testing.assert_allclose(motion[..., 0] + 1j * motion[..., 1], expected, rtol=0, atol=1e-14)
    assert "higher class" not in copy.centrode("check", "boom.toml")


TRUTHS: Mapping[str, Callable[[Copy], None]] = {
    "A chapter": transmission_angles_of_the_report,
    "A load": moment_and_energy_of_the_buffer,
    "A closed form of a group": motion_of_the_boom,
}


@pytest.mark.parametrize("name", RECIPES)
def test_a_recipe_is_complete(name: str, tmp_path: Path) -> None:
    copy = Copy(tmp_path)
    commands = follow(RECIPES[name], tmp_path)
    assert commands
    with closing(copy):
        for block in commands:
            for said in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
                line, _newline, printed = said.partition("\n")
                program, *arguments = shlex.split(line)
                output = (copy.python if program == "python" else copy.centrode)(*arguments)
                pattern = re.escape(printed.rstrip("\n")).replace(re.escape("..."), ".*")
                assert not printed or re.fullmatch(pattern, output.rstrip("\n"), re.DOTALL)
        if name in TRUTHS:
            TRUTHS[name](copy)


def test_truths_belong_to_recipes() -> None:
    assert TRUTHS.keys() <= RECIPES.keys()
