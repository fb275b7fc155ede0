"""The page of the workbench under a hand: what a test draws, presses and reads."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from report.browser import frames

STORE = "centrode.workbench"
DRAWING = ".stage-holder .drawing"
PICTURES = 1500
"""So many are waited for: a quarter of a minute on a machine that does nothing else."""
Spot: TypeAlias = tuple[float, float] | str


@dataclass
class Bench:
    """A page, and what its console said."""

    page: Any
    messages: list[str] = field(default_factory=list)

    # what it shows

    @property
    def text(self) -> str:
        """The description as the page keeps it."""
        kept = self.page.evaluate(f"dispatchEvent(new Event('pagehide')), localStorage.getItem('{STORE}')")
        return str(json.loads(kept)["text"])

    @property
    def tables(self) -> dict[str, Any]:
        """Tables of the description."""
        return tomllib.loads(self.text)

    def names(self, kind: str) -> list[str]:
        """Names of the points, links or guides of the drawing."""
        return list(
            self.page.eval_on_selector_all(f'[data-kind="{kind}"]', "all => all.map(one => one.dataset.name)")
        )

    def said(self) -> str:
        """What the line under the drawing says."""
        return str(self.page.inner_text("#said"))

    def values(self) -> dict[str, float]:
        """Numbers at the cursor, as the curves say them: label -> value, without its unit."""
        found = {}
        for line in self.page.locator(".legend .entry").all_inner_texts():
            label, _, value = line.partition(" = ")
            found[label] = float(value.split("\u00a0")[0].replace("−", "-").replace("°", ""))
        return found

    def choose_curve(self, number: int, key: str) -> None:
        """Let a curve show another quantity."""
        self.page.locator(".chart select").nth(number).select_option(key)
        frames(self.page)

    # what a hand does

    def wait(self, condition: str) -> None:
        """Wait until something of the page holds."""
        self.until(lambda: bool(self.page.evaluate(condition)))

    def until(self, holds: Callable[[], bool]) -> None:
        """Wait, picture by picture, until something holds."""
        for _ in range(PICTURES):
            if holds():
                return
            frames(self.page)
        raise AssertionError(f"it never came to hold; the page says: {self.said()}")

    def gesture(self, act: Callable[[], None], *, settle: bool = True) -> None:
        """Do something that changes the description, and wait for what follows from it, or for the text alone."""
        before = self.text
        act()
        self.until(lambda: self.text != before)
        if settle:
            self.settle()

    def settle(self) -> None:
        """Wait until nothing is computed any more."""
        self.wait("!document.querySelector('.busy.on')")

    def spot(self, place: Spot) -> tuple[float, float]:
        """A place of the drawing, as parts of its sides, a point, or the middle of a link, on the screen."""
        if isinstance(place, tuple):
            box = self.page.locator(DRAWING).bounding_box()
            return box["x"] + place[0] * box["width"], box["y"] + place[1] * box["height"]
        if place in self.names("link"):
            (a, b), (c, d) = (self.spot(point) for point in place)
            return (a + c) / 2, (b + d) / 2
        box = self.page.locator(f'[data-point="{place}"] .ring').bounding_box()
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def drag(self, start: Spot, end: Spot) -> None:
        """Drag from one place of the drawing to another."""
        mouse = self.page.mouse
        mouse.move(*self.spot(start))
        mouse.down()
        mouse.move(*self.spot(end), steps=6)
        mouse.up()

    def draw(self, start: Spot, end: Spot) -> None:
        """Draw a link, or a guide."""
        self.gesture(lambda: self.drag(start, end))

    def click(self, place: Spot) -> None:
        """Select what lies at a place."""
        self.page.mouse.click(*self.spot(place))

    def switch(self, row: str) -> None:
        """Switch a state row of what is selected."""
        self.gesture(lambda: self.page.click(f'[data-row="{row}"]'))

    def mode(self, name: str) -> None:
        """Choose what a drag does."""
        self.page.click(f'.modes [data-mode="{name}"]')

    def template(self, name: str) -> None:
        """Begin from a built-in description."""
        self.page.click('[data-do="open"]')
        self.gesture(lambda: self.page.click(f'[data-template="{name}"]'))

    def motion(self) -> None:
        """Wait until the motion is there."""
        self.wait("document.querySelector('[data-do=seek]')?.disabled === false")
        self.settle()


@contextmanager
def bench(
    running: Any, address: str, wide: int = 1280, language: str | None = "en", **how: Any
) -> Iterator[Bench]:
    """The workbench in a window of its own, with a store of its own; its language is that of the address with None."""
    context = running.new_context(viewport={"width": wide, "height": 900}, **how)
    if language is not None:
        context.add_init_script(
            "localStorage.getItem('centrode.language') ?? "
            f"localStorage.setItem('centrode.language', '{language}')"
        )
    yield opened(context, address)
    context.close()


def opened(context: Any, address: str) -> Bench:
    """The workbench in a further tab of a window."""
    one = Bench(context.new_page())
    one.page.on("console", lambda message: one.messages.append(message.text))
    one.page.on("pageerror", lambda error: one.messages.append(str(error)))
    one.page.goto(address)
    one.page.wait_for_selector(".bench", timeout=60_000)
    one.settle()
    return one
