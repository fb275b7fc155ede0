"""Mechanisms that links of PMKS+ hold: the address of a drawing is the drawing itself, in digits of base 64.

An address has sections between full stops: switches, numbers, speed, units; joints; links; forces; what was selected.
The end is a character for the length, and in newer ones a hash. A coordinate is a whole number of thousandths.
"""

from __future__ import annotations

import math
import re
import string
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from urllib.parse import unquote

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.files import mechanism_from
from centrode.model.mechanism import Mechanism
from centrode.model.reading import Problem, read_link_name, read_name

PAYLOAD = 100_000
"""Characters of an address."""
PARTS = 500
"""Joints, links or forces of one."""
DIGITS = string.digits + string.ascii_uppercase + string.ascii_lowercase + "_-"
LENGTH_MARKS = DIGITS[:62]
HASH_LENGTH = 6
THOUSANDTHS = 1000
UNITS = (("inch", "lb", "lb*inch^2"), ("cm", "g", "kg*cm^2"), ("m", "kg", "kg*m^2"))
"""Units of lengths, masses and moments of inertia by the number that an address gives."""
FORCES = ("lbf", "N")
ROOT_MARKS, PART_MARKS = "YAMG0123", "NamgN4567"
"""Characters before a link that is a body, and before one that is welded into another."""
OFF_LINE = 0.02
"""So far [units of the drawing] a pin may lie from its slot: places are rounded to thousandths."""
SAME_PLACE = 2e-3
GRAVITY = 9.81
GRAVITY_OFF = 256
CLOCKWISE = 1
LINEAR_SPEED = 5.0
"""Speed of a driven slider, in units of the drawing by second, where an address gives none."""

_SECTION = re.compile(r"[0-9A-Za-z_\-]*")


@dataclass(frozen=True)
class DrawnJoint:
    """A joint as an address has it."""

    id: str
    name: str
    place: tuple[float, float]
    angle: float
    slides: bool
    driven: bool
    fixed: bool
    welded: bool
    carrier: str
    slot: tuple[str, str]


@dataclass(frozen=True)
class DrawnLink:
    """A link as an address has it; a block of a slider has no body of its own."""

    id: str
    name: str
    is_root: bool
    is_block: bool
    mass: float
    inertia: float
    centre: tuple[float, float]
    joints: tuple[str, ...]


@dataclass(frozen=True)
class DrawnForce:
    """A force as an address has it."""

    id: str
    link: str
    start: tuple[float, float]
    end: tuple[float, float]
    turns: bool
    outwards: bool
    size: float


@dataclass(frozen=True)
class PmksDrawing:
    """Everything that an address of PMKS+ says of the mechanism."""

    switches: int
    linear_speed: float
    speed: float
    units: tuple[str, str, str]
    force_unit: str
    joints: Mapping[str, DrawnJoint]
    links: Mapping[str, DrawnLink]
    forces: tuple[DrawnForce, ...]


def from_pmks(url: str) -> Mechanism:
    """The mechanism of a link of PMKS+: its joints, links, sliders, slots, the drive, masses and forces.

    Parameters
    ----------
    url : str
        The whole address, or what stands behind its question mark.

    Returns
    -------
    Mechanism
        In the position that is drawn, with the units of the drawing. A slider drives along its slot from the slot's
        first joint to the second. Masses are omitted where every link has those that PMKS+ begins with (one unit).

    Raises
    ------
    InputError
        It is no such address, it is damaged (its length or hash do not fit), or it holds what is not read: gears,
        motors between two moving links, speeds of single drives, and records of newer versions.

    Notes
    -----
    Places are exact to a thousandth of the drawing's unit, as the address has them.

    Examples
    --------
    >>> import centrode as ct
    >>> joints = "0.Fe.A,0.2111.6A,A,0,0,0.0B,B,0,Fe,0.0C,C,ku,V8,0.4D,D,_W,0,0"
    >>> links = "..YRAB,AB,Fe,Fe,0,0,,A,B,,.YRBC,BC,Fe,Fe,0,0,,B,C,,.YRCD,CD,Fe,Fe,0,0,,C,D,,...NH"
    >>> ct.from_pmks("https://app.pmksplus.com/?" + joints + links).link_names
    ('AB', 'BC', 'CD')
    """
    return _describe(_decode(_payload(url)))


def _refusal(what: str, repair: str = "") -> InputError:
    return InputError("PMKS+", what, repair or _("open the link in PMKS+ and copy its address again"))


def _unread(what: str) -> InputError:
    return InputError("PMKS+", what, _("remove it in PMKS+, and copy the link again"))


# The address.


def _payload(url: str) -> str:
    """What an address holds, without the marks of its length and hash, which have to fit."""
    if not isinstance(url, str):
        raise _refusal(_("a link is a text"))
    if len(url) > PAYLOAD:
        raise _refusal(
            _("the link has {size} characters, at most {most} are allowed").format(
                size=len(url), most=PAYLOAD
            ),
            _("simplify the mechanism"),
        )
    text = unquote(url.strip())
    text = text.partition("?")[2] if "?" in text else text
    text = text.partition("#")[0]
    body, star, digest = text.rpartition("*")
    if star:
        if len(digest) != HASH_LENGTH or digest != _hash_of(body):
            raise _refusal(_("the link is damaged: its hash does not fit"))
        text = body
    if len(text) < 2 or text[-1] != LENGTH_MARKS[(len(text) - 1) % len(LENGTH_MARKS)]:
        raise _refusal(_("this is not a link of PMKS+, or it is damaged: its length does not fit"))
    return text[:-1]


def _hash_of(body: str) -> str:
    """The hash that newer addresses end with: FNV-1a of 32 bits in digits of base 62."""
    value = 0x811C9DC5
    for letter in body:
        value = ((value ^ ord(letter)) * 0x01000193) & 0xFFFFFFFF
    written = ""
    for _place in range(HASH_LENGTH):
        value, digit = divmod(value, 62)
        written = LENGTH_MARKS[digit] + written
    return written


def _decode(payload: str) -> PmksDrawing:
    sections = payload.split(".")
    if len(sections) < 7:
        raise _refusal(_("this is not a link of PMKS+: parts of it are missing"))
    switches = _whole(sections[0], signed=False)
    decimals = [_decimal(one) for one in sections[1].split(",")]
    numbers = sections[2].split(",")
    units = sections[3]
    if not re.fullmatch(r"[0-2][0-9A-Za-z]{2,3}", units):
        raise _refusal(_("its units are not those of PMKS+"))
    force = int(units[2]) if units[2] in "01" else 1
    parts, rest = [], sections[4:]
    for _kind in range(3):
        if "" not in rest:
            raise _refusal(_("this is not a link of PMKS+: parts of it are missing"))
        end = rest.index("")
        if end > PARTS:
            raise _refusal(_("it has too many parts"), _("simplify the mechanism"))
        parts.append(rest[:end])
        rest = rest[end + 1 :]
    if len(rest) > 1:
        raise _unread(_("it holds records of a newer version, such as gears or locks"))
    joints = [_joint(one) for one in parts[0]]
    links = [_link(one) for one in parts[1]]
    forces = tuple(_force(one) for one in parts[2])
    for named in (joints, links):
        if len({one.id for one in named}) < len(named):
            raise _refusal(_("two of its parts have one name"))
    return PmksDrawing(
        switches,
        decimals[1] if len(decimals) > 1 and decimals[1] > 0.0 else LINEAR_SPEED,
        float(_whole(numbers[0])),
        UNITS[int(units[0])],
        FORCES[force],
        {one.id: one for one in joints},
        {one.id: one for one in links},
        forces,
    )


def _whole(text: str, *, signed: bool = True) -> int:
    """A whole number in digits of base 64; a zero before others makes it negative."""
    if not text or len(text) > 9 or not _SECTION.fullmatch(text):
        raise _refusal(_("a number of it cannot be read"))
    negative = signed and text[0] == "0" and len(text) > 1
    value = 0
    for letter in text[1:] if negative else text:
        value = 64 * value + DIGITS.index(letter)
    return -value if negative else value


def _decimal(text: str) -> float:
    return _whole(text) / THOUSANDTHS


def _joint(text: str) -> DrawnJoint:
    fields = text.split(",")
    if len(fields) < 5 or not fields[0]:
        raise _refusal(_("a joint of it cannot be read"))
    flags = _whole(fields[0][0], signed=False)
    more = [*fields[5:9], *[""] * 4][:4]
    if len(fields) > 9 or (more[3] and _whole(more[3])):
        raise _unread(_("a drive has a speed of its own"))
    name = fields[0][1:]
    return DrawnJoint(
        name,
        fields[1] or name,
        (_decimal(fields[2]), _decimal(fields[3])),
        _decimal(fields[4]),
        bool(flags & 1),
        bool(flags & 2),
        bool(flags & 4),
        bool(flags & 8),
        more[0],
        (more[1], more[2]),
    )


def _link(text: str) -> DrawnLink:
    fields = text.split(",")
    head = fields[0]
    if len(fields) < 9 or len(head) < 3 or head[0] not in ROOT_MARKS + PART_MARKS or head[1] not in "RP":
        raise _refusal(_("a link of it cannot be read"))
    if "" not in fields[7:]:
        raise _refusal(_("a link of it cannot be read"))
    joints = fields[7 : 7 + fields[7:].index("")]
    if len(set(joints)) < len(joints):
        raise _refusal(_("a link of it names a joint twice"))
    return DrawnLink(
        head[2:],
        fields[1] or head[2:],
        head[0] in ROOT_MARKS,
        head[1] == "P",
        _decimal(fields[2]),
        _decimal(fields[3]),
        (_decimal(fields[4]), _decimal(fields[5])),
        tuple(joints),
    )


def _force(text: str) -> DrawnForce:
    fields = text.split(",")
    if len(fields) != 8 or not fields[0]:
        raise _refusal(_("a force of it cannot be read"))
    flags = _whole(fields[0][0], signed=False)
    x, y, u, v, size = (_decimal(one) for one in fields[3:8])
    return DrawnForce(fields[0][1:], fields[1], (x, y), (u, v), bool(flags & 1), bool(flags & 2), size)


# What it describes.


def _describe(drawing: PmksDrawing) -> Mechanism:
    bodies = {link.id: link for link in drawing.links.values() if link.is_root and not link.is_block}
    if not bodies:
        raise _refusal(_("it has no link"), _("draw one"))
    for link in drawing.links.values():
        for joint in link.joints:
            if joint not in drawing.joints:
                raise _refusal(_("a link of it names a joint that is not there"))
    names = _Names(drawing, bodies)
    tables: dict[str, Any] = {
        "title": "PMKS+",
        "display": {"length": drawing.units[0], "angle": "deg"},
        "points": {},
        "frame": {},
        "links": {},
        "guides": [],
        "drives": [],
        "loads": [],
    }
    pins = {joint.id: joint for joint in drawing.joints.values() if not joint.slides}
    used = {joint for body in bodies.values() for joint in body.joints if joint in pins}
    tables["points"] = {names.points[one]: _place(drawing, pins[one].place) for one in pins if one in used}
    tables["frame"] = {"points": [names.points[one] for one in pins if one in used and pins[one].fixed]}
    for body in bodies.values():
        tables["links"][names.links[body.id]] = {
            "points": [names.points[one] for one in body.joints if one in pins]
        }
    for drawn in drawing.joints.values():
        if drawn.slides:
            tables["guides"].append(_guide(drawing, bodies, names, drawn))
        if drawn.driven:
            tables["drives"].append(_drive(drawing, bodies, names, drawn))
    _check_welds(drawing, bodies)
    _add_masses(drawing, bodies, names, tables)
    for force in drawing.forces:
        _add_force(drawing, bodies, names, tables, force)
    found = {key: value for key, value in tables.items() if value not in ({}, [])}
    try:
        return mechanism_from(found, "PMKS+")
    except RecursionError:
        raise _refusal(_("it nests too deeply")) from None


class _Names:
    """Names of points and links: those of the drawing where they may be names here and differ."""

    def __init__(self, drawing: PmksDrawing, bodies: Mapping[str, DrawnLink]) -> None:
        self.points: dict[str, str] = {}
        self.links: dict[str, str] = {}
        for joint in drawing.joints.values():
            self.points[joint.id] = self._free((joint.name, joint.id), "P", read_name, self.points)
        for link in bodies.values():
            self.links[link.id] = self._free((link.name, link.id), "link", read_link_name, self.links)

    def _free(self, wishes: Sequence[str], stem: str, read: Any, taken: Mapping[str, str]) -> str:
        known = set(taken.values())
        for wish in wishes:
            try:
                name: str = read(wish)
            except Problem:
                continue
            if name not in known:
                return name
        return next(name for k in range(1, PARTS + 2) for name in [f"{stem} {k}"] if name not in known)

    def new_link(self, link: DrawnLink) -> str:
        """A name for a block."""
        self.links[link.id] = self._free((link.name, link.id), "slider", read_link_name, self.links)
        return self.links[link.id]

    def new_point(self) -> str:
        """A name that no joint has."""
        known = set(self.points.values())
        name = next(one for k in range(1, 2 * PARTS) for one in [f"F{k}"] if one not in known)
        self.points[f"force {name}"] = name
        return name


def _place(drawing: PmksDrawing, place: tuple[float, float]) -> list[str]:
    return [f"{x!r} {drawing.units[0]}" for x in place]


def _mate(drawing: PmksDrawing, joint: DrawnJoint) -> DrawnJoint:
    """The pin that a slider carries: the other joint of its block."""
    blocks = [link for link in drawing.links.values() if link.is_block and joint.id in link.joints]
    if len(blocks) != 1 or len(blocks[0].joints) != 2:
        raise _unread(_("a slider of it has no block of two joints"))
    (other,) = (one for one in blocks[0].joints if one != joint.id)
    mate = drawing.joints[other]
    if mate.slides or mate.fixed or math.dist(mate.place, joint.place) > SAME_PLACE:
        raise _unread(_("a slider of it does not carry a pin"))
    return mate


def _guide(
    drawing: PmksDrawing, bodies: Mapping[str, DrawnLink], names: _Names, joint: DrawnJoint
) -> dict[str, Any]:
    """The guide of a slider: on the frame at an angle, or in the slot of a link."""
    mate = _mate(drawing, joint)
    carried = [body for body in bodies.values() if mate.id in body.joints]
    if not carried:
        raise _unread(_("a slider of it carries nothing"))
    guide: dict[str, Any] = {"point": names.points[mate.id]}
    if joint.fixed or not joint.carrier:
        if not joint.fixed:
            raise _unread(_("a slider of it has neither a fixed guide nor a slot"))
        guide |= {"on": "frame", "direction": f"{joint.angle!r} rad"}
    else:
        carrier = bodies.get(joint.carrier)
        if (
            carrier is None
            or any(one not in carrier.joints for one in joint.slot)
            or joint.slot[0] == joint.slot[1]
        ):
            raise _unread(_("a slot of it is in no link"))
        guide |= _slot(drawing, carrier, names, joint, mate)
    if mate.welded:
        if len(carried) != 1:
            raise _unread(_("a slider of it is welded to several links"))
        guide["link"] = names.links[carried[0].id]
    return guide


def _slot(
    drawing: PmksDrawing, carrier: DrawnLink, names: _Names, joint: DrawnJoint, mate: DrawnJoint
) -> dict[str, Any]:
    """A slot between two joints of a link, in the axes of this: from its first point towards its second."""
    start, end = (drawing.joints[one].place for one in joint.slot)
    along = math.dist(start, end)
    pins = [one for one in carrier.joints if not drawing.joints[one].slides]
    if along <= SAME_PLACE or len(pins) < 2:
        raise _unread(_("a slot of it has no direction"))
    off = (end[0] - start[0]) * (mate.place[1] - start[1]) - (end[1] - start[1]) * (mate.place[0] - start[0])
    if abs(off) / along > OFF_LINE:
        raise _unread(_("a pin of it lies beside its slot"))
    first, second = (drawing.joints[one].place for one in pins[:2])
    own = math.atan2(second[1] - first[1], second[0] - first[0])
    turn = math.remainder(math.atan2(end[1] - start[1], end[0] - start[0]) - own, math.tau)
    return {
        "on": names.links[carrier.id],
        "through": names.points[joint.slot[0]],
        "direction": f"{turn!r} rad",
    }


def _drive(
    drawing: PmksDrawing, bodies: Mapping[str, DrawnLink], names: _Names, joint: DrawnJoint
) -> dict[str, Any]:
    if joint.slides:
        mate = _mate(drawing, joint)
        speed = f"{drawing.linear_speed!r} {drawing.units[0]}/s"
        drive: dict[str, Any] = {"guide": names.points[mate.id], "speed": speed}
        if joint.carrier and joint.slot[0] in drawing.joints:
            start = drawing.joints[joint.slot[0]].place
            end = drawing.joints[joint.slot[1]].place
            along = math.dist(start, end)
            way = (mate.place[0] - start[0]) * (end[0] - start[0]) + (mate.place[1] - start[1]) * (
                end[1] - start[1]
            )
            drive["start"] = f"{way / along!r} {drawing.units[0]}"
        return drive
    driven = [body for body in bodies.values() if joint.id in body.joints]
    if not joint.fixed:
        raise _unread(_("a motor of it is between two moving links"))
    if len(driven) != 1:
        raise _unread(_("a motor of it turns several links, or none"))
    if not drawing.speed:
        raise _unread(_("its speed is zero"))
    sense = -1.0 if drawing.switches & CLOCKWISE else 1.0
    return {"link": names.links[driven[0].id], "speed": f"{sense * drawing.speed!r} rpm"}


def _check_welds(drawing: PmksDrawing, bodies: Mapping[str, DrawnLink]) -> None:
    """A welded pin joins links into one body, or a link to its slider; anything else is not read."""
    mates = {_mate(drawing, joint).id for joint in drawing.joints.values() if joint.slides}
    for joint in drawing.joints.values():
        several = joint.fixed or len([body for body in bodies.values() if joint.id in body.joints]) > 1
        if joint.welded and several and not joint.slides and joint.id not in mates:
            raise _unread(_("a welded joint of it joins links that are not one body"))


def _add_masses(
    drawing: PmksDrawing, bodies: Mapping[str, DrawnLink], names: _Names, tables: dict[str, Any]
) -> None:
    """Masses of links and blocks, unless all are those that PMKS+ begins with and no force acts."""
    blocks = [link for link in drawing.links.values() if link.is_block]
    default = all(body.mass == body.inertia == 1.0 for body in bodies.values())
    if default and all(block.mass in (0.0, 1.0) for block in blocks) and not drawing.forces:
        return
    length, mass_unit, inertia_unit = drawing.units
    for body in (*bodies.values(), *blocks):
        if body.mass < 0.0 or body.inertia < 0.0:
            raise _refusal(_("a mass of it is negative"))
    for body in bodies.values():
        if body.mass > 0.0:
            pins = [drawing.joints[one].place for one in _pins(drawing, body)]
            table = tables["links"][names.links[body.id]]
            table["mass"] = f"{body.mass!r} {mass_unit}"
            table["inertia"] = f"{body.inertia!r} {inertia_unit}"
            table["centre"] = [f"{x!r} {length}" for x in _local(pins, body.centre)]
    for block in blocks:
        if block.mass > 0.0:
            _add_block(drawing, block, names, tables)
    if not drawing.switches & GRAVITY_OFF:
        tables["gravity"] = [0, -GRAVITY]


def _add_block(drawing: PmksDrawing, block: DrawnLink, names: _Names, tables: dict[str, Any]) -> None:
    """A block with a mass: a body of one point, which its guide keeps from turning."""
    pins = [one for one in block.joints if one in drawing.joints and not drawing.joints[one].slides]
    guides = [guide for guide in tables["guides"] if pins and guide["point"] == names.points[pins[0]]]
    if len(pins) != 1 or len(guides) != 1 or "link" in guides[0]:
        raise _unread(_("a block of a slider has a mass of its own, and is welded to a link"))
    name = names.new_link(block)
    tables["links"][name] = {
        "points": [names.points[pins[0]]],
        "mass": f"{block.mass!r} {drawing.units[1]}",
        "inertia": f"{block.inertia!r} {drawing.units[2]}",
        "centre": [0, 0],
    }
    guides[0]["link"] = name


def _local(pins: Sequence[tuple[float, float]], place: tuple[float, float]) -> tuple[float, float]:
    """A place in the axes of a link: from its first point towards its second."""
    if len(pins) < 2:
        raise _unread(_("a link of it has one joint only"))
    (x, y), (u, v) = pins[:2]
    span = math.hypot(u - x, v - y)
    if span == 0.0:
        raise _unread(_("two joints of a link of it are one place"))
    cosine, sine = (u - x) / span, (v - y) / span
    a, b = place[0] - x, place[1] - y
    return a * cosine + b * sine, b * cosine - a * sine


def _add_force(
    drawing: PmksDrawing,
    bodies: Mapping[str, DrawnLink],
    names: _Names,
    tables: dict[str, Any],
    force: DrawnForce,
) -> None:
    if force.link not in bodies:
        raise _unread(_("a force of it acts on no link"))
    way = math.dist(force.start, force.end)
    if force.size == 0.0:
        return
    if way == 0.0:
        raise _refusal(_("a force of it has no direction"))
    sense = force.size / way if force.outwards else -force.size / way
    axes: dict[str, str] = {}
    ends = force.start, force.end
    if force.turns:
        pins = [drawing.joints[one].place for one in _pins(drawing, bodies[force.link])]
        ends = _local(pins, force.start), _local(pins, force.end)
        axes = {"axes": names.links[force.link]}
    vector = [f"{sense * (end - start)!r} {drawing.force_unit}" for start, end in zip(*ends, strict=True)]
    body = bodies[force.link]
    point = next(
        (
            one
            for one in _pins(drawing, body)
            if math.dist(drawing.joints[one].place, force.start) <= SAME_PLACE / 2
        ),
        None,
    )
    if point is not None:
        name = names.points[point]
    else:
        name = names.new_point()
        tables["points"][name] = _place(drawing, force.start)
        tables["links"][names.links[body.id]]["points"].append(name)
    tables["loads"].append({"kind": "force", "point": name, "vector": vector, **axes})


def _pins(drawing: PmksDrawing, body: DrawnLink) -> Iterator[str]:
    return (one for one in body.joints if not drawing.joints[one].slides)
