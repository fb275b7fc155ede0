"""Figures of a balance: hodograph of the shaking force, effects over the cycle, harmonics, the counterweights drawn."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

from centrode.locale import _
from centrode.present.abscissa import main_abscissa
from centrode.present.curves import Panel, sheet, write_title
from centrode.present.drawing import draw_mechanism
from centrode.present.labels import label_places
from centrode.present.obstacles import lines
from centrode.present.reading import scene_of
from centrode.present.scene import Scene, box
from centrode.present.shown import formula, labelled, plain
from centrode.present.style import DASHES, INK, MUTED, PALETTE, Decimals, Pen, house_style, pens
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.balancing.balance import Balance
    from centrode.dynamics.balancing.counterweights import Counterweight

Array = NDArray[np.float64]
BEFORE, AFTER = Pen(PALETTE[1], DASHES[1]), Pen(PALETTE[0])
NOTHING = 1e-9
WEIGHT_POINTS = 8.5


def balance_figures(balance: Balance, motion: xarray.Dataset) -> dict[str, Figure]:
    """Figures of a balance, by name.

    Parameters
    ----------
    balance : Balance
    motion : Dataset
        The mechanism's motion; the first sample is drawn.

    Returns
    -------
    dict of name -> Figure
        "shaking-hodograph", "shaking-cycle", "shaking-harmonics", "counterweights".
    """
    with house_style():
        return {
            "shaking-hodograph": _hodograph(balance),
            "shaking-cycle": _cycle(balance),
            "shaking-harmonics": _harmonics(balance),
            "counterweights": _drawing(balance, motion),
        }


def _words() -> tuple[str, str]:
    return _("without counterweights"), _("with counterweights")


def _hodograph(balance: Balance) -> Figure:
    """Ends of the shaking force from one origin, with dots every tenth of the cycle."""
    figure = Figure(figsize=(7.4, 6.2), layout="constrained")
    axes = figure.subplots()
    for word, data, pen in zip(_words(), (balance.before, balance.after), (BEFORE, AFTER), strict=True):
        force = data["shaking_force"].to_numpy()
        axes.plot(force[:, 0], force[:, 1], color=pen.colour, linestyle=pen.dashes, label=word)
        marks = np.unique(np.linspace(0, len(force) - 1, 11).round().astype(int))
        axes.plot(force[marks, 0], force[marks, 1], ".", color=pen.colour, markersize=5)
        axes.plot(force[:1, 0], force[:1, 1], "o", color=pen.colour, markersize=6)
    axes.plot([0.0], [0.0], "+", color=INK, markersize=9)
    axes.set_aspect("equal", adjustable="datalim")
    symbol = QUANTITIES["shaking_force"].symbol
    axes.set_xlabel(labelled(formula(symbol, "x"), "N"))
    axes.set_ylabel(labelled(formula(symbol, "y"), "N"))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(Decimals())
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)
    write_title(
        figure,
        _("Shaking force on the frame; its beginning is the great dot"),
        _(balance.mechanism.title),
    )
    return figure


def _cycle(balance: Balance) -> Figure:
    """Size of the force, moment, and what the drive gives, over the cycle."""
    rows = []
    for name in ("shaking_force_size", "shaking_moment", "inertia_on_drive"):
        unit = str(balance.before[name].attrs["units"])
        curves = {
            word: data[name].to_numpy()
            for word, data in zip(_words(), (balance.before, balance.after), strict=True)
        }
        drawn = dict(zip(curves, (BEFORE, AFTER), strict=True))
        quantity = QUANTITIES[name]
        label = labelled(f"{quantity.title}", unit)
        scale = max(float(np.nanmax(np.abs(curve))) for curve in curves.values())
        rows.append([Panel(label, unit, curves, drawn, scale)])
    title = _("What the inertia does to the frame and to the drive")
    return sheet(title, _(balance.mechanism.title), rows, main_abscissa(balance.mechanism, balance.before))


def _harmonics(balance: Balance) -> Figure:
    """Bars of the harmonics of force and moment, by order."""
    figure = Figure(figsize=(9.2, 6.4), layout="constrained")
    for axes, (name, text) in zip(
        figure.subplots(2, 1, sharex=True),
        (
            ("force_harmonic_greatest", QUANTITIES["force_harmonic_greatest"].title),
            ("moment_harmonic_amplitude", _("amplitude of the moment")),
        ),
        strict=True,
    ):
        _bars(axes, balance, name)
        axes.set_ylabel(labelled(text, str(balance.before[name].attrs["units"])))
        axes.yaxis.set_major_formatter(Decimals())
        axes.grid(visible=False, axis="x")
    axes.set_xlabel(_("order: periods in a turn of the drive"))
    figure.axes[0].legend(loc="upper right")
    write_title(figure, _("Harmonics of shaking force and moment"), _(balance.mechanism.title))
    return figure


def _bars(axes: Axes, balance: Balance, name: str) -> None:
    orders = balance.before["order"].to_numpy()[1:]
    width = 0.38 * float(orders[1] - orders[0] if len(orders) > 1 else 1.0)
    for side, word, data, pen in zip(
        (-0.5, 0.5), _words(), (balance.before, balance.after), (BEFORE, AFTER), strict=True
    ):
        heights = data[name].to_numpy()[1:]
        axes.bar(orders + side * width, heights, width, color=pen.colour, label=word)
    axes.set_xticks(orders if len(orders) <= 20 else orders[:: -(-len(orders) // 20)])
    if not any(float(data[name].max()) for data in (balance.before, balance.after)):
        axes.set_ylim(0.0, 1.0)


def _drawing(balance: Balance, motion: xarray.Dataset) -> Figure:
    """The mechanism with its counterweights at the first sample."""
    scene = scene_of(balance.mechanism, motion)
    scene = _wide_enough(scene, balance.counterweights)
    size = scene.high - scene.low
    width = 7.0 * float(size[0]) / scene.extent + 1.6
    figure = Figure(
        figsize=(max(4.6, width), 7.0 * float(size[1]) / scene.extent + 1.4), layout="constrained"
    )
    axes = figure.subplots()
    draw_mechanism(axes, scene, 0)
    colours = pens(balance.mechanism.link_names)
    heavy = [one for one in balance.counterweights if one.mass > 0.0]
    for one in heavy:
        _draw_one(axes, scene, one, colours[one.link].colour)
    _write_masses(axes, scene, heavy)
    axes.grid(visible=False)
    axes.set_xlabel(labelled(formula("x"), str(balance.mechanism.display.length)))
    axes.set_ylabel(labelled(formula("y"), str(balance.mechanism.display.length)))
    write_title(figure, _("Counterweights"), _(balance.mechanism.title))
    return figure


def _reach(scene: Scene, one: Counterweight) -> float:
    """Radius of the circle that is drawn: the disc's own, else a sign."""
    return 2.6 * scene.sign if one.disc is None else max(one.disc * scene.factor, 1.5 * scene.sign)


def _wide_enough(scene: Scene, counterweights: tuple[Counterweight, ...]) -> Scene:
    """The scene with corners that hold the counterweights too."""
    corners = [np.array([scene.low, scene.high])]
    for one in counterweights:
        at = scene.carried(one.link, one.place, 0)
        if at is not None and one.mass > 0.0:
            corners.append(np.array([at - _reach(scene, one), at + _reach(scene, one)]))
    low, high = box(corners)
    return replace(scene, low=low, high=high)


def _draw_one(axes: Axes, scene: Scene, one: Counterweight, colour: str) -> None:
    """An arm from the base, and a filled circle."""
    at, base = scene.carried(one.link, one.place, 0), scene.at(0).get(one.base)
    if at is None or base is None:
        return
    axes.plot([base[0], at[0]], [base[1], at[1]], color=colour, linewidth=2.4, zorder=2.9)
    circle = Circle(
        (at[0], at[1]), _reach(scene, one), facecolor=colour, edgecolor=INK, linewidth=0.9, zorder=4.5
    )
    circle.set_alpha(0.55)
    axes.add_patch(circle)


def _write_masses(axes: Axes, scene: Scene, counterweights: list[Counterweight]) -> None:
    """The mass beside each counterweight."""
    places = {}
    for one in counterweights:
        at = scene.carried(one.link, one.place, 0)
        if at is not None:
            places[f"{one.mass:.4g} kg"] = at
    point = scene.extent / (72.0 * scene.inches)
    offset = max([_reach(scene, one) for one in counterweights], default=0.0) + 0.9 * WEIGHT_POINTS * point
    centres = label_places(places, lines(scene, 0), offset, WEIGHT_POINTS * point)
    for text, centre in centres.items():
        axes.text(
            centre[0],
            centre[1],
            plain(text),
            fontsize=WEIGHT_POINTS,
            color=MUTED,
            ha="center",
            va="center",
            zorder=8,
        )
