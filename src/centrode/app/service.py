"""The workbench as a program: a port, a server on it, and a browser."""

from __future__ import annotations

import socket
import threading
import webbrowser
from contextlib import suppress
from pathlib import Path

import uvicorn

from centrode.app.folders import WorkFolder
from centrode.app.server import MESSAGE_SIZE, ServerSettings, server_application
from centrode.errors import InputError
from centrode.locale import _

LOOPBACK = "127.0.0.1"


def work_folder_of(file: Path | None) -> WorkFolder:
    """The folder of a file, or the working folder; InputError for a file that is none of a description."""
    if file is None:
        return WorkFolder(Path().resolve())
    folder = file.parent.resolve()
    if not folder.is_dir():
        raise InputError(str(file), _("there is no such folder"), _("check the path"))
    work = WorkFolder(folder, file.name)
    work.checked_name(file.name)
    work.first_file()
    return work


def bound_socket(port: int) -> socket.socket:
    """A socket at a port of this machine, any free one for 0; InputError where it is taken."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        listener.bind((LOOPBACK, port))
    except OSError as error:
        listener.close()
        what = _("port {port} cannot be used: {reason}").format(port=port, reason=error.strerror)
        raise InputError("--port", what, _("choose another one, or leave the option out")) from None
    return listener


def run_server(settings: ServerSettings, listener: socket.socket, *, browser: bool) -> None:
    """Serve until somebody interrupts; a browser opens the page once it answers."""
    config = uvicorn.Config(
        server_application(settings),
        log_level="warning",
        access_log=False,
        server_header=False,
        ws_max_size=MESSAGE_SIZE,
        ws="websockets-sansio",
        timeout_graceful_shutdown=1,
    )
    if browser:
        threading.Timer(0.5, webbrowser.open, (settings.address,)).start()
    # interrupting it is how it ends
    with suppress(KeyboardInterrupt):
        uvicorn.Server(config).run(sockets=[listener])
