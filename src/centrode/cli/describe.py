"""`centrode describe`: how a mechanism works, in words."""

from __future__ import annotations

import textwrap

import click

import centrode as ct
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument
from centrode.locale import _, mark


@click.command(help=mark("Say in words how a mechanism works."))
@mechanism_argument
def describe(mechanism: str) -> None:
    """Print the description in words; exit code 2 where there is none."""
    description = ct.load(mechanism)
    with about(mechanism):
        text = ct.describe(description)
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo("\n\n".join(textwrap.fill(paragraph, output.WIDTH) for paragraph in text.split("\n\n")))
