"""`centrode examples`: the built-in mechanisms, listed or printed."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

import click

import centrode as ct
from centrode import render
from centrode.cli import library, output
from centrode.locale import _, mark, ngettext


@click.command(help=mark("List the built-in mechanisms, or print one as TOML."))
@click.argument("name", required=False, metavar=mark("[NAME]"), help=mark("Name of a built-in mechanism."))
@click.option(
    "--out",
    "out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("Write the TOML to FILE instead of printing it."),
)
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def examples(name: str | None, out: Path | None, force: bool) -> None:
    """List the built-in mechanisms, or print or write the one called `name`."""
    if name is None:
        if out is not None:
            raise click.UsageError(_("--out needs the NAME of a built-in mechanism"))
        click.echo(_listing())
        return
    text = library.example_text(name)
    if out is None:
        click.echo(text, nl=not text.endswith("\n"))
        return
    output.write_file(out, text, force=force)
    click.echo(_("wrote {file}").format(file=out))


def _listing() -> str:
    """Linkages, then cams, pairs and trains of gears, each with what computes them."""
    kinds = {
        "linkage": (
            ngettext("{count} mechanism", "{count} mechanisms", len(ct.example_names())),
            _("print one with: centrode examples NAME; compute it with: centrode run NAME"),
        ),
        "cam": (
            ngettext("{count} cam", "{count} cams", len(ct.example_names("cam"))),
            _("compute one with: centrode cam NAME"),
        ),
        "gear pair": (
            ngettext("{count} pair of gears", "{count} pairs of gears", len(ct.example_names("gear pair"))),
            _("compute one with: centrode gears NAME"),
        ),
        "gear train": (
            ngettext(
                "{count} train of gears", "{count} trains of gears", len(ct.example_names("gear train"))
            ),
            _("compute one with: centrode trains NAME"),
        ),
    }
    lines = iter(
        render.aligned_text(_rows([name for kind in kinds for name in ct.example_names(kind)])).splitlines()
    )
    parts = []
    for kind, (counted, behind) in kinds.items():
        count = len(ct.example_names(kind))
        parts.append("\n".join(islice(lines, count)))
        parts.append(f"{counted.format(count=count)}; {behind}")
    return "\n\n".join(parts)


def _rows(names: Sequence[str]) -> list[tuple[str, str]]:
    return [(name, _(str(tomllib.loads(library.example_text(name)).get("title", "")))) for name in names]
