"""A server of the workbench as a program of its own, which a test may kill and start again."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

STARTED = """
import socket
import sys
from pathlib import Path
from centrode.app.server import ServerSettings
from centrode.app.service import run_server, work_folder_of
if __name__ == "__main__":
    port = int(sys.argv[1])
    listener = socket.socket()
    if sys.platform != "win32":  # the port of a server that was killed just now
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind(("127.0.0.1", port))
    listener.listen(16)  # who comes before it answers waits
    print("listening", flush=True)
    work = work_folder_of(Path(sys.argv[3]) if sys.argv[3] else None)
    run_server(ServerSettings(work, port, token=sys.argv[2]), listener, browser=False)
"""


@dataclass
class Served:
    """A server at a port, with a token that stays the same."""

    folder: Path
    port: int
    token: str = "0123456789abcdef"
    file: str = ""
    process: subprocess.Popen[str] | None = None

    @property
    def address(self) -> str:
        """What a browser opens."""
        return f"http://127.0.0.1:{self.port}/?token={self.token}"

    def start(self) -> None:
        """Start it, and wait until it has its port: what comes before it answers waits there."""
        script = self.folder / "started.py"
        script.write_text(STARTED, "utf-8")
        self.process = subprocess.Popen(
            [sys.executable, str(script), str(self.port), self.token, self.file],
            cwd=self.folder,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)},
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        assert self.process.stdout.readline().strip() == "listening"

    def kill(self) -> None:
        """End it at once."""
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            if self.process.stdout is not None:
                self.process.stdout.close()
            self.process = None


def free_port() -> int:
    """A port that nobody has now."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])


@contextmanager
def served(folder: Path) -> Iterator[Served]:
    """Running; killed afterwards."""
    one = Served(folder, free_port())
    one.start()
    try:
        yield one
    finally:
        one.kill()
