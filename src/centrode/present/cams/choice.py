"""What a choice costs: the front of best designs, with the parameters that lead to them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.cams.parameter_choice.problem import MEASURES
from centrode.locale import _
from centrode.model.cam import CONSTANT, POINT
from centrode.present.curves import legend_width, write_legend, write_title
from centrode.present.displayed_units import formula, label_with_unit, shown_as
from centrode.present.style import INK, MUTED, PALETTE, Decimals, house_style

if TYPE_CHECKING:
    from centrode.cams.parameter_choice.search import CamChoice, TradeOff
    from centrode.model.cam import Cam
    from centrode.model.settings import Display

Array = NDArray[np.float64]

FRONT, CHOSEN, START, BOUND = PALETTE[0], PALETTE[1], INK, PALETTE[3]
HIGH, LOW = 3.9, 1.35
"""Inches of the panel of the front, and of each parameter."""

SYMBOLS: Mapping[str, tuple[str, str, str]] = {
    "curvature.k0": ("k", "0", "1/m"),
    "curvature.k1": ("k", "1", "1/rad"),
    "start.radius": ("ρ", "0", "m"),
    "start.pressure_angle": ("γ", "0", "rad"),
    "roller.radius": ("r", "", "m"),
}
"""Letter, index and SI unit of each parameter."""


def trade_off_figure(found: CamChoice) -> Figure | None:
    """Best designs as a bound moves, the start and the chosen one among them; None where there is no front.

    Parameters
    ----------
    found : CamChoice
        Of `choose_cam`. Below the front stand the parameters of its designs.
    """
    front = found.front
    if front is None or not front.designs:
        return None
    with house_style():
        names = list(front.designs[0].parameters)
        handles = [_("best designs"), _("chosen"), _("start, misses a bound")]
        height = HIGH + LOW * len(names) + 1.1
        figure = Figure(figsize=(6.6 + legend_width(handles, HIGH), height), layout="constrained")
        rows = figure.subplots(
            1 + len(names), 1, sharex=True, height_ratios=[HIGH, *([LOW] * len(names))], squeeze=False
        )[:, 0]
        _draw_front(rows[0], found, front)
        for axes, name in zip(rows[1:], names, strict=True):
            _draw_parameter(axes, found, front, name)
        rows[-1].set_xlabel(_label(front.against, found.cam.display))
        write_title(figure, _title(front), _(found.cam.title))
    return figure


def choice_figures(found: CamChoice) -> dict[str, Figure]:
    """The figure of a choice's front by name, where there is one."""
    figure = trade_off_figure(found)
    return {} if figure is None else {"cam-choice": figure}


def parameter_symbol(name: str) -> tuple[str, str, str]:
    """Letter, index and SI unit of a parameter; a spline's points are numbered, a formula's constants as they are."""
    if POINT.fullmatch(name):
        return "K", name.rpartition(".")[2], "1/m"
    if CONSTANT.fullmatch(name):
        return name.rpartition(".")[2], "", "1"
    return SYMBOLS[name]


def parameter_unit(cam: Cam, name: str) -> str:
    """SI unit of a parameter: that of k1 depends on the law."""
    if name == "curvature.k1" and cam.curvature.law == "linear":
        return "1/m/rad"
    return parameter_symbol(name)[2]


def measure_shown(name: str, display: Display) -> tuple[float, str]:
    """Factor and unit in which a measure is shown: stresses in megapascals."""
    unit = MEASURES[name].unit
    return (1e-6, "MPa") if unit == "Pa" else shown_as(unit, display)


def _title(front: TradeOff) -> str:
    best, against = (_(MEASURES[name].title) for name in (front.best, front.against))
    return _("Trade-off: {best} against {against}").format(best=best, against=against)


def _label(name: str, display: Display) -> str:
    title = _(MEASURES[name].title)
    worst = _("least {measure}") if MEASURES[name].least else _("greatest {measure}")
    return label_with_unit(worst.format(measure=title), measure_shown(name, display)[1])


def _draw_front(axes: Axes, found: CamChoice, front: TradeOff) -> None:
    display = found.cam.display
    across, up = measure_shown(front.against, display)[0], measure_shown(front.best, display)[0]
    x, y = across * front.values(front.against), up * front.values(front.best)
    (line,) = axes.plot(x, y, color=FRONT, marker="o", markersize=3.5, label=_("best designs"))
    key: list[tuple[Artist, str]] = [(line, _("best designs"))]
    bound = found.choice.chosen.measures[front.against].bound
    if bound is not None:
        key.append((axes.axvline(across * bound, color=BOUND, linestyle="--", linewidth=1.2), _("bound")))
    for design, name, colour, marker in (
        (found.choice.start, _("start"), START, "s"),
        (found.choice.chosen, _("chosen"), CHOSEN, "D"),
    ):
        told = _("{name}, misses a bound").format(name=name) if design.misses else name
        place = [across * design.measures[front.against].value], [up * design.measures[front.best].value]
        face = "white" if design.misses else colour
        (dot,) = axes.plot(
            *place, marker, color=colour, markerfacecolor=face, markersize=7, linestyle="none", zorder=5
        )
        key.append((dot, told))
    axes.set_ylabel(_label(front.best, display))
    axes.yaxis.set_major_formatter(Decimals())
    axes.xaxis.set_major_formatter(Decimals())
    write_legend(axes, key, inches=HIGH)


def _draw_parameter(axes: Axes, found: CamChoice, front: TradeOff, name: str) -> None:
    letter, index, _unit = parameter_symbol(name)
    factor, unit = shown_as(parameter_unit(found.cam, name), found.cam.display)
    values = factor * np.array([design.parameters[name] for design in front.designs])
    axes.plot(
        measure_shown(front.against, found.cam.display)[0] * front.values(front.against), values, color=FRONT
    )
    assert found.cam.choose is not None
    for end in found.cam.choose.parameters[name]:
        low, high = float(values.min()), float(values.max())
        if low - 0.02 * abs(low) <= factor * end <= high + 0.02 * abs(high):
            axes.axhline(factor * end, color=MUTED, linewidth=0.9, linestyle=":")
    chosen = factor * found.choice.chosen.parameters[name]
    at = (
        measure_shown(front.against, found.cam.display)[0] * found.choice.chosen.measures[front.against].value
    )
    axes.plot([at], [chosen], "D", color=CHOSEN, markersize=5)
    axes.set_ylabel(label_with_unit(formula(letter, index), unit))
    axes.yaxis.set_major_formatter(Decimals())
