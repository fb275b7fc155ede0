"""Make the pictures of the workbench in a browser: docs/images/app.png and those whose names begin with app-.

python -m tools.app_pictures [NAME...]

It needs a Chromium and playwright, as the tests of pages do.
"""

from __future__ import annotations

import io
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

from tools.report_picture import BROWSERS

FOLDER = Path(__file__).parents[1] / "docs" / "images"
SIZES: Mapping[str, tuple[int, int]] = {
    "app": (1600, 900),
    "app-drawing": (1180, 720),
    "app-text": (1600, 900),
    "app-events": (1600, 900),
}
PATIENCE = 120_000
"""Milliseconds in which the server has to answer."""
SETTLED = "!document.querySelector('.busy.on') && !document.querySelector('.waiting')"
DRAWING = ".stage-holder .drawing"


@contextmanager
def workbench() -> Iterator[str]:
    """The address of a server of its own."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "centrode", "app", "--no-browser"]
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True)
        try:
            assert process.stdout is not None
            found = re.search(r"http://\S+", process.stdout.readline())
            assert found is not None
            yield found.group()
        finally:
            process.terminate()
            process.wait()


def settle(window: Any) -> None:
    """Wait until nothing is computed any more."""
    for _ in range(PATIENCE // 100):
        window.wait_for_timeout(100)
        if window.evaluate(SETTLED):
            break
    window.wait_for_timeout(700)


def begin(window: Any, template: str) -> None:
    """Open a built-in mechanism."""
    title = window.title()
    window.click('[data-do="open"]')
    window.click(f'[data-template="{template}"]')
    while window.title() == title:
        window.wait_for_timeout(50)
    settle(window)


def press(window: Any) -> None:
    """Reactions of the press, with their arrows on the drawing."""
    begin(window, "six-bar-press")
    window.click("#tab-reactions")
    settle(window)
    window.locator('[data-do="seek"]').fill("90")
    window.focus('[data-kind="link"][data-name="AB"]')
    window.keyboard.press(" ")
    window.evaluate("document.activeElement.blur()")
    settle(window)


def drawing(window: Any) -> None:
    """A four-bar after four of its five gestures, and a line on its way."""
    box = window.locator(DRAWING).bounding_box()

    def spot(x: float, y: float) -> tuple[float, float]:
        return box["x"] + x * box["width"], box["y"] + y * box["height"]

    def at(name: str) -> tuple[float, float]:
        ring = window.locator(f'[data-point="{name}"] .ring').bounding_box()
        return ring["x"] + ring["width"] / 2, ring["y"] + ring["height"] / 2

    def draw(start: tuple[float, float], end: tuple[float, float], *, drop: bool = True) -> None:
        window.mouse.move(*start)
        window.mouse.down()
        window.mouse.move(*end, steps=5)
        if drop:
            window.mouse.up()
            settle(window)

    draw(spot(0.24, 0.7), spot(0.28, 0.58))
    draw(at("B"), spot(0.6, 0.3))
    draw(at("C"), spot(0.68, 0.7))
    a, b = at("A"), at("B")
    window.mouse.click((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
    window.click('[data-row="drive"]')
    settle(window)
    window.mouse.click(*at("D"))
    window.click('[data-row="ground"]')
    settle(window)
    window.focus('[data-kind="link"][data-name="BC"]')
    window.keyboard.press(" ")
    draw(at("C"), spot(0.87, 0.5), drop=False)


def text(window: Any) -> None:
    """The text beside the drawing, at night."""
    begin(window, "whitworth-quick-return")
    window.click('[data-do="text"]')
    window.wait_for_selector(".cm-content")
    window.click('.modes [data-mode="move"]')
    window.locator('[data-do="seek"]').fill("60")
    settle(window)


def events(window: Any) -> None:
    """A simulated catapult at the first impact of its arm."""
    begin(window, "catapult")
    window.click("#tab-simulate")
    settle(window)
    window.locator(".event-list button", has_text="0.4475").click()
    window.evaluate("document.activeElement.blur()")
    settle(window)


SCENES: Mapping[str, Callable[[Any], None]] = {
    "app": press,
    "app-drawing": drawing,
    "app-text": text,
    "app-events": events,
}


def main() -> None:
    """Write the pictures."""
    program = next(filter(None, map(shutil.which, BROWSERS)))
    with workbench() as address, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        chosen = sys.argv[1:] or SCENES
        for name, scene in ((name, SCENES[name]) for name in chosen):
            wide, high = SIZES[name]
            scheme: Any = "dark" if name == "app-text" else "light"
            window = browser.new_page(viewport={"width": wide, "height": high}, color_scheme=scheme)
            window.set_default_timeout(PATIENCE)
            window.goto(address)
            window.wait_for_selector(".bench")
            settle(window)
            scene(window)
            shown = Image.open(io.BytesIO(window.screenshot())).convert("RGB")
            shown.quantize(256, kmeans=3, dither=Image.Dither.NONE).save(
                FOLDER / f"{name}.png", format="png", optimize=True
            )
            window.close()
        browser.close()


if __name__ == "__main__":
    main()
