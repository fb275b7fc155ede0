"""`centrode schema`: the grammar of a description as JSON Schema."""

from __future__ import annotations

import json

import click

from centrode.cli import library
from centrode.locale import _, mark


@click.command(help=mark("Print the JSON Schema of the description, for editors."))
@click.option("--cam", is_flag=True, help=mark("The schema of cams; by default that of linkages."))
@click.option("--gears", is_flag=True, help=mark("The schema of pairs of gears."))
@click.option("--trains", is_flag=True, help=mark("The schema of trains of gears."))
def schema(cam: bool, gears: bool, trains: bool) -> None:
    """Print the JSON Schema of the description."""
    if cam + gears + trains > 1:
        raise click.UsageError(_("--cam, --gears and --trains exclude each other"))
    schemas = (
        (cam, library.cam_schema),
        (gears, library.gear_pair_schema),
        (trains, library.gear_train_schema),
    )
    found = next((kind for wished, kind in schemas if wished), library.mechanism_schema)()
    click.echo(json.dumps(found, indent=2, ensure_ascii=False))
