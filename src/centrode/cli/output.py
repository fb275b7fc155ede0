"""What commands write: tables in plain text, single files, and folders that appear whole or not at all."""

from __future__ import annotations

import shutil
import sys
import textwrap
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from itertools import groupby
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import click

from centrode import render
from centrode.cli.tables import asked_spelling, table_files
from centrode.errors import InputError
from centrode.files.drafts import draft_file, draft_folder, refusals
from centrode.files.inputs import keep_inputs
from centrode.locale import _, ngettext

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.sheet import Sheet

WIDTH = 100
"""Columns of a paragraph."""


def print_sheet(sheet: Sheet, display: Display) -> None:
    """Print a sheet; a terminal gets no line longer than it has columns, as far as words and numbers allow."""
    click.echo(render.sheet_text(sheet, display, terminal_width()))


def terminal_width() -> int | None:
    """Columns of the terminal that is printed on; None where a file or another program takes what is printed."""
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else None


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
    """A paragraph that counts and names the files of a folder, and one for each folder in it.

    Of one file beside the reader it is just its name.
    """
    if folder == Path() and len(names) == 1:
        return _("wrote {file}").format(file=names[0])
    count = ngettext("{n} file in {folder}", "{n} files in {folder}", len(names))
    folders = {
        place: list(within) for place, within in groupby(names, lambda name: str(PurePosixPath(name).parent))
    }
    heading = count.format(n=len(names), folder=folder) + ":"
    lines = [paragraph(heading, folders.pop(".", [])).rstrip()]
    lines += [
        paragraph(f"{place}/:", [PurePosixPath(name).name for name in within])
        for place, within in folders.items()
    ]
    return "\n".join(lines)


def file_names(draft: Path) -> list[str]:
    """Names of the files in a draft folder, those in folders of it last."""
    names = [path.relative_to(draft).as_posix() for path in draft.rglob("*") if path.is_file()]
    return sorted(names, key=lambda name: ("/" in name, name))


def tell(text: str, *, nl: bool = True) -> None:
    """Print on stderr; what nobody can read there (it is closed, or full) is no reason to fail."""
    with suppress(OSError):
        click.echo(text, nl=nl, err=True)


def wrote(paths: Sequence[Path]) -> str:
    """A sentence that names the single files that were written."""
    return _("wrote {file}").format(file=", ".join(map(str, paths)))


@contextmanager
def output_folder(path: Path) -> Iterator[Path]:
    """Folder to write into; its files appear in `path` when the block ends, and not at all when it raises.

    Raises InputError as `draft_folder` does, and at once where what writes workbooks is missing.
    """
    asked_spelling().check()
    with draft_folder(path) as draft:
        yield draft


def write_file(path: Path, text: str, *, force: bool = False) -> None:
    """Write one UTF-8 file whole or not at all; InputError where it cannot be, or stands already without `force`."""
    with output_file(path, force=force) as draft:
        draft.write_text(text, encoding="utf-8", newline="\n")


@contextmanager
def output_table(path: Path, *, force: bool = False) -> Iterator[tuple[Path, Path]]:
    """CSV file to write into, and the workbook beside it; they are one where the command was asked for no workbook.

    Raises as `output_file` does, for each of the files.
    """
    asked_spelling().check()
    with ExitStack() as files:
        drafts = [files.enter_context(output_file(one, force=force)) for one in table_files(path)]
        yield drafts[0], drafts[-1]


@contextmanager
def output_file(path: Path, *, force: bool = False) -> Iterator[Path]:
    """File to write into; it appears at `path` when the block ends, and not at all when it raises.

    Raises InputError as `draft_file` does, and at once where `path` exists already without `force`. What the command
    reads is not replaced with `force` either. The draft has the same name.
    """
    with refusals(path):
        keep_inputs(path)
        if path.is_dir():
            raise InputError(str(path), _("is a folder"), _("name a file"))
        if path.exists() and not force:
            raise InputError(str(path), _("exists already"), _("add --force to replace it"))
    with draft_file(path) as draft:
        yield draft
