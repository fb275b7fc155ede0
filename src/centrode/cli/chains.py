"""`centrode chains`: all kinematic chains, or Assur groups, of a number of links, with an atlas and descriptions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import click

from centrode import render
from centrode.cli import library, output
from centrode.cli.arguments import no_figures_option
from centrode.cli.progress import Progress
from centrode.cli.tables import asked_spelling, tables_options
from centrode.errors import InputError
from centrode.locale import _, mark, ngettext

if TYPE_CHECKING:
    from centrode.sheets.sheet import Sheet

Listed: TypeAlias = tuple[tuple[int, Any], ...]
"""Chains with their numbers."""

_NONE: Listed = ()
MOST_DESCRIPTIONS = 2_000
"""Descriptions that are written without a chain being named; those of the chains of ten links are 1834."""


@click.command(help=mark("List kinematic chains or Assur groups."))
@click.argument("links", type=int, metavar=mark("LINKS"), help=mark("Number of links, the frame counted."))
@click.option(
    "--mobility", type=int, default=1, metavar=mark("N"), help=mark("Degrees of freedom; 1 by default.")
)
@click.option("--cut-links", is_flag=True, help=mark("Also chains whose parts a single link holds together."))
@click.option("--groups", is_flag=True, help=mark("Assur groups of so many links in place of chains."))
@click.option("--chain", "number", type=int, metavar=mark("N"), help=mark("This chain of the list alone."))
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("DIR"),
    help=mark("Write the table, the atlas and a description of each inversion into this folder."),
)
@no_figures_option
@tables_options
def chains(
    links: int,
    mobility: int,
    cut_links: bool,
    groups: bool,
    number: int | None,
    out: Path | None,
    no_figures: bool,
) -> None:
    """Print the list; with `out` write it, its atlas, and of chains a description to start from for each inversion."""
    with Progress() as progress:
        progress.say(_("looking for chains"))
        if groups:
            _refuse_of_chains(mobility, cut_links, number)
            sheet, listed = library.groups_sheet(library.assur_list(links)), _NONE
        else:
            found = library.chain_list(links, mobility, cut_links=cut_links)
            listed = tuple(enumerate(found.chains, start=1))
            if number is not None:
                listed = _chosen(listed, number)
            sheet = library.chains_sheet(found, number)
        output.print_sheet(sheet, library.display())
        if out is None:
            return
        with output.output_folder(out) as draft:
            told = _write(sheet, listed if mobility else _NONE, draft, no_figures, progress)
            names = output.file_names(draft)
    click.echo("\n" + _files(out, names))
    if told:
        output.tell(told)


def _refuse_of_chains(mobility: int, cut_links: bool, number: int | None) -> None:
    if mobility != 1 or cut_links or number is not None:
        what = _("--mobility, --cut-links and --chain belong to chains")
        raise InputError("--groups", what, _("leave them out"))


def _chosen(listed: Listed, number: int) -> Listed:
    if not 1 <= number <= len(listed):
        what = _("there is no chain {number}").format(number=number)
        raise InputError("--chain", what, _("the list has chains 1 to {last}").format(last=len(listed)))
    return listed[number - 1 : number]


def _write(sheet: Sheet, listed: Listed, draft: Path, no_figures: bool, progress: Progress) -> str:
    """Files of a list; returns what a reader should know besides."""
    display = library.display()
    render.write_tables(sheet, draft, display, asked_spelling())
    if not no_figures:
        render.write_pictures(sheet.pictures, draft, display, progress.say)
    count = sum(len(chain.inversions) for _number, chain in listed)
    if count > MOST_DESCRIPTIONS:
        text = _(
            "{n} descriptions are not written; name a chain with --chain to have those of its inversions"
        )
        return text.format(n=count)
    for number, chain in listed:
        progress.say(_("writing descriptions"), number, listed[-1][0])
        for inversion, text in enumerate(library.start_texts(chain), start=1):
            (draft / "start").mkdir(exist_ok=True)
            name = f"chain-{number}-inversion-{inversion}.toml"
            (draft / "start" / name).write_text(text, encoding="utf-8", newline="\n")
    return ""


def _files(folder: Path, names: list[str]) -> str:
    """What was written; descriptions are counted."""
    start = [name for name in names if name.startswith("start/")]
    text = output.files_in(folder, [name for name in names if name not in start])
    if not start:
        return text
    count = ngettext("start/: {n} description", "start/: {n} descriptions", len(start)).format(n=len(start))
    return f"{text}\n{count}"
