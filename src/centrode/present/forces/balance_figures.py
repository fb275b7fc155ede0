"""Figures of a balance: hodograph of the shaking force, effects over the cycle, harmonics, the counterweights drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

from centrode.locale import _
from centrode.present.abscissa import main_abscissa
from centrode.present.curves import Panel, legend_width, sheet, write_legend, write_title
from centrode.present.drawing import draw_mechanism
from centrode.present.reading import scene_of
from centrode.present.scene import Scene, box
from centrode.present.shown import formula, labelled, shown_as
from centrode.present.style import DASHES, INK, PALETTE, Decimals, Pen, house_style, pens
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.balancing.balance import Balance
    from centrode.dynamics.balancing.counterweights import Counterweight

Array = NDArray[np.float64]
BEFORE, AFTER = Pen(PALETTE[1], DASHES[1]), Pen(PALETTE[0])
SHOWN = 0.12
"""Share of the motion at which the mechanism is drawn: at its beginning links often lie on one line."""


def balance_figures(balance: Balance, motion: xarray.Dataset) -> dict[str, Figure]:
    """Figures of a balance, by name.

    Parameters
    ----------
    balance : Balance
    motion : Dataset
        The mechanism's motion over its cycle; one sample of it is drawn.

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
    size = np.ptp(np.concatenate([data["shaking_force"] for data in (balance.before, balance.after)]), axis=0)
    width, height = np.maximum(6.0 * size / max(float(size.max()), np.finfo(float).tiny), 2.6)
    figure = Figure(figsize=(width + 2.9, height + 1.1), layout="constrained")
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
    for number, name in enumerate(("shaking_force_size", "shaking_moment", "inertia_on_drive")):
        unit = str(balance.before[name].attrs["units"])
        curves = {
            word: data[name].to_numpy()
            for word, data in zip(_words(), (balance.before, balance.after), strict=True)
        }
        drawn = dict(zip(curves, (BEFORE, AFTER), strict=True))
        quantity = QUANTITIES[name]
        label = labelled(f"{quantity.title}", unit)
        scale = max(float(np.nanmax(np.abs(curve))) for curve in curves.values())
        rows.append([Panel(label, unit, curves, drawn, scale, legend=number == 0)])
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
        axes.set_axisbelow(True)
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
        # counterweights can shorten the cycle, and then it has fewer orders
        own, heights = data["order"].to_numpy()[1:], data[name].to_numpy()[1:]
        axes.bar(own + side * width, heights, width, color=pen.colour, label=word)
    axes.set_xticks(orders if len(orders) <= 20 else orders[:: -(-len(orders) // 20)])
    if not any(float(data[name].max()) for data in (balance.before, balance.after)):
        axes.set_ylim(0.0, 1.0)


def _drawing(balance: Balance, motion: xarray.Dataset) -> Figure:
    """The mechanism with its counterweights at one sample, and what they weigh in a legend."""
    scene = scene_of(balance.mechanism, motion)
    sample = round(SHOWN * motion.sizes["sample"])
    heavy = [one for one in balance.counterweights if one.mass > 0.0]
    scene = _wide_enough(scene, heavy, sample)
    size = scene.high - scene.low
    colours = pens(balance.mechanism.link_names)
    names = {one.link: _name(balance, one) for one in heavy}
    beside = legend_width(list(names.values())) if names else 0.0
    width, height = 6.4 * size / scene.extent
    figure = Figure(figsize=(max(width, 3.2) + 1.0 + beside, height + 1.5), layout="constrained")
    axes = figure.subplots()
    draw_mechanism(axes, scene, sample)
    key: list[tuple[Artist, str]] = []
    for one in heavy:
        circle = _draw_one(axes, scene, sample, one, colours[one.link].colour)
        key += [] if circle is None else [(circle, names[one.link])]
    write_legend(axes, key, inches=float(height))
    axes.grid(visible=False)
    axes.set_xlabel(labelled(formula("x"), str(balance.mechanism.display.length)))
    axes.set_ylabel(labelled(formula("y"), str(balance.mechanism.display.length)))
    write_title(figure, _("Counterweights"), _(balance.mechanism.title))
    return figure


def _name(balance: Balance, one: Counterweight) -> str:
    factor, unit = shown_as("m", balance.mechanism.display)
    text = _("{link}: {mass:.4g} kg, {radius:.4g} {unit} from {base}")
    return text.format(link=one.link, mass=one.mass, radius=one.radius * factor, unit=unit, base=one.base)


def _reach(scene: Scene, one: Counterweight) -> float:
    """Radius of the circle that is drawn: the disc's own, else a sign."""
    return 2.4 * scene.sign if one.disc is None else max(one.disc * scene.factor, 1.5 * scene.sign)


def _wide_enough(scene: Scene, counterweights: Sequence[Counterweight], sample: int) -> Scene:
    """The scene with corners that hold the counterweights too."""
    corners = [np.array([scene.low, scene.high])]
    for one in counterweights:
        at = scene.carried(one.link, one.place, sample)
        if at is not None:
            corners.append(np.array([at - _reach(scene, one), at + _reach(scene, one)]))
    low, high = box(corners)
    return replace(scene, low=low, high=high)


def _draw_one(axes: Axes, scene: Scene, sample: int, one: Counterweight, colour: str) -> Circle | None:
    """An arm from the base, and a filled circle; great discs lie behind the links."""
    at, base = scene.carried(one.link, one.place, sample), scene.at(sample).get(one.base)
    if at is None or base is None:
        return None
    axes.plot([base[0], at[0]], [base[1], at[1]], color=colour, linewidth=2.4, zorder=2.9)
    circle = Circle(
        (at[0], at[1]), _reach(scene, one), facecolor=colour, edgecolor=INK, linewidth=0.9, zorder=1.9
    )
    circle.set_alpha(0.55)
    axes.add_patch(circle)
    return circle
