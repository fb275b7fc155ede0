"""How a command's tables are spelled besides plain CSV: with decimal commas, as workbooks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from centrode.cli import library
from centrode.errors import InputError
from centrode.locale import _, mark

if TYPE_CHECKING:
    from centrode.render.table_files import TableSpelling

Command = TypeVar("Command", bound=Callable[..., Any])

COMMA, XLSX = "centrode.decimal-comma", "centrode.xlsx"


def tables_options(command: Command) -> Command:
    """The options of every command that writes tables; `output` reads them."""
    for name, key, told in (
        ("--xlsx", XLSX, mark("Also write each table as a workbook, a sheet for each quantity.")),
        ("--decimal-comma", COMMA, mark("CSV with decimal commas; fields are separated by semicolons.")),
    ):
        command = click.option(name, is_flag=True, expose_value=False, callback=_keep(key), help=told)(
            command
        )
    return command


def _keep(key: str) -> Callable[[click.Context, click.Parameter, bool], None]:
    """Remember an option for the end of the command."""

    def keep(context: click.Context, _parameter: click.Parameter, value: bool) -> None:
        context.meta[key] = value

    return keep


def asked_spelling() -> TableSpelling:
    """How the running command was asked to spell its tables."""
    context = click.get_current_context(silent=True)
    asked = {} if context is None else context.meta
    spelling: TableSpelling = library.table_spelling(bool(asked.get(XLSX)), bool(asked.get(COMMA)))
    return spelling


def need_table(path: Path | None) -> None:
    """Refuse the options where the one file that is asked for, if any, is no table."""
    if path is not None and path.suffix.lower() == ".csv":
        return
    asked = asked_spelling()
    for option, given in (("--xlsx", asked.xlsx), ("--decimal-comma", asked.comma)):
        if given:
            raise InputError(option, _("no table is written"), _("name a file .csv with --out, or omit it"))


def table_files(path: Path) -> list[Path]:
    """The file of a table, and the workbook beside it where the running command was asked for one."""
    return [path, path.with_suffix(".xlsx")] if asked_spelling().xlsx else [path]
