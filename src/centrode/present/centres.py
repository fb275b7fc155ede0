"""Instant centres as a picture: the mechanism with its centres at the left, the circle diagram at the right."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.analysis.instant_centres.centres import line_direction
from centrode.locale import _, ngettext
from centrode.model.labels import body_name
from centrode.present.curves import write_title
from centrode.present.drawing import draw_mechanism
from centrode.present.obstacles import lines
from centrode.present.pictures import caption, label_lengths
from centrode.present.reading import scene_of
from centrode.present.scene import Array, Scene
from centrode.present.shown import plain
from centrode.present.sphere.axes_drawing import draw_axes
from centrode.present.sphere.globe import globe_of
from centrode.present.style import INK, MUTED, house_style, pens
from centrode.present.symbols import subscripted
from centrode.present.tags import Tag, write_tags
from centrode.present.window import widened, within

if TYPE_CHECKING:
    import xarray

    from centrode.analysis.instant_centres.bodies import Pair
    from centrode.analysis.instant_centres.kennedy import Construction, KennedyStep
    from centrode.model.mechanism import Mechanism

WIDTH, HEIGHT = 8.2, 5.75  # inches: A5 across
LEFT = (0.085, 0.095, 0.53, 0.775)  # of the drawing, as parts of the figure
CENTRE = "#A00000"
FOUND = "#0072B2"
FULL = 6  # bodies of which all centres are shown
NAMED = 10.0  # size of names [pt]
TOGETHER = 0.3  # places nearer than this share one text, in radii of a hinge


def centres_figure(
    mechanism: Mechanism,
    motion: xarray.Dataset,
    construction: Construction,
    sample: int = 0,
    pairs: Sequence[tuple[str, str]] | None = None,
) -> Figure:
    """A position with its instant centres, the lines that they were found on, and the circle diagram.

    Parameters
    ----------
    mechanism : Mechanism
    motion : Dataset
        Without batch dimensions; the drawing holds all its samples.
    construction : Construction
        Of `construct_centres` at the sample.
    pairs : sequence of (body, body), optional
        The centres to show; all of up to six bodies, of more those against the frame, if left out.
    """
    with house_style():
        shown = _chosen(construction, pairs)
        needed = construction.needed(shown)
        figure = Figure(figsize=(WIDTH, HEIGHT))
        axes = figure.add_axes(LEFT)
        if mechanism.space == "sphere":
            seen = draw_axes(axes, globe_of(mechanism, motion), needed, shown, sample)
            axes.set_title(caption(mechanism, motion, sample))
            _column(figure, mechanism, needed, shown, seen)
            write_title(figure, _("Instantaneous axes"), _(mechanism.title))
            return figure
        scene = scene_of(mechanism, motion)
        centres = {step.pair: scene.factor * np.array(step.place) for step in needed.steps if step.place}
        places = np.array([centres[pair] for pair in shown if pair in centres]).reshape(-1, 2)
        scene = widened(scene, places, (LEFT[2] * WIDTH - 0.3, LEFT[3] * HEIGHT - 0.3))
        draw_mechanism(axes, scene, sample, names=False)
        label_lengths(axes, scene)
        axes.set_title(caption(mechanism, motion, sample))
        rays = _rays(axes, scene, needed, shown, centres)
        inside = {pair: place for pair, place in centres.items() if pair in shown and within(axes, place)}
        for place in inside.values():
            axes.plot(*place, marker="D", markersize=4.2, color=CENTRE, markeredgecolor="white",
                      markeredgewidth=0.6, zorder=7.5)  # fmt: skip
        tags = _tags(scene, sample, inside, len(construction.bodies))
        reach = 72 * scene.sign * scene.inches / scene.extent
        write_tags(axes, tags, lines(scene, sample), rays, NAMED, reach)
        _column(figure, mechanism, needed, shown, inside)
        write_title(figure, _("Instant centres"), _(mechanism.title))
    return figure


def _chosen(construction: Construction, pairs: Sequence[tuple[str, str]] | None) -> list[Pair]:
    names = construction.bodies
    if pairs is not None:
        numbers = [(names.index(first), names.index(second)) for first, second in pairs]
        return [(max(pair), min(pair)) for pair in numbers]
    everything = [step.pair for step in construction.steps]
    return everything if len(names) <= FULL else [pair for pair in everything if pair[1] == 0]


def _rays(
    axes: Axes, scene: Scene, needed: Construction, shown: Sequence[Pair], centres: dict[Pair, Array]
) -> list[tuple[Array, Array]]:
    """The lines of Kennedy's theorem through the centres that are shown, drawn and returned."""
    far = 4.0 * scene.extent
    found = []
    directions = {step.pair: np.array(step.direction) for step in needed.steps if step.direction}
    for step in needed.steps:
        if step.how != "kennedy" or step.pair not in shown:
            continue
        for by in step.by:
            legs = [step.pair, *((max(one, by), min(one, by)) for one in step.pair)]
            places = [centres[leg] for leg in legs if leg in centres]
            ways = [directions[leg] for leg in legs if leg in directions]
            if not places or (len(places) == 1 and not ways):
                continue
            known = [place for place in places if np.abs(place).max() < 50 * far]
            if ways and known:
                ends = [known[0] - far * ways[0], known[0] + far * ways[0], *known]
                along = ways[0]
            elif len(known) > 1:
                ends = known
                along = max((b - a for a in known for b in known), key=lambda v: float(np.hypot(*v)))
            else:
                continue
            shares = [float(place @ along) for place in ends]
            ray = ends[int(np.argmin(shares))], ends[int(np.argmax(shares))]
            axes.plot(*np.array(ray).T, color=FOUND, linewidth=0.6, dashes=(5, 2.5),
                      zorder=1.2, scalex=False, scaley=False)  # fmt: skip
            found.append(ray)
    return found


def _tags(scene: Scene, sample: int, centres: dict[Pair, Array], bodies: int) -> list[Tag]:
    """Names of points and centres; those in one place share a text."""
    entries = [(place, [plain(name)]) for name, place in scene.at(sample).items()]
    for pair, place in centres.items():
        near = [texts for at, texts in entries if np.hypot(*(at - place)) < TOGETHER * scene.sign]
        if near:
            near[0].append(subscripted(pair, bodies))
        else:
            entries.append((place, [subscripted(pair, bodies)]))
    return [Tag(place, _wrapped(texts)) for place, texts in entries]


def _wrapped(texts: Sequence[str]) -> str:
    """Texts side by side, three in a line."""
    return "\n".join(", ".join(texts[k : k + 3]) for k in range(0, len(texts), 3))


def _column(
    figure: Figure,
    mechanism: Mechanism,
    needed: Construction,
    shown: Sequence[Pair],
    inside: dict[Pair, Array],
) -> None:
    """Bodies by number, the circle diagram, and its chords in order."""
    diagram = figure.add_axes((0.66, 0.455, 0.33, 0.425))
    circle_diagram(diagram, needed)
    key = figure.add_axes((0.645, 0.01, 0.35, 0.43))
    key.set_axis_off()
    links = pens(mechanism.link_names)
    handles = [
        Line2D([], [], color=links[name].colour, linestyle=links[name].dashes, linewidth=2.2)
        if name in links
        else Line2D([], [], color=INK, linewidth=0.0)
        for name in needed.bodies
    ]
    texts = [f"{number} {plain(body_name(mechanism, name))}" for number, name in enumerate(needed.bodies)]
    columns = 1 if len(texts) <= 4 else 2 if len(texts) <= 12 else 3
    key.legend(
        handles, texts, loc="upper left", bbox_to_anchor=(0.0, 1.0), ncols=columns, fontsize=8.0,
        handlelength=1.4, borderaxespad=0.0, columnspacing=0.8, labelspacing=0.25,
    )  # fmt: skip
    rows = -(-len(texts) // columns)
    _order(key, needed, shown, inside, top=1.0 - 0.066 * rows - 0.035)


def _order(
    key: Axes, needed: Construction, shown: Sequence[Pair], inside: dict[Pair, Array], top: float
) -> None:
    """The constructed centres in their order, as many as there is room for."""
    count = len(needed.bodies)
    texts = [
        f"{subscripted(step.pair, count)}: {constructed(step, count)}{_elsewhere(step, step.pair in inside)}"
        for step in needed.steps
        if step.how not in ("hinge", "guide", "rolling") or (step.pair in shown and step.pair not in inside)
    ]
    room = max(1, int(top / 0.062))
    if len(texts) > room:
        rest = len(texts) - room + 1
        more = ngettext("… and {n} more", "… and {n} more", rest).format(n=rest)
        texts = [*texts[: room - 1], more]
    key.text(0.0, top, "\n".join(texts), fontsize=7.6, color=INK, va="top", linespacing=1.22,
             transform=key.transAxes)  # fmt: skip


def constructed(step: KennedyStep, bodies: int) -> str:
    """How a centre was found, in symbols where there are some."""

    def leg(one: int, by: int) -> str:
        return subscripted((max(one, by), min(one, by)), bodies)

    first, second = step.pair
    if step.how == "kennedy":
        return " × ".join(f"{leg(first, by)}{leg(second, by)}" for by in step.by)
    if step.how == "together":
        return f"{leg(first, step.by[0])} = {leg(second, step.by[0])}"
    words = {
        "hinge": _("hinge"),
        "guide": _("square to the guide") if step.place is None else _("pole of the guide"),
        "rolling": _("contact"),
        "gear": _("gear"),
        "rest": _("no relative motion"),
        "field": _("velocity field"),
    }
    return words[step.how]


def _elsewhere(step: KennedyStep, inside: bool) -> str:
    """What is said of a centre that the drawing does not show."""
    if step.direction is not None:
        return f", ∞ {line_direction(step.direction):.4g}°"
    return "" if inside or step.place is None else ", " + _("off the sheet")


def circle_diagram(axes: Axes, construction: Construction) -> None:
    """Bodies on a circle; chords of primary centres are full and dark, of constructed ones dashed and blue."""
    count = len(construction.bodies)
    turns = np.pi / 2 - 2 * np.pi * np.arange(count) / count
    places = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    for step in construction.steps:
        primary = step.how in ("hinge", "guide", "rolling")
        colour = INK if primary else CENTRE if step.how == "field" else FOUND
        axes.plot(*places[list(step.pair)].T, color=colour, linewidth=1.5 if primary else 1.0,
                  linestyle="-" if primary else (0, (4, 2)), zorder=2)  # fmt: skip
    axes.plot(*np.concatenate([places, places[:1]]).T, color=MUTED, linewidth=0.4, zorder=1)
    for number, place in enumerate(places):
        axes.plot(*place, marker="o", markersize=4.0, color=INK, zorder=3)
        x, y = 1.16 * place
        axes.text(x, y, str(number), fontsize=9.0, color=INK, ha="center", va="center")
    axes.set_aspect("equal")
    axes.set_xlim(-1.3, 1.3)
    axes.set_ylim(-1.3, 1.3)
    axes.set_axis_off()
