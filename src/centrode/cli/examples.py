"""`centrode examples`: the built-in mechanisms, listed or printed."""

from __future__ import annotations

import tomllib
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
    """Linkages, then cams, then pairs of gears, each with what computes them."""
    linkages, cams, pairs = ct.example_names(), ct.example_names("cam"), ct.example_names("gear pair")
    count = ngettext("{count} mechanism", "{count} mechanisms", len(linkages)).format(count=len(linkages))
    use = _("print one with: centrode examples NAME; compute it with: centrode run NAME")
    lines = render.aligned(_rows((*linkages, *cams, *pairs))).splitlines()
    counted = ngettext("{count} cam", "{count} cams", len(cams)).format(count=len(cams))
    behind = _("compute one with: centrode cam NAME")
    gears = ngettext("{count} pair of gears", "{count} pairs of gears", len(pairs)).format(count=len(pairs))
    last = _("compute one with: centrode gears NAME")
    ends = len(linkages), len(linkages) + len(cams)
    first, second, third = (
        "\n".join(lines[slice(*between)]) for between in ((0, ends[0]), ends, (ends[1], len(lines)))
    )
    return f"{first}\n\n{count}; {use}\n\n{second}\n\n{counted}; {behind}\n\n{third}\n\n{gears}; {last}"


def _rows(names: tuple[str, ...]) -> list[tuple[str, str]]:
    return [(name, _(str(tomllib.loads(library.example_text(name)).get("title", "")))) for name in names]
