"""`centrode centres`: instant centres of a mechanism at given places, constructed and from velocities."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import dark_option, mechanism_argument, no_figures_option, written_option
from centrode.cli.progress import Progress
from centrode.cli.reached import is_moving, tell_absent
from centrode.cli.tables import tables_options
from centrode.errors import InputError
from centrode.locale import _, mark

if TYPE_CHECKING:
    import xarray

    from centrode.analysis.instant_centres.kennedy import Construction

MOST_ROWS = 300
"""Centres of one place that are printed without being asked for by name."""


@click.command(help=mark("Find the instant centres of velocity of every pair of links."))
@mechanism_argument
@click.option(
    "--at",
    "places",
    multiple=True,
    metavar=mark("VALUE"),
    help=mark(
        'Value of the drive ("pi/2 rad"), or time; the instants of the study if left out, else the start.'
    ),
)
@click.option(
    "--pair",
    "pairs",
    multiple=True,
    metavar=mark("LINK,LINK"),
    help=mark('Two links ("AC,frame"); all pairs if left out. As often as needed.'),
)
@written_option
@tables_options
@no_figures_option
@dark_option
def centres(
    mechanism: str,
    places: tuple[str, ...],
    pairs: tuple[str, ...],
    out: Path | None,
    no_figures: bool,
    dark: bool,
) -> None:
    """Print the centres of each place, and write them where asked."""
    description = ct.load(mechanism)
    asked = named_pairs(pairs) or None
    with Progress() as progress:
        progress.say(_("solving"))
        with about(mechanism):
            at = [ct.range_value(description, text, "--at") for text in places] or _usual(description)
            motion = ct.motion(description, at=at)
            names = ct.body_names(description)
            _check_rows(names, asked)
            found = ct.instant_centres(motion, asked)
            made = [_constructed(motion, sample, names) for sample in range(len(at))]
        texts = [
            _text(description, motion, found, sample, names, made[sample], asked) for sample in range(len(at))
        ]
        files: list[str] = []
        if out is not None:
            with output.output_folder(out) as draft:
                progress.say(_("writing tables"))
                ct.write_centres_csv(description, found, draft / "centres.csv", made)
                ct.write_motion_netcdf(found, draft / "centres.nc")
                if not no_figures:
                    progress.say(_("drawing"))
                    _draw(description, motion, made, asked, draft, dark)
                files = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo(f"\n{_numbered(description, names)}")
    for text in texts:
        click.echo(f"\n{text}")
    if out is not None:
        click.echo("\n" + output.files_in(out, files))
    tell_absent(mechanism, motion)


def _numbered(description: ct.Mechanism, names: Iterable[str]) -> str:
    """The bodies by number; a number and its name stay in one line."""
    items = [_unbroken(f"{number} {ct.body_name(description, name)}") for number, name in enumerate(names)]
    return output.paragraph(_("bodies") + ":", items).replace("\N{NO-BREAK SPACE}", " ")


def _unbroken(text: str) -> str:
    return text.replace(" ", "\N{NO-BREAK SPACE}")


def named_pairs(texts: Iterable[str]) -> list[tuple[str, str]]:
    """Pairs of names from texts "AC,frame"; raises InputError for another form."""
    found = []
    for text in texts:
        first, comma, second = (part.strip() for part in text.partition(","))
        if not comma or not first or not second or "," in second:
            raise InputError(
                "--pair",
                _("expected LINK,LINK, got {text}").format(text=f'"{text}"'),
                _('write "AC,frame"'),
            )
        found.append((first, second))
    return found


def _usual(description: ct.Mechanism) -> list[float]:
    """The instants of the study, where its values of the drive state instants; else the initial position."""
    stated = description.study.instants if description.motion_parameter.states_instants else ()
    return list(stated) or [ct.initial_place(description)]


def _check_rows(names: tuple[str, ...], asked: list[tuple[str, str]] | None) -> None:
    count = len(names) * (len(names) - 1) // 2
    if asked is None and count > MOST_ROWS:
        raise InputError(
            "--pair",
            _("{bodies} bodies have {count} centres").format(bodies=len(names), count=count),
            _('name those that matter, as in --pair "{first},frame"').format(first=names[1]),
        )


def _constructed(motion: xarray.Dataset, sample: int, names: tuple[str, ...]) -> Construction | None:
    """The construction of a place; none where there is no position, or more bodies than can be drawn."""
    if not is_moving(motion, sample) or len(names) > ct.MOST_BODIES:
        return None
    return ct.construct_centres(motion, sample)


def _text(
    description: ct.Mechanism,
    motion: xarray.Dataset,
    found: xarray.Dataset,
    sample: int,
    names: tuple[str, ...],
    made: Construction | None,
    asked: list[tuple[str, str]] | None,
) -> str:
    """A heading with the place and a table of its centres; of pairs asked for also what they were found from."""
    rows = ct.centres_rows(description, found, sample, names, made)
    text = f"{ct.place_words(description, motion, sample)}\n{render.aligned(rows, ct.centres_header(found))}"
    if asked is None or made is None:
        return text
    steps = [_unbroken(step) for step in ct.steps_leading_to(made, asked)]
    way = "\n" + output.paragraph(_("by way of") + ":", steps) if steps else ""
    return f"{text}{way}".replace("\N{NO-BREAK SPACE}", " ")


def _draw(
    description: ct.Mechanism,
    motion: xarray.Dataset,
    made: list[Construction | None],
    asked: list[tuple[str, str]] | None,
    folder: Path,
    dark: bool,
) -> None:
    """One picture for each place; numbered where there are several."""
    for number, construction in enumerate(made, start=1):
        if construction is None:
            continue
        figure = ct.centres_figure(description, motion, construction, number - 1, asked)
        name = "centres" if len(made) == 1 else f"centres-{number}"
        ct.save_figures({name: ct.darkened(figure) if dark else figure}, folder)
