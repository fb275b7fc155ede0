"""`centrode app`: the workbench in a browser."""

from __future__ import annotations

from pathlib import Path

import click

from centrode.cli import library
from centrode.errors import InputError
from centrode.locale import _, mark
from centrode.optional_packages import how_to_install


@click.command(help=mark("Draw a mechanism in a browser."))
@click.argument(
    "file",
    required=False,
    type=click.Path(path_type=Path),
    metavar=mark("[FILE]"),
    help=mark("A TOML file, or a folder of such files; the working folder by default."),
)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    metavar=mark("N"),
    help=mark("Port of this machine, 0 for any free one; by default 8765 or the next free one."),
)
@click.option("--no-browser", is_flag=True, help=mark("Print the address without opening a browser."))
def app(file: Path | None, port: int | None, no_browser: bool) -> None:
    """Serve the workbench at 127.0.0.1 until it is interrupted."""
    try:
        library.run_server.load()
    except ModuleNotFoundError as missing:
        if (missing.name or "").startswith("centrode"):
            raise
        what = _("the workbench needs {library}, which is not installed").format(library=missing.name)
        raise InputError("", what, how_to_install("app")) from missing
    work = library.work_folder_of(file)
    listener = library.bound_socket(port)
    settings = library.server_settings(work, listener.getsockname()[1])
    click.echo(_("The workbench is at {address}").format(address=settings.address))
    click.echo(_("Only this machine can reach it. Ctrl-C ends it."))
    library.run_server(settings, listener, browser=not no_browser)
