"""What a notebook shows of a mechanism, its structure, its motion and its equations."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any

from centrode import render
from centrode.errors import CentrodeError
from centrode.kinematics.motion import motion as motion_of
from centrode.locale import _
from centrode.model.files import parse_mechanism
from centrode.model.settings import shown_as
from centrode.quantities import spelled_unit, with_unit
from centrode.sheets.linkages import MechanismPicture
from centrode.sheets.texts import Sentence
from centrode.topics.presentation import display_of, is_result, page, sheet_of

if TYPE_CHECKING:
    import xarray

    from centrode.equations.derivation import Equations
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
    return drawing + render.rows_html(heads, rows)


def result_html(result: Any) -> str:
    """A result of a topic as its first picture, its facts and its tables; a motion as a drawing over its dataset.

    A dataset that names no topic is shown as xarray shows it.
    """
    is_dataset = hasattr(result, "_repr_html_")
    own: str = result._repr_html_() if is_dataset else ""
    if is_dataset and not is_result(result):
        return own
    try:
        return render.sheet_html(sheet_of(result), display_of(result)) + own
    except (CentrodeError, LookupError, ValueError):  # parts of a dataset may lack what a picture needs
        return own


def motion_html(dataset: xarray.Dataset) -> str:
    """A motion as a drawing over xarray's own view of it; any other dataset as the result that it is."""
    if not _is_motion(dataset):
        return result_html(dataset)
    own: str = dataset._repr_html_()
    try:
        mechanism = parse_mechanism(dataset.attrs["mechanism"])
        return _drawing(mechanism, dataset) + own
    except (CentrodeError, LookupError, ValueError):  # parts of a motion may lack what a drawing needs
        return own


def equations_markdown(equations: Equations) -> str:
    """The equations of a mechanism as Markdown, their formulas as LaTeX between dollar signs."""
    return page(equations, "md")


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
    picture = MechanismPicture(Sentence("Mechanism"), mechanism, dataset)
    return render.figure_html(render.figure_of(picture, mechanism.display))


def _link(mechanism: Mechanism, name: str) -> tuple[str, str]:
    """Points of a link, and its length in the unit of the display."""
    link = mechanism.links[name]
    if link.length is None:
        return ", ".join(link.coordinates), ""
    factor, unit = shown_as("m" if mechanism.space == "plane" else "rad", mechanism.display)
    return ", ".join(link.coordinates), with_unit(f"{factor * link.length:.6g}", spelled_unit(unit))
