"""`centrode schema`: the grammar of the description as JSON Schema."""

from __future__ import annotations

import json

import click

import centrode as ct
from centrode.locale import mark


@click.command(help=mark("Print the JSON Schema of the description, for editors."))
def schema() -> None:
    """Print the JSON Schema of the description."""
    click.echo(json.dumps(ct.mechanism_schema(), indent=2, ensure_ascii=False))
