"""Damaged and forged links to a description: each is read or refused in words, in bounded memory.

A dozen links of all kinds in the suite; `CENTRODE_LINKS=1000 pytest tests/app/test_shared_links.py` follows a thousand.
"""

from __future__ import annotations

import base64
import os
import random
import string
import sys
import zlib
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from centrode.app.words import WORDS
from centrode.model.examples import example_text

from .bench import bench
from .served import Served
from .test_memory import GREATEST, memory

LINKS = int(os.environ.get("CENTRODE_LINKS", "12"))
LETTERS = string.ascii_letters + string.digits + "-_"
TEXTS = ("crank-rocker", "six-bar-press", "slider-crank-offset", "spherical-four-bar")
BOMB = 64_000_000
"""Bytes that a forged link unfolds to; the page stops at two million."""
PATIENCE = 60_000
"""Milliseconds after which a link counts as one that hangs."""
FOLLOW = """async ([link, patience]) => {
  const said = document.querySelector("#said"), words = () => said.textContent;
  const picture = () => new Promise(requestAnimationFrame);
  // says what that mode does
  document.querySelector('.modes [aria-pressed="false"]:not([aria-disabled="true"])').click();
  await picture();
  const before = words(), end = performance.now() + patience;
  location.hash = link;
  while (words() === before || document.querySelector(".busy.on")) {
    if (performance.now() > end) return null;
    await picture();
  }
  history.replaceState(null, "", location.pathname + location.search);
  return words();
}"""


def packed(content: bytes) -> str:
    """Bytes as a link holds them."""
    made = zlib.compressobj(9, zlib.DEFLATED, -15)
    return letters_of(made.compress(content) + made.flush())


def letters_of(content: bytes) -> str:
    return base64.urlsafe_b64encode(content).decode().rstrip("=")


def flipped(source: random.Random, text: str) -> str:
    content = bytearray(base64.urlsafe_b64decode(packed(text.encode()) + "=="))
    for _k in range(source.randrange(1, 4)):
        content[source.randrange(len(content))] ^= 1 << source.randrange(8)
    return letters_of(bytes(content))


def cut(source: random.Random, text: str) -> str:
    link = packed(text.encode())
    first = source.randrange(len(link))
    return link[first : first + source.randrange(len(link))] if source.random() < 0.3 else link[:first]


def inserted(source: random.Random, text: str) -> str:
    link = packed(text.encode())
    at = source.randrange(len(link) + 1)
    strange = source.choice(
        ["=", "%00", "ы", " ", "&m=", "#m=", "<b>", source.choice(LETTERS) * source.randrange(1, 9)]
    )
    return link[:at] + strange + link[at:]


def with_damaged_text(source: random.Random, text: str) -> str:
    """The link itself is right: what it holds is no good description any more."""
    for _k in range(source.randrange(1, 4)):
        at = source.randrange(len(text))
        text = text[:at] + source.choice('"=[]{}#,.\n\\09aß\u2028\x00') + text[at + source.randrange(4) :]
    return packed(text.encode())


def bomb(source: random.Random, text: str) -> str:
    """A short link that unfolds to many bytes: zeros, brackets, or the description over and over."""
    unit = source.choice([b"\x00", b"[", b"\n[[a]]", b"a.", text.encode()])
    return packed(unit * (BOMB // len(unit)))


def without_sense(source: random.Random, text: str) -> str:
    content = bytes(source.randrange(256) for _k in range(source.randrange(200)))
    return source.choice(
        [letters_of(content), packed(content), packed(b"\xff\xfe" + text.encode("utf-16-le"))]
    )


KINDS: tuple[Callable[[random.Random, str], str], ...] = (
    flipped,
    cut,
    inserted,
    with_damaged_text,
    without_sense,
    bomb,
)


def links(source: random.Random) -> Iterator[str]:
    """Of each kind as many, but that bombs are one in thirty of a long run."""
    texts = [example_text(name) for name in TEXTS]
    for k in range(LINKS):
        kinds = KINDS if k < 12 or k % 30 == 0 else KINDS[:-1]
        yield kinds[k % len(kinds)](source, source.choice(texts))


def greatest_page(session: Any) -> int:
    """Memory [bytes] of the greatest process of a page."""
    processes = session.send("SystemInfo.getProcessInfo")["processInfo"]
    return max(memory(one["id"]) for one in processes if one["type"] == "renderer")


@pytest.mark.skipif(sys.platform != "linux", reason="memory is read from /proc")
def test_links_that_are_damaged_or_forged(
    running: Any, server: Served, capfd: pytest.CaptureFixture[str]
) -> None:
    """No traceback, no hang, nothing above the bound, and a good link is read after all of them."""
    good = example_text("crank-rocker")
    with bench(running, server.address) as one:
        session = running.new_browser_cdp_session()
        assert server.process is not None
        greatest, refused = 0, 0
        for k, link in enumerate(links(random.Random(28))):
            said = one.page.evaluate(FOLLOW, [f"#m={link}", PATIENCE])
            assert said is not None, f"link {k} hangs: {link[:300]}"
            assert "error in centrode" not in said and "Traceback" not in said, (k, said, link[:300])
            refused += said == WORDS["link_damaged"]
            if k < 12 or k % 10 == 0:
                greatest = max(greatest, memory(server.process.pid), greatest_page(session))
        assert refused >= LINKS // 3
        one.page.evaluate(FOLLOW, [f"#m={packed(good.encode())}", PATIENCE])
        assert one.text == good
        one.motion()
        assert one.messages == []
    assert 20_000_000 < greatest < GREATEST
    said = "".join(capfd.readouterr())
    assert "Traceback" not in said and "error in centrode" not in said
    if os.environ.get("CENTRODE_SAYS_MEMORY"):
        print(f"{greatest / 1e6:.0f} MB")
