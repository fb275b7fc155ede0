"""Make the picture of a report: its page in a browser beside two pages of PDFs, docs/images/report.png.

python -m tools.report_picture

It needs a Chromium and playwright, as the tests of pages do.
"""

from __future__ import annotations

import io
import shutil
import tempfile
from pathlib import Path
from typing import Any

import typst
from PIL import Image, ImageChops, ImageOps
from playwright.sync_api import sync_playwright

import centrode as ct
from centrode.report.pdf_document import Source, style_files

FILE = Path(__file__).parents[1] / "docs" / "images" / "report.png"
EXAMPLE = "six-bar-press"
ON_PAGE = ("motion", "words")
ON_PAPER: tuple[tuple[tuple[str, ...] | None, int], ...] = ((None, 0), (("force-polygons",), 1))
"""Chapters of two documents (all of the first), each with the index of the page that is shown."""
SHARE = 0.7
"""Of the way through the motion, where the browser shows it."""
HEIGHT, GAP, BORDER = 1020, 14, 1
WIDTH = 800
GROUND, EDGE = "#EEEEEE", "#C6C6C6"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def page_in_browser() -> Image.Image:
    """The page of the report."""
    report = ct.report(ct.example(EXAMPLE), ct.ReportOptions(chapters=ON_PAGE))
    program = next(filter(None, map(shutil.which, BROWSERS)))
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        (file,) = ct.write_report(report, folder, formats=("html",))
        browser = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        window = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        window.goto(file.as_uri())
        window.evaluate("document.fonts.ready")
        drive = window.locator("input[type=range]").first
        drive.fill(str(round(float(drive.get_attribute("max") or 0) * SHARE)))
        drive.blur()
        window.evaluate("document.querySelector('main h2').scrollIntoView()")
        shown = window.screenshot()
        browser.close()
    return Image.open(io.BytesIO(shown)).convert("RGB")


def page_of_paper(chapters: tuple[str, ...] | None, index: int) -> Image.Image:
    """A page of the PDF with these chapters, or of the compact report."""
    report = ct.report(ct.example(EXAMPLE), ct.ReportOptions(chapters=chapters))
    source = Source(report)
    files: Any = {"main": source.text.encode(), **style_files(report), **source.files}
    pages: Any = typst.Compiler(ignore_system_fonts=True).compile(input=files, format="png", ppi=150)
    page = Image.open(io.BytesIO(pages[index])).convert("RGB")
    return page.resize((round(page.width * HEIGHT / page.height), HEIGHT), Image.Resampling.LANCZOS)


def main() -> None:
    """Write the picture."""
    sheets = [
        ImageOps.expand(sheet, BORDER, EDGE)
        for sheet in (page_in_browser(), *(page_of_paper(*shown) for shown in ON_PAPER))
    ]
    width = sum(sheet.width + GAP for sheet in sheets) + GAP
    whole = Image.new("RGB", (width, sheets[0].height + 2 * GAP), GROUND)
    left = GAP
    for sheet in sheets:
        whole.paste(sheet, (left, GAP))
        left += sheet.width + GAP
    # all hues of the lines, few of the greys between them: the rule takes its colours from the greys alone
    few = whole.quantize(255, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).convert("RGB")
    few.paste(GROUND, mask=ImageOps.invert(_mask(whole)))
    few.quantize(256, dither=Image.Dither.NONE).save(FILE, format="png", optimize=True)


def _mask(whole: Image.Image) -> Image.Image:
    """White where there is a sheet, black where the ground is seen."""
    ground = Image.new("RGB", whole.size, GROUND)
    return ImageChops.difference(whole, ground).convert("L").point(lambda one: 255 if one else 0)


if __name__ == "__main__":
    main()
