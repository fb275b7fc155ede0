"""Make the picture of a mechanism's page in a browser, docs/images/page.png.

python -m tools.page_picture

It needs a Chromium and playwright, as the tests of pages do.
"""

from __future__ import annotations

import io
import shutil
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

import centrode as ct
from centrode.report.mechanism_page import mechanism_page
from tools.report_picture import BROWSERS

FILE = Path(__file__).parents[1] / "docs" / "images" / "page.png"
EXAMPLE = "six-bar-press"
SHOWN = ("velocities", "instant centres", "ghost positions")
WIDTH, HEIGHT = 1280, 860
SHARE = 0.62
"""Of the way through the motion, where the browser shows it."""


def page_in_browser() -> Image.Image:
    """The page at a position, with what its boxes add."""
    program = next(filter(None, map(shutil.which, BROWSERS)))
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        file = Path(folder) / "page.html"
        file.write_text(mechanism_page(ct.example(EXAMPLE)), encoding="utf-8")
        browser = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        window = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        window.goto(file.as_uri())
        for name in SHOWN:
            window.get_by_label(name, exact=True).check()
        drive = window.locator("input[type=range]").first
        drive.fill(str(round(float(drive.get_attribute("max") or 0) * SHARE)))
        drive.blur()
        window.wait_for_function("() => new Promise(done => requestAnimationFrame(() => done(true)))")
        shown = window.screenshot()
        browser.close()
    return Image.open(io.BytesIO(shown)).convert("RGB")


def main() -> None:
    """Write the picture."""
    page_in_browser().quantize(256, dither=Image.Dither.NONE).save(FILE, format="png", optimize=True)


if __name__ == "__main__":
    main()
