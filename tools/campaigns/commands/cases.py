"""One command line over one changed description, and what is asked of its ending."""

from __future__ import annotations

import contextlib
import io
import os
import random
import shlex
import tempfile
import time
from pathlib import Path

from centrode.cli.main import main
from tools.campaigns.campaign import Campaign, Outcome
from tools.campaigns.commands import inputs, lines, processes
from tools.campaigns.commands.processes import Ending

ORDERLY = (0, 2, 3)
SHOWN = 3000
PROCESSES = 0.03
"""Share of the cases that run as a terminal runs them."""


def drawn(seed: int, number: int) -> tuple[list[str], str, bytes, random.Random]:
    """Words of a command line, the name of its file and what stands in it."""
    draw = random.Random(f"{seed} {number}")
    path, command = draw.choice(list(lines.commands()))
    kind = lines.takes(command) or "linkage"
    if lines.takes_both(command) and draw.random() < 0.3:
        kind = "cam"
    if kind == "name":
        file, content = draw.choice(("crank-rocker", "nothing", "", "../x", "-", "given.toml")), b"x = 1\n"
    else:
        file, content = draw.choice(inputs.NAMES), inputs.content(draw, kind)
    names = inputs.names_in(content.decode(errors="replace"))
    words = [*path, *lines.words_of(draw, command, file, names)]
    return words, file, content, draw


def run(seed: int, number: int, here: bool = False) -> Outcome:
    """One command line in a folder of its own; `here` runs it within this process, without bounds."""
    words, file, content, draw = drawn(seed, number)
    outcome = Outcome(
        subject=f"centrode {shlex.join(words)}\n# {file!r}\n{content[:SHOWN].decode(errors='replace')}"
    )
    with tempfile.TemporaryDirectory() as top:
        folder, beside = Path(top) / "a" / "b" / "work", Path(top)
        (folder / "taken").mkdir(parents=True)
        (folder / "taken" / "file").write_bytes(b"kept\n")
        given = put(folder, file, content)
        before = content_of(folder)
        if here:
            ended = within(words, folder)
        else:
            ended = processes.ending(words, folder, beside, forked=draw.random() >= PROCESSES)
        outcome.subject += f"\n# exit {ended.code}\n{ended.said[-SHOWN:]}\n{ended.complained[-SHOWN:]}"
        judge(outcome, words, ended, before, content_of(folder), given)
    return outcome


def put(folder: Path, file: str, content: bytes) -> str | None:
    """Write the input where its name lets it be."""
    try:
        (folder / file).write_bytes(content)
    except (OSError, ValueError):
        return None
    return file


def content_of(folder: Path) -> dict[str, bytes]:
    """All files below a folder."""
    found = {}
    for parent, _folders, files in os.walk(folder):
        for name in files:
            file = Path(parent) / name
            found[file.relative_to(folder).as_posix()] = file.read_bytes()
    return found


def judge(
    outcome: Outcome,
    words: list[str],
    ended: Ending,
    before: dict[str, bytes],
    after: dict[str, bytes],
    given: str | None,
) -> None:
    """Hold the ending against what is promised of every command."""
    row = words[0]
    outcome.count(f"exit {ended.code}")
    outcome.measure(row, "seconds", round(ended.seconds, 1))
    first = ended.complained.strip().splitlines()[:1]
    if ended.code in processes.TOO_LONG:
        outcome.fault(f"{row}: more than {processes.SECONDS} s")
    elif ended.code not in ORDERLY:
        outcome.fault(f"{row}: exit {ended.code}: {first[0] if first else ''}")
    if "Traceback (most recent call last)" in ended.complained:
        outcome.fault(f"{row}: a traceback")
    if ended.code in (2, 3) and not ended.complained.strip():
        outcome.fault(f"{row}: exit {ended.code} without a word")
    allowed = "--force" in words
    for name, was in before.items():
        if name not in after:
            outcome.fault(f"{row}: {name!r} is gone")
        elif after[name] != was and (name == given or not allowed):
            outcome.fault(f"{row}: {name!r} was overwritten")
    if ended.code == 2 and set(after) - set(before):
        outcome.fault(f"{row}: refused (exit 2), yet left {sorted(set(after) - set(before))[:3]}")


def within(words: list[str], folder: Path) -> Ending:
    """The command in this process."""
    home, began = Path.cwd(), time.monotonic()
    said, complained = io.StringIO(), io.StringIO()
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
            code = main(words)
    finally:
        os.chdir(home)
    return Ending(code, said.getvalue(), complained.getvalue(), time.monotonic() - began)


CAMPAIGN = Campaign(
    name="commands",
    title="Commands",
    about=f"""Every command of the command line, with options drawn from what the program says of them, over built-in
descriptions, studies and tables that were changed at random: keys dropped and renamed, numbers replaced by zero, nan
and what is far too large, texts that are hostile, text cut and torn, binary and empty files, files with strange names.

Each command has to end with exit code 0, 2 or 3, with a message where it is not 0, without a traceback, within
{processes.SECONDS} s of processor time and {processes.GIBIBYTES} GiB of memory more than at its start. It must leave
its input and, without `--force`, every other file as it was; with exit code 2 it leaves nothing new.""",
    columns={"seconds": "the longest by the clock, on a machine with other work"},
    run=run,
    cases=20000,
    block=20,
)
