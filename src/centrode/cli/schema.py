"""`centrode schema`: the grammar of a description as JSON Schema."""

from __future__ import annotations

import json

import click

from centrode.cli import library
from centrode.locale import mark


@click.command(help=mark("Print the JSON Schema of the description, for editors."))
@click.option("--cam", is_flag=True, help=mark("The schema of cams; by default that of linkages."))
def schema(cam: bool) -> None:
    """Print the JSON Schema of the description."""
    found = library.cam_schema() if cam else library.mechanism_schema()
    click.echo(json.dumps(found, indent=2, ensure_ascii=False))
