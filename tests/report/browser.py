"""A browser for tests: Debian's Chromium, without a network; where there is none, tests that need it are skipped."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome")


def chromium() -> str:
    """The program; skips the test where there is none."""
    found = next((path for path in map(shutil.which, NAMES) if path), None)
    if found is None:
        pytest.skip("no Chromium: apt-get install chromium")
    return found


@contextmanager
def browser() -> Iterator[Any]:
    """Running; closed afterwards."""
    library = pytest.importorskip("playwright.sync_api", reason="no playwright: pip install playwright")
    program = chromium()
    with library.sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        yield running
        running.close()


@dataclass
class Seen:
    """A page that was opened, and what it said and asked for."""

    page: Any
    messages: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)


def frames(page: Any) -> None:
    """Wait until what a page has to do now is drawn."""
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def until(page: Any, holds: Callable[[], bool]) -> None:
    """Wait, picture by picture, until something holds."""
    for _ in range(10_000):
        if holds():
            return
        frames(page)
    raise AssertionError("it never came to hold")


@contextmanager
def opened(running: Any, file: Path, wide: int = 1280, **how: Any) -> Iterator[Seen]:
    """A file in a window, with everything that it says and asks for."""
    context = running.new_context(viewport={"width": wide, "height": 900}, **how)
    seen = Seen(context.new_page())
    seen.page.on("console", lambda one: seen.messages.append(one.text))
    seen.page.on("pageerror", lambda one: seen.messages.append(str(one)))
    seen.page.on("dialog", lambda one: (seen.messages.append(one.message), one.dismiss()))
    seen.page.on("request", lambda one: seen.requests.append(one.url))
    seen.page.goto(file.as_uri())
    if how.get("java_script_enabled", True):
        seen.page.evaluate("document.fonts.ready")
        frames(seen.page)
    yield seen
    context.close()
