"""A server that runs: what it takes of the memory over a thousand messages, good ones and damaged ones."""

from __future__ import annotations

import json
import os
import random
import sys
from pathlib import Path
from typing import Any

import pytest

from centrode.model.examples import example_names, example_text

from .served import served
from .test_server import mutate

client = pytest.importorskip("websockets.sync.client")

GREATEST = 500_000_000
"""Bytes that the server and its processes may take together."""
MESSAGES = 1000


def children(process: int) -> list[int]:
    """A process with all that it has started."""
    found = [process]
    for task in Path(f"/proc/{process}/task").iterdir():
        for child in (task / "children").read_text().split():
            found += children(int(child))
    return found


def memory(process: int) -> int:
    """Memory [bytes] of a process and its children; what several share counts once."""
    total = 0
    for one in children(process):
        try:
            lines = Path(f"/proc/{one}/smaps_rollup").read_text().splitlines()
        except OSError:
            continue  # it has ended meanwhile
        total += sum(1024 * int(line.split()[1]) for line in lines if line.startswith("Pss:"))
    return total


def thousand_messages(source: random.Random) -> list[dict[str, Any]]:
    """Everything that a page asks, of some built-in descriptions, each third message damaged."""
    texts = [example_text(name) for name in (*example_names()[::14], *example_names("cam")[:2])]
    made = []
    for k in range(MESSAGES):
        text = texts[k % len(texts)]
        kinds = [
            {"do": "read", "text": text},
            {"do": "motion", "text": text, "samples": 91},
            {"do": "drag", "text": text, "mode": "move", "point": "B", "to": [2, 3]},
            {"do": "edit", "text": text, "operations": [{"do": "move_point", "point": "B", "to": [2, 3]}]},
            {"do": "complete", "text": text, "line": 3, "column": 4},
            {"do": "hello"},
        ]
        message = kinds[k % len(kinds)]
        made.append(mutate(source, message) if k % 3 == 2 else message)
    return made


@pytest.mark.skipif(sys.platform != "linux", reason="memory is read from /proc")
def test_a_thousand_messages_stay_below_the_bound(tmp_path: Path) -> None:
    """Every one has an answer, and none takes more than the bound; the processes are those of a page that works."""
    greatest = 0
    with served(tmp_path) as one:
        assert one.process is not None
        address = f"ws://127.0.0.1:{one.port}/socket?token={one.token}"
        origin = f"http://127.0.0.1:{one.port}"
        with client.connect(address, origin=origin, max_size=None, open_timeout=120) as socket:
            for number, message in enumerate(thousand_messages(random.Random(28)), 1):
                socket.send(json.dumps({**message, "id": number}))
                reply = socket.recv(timeout=120)
                said = reply if isinstance(reply, str) else reply[4:4000].decode(errors="replace")
                assert "error in centrode" not in said and "Traceback" not in said, message
                if number % 10 == 0:
                    greatest = max(greatest, memory(one.process.pid))
    assert 50_000_000 < greatest < GREATEST
    if os.environ.get("CENTRODE_SAYS_MEMORY"):
        print(f"{greatest / 1e6:.0f} MB")
