"""What several commands are given."""

from __future__ import annotations

import click

from centrode.locale import mark

mechanism_argument = click.argument(
    "mechanism",
    metavar=mark("FILE_OR_EXAMPLE"),
    help=mark("A TOML file, or the name of a built-in mechanism."),
)
"""The mechanism that a command is about."""
