"""Look at every panel and page of the workbench: in each language, at three widths, by day and at night.

python -m tools.app_panels FOLDER [--topics NAME ...] [--descriptions NAME ...] [--languages CODE ...]
    [--audit] [--square] [--blind]

For each panel it writes one sheet a width, with the panel in all languages by day and at night (with --square by day or
at night, turn about), and prints what does not fit: what is wider than the page or its panel, words that are cut, small
letters, scrolled boxes inside scrolled boxes, panels that stay empty, what the console says, and what of a Russian or
Ukrainian panel is in Latin letters. With --audit axe-core looks at every panel too. The pages of gears and of
syntheses are looked at whole, as `gears` and `synthesis`. It needs a Chromium and playwright, as the tests of pages do.
"""

from __future__ import annotations

import argparse
import base64
import io
import re
import shutil
import sys
import time
import zlib
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from PIL import Image, ImageDraw
from playwright.sync_api import TimeoutError as LateError
from playwright.sync_api import sync_playwright

from centrode.model.examples import example_text
from tools.app_pictures import PATIENCE, SETTLED, workbench
from tools.report_picture import BROWSERS

AXE = Path(__file__).parents[1] / "tests" / "report" / "axe" / "axe.min.js"
LANGUAGES = ("en", "ru", "uk")
SCHEMES = ("light", "dark")
WIDTHS = (400, 1000, 1600)
HEIGHT = 900
RESIZED = 700
"""Milliseconds after which a panel of another width asks for its figures."""
TALLEST = 2400
"""Pixels of a panel that a sheet shows."""
GAP, HEAD = 16, 22
TOLERANCES = """
[tolerances]
default = "±0.1 mm"
[tolerances.clearances]
B = "0.05 mm"
[tolerances.outputs]
swing = { formula = "range(angle_DB)", deviation = "0.1 deg" }
rocker = "angle.DB"
"""
DESCRIPTIONS = (
    "six-bar-press",
    "six-bar-press-run-up",
    "five-bar-two-drives",
    "indexing-cam",
    "walking-wheel-four-legs",
    "crank-rocker",
    "planetary-gear-train",
    "spherical-four-bar",
    "double-pendulum",
    "door-closer",
    "catapult",
    "vibrating-screen",
)
"""Each panel is shown of the first of these that has it."""
AGAIN = {
    "spherical-four-bar": ("motion", "centres", "equations"),
    "planetary-gear-train": ("run",),
    "double-pendulum": ("equilibrium", "modes"),
    "door-closer": ("simulate", "equilibrium"),
    "catapult": ("simulate",),
    "vibrating-screen": ("simulate", "modes"),
}
"""Panels that look otherwise of some descriptions."""
PLAYED = ("simulate", "modes")
"""Panels that move the drawing: the window around them is shown too."""
PAGES = {
    "gears": "#facts td",
    "synthesis": "#answers .card",
    "synthesis-function": "#answers .card",
    "synthesis-strokes": "#answers .card",
}
"""Further pages, with what is wanted of them, and what is there once they are ready."""
POINTS = "0 0\n40 0\n60 30\n50 60\n0 60\n-10 30"
"""Points of a path [mm] for which the page of syntheses finds mechanisms."""
FITS = """(where) => {
  const panel = document.querySelector(where), page = document.documentElement, said = [];
  const card = (panel.closest(".card.panel") ?? panel).getBoundingClientRect();
  if (page.scrollWidth > page.clientWidth) said.push(`the page is ${page.scrollWidth - page.clientWidth} too wide`);
  const say = (what, one) => {
    const text = (one.value ?? one.textContent ?? "").trim().slice(0, 50);
    said.push(`${what}: ${one.tagName.toLowerCase()}.${one.getAttribute("class") ?? ""} "${text}"`);
  };
  const scrolls = (one, axis) => /auto|scroll/.test(getComputedStyle(one)[`overflow${axis}`]);
  const clips = (one) => getComputedStyle(one).overflowX !== "visible";
  for (const one of panel.querySelectorAll("*")) {
    if (one.closest("svg, math") || !one.getClientRects().length) continue;
    let around = one.parentElement;
    while (around !== panel && !clips(around)) around = around.parentElement;
    const right = one.getBoundingClientRect().right;
    if (around === panel && right > card.right + 1) say("wider than the panel", one);
    const wide = one.scrollWidth > one.clientWidth + 1, field = /INPUT|SELECT/.test(one.tagName);
    if (wide && (field ? one.type !== "range" : clips(one) && !scrolls(one, "X"))) say("cut", one);
    const high = one.scrollHeight > one.clientHeight + 1;
    if (high && scrolls(one, "Y") && !one.matches(".long")) say("scrolled in the panel", one);
    const own = [...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
    if (!own) continue;
    if (/(^|[ (])--[a-z]/.test(one.textContent)) say("an option of the command", one);
    if (parseFloat(getComputedStyle(one).fontSize) < 11) say("small", one);
    const range = document.createRange();
    range.selectNodeContents(one);
    const word = !/\\s/.test(one.textContent.trim()) && one.childElementCount === 0;
    if (word && one.clientWidth && range.getClientRects().length > 1) say("word over lines", one);
  }
  if (!panel.textContent.trim()) said.push("empty");
  return said;
}"""
AUDIT = """async ([where, rules]) => {
  const how = {resultTypes: ["violations"], ...(rules.length ? {runOnly: rules} : {})};
  const found = await axe.run({include: [where], exclude: [[".paper svg > *"]]}, how);
  return found.violations.filter((one) => ["serious", "critical"].includes(one.impact))
    .map((one) => `${one.id}: ${one.nodes.slice(0, 2).map((node) => node.html.slice(0, 120)).join(" | ")}`);
}"""
WHOLE = """
.live.bench, .live.bench main { height: auto !important; overflow: visible !important; }
.right, .live.bench .panel, .side { overflow: visible !important; }
"""
DRAWN = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
BEGUN = time.monotonic()
FOREIGN = re.compile(r"\b[A-Za-z][a-z]{3,}\b")


@dataclass
class Findings:
    """What is wrong, with the views in which it is; pictures of each panel."""

    wrong: dict[tuple[str, str], list[str]] = field(default_factory=lambda: defaultdict(list))
    foreign: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    audited: Counter[str] = field(default_factory=Counter)
    captured: Counter[str] = field(default_factory=Counter)
    pictures: dict[tuple[str, int], dict[tuple[str, str], Path]] = field(
        default_factory=lambda: defaultdict(dict)
    )


def packed(text: str) -> str:
    """A text as the link of the workbench holds it."""
    made = zlib.compressobj(9, zlib.DEFLATED, -15)
    return base64.urlsafe_b64encode(made.compress(text.encode()) + made.flush()).decode().rstrip("=")


def description(name: str) -> str:
    """The text of a description; the crank-rocker has limits of its dimensions."""
    return example_text(name) + (TOLERANCES if name == "crank-rocker" else "")


def until(window: Any, condition: str, argument: object = None) -> None:
    """Wait, picture by picture, until something of the page holds."""
    for _ in range(PATIENCE // 16):
        window.evaluate(DRAWN)
        if window.evaluate(condition, argument):
            return
    raise SystemExit(f"it never came to hold: {condition} {argument or ''}")


def settle(window: Any) -> None:
    """Wait until nothing is computed any more and all is drawn."""
    until(window, SETTLED)
    until(window, "document.querySelector('#panel:not([data-ready=true])') === null")
    window.evaluate(DRAWN)


def panels(window: Any) -> list[str]:
    """Names of the panels that the description has."""
    tabs = window.locator('[role="tab"]:not(.away)')
    return [str(one).removeprefix("tab-") for one in tabs.evaluate_all("all => all.map(one => one.id)")]


def open_panel(window: Any, name: str) -> None:
    """Open a panel and wait until it is there."""
    window.evaluate("name => document.getElementById(`tab-${name}`).click()", name)
    until(
        window,
        "name => document.querySelector(`#panel[data-topic='${name}'][data-ready=true]`) !== null",
        name,
    )
    settle(window)


def picture(window: Any, where: str) -> Image.Image:
    """The whole panel, or page."""
    style = window.add_style_tag(content=WHOLE)
    window.evaluate(DRAWN)
    shown = Image.open(io.BytesIO(window.locator(where).screenshot())).convert("RGB")
    style.evaluate("one => one.remove()")
    return shown.crop((0, 0, shown.width, min(shown.height, TALLEST)))


def look(
    window: Any,
    name: str,
    view: tuple[str, str],
    found: Findings,
    arguments: argparse.Namespace,
    where: str = "#panel",
) -> None:
    """A panel, or a page, at all widths."""
    (language, scheme), folder = view, arguments.folder
    for wide in WIDTHS:
        window.set_viewport_size({"width": wide, "height": HEIGHT})
        window.wait_for_timeout(RESIZED)
        settle(window)
        turn = LANGUAGES.index(language) + WIDTHS.index(wide)
        if arguments.square and SCHEMES.index(scheme) != turn % 2:
            continue  # each language at each width, by day or at night
        combination = f"{language} {wide} {scheme}"
        said = [*dict.fromkeys(window.evaluate(FITS, where))]
        if arguments.audit:
            found.audited[combination] += 1
            # at night nothing else has changed
            rules = ["color-contrast"] if scheme == SCHEMES[1] and not arguments.square else []
            said += window.evaluate(AUDIT, [where, rules])
        for one in said:
            found.wrong[name, one].append(combination)
            print(f"{name}: {one} [{combination}]", flush=True)
        if arguments.blind:
            continue
        file = folder / "views" / f"{name}-{wide}-{language}-{scheme}.png"
        picture(window, ".card.panel" if where == "#panel" else where).save(file)
        found.captured[combination] += 1
        found.pictures[name, wide][language, scheme] = file
        if name.partition("-")[0] in PLAYED:
            around = folder / "views" / f"{name}-window-{wide}-{language}-{scheme}.png"
            window.screenshot(path=around)
            found.pictures[f"{name}-window", wide][language, scheme] = around
    if language != "en":
        text = window.inner_text(where)
        found.foreign[name] |= set(FOREIGN.findall(text))


def look_at_both(
    window: Any,
    name: str,
    language: str,
    found: Findings,
    arguments: argparse.Namespace,
    where: str = "#panel",
) -> None:
    """A panel, or a page, by day and at night at all widths."""
    for scheme in SCHEMES:
        window.emulate_media(color_scheme=scheme)
        settle(window)
        look(window, name, (language, scheme), found, arguments, where)
    window.emulate_media(color_scheme=SCHEMES[0])
    window.set_viewport_size({"width": WIDTHS[-1], "height": HEIGHT})
    print(f"{time.monotonic() - BEGUN:.0f} s: {name} {language}", flush=True)


@contextmanager
def open_window(
    running: Any, address: str, language: str, found: Findings, arguments: argparse.Namespace
) -> Iterator[Any]:
    """A window of a language at an address, in which axe-core stands ready; what its console says is a finding."""
    context = running.new_context(viewport={"width": WIDTHS[-1], "height": HEIGHT}, color_scheme=SCHEMES[0])
    context.add_init_script(f"localStorage.setItem('centrode.language', '{language}')")
    window = context.new_page()
    window.set_default_timeout(PATIENCE)
    said: list[str] = []
    window.on("console", lambda message: said.append(message.text))
    window.on("pageerror", lambda error: said.append(str(error)))
    window.goto(address)
    if arguments.audit:
        window.evaluate(AXE.read_text("utf-8"))
    yield window
    for message in said:
        found.wrong[address.partition("#")[0].rpartition("/")[2], message].append(language)
        print(f"console: {message} [{language}]", flush=True)
    context.close()


def search(window: Any, kind: str) -> None:
    """Let the page of syntheses find mechanisms of a kind; those of a path with a trade-off."""
    window.select_option("#kind", kind)
    if kind == "path":
        window.fill("#size", "")
        window.select_option("#trade_off", "transmission")
        window.fill("#targets", POINTS)
        window.dispatch_event("#targets", "change")
    window.click("#search")
    window.locator("#answers .card").first.click()


def walk(running: Any, address: str, found: Findings, arguments: argparse.Namespace) -> None:
    """Every panel and page in every language, by day and at night, window by window."""
    only_pages = arguments.topics and not set(arguments.topics) - set(PAGES)
    for language in arguments.languages:
        seen: set[str] = set()
        for name in () if only_pages else arguments.descriptions:
            link = f"{address}#m={packed(description(name))}"
            with open_window(running, link, language, found, arguments) as window:
                until(window, "document.querySelectorAll('[role=tab]:not(.away)').length > 2")
                settle(window)
                for topic in panels(window):
                    again = topic in AGAIN.get(name, ())
                    key = f"{topic}-{name}" if again else topic
                    if (topic in seen and not again) or (arguments.topics and key not in arguments.topics):
                        continue
                    seen.add(topic)
                    open_panel(window, topic)
                    look_at_both(window, key, language, found, arguments)
        for name, there in PAGES.items():
            if arguments.topics and name not in arguments.topics:
                continue
            page, _hyphen, kind = name.partition("-")
            where = address.replace("/?", f"/{page}?")
            with open_window(running, where, language, found, arguments) as window:
                try:
                    if page == "synthesis":
                        search(window, kind or "path")
                    window.wait_for_selector(there)
                except LateError:
                    found.wrong[name, "no answer in time"].append(language)
                    print(f"{name}: no answer in time [{language}]", flush=True)
                    continue
                settle(window)
                look_at_both(window, name, language, found, arguments, f"#{page}")


def write_sheets(found: Findings, folder: Path) -> Iterator[Path]:
    """One picture of each panel at each width: languages beside each other, day and night."""
    for (name, wide), files in found.pictures.items():
        views = {view: Image.open(file) for view, file in files.items()}
        size = (
            sum(one.width + GAP for one in views.values()) + GAP,
            max(one.height for one in views.values()) + HEAD + GAP,
        )
        sheet = Image.new("RGB", size, "#8899AA")
        pen, x = ImageDraw.Draw(sheet), GAP
        for (language, scheme), one in sorted(views.items(), key=lambda item: SCHEMES.index(item[0][1])):
            pen.text((x, 5), f"{name}  {wide}  {language}  {scheme}", fill="black")
            sheet.paste(one, (x, HEAD))
            x += one.width + GAP
        file = folder / f"{name}-{wide}.png"
        sheet.save(file)
        yield file


def main(words: Sequence[str] | None = None) -> int:
    """Write the sheets and print what is wrong; the exit code is 1 where axe-core or the layout has findings."""
    parser = argparse.ArgumentParser(prog="python -m tools.app_panels", description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--topics", nargs="+", default=[])
    parser.add_argument("--languages", nargs="+", default=LANGUAGES, choices=LANGUAGES)
    parser.add_argument("--descriptions", nargs="+", default=DESCRIPTIONS, choices=DESCRIPTIONS)
    parser.add_argument("--audit", action="store_true")
    parser.add_argument("--square", action="store_true")
    parser.add_argument("--blind", action="store_true", help="write no sheets")
    arguments = parser.parse_args(words)
    (arguments.folder / "views").mkdir(parents=True, exist_ok=True)
    found = Findings()
    program = next(filter(None, map(shutil.which, BROWSERS)))
    with workbench() as address, sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        walk(running, address, found, arguments)
        running.close()
    files = [*write_sheets(found, arguments.folder)]
    for name, latin in sorted(found.foreign.items()):
        print(f"{name}: in Latin letters: {', '.join(sorted(latin))}")
    for combination in sorted(found.audited | found.captured):
        pictures, audits = found.captured[combination], found.audited[combination]
        print(f"{combination}: {pictures} pictures, {audits} audits")
    print(f"{len({name for name, _wide in found.pictures})} panels, {len(files)} sheets")
    return int(bool(found.wrong))


if __name__ == "__main__":
    sys.exit(main())
