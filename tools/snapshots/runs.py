"""Running a case: in this process, in a folder of its own; what it said and wrote becomes artefacts."""

from __future__ import annotations

import contextlib
import io
import os
import re
import tempfile
import warnings
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import centrode as ct
from centrode.cli.main import COMMANDS, main
from tools.snapshots.artefacts import Artefact, Digest
from tools.snapshots.cases import (
    BESIDE,
    EVERY_ROOM,
    LANGUAGES,
    RECORDED,
    Case,
    cam_cases,
    help_cases,
    linkage_cases,
    refusal_cases,
    study_cases,
)
from tools.snapshots.comparison import digests_of
from tools.snapshots.files import file_artefact, text_artefact
from tools.snapshots.record import write_record
from tools.snapshots.stand_ins import seen_instead_of_drawn

SETTINGS = ("LC_ALL", "LC_MESSAGES", "LANG", "CENTRODE_DEBUG", "COLUMNS")
VERSION = re.compile(rf"(?<![\w.]){re.escape(ct.__version__)}(?![\w.])")


def subjects() -> list[str]:
    """Every example, and what is recorded beside them; those that are recorded come first."""
    names = [
        line.split()[0] for line in _printed(["examples"]).splitlines() if re.match(r"[a-z][\w-]+  ", line)
    ]
    return [*RECORDED, *sorted(set(names) - set(EVERY_ROOM))]


def artefacts_of(subject: str, commands: Collection[str] = ()) -> Iterator[tuple[str, Artefact]]:
    """Name and artefact of everything that is recorded of a subject, in a fixed order; of some commands alone."""
    if subject == "face":
        yield "dir(centrode)", text_artefact("\n".join(dir(ct)))
        return
    text = "" if subject in BESIDE else _printed(["examples", subject])
    for language in LANGUAGES:
        for case in _cases(subject, text, language):
            if not of_commands(case.name, commands):
                continue
            for name, artefact in run(case, language):
                artefact.brief = language != LANGUAGES[0]
                yield f"{case.name}/{language}/{name}", artefact


def of_commands(name: str, commands: Collection[str]) -> bool:
    """Whether what is recorded under a name belongs to one of the commands; to none named, everything belongs."""
    return not commands or re.split("[ /]", name)[0] in commands


def subject_digests(
    subject: str, commands: Collection[str] = ()
) -> tuple[dict[str, Digest], dict[str, list[str]]]:
    """Digests of the artefacts of a subject, and the labels of their series."""
    return digests_of(dict(artefacts_of(subject, commands)))


def write_digests(subject: str, folder: Path) -> int:
    """Write the record of a subject; returns how many artefacts there are."""
    digests, _labels = subject_digests(subject)
    write_record(folder, subject, digests)
    return len(digests)


def write_texts(subject: str, folder: Path, commands: Collection[str] = ()) -> int:
    """Write the artefacts of a subject as plain text, a file each; returns how many there are."""
    count = 0
    for name, artefact in artefacts_of(subject, commands):
        count += 1
        parts = [re.sub(r"[^\w.()=,+-]+", "-", part)[:100] for part in name.split("/")]
        target = folder.joinpath(subject, *parts[:-1], f"{parts[-1]}.text")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(artefact.text, encoding="utf-8", errors="surrogateescape")
    return count


def _cases(subject: str, text: str, language: str) -> Iterator[Case]:
    match subject:
        case "help":
            return help_cases([str(command.name) for command in COMMANDS])
        case "refusals":
            return refusal_cases()
        case "studies":
            return study_cases()
    return (cam_cases if 'kind = "cam"' in text else linkage_cases)(subject, text, language)


def run(case: Case, language: str) -> Iterator[tuple[str, Artefact]]:
    """What a case gives in a language: how it ended and what it said, then every file, then figures and frames."""
    comma = language != "en"
    with (
        tempfile.TemporaryDirectory() as folder,
        _inside(Path(folder), language),
        seen_instead_of_drawn(comma) as seen,
    ):
        for name, content in case.files.items():
            Path(name).write_text(content, encoding="utf-8")
        blocks: list[Artefact] = []
        code, out, err = _done([*case.words, "--lang", language], blocks, comma)
        said = text_artefact(_lasting(out, folder), comma)
        said.say(f"exit code {code}")
        yield "said", said
        if err:
            yield "error", text_artefact(_lasting(err, folder), comma)
        for number, block in enumerate(blocks, start=1):
            yield f"blocks {number}" if number > 1 else "blocks", block
        shown: set[int] = set()
        for path in sorted(Path().rglob("*")):
            if path.is_file() and str(path) not in case.files:
                artefact = file_artefact(path, seen)
                shown |= {number for number, one in enumerate(seen.figures) if one is artefact}
                yield str(path.as_posix()), _without_version(artefact)
        for number, figure in enumerate(seen.figures):
            if number not in shown:
                yield f"figure {number}", figure
        for number, frame in enumerate(seen.frames, start=1):
            yield f"frame {number}", frame


def _done(words: list[str], blocks: list[Artefact], comma: bool) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of a command; what a report is made of goes to `blocks`."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.ExitStack() as stack:
        if hasattr(ct, "write_report"):
            write = ct.write_report

            def write_report(report: Any, *arguments: Any, **options: Any) -> Any:
                block = Artefact(comma)
                _tell(report, "report", block)
                blocks.append(_without_version(block))
                return write(report, *arguments, **options)

            stack.enter_context(mock.patch.object(ct, "write_report", write_report))
        stack.enter_context(contextlib.redirect_stdout(out))
        stack.enter_context(contextlib.redirect_stderr(err))
        code = main(words)
    return code, out.getvalue(), err.getvalue()


def _tell(value: Any, name: str, made: Artefact) -> None:
    """Plain data, field by field."""
    match value:
        case str() | bool() | None:
            made.say(f"{name}: {value}")
        case int() | float():
            made.say(f"{name}: {value!r}")
        case bytes():
            made.say(f"{name}: bytes")
        case np.ndarray() if value.dtype.kind in "fiub":
            made.add(name, value)
        case dict():
            for key, one in value.items():
                _tell(one, f"{name} {key}", made)
        case list() | tuple() | np.ndarray():
            if value and all(isinstance(one, float) for one in value):
                made.add(name, value)
                return
            for one in value:
                _tell(one, name, made)
        case _ if hasattr(value, "__dataclass_fields__"):
            made.say(f"{name} {type(value).__name__}")
            for field in value.__dataclass_fields__:
                _tell(getattr(value, field), field, made)
        case _:
            made.say(f"{name}: {type(value).__name__}")


def _printed(words: list[str]) -> str:
    code, out, err = _done([*words, "--lang", "en"], [], False)
    if code:
        raise RuntimeError(f"{' '.join(words)}: {err}")
    return out


@contextlib.contextmanager
def _inside(folder: Path, language: str) -> Iterator[None]:
    """The current folder and the environment's language for a while; remarks of libraries are no part of the record."""
    settings = {name: value for name, value in os.environ.items() if name not in SETTINGS}
    settings |= {"LANGUAGE": language, "COLUMNS": "80"}
    with (
        mock.patch.dict(os.environ, settings, clear=True),
        contextlib.chdir(folder),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore")
        yield


def _lasting(text: str, folder: str) -> str:
    """A text without what differs between runs: the temporary folder and the version."""
    return VERSION.sub("VERSION", text.replace(os.path.realpath(folder), "FOLDER").replace(folder, "FOLDER"))


def _without_version(artefact: Artefact) -> Artefact:
    parts = [VERSION.sub("VERSION", part) if isinstance(part, str) else part for part in artefact.parts]
    return Artefact(artefact.comma, artefact.brief, parts)
