"""Files `.linkage2` of the program Linkage: connectors, links, anchors, inputs, sliders, actuators.

The format is that of its public source: `connector` elements have places and marks, `Link` elements name the connectors
that they join, and a sliding connector the two between which it slides. Places are in 96ths of an inch, y upwards.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model.reading import Problem, read_name
from centrode.sketches.parts import FRAME, Body, DrawingParts, Guided, less, unit
from centrode.sketches.sketch import LARGEST, Place, Sketch
from centrode.sketches.xml_trees import Element, xml_tree

UNIT = 0.0254 / 96
"""Metres in a unit of places."""
MECHANISM_LAYER = 16
MOST_CONNECTORS = 300
MOST_LINKS = 200
USUAL_PACE = 15.0
"""Turns or cycles by minute where the file gives none."""


@dataclass(frozen=True)
class _Connector:
    """A connector: its node, its marks, and the identifiers between which it slides."""

    node: int
    anchored: bool
    drives: bool
    pace: float
    limits: tuple[str, ...]
    fastened: str


def linkage_drawing(content: bytes, where: str) -> tuple[DrawingParts, Sketch]:
    """Parts of a mechanism of Linkage, and a sketch without lines that holds unit, notes and what was left out.

    Raises InputError where the file is no such file, or holds what is not read: gears, curved slots.
    """
    root = xml_tree(content, where)
    if root.name != "linkage2":
        what = _("this is no file of Linkage: its root is {name}").format(name=root.name[:40])
        raise InputError(where, what, _("save it as .linkage2"))
    return _LinkageReader(root, where).read()


class _LinkageReader:
    def __init__(self, root: Element, where: str) -> None:
        self.root, self.where = root, where
        self.sketch = Sketch(unit=UNIT)
        self.parts = DrawingParts()
        self.connectors: dict[str, _Connector] = {}
        self.links: dict[str, Body] = {}

    def read(self) -> tuple[DrawingParts, Sketch]:
        self._read_program()
        for element in self.root.children:
            if element.name == "connector" and self._is_mechanism(element):
                self._read_connector(element)
        if not self.connectors:
            raise InputError(self.where, _("it has no connectors"), _("draw links in Linkage"))
        for element in self.root.children:
            if element.name in ("Link", "element") and self._is_mechanism(element):
                self._read_link(element)
            elif element.name == "ratios" and element.children:
                raise InputError(
                    self.where, _("gears and chains of Linkage are not read"), _("remove them there")
                )
            elif element.name not in (
                "connector",
                "Link",
                "element",
                "program",
                "selected",
                "ratios",
                "background",
            ):
                self.sketch.leave_out(_("elements {name}").format(name=element.name[:40]))
        self._fasten()
        self._add_sliders()
        self._settle()
        return self.parts, self.sketch

    def _refuse(self, what: str) -> InputError:
        return InputError(self.where, what, _("save it again in Linkage"))

    def _number(self, element: Element, name: str, usual: float) -> float:
        text = element.get(name)
        if not text:
            return usual
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not abs(value) < LARGEST:
            raise self._refuse(_("{name} of a part of it is no number").format(name=name))
        return value

    def _is_mechanism(self, element: Element) -> bool:
        """Whether a part belongs to the mechanism: not a measurement, nor on the layer of drawings alone."""
        layer = element.get("layer")
        drawn = layer.isdigit() and len(layer) < 12 and int(layer) != 0 and not int(layer) & MECHANISM_LAYER
        if drawn or element.get("measurementelement") == "true":
            self.sketch.leave_out(_("measurements and parts of the drawing layer"))
            return False
        return True

    def _read_program(self) -> None:
        program = next((one for one in self.root.children if one.name == "program"), None)
        self.sketch.notes.append(_("places count 96 to the inch, as Linkage draws them"))
        if program is not None:
            factor = self._number(program, "scalefactor", 1.0)
            if factor > 0.0 and factor != 1.0:
                self.sketch.unit *= factor
                self.sketch.notes.append(
                    _("the scale factor {factor} of the file was used").format(factor=f"{factor:g}")
                )

    def _read_connector(self, element: Element) -> None:
        identifier = element.get("id")
        if not identifier or identifier in self.connectors:
            raise self._refuse(_("two of its parts have one name"))
        if len(self.connectors) >= MOST_CONNECTORS:
            raise InputError(self.where, _("it has too many parts"), _("simplify the mechanism"))
        place: Place = (self._number(element, "x", 0.0), self._number(element, "y", 0.0))
        node = len(self.parts.places)
        self.parts.places.append(place)
        self.parts.names.append(self._name(element.get("name")))
        limits: tuple[str, ...] = ()
        if element.get("slider") == "true":
            if self._number(element, "slideradius", 0.0) != 0.0:
                raise InputError(
                    self.where, _("curved slots of Linkage are not read"), _("make them straight there")
                )
            limits = tuple(one.get("id") for one in element.children if one.name == "slidelimit")
            if len(limits) != 2 or limits[0] == limits[1]:
                raise self._refuse(_("a slider of it does not slide between two connectors"))
        self.connectors[identifier] = _Connector(
            node, element.get("anchor") == "true", element.get("input") == "true",
            self._number(element, "rpm", USUAL_PACE) or USUAL_PACE, limits,
            element.get("fastenlink") or element.get("fasten"),
        )  # fmt: skip
        if self.connectors[identifier].anchored:
            self.parts.bodies[FRAME].nodes.append(node)

    def _name(self, wish: str) -> str:
        letters = "ABCDEFGHJKLMNPQRSTUVW"
        k = len(self.parts.names)
        usual = letters[k % len(letters)] + (str(k // len(letters)) if k >= len(letters) else "")
        for name in (wish.strip(), usual, f"P{k}", f"P{k} {k}"):
            try:
                if (read := read_name(name)) not in self.parts.names:
                    return str(read)
            except Problem:
                continue
        raise self._refuse(_("two of its parts have one name"))

    def _read_link(self, element: Element) -> None:
        if len(self.parts.bodies) > MOST_LINKS:
            raise InputError(self.where, _("it has too many parts"), _("simplify the mechanism"))
        nodes = []
        for child in element.children:
            if child.name == "connector":
                connector = self.connectors.get(child.get("id"))
                if connector is None:
                    raise self._refuse(_("a link of it names a joint that is not there"))
                nodes.append(connector.node)
        nodes = list(dict.fromkeys(nodes))
        if element.get("actuator") == "true":
            if len(nodes) != 2:
                raise self._refuse(_("an actuator of it does not join two connectors"))
            stroke, pace = self._number(element, "throw", 0.0), self._number(element, "cpm", USUAL_PACE)
            speed = 2.0 * stroke * pace / 60.0 * self.sketch.unit
            self.parts.cylinders.append((nodes[0], nodes[1], f"{speed * 1e3:.10g} mm/s"))
            self.sketch.notes.append(
                _("an actuator is a cylinder that moves one way, evenly, at its mean speed")
            )
            return
        body = Body(nodes, [], element.get("name"))
        self.parts.bodies.append(body)
        self.links.setdefault(element.get("id"), body)
        fastened = element.get("fastenlink")
        if fastened:
            self.links[f"fastened {len(self.parts.bodies)} {fastened}"] = body

    def _fasten(self) -> None:
        """Links that are fastened to another one are part of it; so are connectors."""
        for connector in self.connectors.values():
            body = self.links.get(connector.fastened)
            if body is not None and connector.node not in body.nodes:
                body.nodes.append(connector.node)
        for key, body in list(self.links.items()):
            if not key.startswith("fastened "):
                continue
            other = self.links.get(key.split(" ", 2)[2])
            if other is None:
                raise self._refuse(_("a link of it is fastened to one that is not there"))
            if other is not body and any(one is other for one in self.parts.bodies):
                self.parts.unite(other, body)
                self.links = {name: other if one is body else one for name, one in self.links.items()}

    def _add_sliders(self) -> None:
        frame = set(self.parts.bodies[FRAME].nodes)
        for connector in self.connectors.values():
            if not connector.limits:
                continue
            if any(limit not in self.connectors for limit in connector.limits):
                raise self._refuse(_("a slider of it does not slide between two connectors"))
            start, end = (self.connectors[limit].node for limit in connector.limits)
            way = less(self.parts.places[end], self.parts.places[start])
            if way == (0.0, 0.0):
                raise self._refuse(_("a slider of it does not slide between two connectors"))
            carrier = next(
                (
                    k
                    for k, body in enumerate(self.parts.bodies)
                    if k != FRAME and {start, end} <= set(body.nodes)
                ),
                None,
            )
            if {start, end} <= frame:
                carrier = FRAME
            if carrier is None or connector.node in self.parts.bodies[carrier].nodes:
                raise self._refuse(_("a slot of it is in no link"))
            self.parts.guided.append(Guided(connector.node, unit(way), carrier))

    def _settle(self) -> None:
        """Rigid parts, drives, and what hangs on nothing."""
        frame = self.parts.bodies[FRAME]
        if not frame.nodes:
            raise InputError(self.where, _("it has no anchor"), _("anchor a connector in Linkage"))
        # a link between anchors is the frame
        for body in [one for one in self.parts.bodies[1:] if set(one.nodes) <= set(frame.nodes)]:
            number = next(k for k, one in enumerate(self.parts.bodies) if one is body)
            self.parts.guided = [
                Guided(one.node, one.direction, FRAME if one.carrier == number else one.carrier)
                for one in self.parts.guided
            ]
            self.parts.remove(body)
        united = self.parts.unite_rigid(self.where)
        if united:
            text = ngettext(
                "lines that hold each other rigidly are one part ({n} time)",
                "lines that hold each other rigidly are one part ({n} times)",
                united,
            )
            self.sketch.notes.append(text.format(n=united))
        # a link of one connector holds nothing
        for body in [one for one in self.parts.bodies[1:] if len(one.nodes) < 2]:
            self.parts.remove(body)
        for connector in self.connectors.values():
            if not connector.drives:
                continue
            turned = [
                k for k, body in enumerate(self.parts.bodies) if k != FRAME and connector.node in body.nodes
            ]
            if not connector.anchored or len(turned) != 1:
                raise self._refuse(_("an input of it does not turn one link about an anchor"))
            self.parts.driven.append((turned[0], f"{-connector.pace:.10g} rpm"))
        if self.parts.driven:
            self.sketch.notes.append(_("a positive number of turns by minute is clockwise"))
        loose = self.parts.leave_out_loose()
        if loose:
            self.sketch.leave_out(_("lines that do not hang together with the frame"), loose)
        self.parts.check(self.where)
