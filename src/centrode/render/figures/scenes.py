"""Scenes as figures as wide as a page: the linkage in its conventional signs, with its marks, lines and curves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.locale import _, ngettext
from centrode.render.drawing.figure_room import PAGE_WIDTH, figure_width
from centrode.render.drawing.globe import arcs_on_paper, draw_globe, draw_line
from centrode.render.drawing.linkage import draw_mechanism
from centrode.render.drawing.style import INK, LINK, MUTED, NAME, SMALL, marker_options, pens
from centrode.render.drawing.tags import Tag, drive_arcs, lines, write_tags
from centrode.render.drawing.texts import plain
from centrode.render.drawing.window import carried_by, segments_of, widen, within
from centrode.render.figures.curves import columns_above, write_title
from centrode.render.figures.linkages import caption, initial_sample, label_lengths
from centrode.render.spelling import FigureSpelling, PrintSpelling
from centrode.scenes.linkage import scene_of
from centrode.scenes.places import Array
from centrode.scenes.places import LinkageScene as Sheet
from centrode.scenes.sphere import STEPS, Globe, globe_of, laid, whole
from centrode.sheets.scenes import ChordKind, CurveKind, LineKind, Mark, MarkKind

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.scenes import CarriedCurve, CircleDiagram, Scene, SceneNote, StraightLine

Segments: TypeAlias = list[tuple[Array, Array]]
Size: TypeAlias = tuple[float, float]
Box: TypeAlias = tuple[float, float, float, float]

HEIGHT = 4.9
"""Of a figure [inch]."""
LEFT, BOTTOM, UP = 0.105, 0.1, 0.76
"""Where the drawing stands, as parts of the figure."""
ACROSS, BESIDE_LEGEND, BESIDE_DIAGRAM = 0.62, 0.58, 0.51
"""Width of the drawing beside two lines of a legend, beside more of them, and beside a circle diagram."""
COLUMN, LINE, CAPTION = 2.3, 0.21, 0.3
"""Inches of a narrow figure: a circle diagram with its key below the drawing, a line of a legend, the caption above."""
CENTRE, FOUND = "#A00000", "#0072B2"
TOGETHER = {"plane": 0.3, "sphere": 0.5}
"""Places nearer than this share one text, in radii of a hinge."""
LOOKS = 9
"""Samples whose curves the window holds."""
BEHIND = 0.45
"""Opacity of what lies behind the sphere."""


class CurveLook(NamedTuple):
    """How a kind of curve is drawn, and every how manieth of its places the window holds; none if zero."""

    colour: str
    width: float
    level: float
    framed: int


CURVES = {
    CurveKind.FIXED: CurveLook("#0072B2", 1.6, 7.2, 1),
    CurveKind.MOVING: CurveLook("#D55E00", 1.6, 7.2, 1),
    CurveKind.INFLECTION: CurveLook("#0072B2", 1.4, 6.8, 1),
    CurveKind.STATIONARY: CurveLook("#009E73", 1.4, 6.8, 0),  # it goes to infinity
}
MARKS: Mapping[MarkKind, dict[str, Any]] = {
    MarkKind.CENTRE: {"markersize": 4.2, "markeredgewidth": 0.6, "zorder": 7.5},
    MarkKind.POLE: {"markersize": 5.0, "zorder": 9.5},
}
RADIUS: dict[str, Any] = {"color": MUTED, "linewidth": 0.8}


def scene_figure(scene: Scene, display: Display) -> Figure:
    """A scene as a figure; beside it its legend, or its circle diagram with the notes."""
    return _Drawing(scene, display).figure()


@dataclass(frozen=True)
class _Placed:
    """A mark where it stands on paper."""

    mark: Mark
    place: Array
    flat: Array


class _Drawing:
    """One scene on its paper."""

    def __init__(self, scene: Scene, display: Display) -> None:
        self.scene = scene
        self.spelling = FigureSpelling(display)
        self.is_narrow = figure_width() < PAGE_WIDTH
        self.size, self.box = self._narrow_place() if self.is_narrow else self._place()
        linkage = scene.linkage
        self.linkage, self.mechanism = linkage, linkage.description
        self.paper = self._paper()
        self.sample = self._chosen_sample() if linkage.sample is None else linkage.sample

    def figure(self) -> Figure:
        """Draw everything."""
        scene, paper = self.scene, self.paper
        figure = Figure(figsize=self.size)
        axes = figure.add_axes(self.box)
        if isinstance(paper, Globe):
            draw_globe(axes, paper, self.sample, names=False)
            solid = arcs_on_paper(paper, self.sample)
        else:
            draw_mechanism(axes, paper, self.sample, names=False)
            label_lengths(axes, paper)
            solid = lines(paper, self.sample)
        axes.set_title(caption(self.mechanism, self.linkage.motion, self.sample))
        rays = [segment for line in scene.lines for segment in self._draw_line(axes, line)]
        curves = [self._placed_curve(curve, self.sample) for curve in scene.curves]
        for curve, places in zip(scene.curves, curves, strict=True):
            self._draw_curve(axes, curve, places)
        marks = [one for one in self._marks(curves) if within(axes, one.flat)]
        for one in marks:
            behind = isinstance(paper, Globe) and not bool(paper.in_front(one.place))
            axes.plot(*one.flat, marker="D", color=CENTRE, markeredgecolor="white", alpha=BEHIND if behind else 1.0,
                      **MARKS[one.mark.kind])  # fmt: skip
        thin = (
            rays
            if isinstance(paper, Globe)
            else [*segments_of([self._inside(curve) for curve in curves]), *rays]
        )
        reach = 72 * paper.sign * paper.inches / paper.extent
        write_tags(axes, [*self._tags(marks), *self._branches(axes, curves)], solid, thin, NAME, reach)
        if scene.diagram is None:
            self._write_legend(figure, axes)
        else:
            self._draw_column(figure, scene.diagram, [one.mark for one in marks])
        title = PrintSpelling(self.spelling.display).text(scene.mechanism)
        write_title(figure, self.spelling.text(scene.title), title)
        return figure

    # where things are

    def _place(self) -> tuple[Size, Box]:
        """Sides of the figure [inch], and the place of the drawing as parts of them, all else on its right."""
        scene = self.scene
        across = BESIDE_DIAGRAM if scene.diagram else ACROSS if len(scene.legend) <= 2 else BESIDE_LEGEND
        return (PAGE_WIDTH, HEIGHT), (LEFT, BOTTOM, across, UP)

    def _narrow_place(self) -> tuple[Size, Box]:
        """The same where all else finds room below the drawing alone."""
        width, edge = figure_width(), LEFT * PAGE_WIDTH
        below = COLUMN if self.scene.diagram else LINE * self._legend_rows()[1]
        height = HEIGHT * (BOTTOM + UP) + CAPTION + below
        box = (
            edge / width,
            (HEIGHT * BOTTOM + below) / height,
            (width - edge) / width - 0.03,
            HEIGHT * UP / height,
        )
        return (width, height), box

    def _legend_rows(self) -> tuple[int, int]:
        """Columns of the legend below a drawing, and lines of one of them."""
        texts = [self.spelling.text(text).splitlines() for _kind, text in self.scene.legend]
        columns = columns_above([line for lines in texts for line in lines], figure_width()) if texts else 1
        return columns, -(-len(texts) // columns) * max(map(len, texts), default=0)

    def _paper(self) -> Sheet | Globe:
        """The motion read for drawing, in a window that also holds the marks and curves not too far out."""
        motion = self.linkage.motion
        if self.mechanism.space == "sphere":
            return whole(globe_of(self.mechanism, motion))
        self.paper = scene_of(self.mechanism, motion)
        looks = np.unique(np.linspace(0, motion.sizes["sample"] - 1, LOOKS).astype(int)).tolist()
        framed = [(curve, CURVES[curve.kind].framed) for curve in self.scene.curves]
        places = [
            self._placed_curve(curve, look)[::every] for look in looks for curve, every in framed if every
        ]
        places += [self._place_mark(mark).place[None] for mark in self.scene.marks]
        places += drive_arcs(self.paper, initial_sample(self.paper, motion))
        room = (self.box[2] * self.size[0] - 0.3, self.box[3] * self.size[1] - 0.3)
        return widen(self.paper, np.concatenate([*places, np.empty((0, 2))]), room)

    def _chosen_sample(self) -> int:
        """The sample nearest to the initial one at which the curves touch within the window, else anywhere."""
        start = initial_sample(self.paper, self.linkage.motion)
        curve = self.scene.curves[0]
        seen = known = curve.pieces >= 0
        if not isinstance(self.paper, Globe):
            places = self.paper.factor * curve.places
            with np.errstate(invalid="ignore"):
                seen = np.asarray(((places >= self.paper.low) & (places <= self.paper.high)).all(axis=1))
            known = np.asarray(np.isfinite(places).all(axis=1))
        candidates = np.flatnonzero(seen if seen.any() else known)
        return int(candidates[np.argmin(np.abs(candidates - start))]) if candidates.size else start

    def _place_mark(self, mark: Mark) -> _Placed:
        """A mark on paper; of the two ends of an axis the one that is seen."""
        if not isinstance(self.paper, Globe):
            place = self.paper.factor * mark.place
            return _Placed(mark, place, place)
        flipped = mark.either_end and not bool(self.paper.in_front(mark.place))
        place = -mark.place if flipped else mark.place
        return _Placed(mark, place, self.paper.flat(place))

    def _placed_curve(self, curve: CarriedCurve, sample: int) -> Array:
        """A curve as it lies at a sample; NaN where its body has no position."""
        if not isinstance(self.paper, Globe):
            return carried_by(self.paper, curve.body, curve.places, sample)
        places = laid(self.paper, curve.body, curve.places, sample)
        return np.full_like(curve.places, np.nan) if places is None else places

    def _marks(self, curves: Sequence[Array]) -> Iterator[_Placed]:
        """The marks of the scene, and the place where its curves touch at the sample."""
        yield from map(self._place_mark, self.scene.marks)
        if self.scene.contact is None:
            return
        place = curves[0][self.sample]
        if np.isfinite(place).all():
            flat = self.paper.flat(place) if isinstance(self.paper, Globe) else place
            yield _Placed(Mark(place, MarkKind.POLE, self.scene.contact), place, flat)

    def _inside(self, curve: Array) -> Array:
        with np.errstate(invalid="ignore"):
            near = np.asarray(((curve >= self.paper.low) & (curve <= self.paper.high)).all(axis=1))
        return np.where(near[:, None], curve, np.nan)

    # what is drawn

    def _draw_line(self, axes: Axes, line: StraightLine) -> Segments:
        """A straight line or a great circle; returns its pieces for names to keep clear of."""
        places = [self._place_mark(mark).place for mark in line.through]
        if isinstance(self.paper, Globe):
            return self._draw_great_circle(axes, places[0], places[1])
        ends = (
            places if line.kind is LineKind.RADIUS else _ends(places, line.direction, 4.0 * self.paper.extent)
        )
        if not ends:
            return []
        how: dict[str, Any] = {"color": FOUND, "linewidth": 0.6, "dashes": (5, 2.5), "zorder": 1.2}
        if line.kind is LineKind.RADIUS:
            how = RADIUS | {"zorder": 6.5}
        axes.plot(*np.array(ends).T, scalex=False, scaley=False, **how)
        return [(ends[0], ends[1])]

    def _draw_great_circle(self, axes: Axes, first: Array, second: Array) -> Segments:
        assert isinstance(self.paper, Globe)
        normal = np.cross(first, second)
        across = np.cross(normal / np.linalg.norm(normal), first)
        turn = np.linspace(0.0, 2.0 * np.pi, 4 * STEPS + 1)[:, None]
        circle = np.cos(turn) * first + np.sin(turn) * across
        draw_line(axes, self.paper, circle, FOUND, 0.8, linestyle=(0, (5, 2.5)), alpha=0.9, zorder=1.2)
        return list(pairwise(self.paper.flat(circle)[self.paper.in_front(circle)][::6]))

    def _draw_curve(self, axes: Axes, curve: CarriedCurve, places: Array) -> None:
        """A curve piece by piece, so that nothing joins where it goes to infinity."""
        look = CURVES[curve.kind]
        for piece in np.unique(curve.pieces[curve.pieces >= 0]):
            own = places[curve.pieces == piece]
            if isinstance(self.paper, Globe):
                draw_line(axes, self.paper, own, look.colour, look.width, zorder=look.level)
                continue
            dot: dict[str, Any] = {"marker": "o", "markersize": 2.5} if len(own) == 1 else {}
            axes.plot(*own.T, color=look.colour, linewidth=look.width, zorder=look.level, scalex=False,
                      scaley=False, **dot)  # fmt: skip

    def _tags(self, marks: Sequence[_Placed]) -> list[Tag]:
        """Names of points and marks; those in one place share a text."""
        paper, near = self.paper, TOGETHER[self.mechanism.space]
        flat = paper.flat if isinstance(paper, Globe) else np.asarray
        entries = [(flat(place), [plain(name)]) for name, place in paper.at(self.sample).items()]
        for one in marks:
            texts = next(
                (texts for at, texts in entries if np.hypot(*(at - one.flat)) < near * paper.sign), None
            )
            if texts is None:
                entries.append((one.flat, texts := []))
            texts.append(self.spelling.text(one.mark.name))
        return [Tag(place, _wrap(texts)) for place, texts in entries]

    def _branches(self, axes: Axes, curves: Sequence[Array]) -> Iterator[Tag]:
        """The numbers of the branches of curves that have several, beside the middle of what is seen of each."""
        for curve, places in zip(self.scene.curves, curves, strict=True):
            numbers = np.unique(curve.pieces[curve.pieces >= 0])
            if numbers.size < 2 or isinstance(self.paper, Globe):
                continue
            for number in numbers.tolist():
                own = self._inside(places[curve.pieces == number])
                own = own[np.isfinite(own).all(axis=1)]
                if len(own) and within(axes, own[len(own) // 2]):
                    yield Tag(own[len(own) // 2], str(number + 1), CURVES[curve.kind].colour)

    # what stands beside it

    def _write_legend(self, figure: Figure, axes: Axes) -> None:
        """What the kinds of curves, lines and marks are."""
        entries = [_handle(kind) for kind, _text in self.scene.legend]
        texts = [self.spelling.text(text) for _kind, text in self.scene.legend]
        look: dict[str, Any] = {"borderaxespad": 0.0, "handlelength": 2.0}
        if self.is_narrow:
            look |= {"loc": "lower left", "ncols": self._legend_rows()[0], "columnspacing": 1.2}
            figure.legend(entries, texts, bbox_to_anchor=(self.box[0], 0.0), **look)
        else:
            axes.legend(entries, texts, loc="upper left", bbox_to_anchor=(1.01, 1.0), **look)

    def _draw_column(self, figure: Figure, diagram: CircleDiagram, shown: Sequence[Mark]) -> None:
        """The circle diagram, the bodies by number, and the notes."""
        wide, high = self.size
        circle, text = (0.66, 0.455, 0.33, 0.425), (0.645, 0.01, 0.35, 0.43)
        if self.is_narrow:  # beside each other below the drawing, the text as wide as on a page
            side, height = 0.26 * PAGE_WIDTH, 0.43 * HEIGHT / high
            circle = (0.0, 0.05 / high, side / wide, height)
            text = ((side + 0.05) / wide, 0.05 / high, (wide - side - 0.05) / wide, height)
        draw_circle_diagram(figure.add_axes(circle), diagram)
        key = figure.add_axes(text)
        key.set_axis_off()
        links = pens(self.mechanism.link_names)
        handles = [
            Line2D([], [], color=links[name].colour, linewidth=LINK, **marker_options(links[name], None))
            if name in links
            else Line2D([], [], color=INK, linewidth=0.0)
            for name, _text in diagram.bodies
        ]
        texts = [
            f"{number} {self.spelling.text(text)}" for number, (_name, text) in enumerate(diagram.bodies)
        ]
        columns = 1 if len(texts) <= 4 else 2 if len(texts) <= 12 else 3
        key.legend(
            handles, texts, loc="upper left", bbox_to_anchor=(0.0, 1.0), ncols=columns, fontsize=SMALL,
            handlelength=1.4, borderaxespad=0.0, columnspacing=0.8, labelspacing=0.25,
        )  # fmt: skip
        rows = -(-len(texts) // columns)
        self._write_notes(key, shown, 1.0 - 0.066 * rows - 0.035)

    def _write_notes(self, key: Axes, shown: Sequence[Mark], top: float) -> None:
        """The notes in their order, as many as there is room for."""
        notes = [note for note in self.scene.notes if note.always or note.mark not in shown]
        texts = [self._note(note, shown) for note in notes]
        room = max(1, int(top / 0.062))
        if len(texts) > room:
            rest = len(texts) - room + 1
            more = ngettext("… and {n} more", "… and {n} more", rest).format(n=rest)
            texts = [*texts[: room - 1], more]
        key.text(0.0, top, "\n".join(texts), fontsize=SMALL, color=INK, va="top", linespacing=1.22,
                 transform=key.transAxes)  # fmt: skip

    def _note(self, note: SceneNote, shown: Sequence[Mark]) -> str:
        text = self.spelling.text(note.text)
        return text if note.mark is None or note.mark in shown else f"{text}, " + _("off the sheet")


def draw_circle_diagram(axes: Axes, diagram: CircleDiagram) -> None:
    """Bodies on a circle; chords of primary centres are full and dark, of constructed ones dashed and blue."""
    count = len(diagram.bodies)
    turns = np.pi / 2 - 2 * np.pi * np.arange(count) / count
    places = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    colours = {ChordKind.PRIMARY: INK, ChordKind.CONSTRUCTED: FOUND, ChordKind.FIELD: CENTRE}
    for ends, kind in diagram.chords:
        primary = kind is ChordKind.PRIMARY
        axes.plot(*places[list(ends)].T, color=colours[kind], linewidth=1.5 if primary else 1.0,
                  linestyle="-" if primary else (0, (4, 2)), zorder=2)  # fmt: skip
    axes.plot(*np.concatenate([places, places[:1]]).T, color=MUTED, linewidth=0.4, zorder=1)
    for number, place in enumerate(places):
        axes.plot(*place, marker="o", markersize=4.0, color=INK, zorder=3)
        x, y = 1.16 * place
        axes.text(x, y, str(number), fontsize=NAME, color=INK, ha="center", va="center")
    axes.set_aspect("equal")
    axes.set_xlim(-1.3, 1.3)
    axes.set_ylim(-1.3, 1.3)
    axes.set_axis_off()


def _ends(places: Sequence[Array], direction: Array | None, far: float) -> Sequence[Array]:
    """Ends of the line through places, beyond the picture where it has a direction; none for a point."""
    # rounding of a place far out would turn the line
    known = [place for place in places if np.abs(place).max() < 50 * far]
    if direction is not None and known:
        inside, along = [known[0] - far * direction, known[0] + far * direction, *known], direction
    elif len(known) > 1:
        inside = known
        along = max((b - a for a in known for b in known), key=lambda v: float(np.hypot(*v)))
    else:
        return ()
    shares = [float(place @ along) for place in inside]
    return inside[int(np.argmin(shares))], inside[int(np.argmax(shares))]


def _wrap(texts: Sequence[str]) -> str:
    """Texts side by side, three in a line."""
    return "\n".join(", ".join(texts[k : k + 3]) for k in range(0, len(texts), 3))


def _handle(kind: MarkKind | LineKind | CurveKind) -> Line2D:
    """What stands in a legend for a kind."""
    if isinstance(kind, CurveKind):
        return Line2D([], [], color=CURVES[kind].colour, linewidth=CURVES[kind].width)
    if isinstance(kind, LineKind):
        return Line2D([], [], **RADIUS)
    return Line2D([], [], color=CENTRE, marker="D", linewidth=0.0, markersize=MARKS[kind]["markersize"])
