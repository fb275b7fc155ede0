"""Drawings of other programs as descriptions: what was understood, what was guessed, what was left out."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from centrode.errors import CentrodeError, InputError, Status
from centrode.kinematics.motion import initial_place, motion
from centrode.locale import _
from centrode.model.files import mechanism_from
from centrode.model.mechanism import Mechanism
from centrode.model.reading import Problem, read_content, read_link_name, two_points
from centrode.model.toml import in_short_lines
from centrode.model.units import read_quantity
from centrode.sketches.dxf_sketches import dxf_sketch
from centrode.sketches.interpretation import read_sketch
from centrode.sketches.linkage_files import linkage_drawing
from centrode.sketches.parts import FRAME, DrawingParts, less
from centrode.sketches.sketch import Sketch, extent
from centrode.sketches.svg_sketches import svg_sketch

FILE_SIZE = 4_000_000
"""Bytes of a drawing."""
CANDIDATES = 6
"""Links that are tried as the driving one."""
SAMPLES = 73
LONGEST_NAME = 8
"""Letters of a name that is made of those of points."""
STANDS = 1e-6
"""So far a point may stand from where it is drawn, as a part of the size: lengths are rounded."""
DIGITS = 9
"""Digits of coordinates, by the size of the drawing."""


@dataclass(frozen=True)
class ImportedSketch:
    """A mechanism that was read off a drawing.

    Attributes
    ----------
    mechanism : Mechanism
    text : its description, with what was guessed and left out as comments at its head
    guesses : what was taken for granted, as sentences
    omitted : what of the drawing is not in the mechanism, as phrases with their numbers
    """

    mechanism: Mechanism
    text: str
    guesses: tuple[str, ...]
    omitted: tuple[str, ...]


def import_sketch(
    path: str | Path, *, scale: float = 1.0, join: float | str | None = None, drive: str | None = None
) -> ImportedSketch:
    """The mechanism that a drawing shows: DXF, SVG, or a file `.linkage2` of the program Linkage.

    Parameters
    ----------
    path : file
    scale : lengths of the mechanism by those of the drawing (5 for a drawing 1:5)
    join : how far apart ends that meet may be in the drawing [m, or a text with its unit]; by default 0.2 % of its size
    drive : name of the driving link, where the drawing marks none, or another one

    Returns
    -------
    ImportedSketch
        Links are lines, polylines and polygons; circles are hinges; hatching, or a layer named ground, is the frame;
        rectangles are sliders. What was guessed and what was omitted stands in the text, too.

    Raises
    ------
    InputError
        A damaged file, one that is too large, a drawing in which nothing moves or more than its drives, and what is not
        read of Linkage: gears, curved slots.

    Examples
    --------
    >>> import centrode as ct
    >>> from pathlib import Path
    >>> lines = '<line x1="0" y1="0" x2="30" y2="-40"/><line x1="30" y1="-40" x2="120" y2="-90"/>'
    >>> lines += '<line x1="120" y1="-90" x2="140" y2="0"/>'
    >>> _ = Path("bars.svg").write_text(f'<svg width="140mm" height="90mm" viewBox="0 -90 140 90">{lines}</svg>')
    >>> bars = ct.import_sketch("bars.svg")
    >>> [round(link.length, 6) for link in bars.mechanism.links.values()]
    [0.05, 0.102956, 0.092195]
    """
    file = Path(path)
    content = read_content(file, FILE_SIZE)
    given: object = scale  # from Python anything may come
    if isinstance(given, bool) or not (isinstance(given, int | float) and 0.0 < given < 1e9):
        raise InputError("scale", _("a scale is a positive number"), _("give 5 for a drawing 1:5"))
    return sketch_content(content, file.name, file.suffix.lower(), float(scale), join, drive)


def sketch_content(
    content: bytes,
    where: str,
    suffix: str,
    scale: float = 1.0,
    join: float | str | None = None,
    drive: str | None = None,
) -> ImportedSketch:
    """The mechanism of a drawing's bytes; `where` is its name in messages. Raises as `import_sketch`."""
    if suffix == ".linkage2":
        parts, sketch = linkage_drawing(content, where)
    elif suffix in (".svg", ".dxf"):
        sketch = svg_sketch(content, where) if suffix == ".svg" else dxf_sketch(content, where)
        sketch.check(where)
        near = None if join is None else read_quantity(join, "length", "join") / sketch.unit
        if near is not None and not near > 0.0:
            raise InputError("join", _("a gap that is closed is a positive length"))
        return _read_both_ways(sketch, where, near, scale, drive)
    else:
        what = _("drawings are read from .svg, .dxf and .linkage2, not from {suffix}")
        raise InputError(where, what.format(suffix=suffix or _("a file without an ending")))
    return _Description(parts, sketch, where, scale).describe(drive)


def _read_both_ways(
    sketch: Sketch, where: str, near: float | None, scale: float, drive: str | None
) -> ImportedSketch:
    """Lines that go straight on through a hinge are two links; where that cannot be driven, one."""
    noted, unread = list(sketch.notes), dict(sketch.unread)
    try:
        return _Description(read_sketch(sketch, where, near), sketch, where, scale).describe(drive)
    except CentrodeError:
        sketch.notes, sketch.unread = noted, unread
        try:
            parts = read_sketch(sketch, where, near, straight_on=True)
            sketch.notes.append(_("lines that go straight on through a hinge are one link"))
            return _Description(parts, sketch, where, scale).describe(drive)
        except CentrodeError:
            pass
        raise


class _Description:
    """Parts of a drawing as the tables of a description."""

    def __init__(self, parts: DrawingParts, sketch: Sketch, where: str, scale: float) -> None:
        self.parts, self.sketch, self.where = parts, sketch, where
        self.unit = sketch.unit * scale
        self.links = self._link_names()
        self.size = extent(parts.places) * self.unit

    def describe(self, drive: str | None) -> ImportedSketch:
        tables = self._tables()
        mechanism, chosen = self._choose_drives(tables, drive)
        tables["drives"] = chosen
        guesses = tuple(self.sketch.notes)
        omitted = tuple(f"{what} ({count})" for what, count in self.sketch.unread.items())
        return ImportedSketch(mechanism, self._text(tables, guesses, omitted), guesses, omitted)

    def _text(self, tables: dict[str, Any], guesses: Sequence[str], omitted: Sequence[str]) -> str:
        """The description, with a report in comments."""
        head = [_("read from {file}").format(file=self.where)]
        head += [_("guessed: {what}").format(what=one) for one in guesses]
        head += [_("not read: {what}").format(what=one) for one in omitted]
        lines = ["# " + "".join(c if c.isprintable() else " " for c in line) for line in head]
        return "\n".join(lines) + "\n\n" + in_short_lines(tomli_w.dumps(tables))

    # Names.

    def _link_names(self) -> list[str]:
        """Names of bodies: their own, those of their points where they are few, else numbers."""
        names = [""]
        for body in self.parts.bodies[1:]:
            points = [self.parts.names[k] for k in body.nodes]
            named = (one for one in self._possible(body.name, points) if one not in names)
            names.append(next(named))
        return names

    def _possible(self, wish: str, points: Sequence[str]) -> Iterator[str]:
        together = "".join(points)
        for name in (wish.strip(), together if len(together) <= LONGEST_NAME else ""):
            try:
                read = str(read_link_name(name))
            except Problem:
                continue
            # a name made of two points is that of the link between them
            if two_points(read) in (None, tuple(points)):
                yield read
        for number in range(1, len(self.parts.bodies) + 2):
            yield f"link {number}"

    # Tables.

    def _tables(self) -> dict[str, Any]:
        parts, names = self.parts, self.parts.names
        moving = {k for body in parts.bodies[1:] for k in body.nodes} | {one.node for one in parts.guided}
        used = sorted(moving.union(*((first, second) for first, second, _speed in parts.cylinders)))
        corner = [min(parts.places[k][axis] for k in used) for axis in (0, 1)]
        origin = (
            parts.places[parts.bodies[FRAME].nodes[0]]
            if parts.bodies[FRAME].nodes
            else (corner[0], corner[1])
        )
        tables: dict[str, Any] = {
            "display": {"length": "mm", "angle": "deg"},
            "points": {names[k]: [self._length(x) for x in less(parts.places[k], origin)] for k in used},
            "frame": {"points": [names[k] for k in parts.bodies[FRAME].nodes if k in used]},
            "links": {},
        }
        for name, body in zip(self.links[1:], parts.bodies[1:], strict=True):
            tables["links"][name] = {"points": [names[k] for k in body.nodes]}
        guides = [self._guide(k) for k in range(len(parts.guided))]
        if guides:
            tables["guides"] = guides
        return tables

    def _length(self, value: float) -> str:
        """A length with its unit, to the digits that a drawing has."""
        millimetres = 1e3 * self.unit * value
        size = (
            max((math.dist(self.parts.places[0], place) for place in self.parts.places), default=1.0)
            * self.unit
            * 1e3
        )
        places = max(0, DIGITS - math.ceil(math.log10(size))) if size > 0.0 else DIGITS
        return f"{round(millimetres, places) + 0.0:.15g} mm"

    def _guide(self, number: int) -> dict[str, Any]:
        one = self.parts.guided[number]
        names = self.parts.names
        guide: dict[str, Any] = {"point": names[one.node]}
        x, y = one.direction
        if one.carrier != FRAME:
            body = self.parts.bodies[one.carrier]
            guide["on"] = self.links[one.carrier]
            first, second = (self.parts.places[k] for k in body.nodes[:2])
            a, b = less(second, first)
            span = math.hypot(a, b) or 1.0
            x, y = (x * a + y * b) / span, (y * a - x * b) / span
            guide["through"] = names[self._slot_point(one.node, one.direction, body.nodes)]
        guide["direction"] = [round(x, 12) + 0.0, round(y, 12) + 0.0]
        if sum(other.node == one.node for other in self.parts.guided) > 1:
            guide["name"] = f"{names[one.node]} guide {number + 1}"
        return guide

    def _slot_point(self, node: int, direction: tuple[float, float], nodes: Sequence[int]) -> int:
        """A point of a link through which its slot goes: the one nearest to the line."""

        def off(k: int) -> float:
            u, v = less(self.parts.places[k], self.parts.places[node])
            return abs(u * direction[1] - v * direction[0])

        return min(nodes, key=off)

    # Drives.

    def _choose_drives(
        self, tables: dict[str, Any], wanted: str | None
    ) -> tuple[Mechanism, list[dict[str, Any]]]:
        if wanted is not None:
            if wanted not in self.links[1:]:
                what = _("the drawing has no link {name}").format(name=wanted)
                raise InputError(
                    "drive", what, _("choose one of: {names}").format(names=", ".join(self.links[1:]))
                )
            drives = [{"link": wanted, "speed": "1 rad/s"}]
            return self._mechanism(tables | {"drives": drives}), drives
        marked = [{"link": self.links[k], "speed": speed or "1 rad/s"} for k, speed in self.parts.driven]
        for first, second, speed in self.parts.cylinders:
            ends = [self.parts.names[first], self.parts.names[second]]
            marked.append({"distance": ends, "speed": speed})  # type: ignore[dict-item]
        if marked:
            return self._assemble(tables | {"drives": marked}, tables), marked
        return self._guessed_drive(tables)

    def _assemble(self, tables: dict[str, Any], kept: dict[str, Any]) -> Mechanism:
        """The mechanism, with the side of a guided point at a cylinder where only the drawing tells it."""
        try:
            return self._mechanism(tables)
        except CentrodeError as failure:
            for point in [one["point"] for one in tables.get("guides", []) if self.parts.cylinders]:
                for side in ("ahead", "behind"):
                    assembly = {"assembly": {"sides": {point: side}}}
                    with suppress(CentrodeError):
                        mechanism = self._mechanism(tables | assembly)
                        kept |= assembly
                        return mechanism
            raise failure

    def _guessed_drive(self, tables: dict[str, Any]) -> tuple[Mechanism, list[dict[str, Any]]]:
        """Of links that turn about fixed hinges the one whose range is the widest, the shorter first."""
        frame = set(self.parts.bodies[FRAME].nodes)
        cranks = []
        for name, body in zip(self.links[1:], self.parts.bodies[1:], strict=True):
            hinged = [k for k in body.nodes if k in frame]
            arms = (
                [math.dist(self.parts.places[hinged[0]], self.parts.places[k]) for k in body.nodes]
                if hinged
                else []
            )
            if len(hinged) == 1 and max(arms) > 0.0:
                cranks.append((max(arms), name))
        trials: list[tuple[dict[str, Any], str]] = [
            ({"link": name, "speed": "1 rad/s"}, name) for _arm, name in sorted(cranks)[:CANDIDATES]
        ]
        if not cranks:
            led = [(index, one) for index, one in enumerate(tables.get("guides", [])) if "on" not in one]
            trials = [({"guide": one.get("name", one["point"]), "start": 0, "speed": "10 mm/s"}, one["point"])
                      for _index, one in led[:CANDIDATES]]  # fmt: skip
        best: tuple[int, Mechanism, dict[str, Any], str] | None = None
        failure: CentrodeError | None = None
        for drive, name in trials:
            try:
                mechanism = self._mechanism(tables | {"drives": [drive]})
                with np.errstate(all="ignore"):
                    reached = int((motion(mechanism, SAMPLES).status.values == Status.OK).sum())
            except CentrodeError as error:
                failure = failure or error
                continue
            if best is None or reached > best[0]:
                best = reached, mechanism, drive, name
        if best is None:
            raise failure or InputError(
                self.where, _("no link turns about a fixed hinge, and none slides along the frame")
            )
        text = _("nothing is marked as driven: {name} drives at 1 rad/s (another one: {option})")
        self.sketch.notes.append(text.format(name=best[3], option="--drive"))
        return best[1], [best[2]]

    def _mechanism(self, tables: dict[str, Any]) -> Mechanism:
        """The mechanism, checked to stand where it is drawn; raises CentrodeError where it cannot be driven so."""
        try:
            mechanism = mechanism_from(tables, self.where, bare_angles="refused")
        except RecursionError:
            raise InputError(self.where, _("it nests too deeply")) from None
        first = motion(mechanism, at=[initial_place(mechanism)]).isel(sample=0)
        if int(first.status) not in (Status.OK, Status.SINGULAR):
            raise InputError(self.where, _("the mechanism does not close in the position that is drawn"))
        places = dict(zip(first.point.values.tolist(), first.position.values, strict=True))
        off = [
            math.dist(places[name], [read_quantity(x, "length", name) for x in drawn])
            for name, drawn in tables["points"].items()
            if name in places
        ]
        if max(off, default=0.0) > STANDS * self.size:
            raise InputError(self.where, _("the mechanism does not close in the position that is drawn"))
        return mechanism
