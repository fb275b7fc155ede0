"""Figures of an integrated motion over time, with the curves in closed form under the integrated ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from centrode.locale import _
from centrode.model.labels import constraint_name
from centrode.present.abscissa import Abscissa, over_time
from centrode.present.curves import Panel, sheet, write_legend, write_title
from centrode.present.panels import Motion, Rows, of_guides, of_links, of_points
from centrode.present.shown import formula, labelled, shown_as
from centrode.present.style import INK, Pen, house_style, pens
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
OVER = Pen(INK, (0, (2.5, 2.5)))
"""Integrated curves lie dashed over those in closed form, so that both show where they agree."""
THIN = 0.9
ROUNDING = 1e-15
"""Errors below this are not drawn: a logarithmic scale would show nothing but them."""


def integration_figures(
    mechanism: Mechanism, integration: xarray.Dataset, motion: xarray.Dataset
) -> dict[str, Figure]:
    """Figures of an integrated motion, by name.

    Parameters
    ----------
    mechanism : Mechanism
        The description.
    integration, motion : Dataset
        The integrated motion, and the one in closed form over the same range.

    Returns
    -------
    dict of name -> Figure
        "integrated-angles", "integrated-angular-velocities", "integrated-velocities", "integrated-slides" and
        "integration-errors": those that have something to show.
    """
    with house_style():
        kept = {
            "link": pens(mechanism.link_names),
            "point": pens(mechanism.moving_points),
            "guide": pens(guide.id for guide in mechanism.guides),
        }
        closed = Motion(mechanism, motion, over_time(motion), kept)
        integrated = Motion(mechanism, integration, over_time(integration), kept)
        figures = {}
        for name, (title, rows, over) in _sheets(closed, integrated).items():
            if any(panel.curves for row in rows for panel in row):
                figures[name] = sheet(title, _(mechanism.title), rows, closed.abscissa)
                _lay_over(figures[name], [panel for row in over for panel in row], integrated.abscissa)
        if any(
            (np.abs(integration[name].to_numpy()) > ROUNDING).any() for name in ("drift", "angle_difference")
        ):
            figures["integration-errors"] = _errors(mechanism, integration)
    return figures


def _sheets(closed: Motion, integrated: Motion) -> Mapping[str, tuple[str, Rows, Rows]]:
    """Title and panels of each figure, in closed form and integrated."""
    return {
        "integrated-angles": (
            _("Angles of the links over time"),
            of_links(closed, "angle"),
            of_links(integrated, "angle"),
        ),
        "integrated-angular-velocities": (
            _("Angular velocities of the links over time"),
            of_links(closed, "angular_velocity"),
            of_links(integrated, "angular_velocity"),
        ),
        "integrated-velocities": (
            _("Velocities of the points over time"),
            of_points(closed, "velocity"),
            of_points(integrated, "velocity"),
        ),
        "integrated-slides": (
            _("Motion along the guides over time"),
            of_guides(closed)[:2],
            _guides(integrated),
        ),
    }


def _guides(integrated: Motion) -> Rows:
    """Displacements and velocities; the equations integrated give no accelerations."""
    without = integrated.dataset.assign(slide_acceleration=integrated.dataset["slide_velocity"])
    return of_guides(Motion(integrated.mechanism, without, integrated.abscissa, integrated.pens))[:2]


def _lay_over(figure: Figure, panels: Sequence[Panel], abscissa: Abscissa) -> None:
    """Draw integrated curves over those that stand in a figure, with one entry in its legends."""
    for axes, panel in zip(figure.axes, panels, strict=False):
        for curve in panel.curves.values():
            axes.plot(
                abscissa.values, curve[abscissa.order], color=OVER.colour, linestyle=OVER.dashes, linewidth=THIN,
                zorder=3,
            )  # fmt: skip
        legend = axes.get_legend()
        if legend is not None:
            texts = [text.get_text() for text in legend.get_texts()]
            entries: list[tuple[Artist, str]] = [
                (handle, text) for handle, text in zip(legend.legend_handles, texts, strict=True) if handle
            ]
            line = Line2D([], [], color=OVER.colour, linestyle=OVER.dashes, linewidth=THIN)
            write_legend(axes, [*entries, (line, _("integrated"))])


def _errors(mechanism: Mechanism, integration: xarray.Dataset) -> Figure:
    """Drift of the constraints and differences of the angles from the closed forms, on logarithmic scales."""
    figure = Figure(figsize=(8.2, 6.0), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    abscissa = over_time(integration)
    factor, unit = shown_as(QUANTITIES["angle_difference"].unit, mechanism.display)
    constraints = {
        constraint_name(name): integration["drift"].sel(constraint=name).to_numpy()
        for name in integration["constraint"].to_numpy().tolist()
    }
    turning = [name for name in mechanism.link_names if integration["angle_difference"].sel(link=name).any()]
    _magnitudes(
        upper,
        abscissa,
        constraints,
        pens(constraints),
        _("drift, greatest length = 1"),
    )
    _magnitudes(
        lower,
        abscissa,
        {name: factor * integration["angle_difference"].sel(link=name).to_numpy() for name in turning},
        pens(mechanism.link_names),
        labelled(formula("|Δφ|"), unit),
    )
    lower.set_xlabel(abscissa.label)
    write_title(
        figure, _("Drift of the constraints, and difference from the closed forms"), _(mechanism.title)
    )
    return figure


def _magnitudes(
    axes: Axes, abscissa: Abscissa, curves: Mapping[str, Array], kept: Mapping[str, Pen], label: str
) -> None:
    handles: list[tuple[Artist, str]] = []
    for name, curve in curves.items():
        size = np.abs(curve[abscissa.order])
        shown = np.where(size > ROUNDING, size, np.nan)
        (line,) = axes.plot(
            abscissa.values, shown, color=kept[name].colour, linestyle=kept[name].dashes, label=name
        )
        handles.append((line, name))
    axes.set_yscale("log")
    if abscissa.values[0] < abscissa.values[-1]:
        axes.set_xlim(float(abscissa.values[0]), float(abscissa.values[-1]))
    axes.set_ylabel(label)
    write_legend(axes, handles)
