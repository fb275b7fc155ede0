"""What a notebook shows of a mechanism, its motion, its equations and any result of a topic."""

from __future__ import annotations

import html
import io
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from matplotlib.backends.backend_svg import FigureCanvasSVG

from centrode import render
from centrode.errors import CentrodeError
from centrode.kinematics.motion import motion as motion_of
from centrode.locale import _
from centrode.model.files import parse_mechanism
from centrode.present.displayed_units import shown_as
from centrode.present.equations.latex import equations_markdown
from centrode.present.figure_files import METADATA
from centrode.present.spelled_figures import spell_decimals
from centrode.present.style import house_style
from centrode.sheets.linkages import MechanismPicture
from centrode.sheets.texts import Sentence
from centrode.topics.presentation import display_of, sheet_of

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

__all__ = ["equations_markdown", "mechanism_html", "motion_html", "result_html"]

SAMPLES = 73


def mechanism_html(mechanism: Mechanism) -> str:
    """A mechanism as a drawing of its motion over a table of its links; the reason where it does not move."""
    try:
        drawing = _drawing(mechanism, motion_of(mechanism, SAMPLES))
    except CentrodeError as failure:
        drawing = f"<p>{html.escape(str(failure))}</p>"
    rows = [(name, *_link(mechanism, name)) for name in mechanism.links]
    heads = (_("link"), _("points"), _("length"))
    return drawing + _table(heads, rows)


def result_html(result: Any) -> str:
    """A result of a topic: its facts as a table, and below it what a terminal prints besides."""
    sheet, display = sheet_of(result), display_of(result)
    description = result.mechanism if hasattr(result, "mechanism") else result.cam
    title = html.escape(_(description.title))
    text = render.sheet_text(replace(sheet, facts=()), display)
    return (
        (f"<h4>{title}</h4>" if title else "")
        + (_table((), render.fact_rows(sheet.facts, display)) if sheet.facts else "")
        + (f"<pre>{html.escape(text)}</pre>" if text else "")
    )


def motion_html(dataset: xarray.Dataset) -> str:
    """A motion as a drawing over xarray's own view of it; any other dataset as xarray shows it."""
    own: str = dataset._repr_html_()
    if not _is_motion(dataset):
        return own
    try:
        mechanism = parse_mechanism(dataset.attrs["mechanism"])
        return _drawing(mechanism, dataset) + own
    except (CentrodeError, LookupError, ValueError):  # parts of a motion may lack what a drawing needs
        return own


def _is_motion(dataset: xarray.Dataset) -> bool:
    """Whether a dataset is a motion of one mechanism with its samples, points and statuses."""
    return (
        isinstance(dataset.attrs.get("mechanism"), str)
        and {"position", "status"} <= set(dataset.variables)
        and dataset["status"].dims == ("sample",)
        and dataset["position"].dims == ("sample", "point", "axis")
        and min(dataset["position"].shape) > 0
    )


def _drawing(mechanism: Mechanism, dataset: xarray.Dataset) -> str:
    """The mechanism over fading pictures of its motion, as SVG within a page."""
    with house_style():
        picture = MechanismPicture(Sentence("Mechanism"), mechanism, dataset)
        figure = render.figure_of(picture, mechanism.display)
        spell_decimals(figure)
        canvas: Any = FigureCanvasSVG(figure)
        drawn = io.BytesIO()
        canvas.print_svg(drawn, metadata=METADATA["svg"])
    text = drawn.getvalue().decode()
    return f"<div style='max-width: 36em'>{text[text.index('<svg') :]}</div>"


def _link(mechanism: Mechanism, name: str) -> tuple[str, str]:
    """Points of a link, and its length in the unit of the display."""
    link = mechanism.links[name]
    if link.length is None:
        return ", ".join(link.coordinates), ""
    factor, unit = shown_as("m" if mechanism.space == "plane" else "rad", mechanism.display)
    return ", ".join(link.coordinates), f"{factor * link.length:.6g} {unit}"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Rows as a table, whatever stands in them shown as it is."""
    heads = "".join(f"<th style='text-align: left'>{html.escape(cell)}</th>" for cell in head)
    lines = [
        "<tr>" + "".join(f"<td style='text-align: left'>{html.escape(cell)}</td>" for cell in row) + "</tr>"
        for row in rows
    ]
    return f"<table>{f'<tr>{heads}</tr>' if heads else ''}{''.join(lines)}</table>"
