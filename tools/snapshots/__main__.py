"""Digests of what the program gives: `python -m tools.snapshots write`, `check`, `texts FOLDER`.

`write` makes the record, `check` compares with it (exit code 1 at a difference). `texts` writes what every example
gives as plain text into a folder, so that two trees can be compared with diff. Another tree is taken with
PYTHONPATH=OTHER/src.
"""

from __future__ import annotations

import argparse
import collections
import functools
import multiprocessing
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TypeVar

from tools.snapshots.artefacts import TOLERANCE
from tools.snapshots.cases import RECORDED
from tools.snapshots.comparison import BITS, DIFFERS, compare
from tools.snapshots.record import FOLDER, read_record
from tools.snapshots.runs import of_commands, subject_digests, subjects, write_digests, write_texts

INTERRUPTED = 130
Answer = TypeVar("Answer")


def main(words: Sequence[str] | None = None) -> int:
    """Do what the words of the command line say; returns the exit code."""
    given = _parsed(words)
    known = subjects() if given.task == "texts" else list(RECORDED)
    unknown = [name for name in given.only if name not in known]
    if unknown:
        print(f"unknown: {', '.join(unknown)}; there are {', '.join(known)}", file=sys.stderr)
        return 2
    chosen = [name for name in known if name in given.only] or known
    try:
        return int({"write": _write, "check": _check, "texts": _texts}[given.task](given, chosen))
    except KeyboardInterrupt:
        return INTERRUPTED


def _parsed(words: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tools.snapshots", description=__doc__)
    parser.add_argument("task", choices=("write", "check", "texts"))
    parser.add_argument("folder", nargs="?", type=Path, help="of `texts`: where they are written")
    parser.add_argument(
        "--only",
        nargs="+",
        default=[],
        metavar="SUBJECT",
        help=f"{', '.join(RECORDED)}; `texts`: any example",
    )
    parser.add_argument(
        "--commands", nargs="+", default=[], metavar="COMMAND", help="of `check` and `texts`: only these"
    )
    parser.add_argument("--jobs", type=int, default=1, help="processes at once")
    parser.add_argument("--bits", action="store_true", help="of `check`: equal numbers are not enough")
    parser.add_argument(
        "--tolerance", type=float, default=TOLERANCE, help="of `check`: part of the scale of numbers"
    )
    parser.add_argument("--record", type=Path, default=FOLDER, help="folder of the record")
    given = parser.parse_args(words)
    if (given.task == "texts") != (given.folder is not None):
        parser.error("a folder belongs to `texts`, and to it alone")
    if given.task == "write" and given.commands:
        parser.error("a record holds every command")
    return given


def _write(given: argparse.Namespace, chosen: list[str]) -> int:
    write = functools.partial(write_digests, folder=given.record)
    for subject, count in _progress(write, chosen, given.jobs):
        print(f"{subject}: {count} artefacts", flush=True)
    return 0


def _check(given: argparse.Namespace, chosen: list[str]) -> int:
    counts: collections.Counter[str] = collections.Counter()
    digests_of = functools.partial(subject_digests, commands=given.commands)
    for subject, (digests, labels) in _progress(digests_of, chosen, given.jobs):
        recorded = {
            name: digest
            for name, digest in read_record(given.record, subject).items()
            if of_commands(name, given.commands)
        }
        for verdict in compare(recorded, digests, labels, given.tolerance):
            counts[verdict.kind] += 1
            if verdict.kind != BITS:
                print(f"{subject}/{verdict}", flush=True)
    print(", ".join(f"{kind}: {count}" for kind, count in sorted(counts.items())))
    unequal = sum(count for kind, count in counts.items() if kind != BITS)
    return 1 if counts[DIFFERS] or (given.bits and unequal) else 0


def _texts(given: argparse.Namespace, chosen: list[str]) -> int:
    write = functools.partial(write_texts, folder=given.folder.resolve(), commands=given.commands)
    for subject, count in _progress(write, chosen, given.jobs):
        print(f"{subject}: {count} texts", flush=True)
    return 0


def _progress(task: Callable[[str], Answer], chosen: list[str], jobs: int) -> Iterator[tuple[str, Answer]]:
    """What a task answers for each subject, in their order; on stderr how many are done."""
    with (
        multiprocessing.get_context("spawn").Pool(jobs, maxtasksperchild=None)
        if jobs > 1
        else Alone() as pool
    ):
        answers: Iterable[Answer] = pool.imap(task, chosen)
        for number, (subject, answer) in enumerate(zip(chosen, answers, strict=True), start=1):
            print(f"{number}/{len(chosen)} {subject}", file=sys.stderr, flush=True)
            yield subject, answer


class Alone:
    """In this process what a pool does in several."""

    def __enter__(self) -> Alone:
        return self

    def __exit__(self, *_failure: object) -> None:
        pass

    def imap(self, task: Callable[[str], Answer], chosen: list[str]) -> Iterator[Answer]:
        """The answers, one after the other."""
        return map(task, chosen)


if __name__ == "__main__":
    sys.exit(main())
