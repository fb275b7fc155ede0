"""What several commands are given."""

from __future__ import annotations

from pathlib import Path

import click

from centrode.errors import InputError
from centrode.locale import _, mark

mechanism_argument = click.argument(
    "mechanism",
    metavar=mark("FILE_OR_EXAMPLE"),
    help=mark("A TOML file, or the name of a built-in mechanism."),
)
"""The mechanism that a command is about."""

results_option = click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("DIR"),
    help=mark("Folder for the results; named after the mechanism by default."),
)
"""Where a command that always writes puts its files; `output.folder_of` names it."""

written_option = click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("DIR"),
    help=mark("Also write tables and pictures into this folder."),
)
"""Where a command that prints its results also writes them."""

samples_option = click.option(
    "--samples", type=int, metavar=mark("N"), help=mark("Number of samples, both ends included.")
)

start_option = click.option(
    "--from",
    "start",
    metavar=mark("A"),
    help=mark('First value of the drive ("0 deg"); a time ("0 s") where the drive is a law.'),
)

stop_option = click.option(
    "--to", "stop", metavar=mark("B"), help=mark("Last value of the drive, or last time.")
)

range_option = click.option(
    "--range",
    "ranged",
    type=click.Choice(["reachable"]),
    help=mark("The range between the limits around the initial position; one turn if there are no limits."),
)
"""In place of what the description says of its range; `--from` and `--to` go before it."""

numbers_option = click.option(
    "--set",
    "numbers",
    multiple=True,
    metavar=mark("PATH=VALUE"),
    help=mark('Another value of a number of the description ("links.AB.length=3.6 m"); may be repeated.'),
)
"""Numbers in place of the description's own."""

no_figures_option = click.option("--no-figures", is_flag=True, help=mark("Write no pictures."))

dark_option = click.option(
    "--dark", is_flag=True, help=mark("Pictures with light lines on a dark background.")
)

workers_option = click.option(
    "--workers",
    type=int,
    metavar=mark("N"),
    help=mark("Number of processes of this machine that compute, as a cluster."),
)

scheduler_option = click.option(
    "--scheduler",
    metavar=mark("URL"),
    help=mark("The scheduler of a cluster whose workers compute: tcp://HOST:PORT, or tls://HOST:PORT."),
)


def asked_cluster(workers: int | None, scheduler: str | None) -> int | str | None:
    """What computes, by the two options; InputError where both are given."""
    if workers is not None and scheduler is not None:
        raise InputError(
            "--workers", _("--scheduler names another cluster"), _("give one of the two options")
        )
    return scheduler if workers is None else workers
