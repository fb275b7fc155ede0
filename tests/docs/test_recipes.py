"""What the page of recipes says is done in a copy of the package, and its commands run there."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import centrode as ct

PAGE = Path(__file__).parents[2] / "docs" / "recipes.md"
BLOCK = re.compile(r"```\{code-block\} (\w+)\n(?::caption: ([^\n]+)\n)?\n?(.*?)```", re.DOTALL)
PLACE = re.compile(r'(\S+), (before|behind) "(.*)"$')
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
        at = old.index(line) if where == "before" else old.index("\n", old.index(line)) + 1
        (root / file).write_text(old[:at] + body + old[at:], encoding="utf-8")
    return commands


@pytest.mark.parametrize("name", RECIPES)
def test_a_recipe_is_complete(name: str, tmp_path: Path) -> None:
    package = Path(ct.__file__).parent
    # with what Python has compiled: a changed module is compiled anew by its time, the others are not
    shutil.copytree(package, tmp_path / "src" / "centrode")
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "src"), "LANG": "C.UTF-8", "MPLBACKEND": "agg"}
    commands = follow(RECIPES[name], tmp_path)
    assert commands
    for block in commands:
        for said in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            line, _newline, printed = said.partition("\n")
            program, *arguments = shlex.split(line)
            start = [sys.executable] if program == "python" else [sys.executable, "-m", "centrode"]
            done = subprocess.run(
                [*start, *arguments],
                cwd=tmp_path,
                env=environment,
                capture_output=True,
                text=True,
                check=False,
            )
            assert done.returncode == 0, done.stderr
            assert not printed or done.stdout.rstrip("\n") == printed.rstrip("\n")
