"""The workbench: a joint of the press dragged by 300 steps, one a picture of the screen; server and page together."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from importlib.util import find_spec
from typing import Any

import numpy as np

from benchmarks.table import Promise, Row

PRESENT = all(map(find_spec, ("playwright", "starlette", "uvicorn"))) and any(
    map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))
)
MISSING = "it needs Chromium, playwright, and the extra app"
if PRESENT:
    from playwright.sync_api import sync_playwright
    from tools.app_pictures import begin, settle, workbench
    from tools.report_picture import BROWSERS

STEPS = 300
EXAMPLE = "six-bar-press"
DRAGS = {"move": "A", "edit": "D"}
"""Mode -> joint: the crank's pin drives the mechanism, the rocker's end changes lengths."""
RATE, LATE = 55.0, 16.0
"""Updates a second, and milliseconds from a step to its drawing for 95 of 100."""
DRAG = """async ([name, mode, steps]) => {
  const svg = document.querySelector(".stage-holder .drawing");
  const ring = document.querySelector(`[data-point="${name}"] .ring`).getBoundingClientRect();
  const x = ring.x + ring.width / 2, y = ring.y + ring.height / 2;
  const send = (type, right, up) => svg.dispatchEvent(new PointerEvent(type, {
    pointerId: 7, pointerType: "mouse", button: 0, buttons: 1, bubbles: true, clientX: x + right, clientY: y - up,
  }));
  const picture = () => new Promise((done) => requestAnimationFrame(done));
  const sent = [], late = [];
  const watch = new MutationObserver(() => late.push(performance.now() - sent[sent.length - 1]));
  watch.observe(svg, {attributes: true, attributeFilter: ["data-updates"]});
  send("pointerdown", 0, 0);
  const begin = performance.now();
  for (let step = 1; step <= steps; step += 1) {
    await picture();
    const turn = (2 * Math.PI * step) / steps;
    sent.push(performance.now());
    if (mode === "move") send("pointermove", 50 * (Math.cos(turn) - 1) + 8 * Math.cos(9 * turn), 50 * Math.sin(turn));
    else send("pointermove", 18 * Math.sin(turn) + 8, 9 * Math.sin(2 * turn));
  }
  await picture();
  const took = performance.now() - begin;
  await new Promise((done) => setTimeout(done, 300));
  watch.disconnect();
  send("pointerup", 0, 0);
  return {took, late};
}"""


def drags() -> Iterator[Row]:
    """A row for each mode; the first drag of each only warms up."""
    program = next(filter(None, map(shutil.which, BROWSERS)))
    with workbench() as address, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        window: Any = browser.new_page(viewport={"width": 1280, "height": 860})
        window.goto(address)
        window.wait_for_selector(".bench")
        settle(window)
        begin(window, EXAMPLE)
        for mode, joint in DRAGS.items():
            window.click(f'.modes [data-mode="{mode}"]')
            window.evaluate(DRAG, [joint, mode, STEPS // 5])
            settle(window)
            measured = window.evaluate(DRAG, [joint, mode, STEPS])
            settle(window)
            rate = 1000.0 * len(measured["late"]) / measured["took"]
            late = float(np.quantile(measured["late"], 0.95))
            yield Row(
                f"{EXAMPLE}: {mode} {joint}",
                {
                    "updates a second": rate,
                    "median [ms]": float(np.median(measured["late"])),
                    "95 of 100 [ms]": late,
                },
                promises=[
                    Promise(f"{mode}: updates a second", rate, at_least=RATE),
                    Promise(f"{mode}: 95 of 100 steps are drawn in [ms]", late, at_most=LATE),
                ],
            )
        browser.close()
