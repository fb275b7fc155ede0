"""What commands write: tables in plain text, single files, and folders that appear whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
import textwrap
import unicodedata
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from centrode.cli.tables import asked_spelling, spell_tables, table_files
from centrode.errors import InputError
from centrode.locale import _, ngettext

WIDTH = 100
"""Columns of a paragraph."""


def table(rows: Sequence[Sequence[str]], header: Sequence[str] = (), right: Sequence[int] = ()) -> str:
    """Rows as plain text, columns aligned and two spaces apart; the columns numbered in `right` align right."""
    lines = [list(header), *rows] if header else list(rows)
    widths = [max(width_of(cell) for cell in column) for column in zip(*lines, strict=True)]
    texts = []
    for line in lines:
        gaps = [" " * (width - width_of(cell)) for cell, width in zip(line, widths, strict=True)]
        cells = [
            gap + cell if number in right else cell + gap
            for number, (cell, gap) in enumerate(zip(line, gaps, strict=True))
        ]
        texts.append("  ".join(cells).rstrip())
    return "\n".join(texts)


def width_of(text: str) -> int:
    """Columns that a text takes on a terminal: marks over letters take none, East Asian letters two."""
    marks = sum(unicodedata.category(letter) in ("Mn", "Me", "Cf") for letter in text)
    wide = sum(unicodedata.east_asian_width(letter) in ("W", "F") for letter in text)
    return len(text) - marks + wide


def paragraph(heading: str, items: Sequence[str]) -> str:
    """A heading with items behind it, or indented below it where one line does not hold them."""
    line = ", ".join(items)
    if len(heading) + 1 + len(line) <= WIDTH:
        return f"{heading} {line}"
    wrap = textwrap.TextWrapper(
        WIDTH, initial_indent="  ", subsequent_indent="  ", break_long_words=False, break_on_hyphens=False
    )
    return f"{heading}\n{wrap.fill(line)}"


def folder_of(out: Path | None, source: str, kind: str) -> Path:
    """The folder that was asked for, else one named after what is read and what is computed."""
    return out if out is not None else Path(f"{Path(source).stem}-{kind}")


def files_in(folder: Path, names: Sequence[str]) -> str:
    """A paragraph that counts and names the files of a folder."""
    count = ngettext("{n} file in {folder}", "{n} files in {folder}", len(names))
    return paragraph(count.format(n=len(names), folder=folder) + ":", names)


def finished(draft: Path) -> list[str]:
    """Names of the files in a draft folder, after its tables have been spelled as the command was asked to."""
    spell_tables(draft)
    return sorted(path.name for path in draft.iterdir())


def wrote(paths: Sequence[Path]) -> str:
    """A sentence that names the single files that were written."""
    return _("wrote {file}").format(file=", ".join(map(str, paths)))


@contextmanager
def output_folder(path: Path) -> Iterator[Path]:
    """Folder to write into; its files appear in `path` when the block ends, and not at all when it raises.

    Raises InputError at once where `path` cannot be written or what writes workbooks is missing, before anything is
    computed. Files of the same name that stand in `path` are replaced, others are left alone.
    """
    asked_spelling().check()
    with _refusals(path):
        base = _existing_part(path)
        draft = Path(tempfile.mkdtemp(prefix=".centrode-", dir=base))
    try:
        yield draft
        with _refusals(path):
            _move_files(draft, path)
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def write_file(path: Path, text: str, *, force: bool = False) -> None:
    """Write one UTF-8 file whole or not at all; InputError where it cannot be, or stands already without `force`."""
    with output_file(path, force=force) as draft:
        draft.write_text(text, encoding="utf-8", newline="\n")


@contextmanager
def output_table(path: Path, *, force: bool = False) -> Iterator[Path]:
    """CSV file to write into; it appears spelled as the command was asked to, with a workbook beside it or without.

    Raises as `output_file` does, for each of the files.
    """
    spelling = asked_spelling()
    spelling.check()
    with ExitStack() as files:
        drafts = [files.enter_context(output_file(one, force=force)) for one in table_files(path)]
        yield drafts[0]
        spelling.spell_table(drafts[0], drafts[-1])


@contextmanager
def output_file(path: Path, *, force: bool = False) -> Iterator[Path]:
    """File to write into; it appears at `path` when the block ends, and not at all when it raises.

    Raises InputError at once where `path` cannot be written, or stands already without `force`. The draft has the
    same ending.
    """
    with _refusals(path):
        if path.is_dir():
            raise InputError(str(path), _("is a folder"), _("name a file"))
        if path.exists() and not force:
            raise InputError(str(path), _("exists already"), _("say --force to replace it"))
        base = _existing_part(path.parent)
        handle, name = tempfile.mkstemp(prefix=".centrode-", suffix=path.suffix, dir=base)
        os.close(handle)
    draft = Path(name)
    try:
        yield draft
        with _refusals(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            _share(draft)
            os.replace(draft, path)
    except BaseException:
        with suppress(OSError):
            draft.unlink()
        raise


def _existing_part(path: Path) -> Path:
    """The folder itself, or the nearest one above it that exists: drafts stand there, on the same file system."""
    for part in (path, *path.parents):
        if part.is_dir():
            return part
        if part.exists() or part.is_symlink():
            where = "" if part == path else str(path)
            raise InputError(where, _("{part} is not a folder").format(part=part), _("name another folder"))
    raise InputError(str(path), _("no part of this path exists"), _("name another folder"))


def _move_files(draft: Path, path: Path) -> None:
    files = sorted(file.relative_to(draft) for file in draft.rglob("*") if file.is_file())
    for file in files:
        _existing_part((path / file).parent)
        if (path / file).is_dir():
            raise InputError(
                str(path / file), _("is a folder, and a file has to go there"), _("name another folder")
            )
    path.mkdir(parents=True, exist_ok=True)
    for file in files:
        (path / file).parent.mkdir(parents=True, exist_ok=True)
        os.replace(draft / file, path / file)


def _share(file: Path) -> None:
    """Give a temporary file the permissions that a file opened in the usual way has."""
    mask = os.umask(0)
    os.umask(mask)
    file.chmod(0o666 & ~mask)


@contextmanager
def _refusals(path: Path) -> Iterator[None]:
    """Say what the operating system refuses as an InputError about `path`."""
    try:
        yield
    except OSError as refusal:
        reason = refusal.strerror or str(refusal)
        raise InputError(
            str(path), _("cannot be written: {reason}").format(reason=reason), _("name another place")
        ) from refusal
