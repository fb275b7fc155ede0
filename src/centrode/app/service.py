"""The workbench as a program: a port, a server on it, and a browser."""

from __future__ import annotations

import os
import socket
import threading
import warnings
import webbrowser
from contextlib import suppress
from pathlib import Path

import uvicorn

from centrode.app.folders import WorkFolder
from centrode.app.server import MESSAGE_SIZE, ServerSettings, server_application
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.examples import FOLDERS, example_names

LOOPBACK = "127.0.0.1"
PORTS = range(8765, 8775)
"""Ports that are tried in turn: a browser keeps its store by port, and finds it again at the same one."""
WAITING_BROWSERS = 128
"""Connections that wait until the server accepts them."""


def work_folder_of(file: Path | None) -> WorkFolder:
    """The folder that is named, or that of a file; the working folder by default. InputError for other files."""
    if file is None or file.is_dir():
        work = WorkFolder((file or Path()).resolve())
        try:
            work.names()  # a folder that cannot be read is refused before anything is served
        except InputError as refusal:
            raise InputError(str(work.folder), refusal.what, _("check the path")) from None
        return work
    folder = file.parent.resolve()
    if not folder.is_dir():
        raise InputError(str(file.parent), _("there is no such folder"), _("check the path"))
    if not file.suffix and not file.exists():
        raise InputError(str(file), _("there is no such folder, and no such file"), _how_to_begin(file))
    work = WorkFolder(folder, file.name)
    work.checked_name(file.name)
    work.first_file()
    return work


def _how_to_begin(file: Path) -> str:
    """The repair for a name that is no folder and no file: of a built-in mechanism, how a file is made of it."""
    if any(str(file) in example_names(kind) for kind in FOLDERS):
        return _("write the built-in mechanism first: centrode examples {name} --out {name}.toml").format(
            name=file
        )
    return _("make the folder first, or end the name of a new file in .toml")


def bound_socket(port: int | None = None) -> socket.socket:
    """A socket that listens at a port of this machine, at any free one for 0; InputError where it is taken.

    Without a port it listens at the first free one of PORTS, and at any free one where all are taken.
    """
    if port is None:
        for usual in PORTS:
            with suppress(OSError):
                return _listening_socket(usual)
        port = 0
    try:
        return _listening_socket(port)
    except OSError as error:
        what = _("port {port} cannot be used: {reason}").format(port=port, reason=error.strerror)
        raise InputError("--port", what, _("choose another one, or leave the option out")) from None


def _listening_socket(port: int) -> socket.socket:
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        if os.name == "posix":
            # the port of a server that has just ended is free at once; on Windows the option would let two share it
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((LOOPBACK, port))
        listener.listen(WAITING_BROWSERS)
    except OSError:
        listener.close()
        raise
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
        opening = threading.Timer(0.5, webbrowser.open, (settings.opening_address(),))
        opening.daemon = True  # none opens once the server has ended
        opening.start()
    # interrupting it is how it ends, even before it has begun to wait for that
    with warnings.catch_warnings(), suppress(KeyboardInterrupt):
        warnings.filterwarnings("ignore", "coroutine .* was never awaited", RuntimeWarning)
        uvicorn.Server(config).run(sockets=[listener])
