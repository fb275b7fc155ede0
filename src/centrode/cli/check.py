"""`centrode check`: what can be said of a mechanism before it moves."""

from __future__ import annotations

import click

import centrode as ct
from centrode import render
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument
from centrode.locale import _, mark


@click.command(help=mark("Check a mechanism: mobility, loops, groups, plan."))
@mechanism_argument
def check(mechanism: str) -> None:
    """Print the structure of a mechanism; exit code 2 if it cannot be driven or does not assemble."""
    description = ct.load(mechanism)
    with about(mechanism):
        checked = ct.check(description)
    steps = [(_("plan") if not i else "", f"{i + 1}. {step}") for i, step in enumerate(checked.plan)]
    click.echo(_(checked.title) or mechanism)
    click.echo()
    click.echo(render.aligned([*ct.check_rows(checked), *steps]))
