"""Mechanisms, structures, motions and equations show themselves; the notebook of the documentation runs."""

from __future__ import annotations

import json
import sys
import types
from typing import Any
from xml.etree import ElementTree as ET

import pytest
import xarray as xr
from tools.notebook import CELLS, TARGET, executed

import centrode as ct
from centrode import notebook, render
from centrode.topics.presentation import sheet_of
from centrode.topics.registry import TOPICS

HOSTILE = '<script>alert("x")</script>'


def page(text: str) -> ET.Element:
    """What is shown, as well-formed XML."""
    return ET.fromstring(f"<div>{text}</div>")


@pytest.mark.parametrize(
    "name", ["slider-between-cranks", "spherical-four-bar", "six-bar-press", "excavator-arm"]
)
def test_a_mechanism_is_a_drawing_over_its_links(name: str) -> None:
    mechanism = ct.example(name)
    shown = page(notebook.mechanism_html(mechanism))
    assert shown.find(".//{http://www.w3.org/2000/svg}path") is not None
    cells = ["".join(cell.itertext()) for cell in shown.iter("td")]
    assert set(mechanism.links) <= set(cells)


def test_lengths_are_in_the_unit_of_the_display() -> None:
    assert "<td style='text-align: left'>7 mm</td>" in notebook.mechanism_html(ct.example("andrews-squeezer"))


def test_what_does_not_assemble_says_why() -> None:
    text = ct.mechanism_text(ct.four_bar(crank=1, coupler=3.5, rocker=3, ground=4))
    mechanism = ct.with_value(ct.parse_mechanism(text), "links.coupler.length", 30.0)
    shown = notebook.mechanism_html(mechanism)
    assert page(shown).find(".//p") is not None
    assert "<svg" not in shown


def test_hostile_text_is_shown_as_text() -> None:
    mechanism = ct.example("crank-rocker").model_copy(update={"title": HOSTILE})
    for shown in (notebook.mechanism_html(mechanism), notebook.result_html(ct.check(mechanism))):
        assert "<script" not in shown
        page(shown)


def test_a_structure_is_a_table() -> None:
    checked = ct.check(ct.example("slider-between-cranks"))
    rows = [[cell.text or "" for cell in row] for row in page(notebook.result_html(checked)).iter("tr")]
    facts = render.fact_rows(sheet_of(checked).facts, checked.mechanism.display)
    assert rows == [list(row) for row in facts]


def test_a_motion_is_a_drawing_over_xarrays_view() -> None:
    motion = ct.motion(ct.example("crank-rocker"), 13)
    shown = notebook.motion_html(motion)
    assert shown.endswith(motion._repr_html_()[-200:])
    assert "<svg" in shown.partition("xr-wrap")[0]
    other = xr.Dataset({"status": ("sample", [0])})
    assert "max-width: 36em" not in notebook.motion_html(other)
    batch = ct.motion(ct.example("crank-rocker"), 13, vary={"links.AB.length": [3.4, 3.5]})
    assert "max-width: 36em" not in notebook.motion_html(batch)


def test_ipython_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[tuple[str, str, str]] = []

    class Formatter:
        def __init__(self, kind: str) -> None:
            self.kind = kind

        def for_type_by_name(self, module: str, name: str, show: Any) -> None:
            told.append((self.kind, module, name))

    kinds = {kind: Formatter(kind) for kind in ("text/html", "text/markdown")}
    shell = types.SimpleNamespace(display_formatter=types.SimpleNamespace(formatters=kinds))
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))  # type: ignore[arg-type]
    notebook.register()
    results = {(topic.result.module, topic.result.name) for topic in TOPICS}
    assert {row[1:] for row in told} == results | {row[1:3] for row in notebook.SHOWN}
    assert len(told) == len(set(told))
    assert told[-len(notebook.SHOWN) :] == [row[:3] for row in notebook.SHOWN]
    for _kind, module, name, _function in notebook.SHOWN:
        result: Any = {"Mechanism": ct.Mechanism, "Dataset": xr.Dataset}.get(name)
        if result is not None:
            assert (result.__module__, result.__name__) == (module, name)
    assert type(ct.equations(ct.example("crank-rocker"))).__name__ == "Equations"


def test_the_notebook_of_the_documentation_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANGUAGE", "en")
    kept = json.loads(TARGET.read_text(encoding="utf-8"))["cells"]
    assert ["".join(cell["source"]) for cell in kept] == [text for _kind, text in CELLS]
    for old, new in zip(kept, executed().cells, strict=True):
        kinds = [
            [sorted(output.get("data", ())) for output in cell.get("outputs", ())] for cell in (old, new)
        ]
        assert kinds[0] == kinds[1]


@pytest.mark.parametrize("name", ["six-bar-press", "spherical-four-bar"])
def test_parts_of_a_motion_are_shown_as_xarray_shows_them(name: str) -> None:
    motion = ct.motion(ct.example(name), 5)
    broken = motion.copy()
    broken.attrs["mechanism"] = "broken ["
    parts = [
        motion[["position", "status"]], motion[["position"]], motion.isel(sample=3), motion.isel(sample=slice(0, 0)),
        motion.isel(point=1), motion.isel(point=slice(0, 0)), motion.isel(point=[1]), motion.isel(link=[0]),
        motion.drop_vars("status"), motion.isel(axis=0), motion.transpose(), motion.rename(sample="k"),
        motion.assign_attrs(mechanism=5), broken, motion.isel(sample=0, point=0), motion.swap_dims(sample="time"),
    ]  # fmt: skip
    for part in parts:
        shown = notebook.motion_html(part)
        assert shown.endswith(part._repr_html_()[-20:])
        assert "xarray.Dataset" in shown
