"""`centrode schema`: the grammar of a description as JSON Schema."""

from __future__ import annotations

import json

import click

from centrode.cli import library
from centrode.locale import _, mark


@click.command(help=mark("Print the JSON Schema of the description, for editors."))
@click.option("--cam", is_flag=True, help=mark("The schema of cams; by default that of linkages."))
@click.option("--gears", is_flag=True, help=mark("The schema of pairs of gears."))
def schema(cam: bool, gears: bool) -> None:
    """Print the JSON Schema of the description."""
    if cam and gears:
        raise click.UsageError(_("--cam and --gears exclude each other"))
    found = (
        library.cam_schema() if cam else library.gear_pair_schema() if gears else library.mechanism_schema()
    )
    click.echo(json.dumps(found, indent=2, ensure_ascii=False))
