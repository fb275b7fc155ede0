"""The model as XML: bodies below each other, constraints of the loops and gears, actuators of the drives."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from centrode.dynamics.bodies import Centre
from centrode.dynamics.masses import masses_of
from centrode.errors import NotComputedYet
from centrode.locale import _
from centrode.model.mechanism import FRAME
from centrode.present.mjcf.tree import Pair, Place, Tree, cylinder_names, outline, slider_name, tree_of

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.bodies import Mass
    from centrode.model.mechanism import Drive, Guide, Mechanism

NOMINAL = 1e-3
"""Mass of a body that the description gives none, as a part of the greatest (of 1 kg where there is none)."""
LIGHTEST = 1e-15
"""What MuJoCo divides by at the least."""
THIN = 0.01
"""Radius of drawn links, as a part of the mechanism's size."""
STEPS = 4000
"""Steps of time in a turn of the drive, at least."""
LONGEST_STEP = 1e-3
HARD = "0.9999 0.9999 0.001"
"""How nearly rigid constraints are (MuJoCo's solimp)."""
REACHED = 100
"""Steps of time in which a drive's speed is reached: faster, and it would fight the constraints."""
FOLLOWED = 10
"""Half of the steps of time by which a drive lags behind the value of its law."""
ROTOR = 0.1
"""Inertia of such a drive itself, as a part of what its gains are for: without, it would fight the constraints."""


def mjcf_text(mechanism: Mechanism, motion: xarray.Dataset) -> str:
    """A linkage as a model of MuJoCo (MJCF), loops closed by equality constraints at the initial position.

    Parameters
    ----------
    mechanism : Mechanism
        In the plane, without wheels that roll.
    motion : Dataset
        Its motion, whose first sample is the initial position.

    Returns
    -------
    str
        XML. Lengths in metres; every coordinate of a joint counts from the initial position. Links have the masses of
        the description; loads, springs and friction are not in the model. A drive is an actuator of its joint with
        the key frame's `ctrl` as its speed (a law's value follows `ctrl`, from the initial one).

    Raises
    ------
    NotComputedYet
        Spherical linkages, wheels that roll, and bodies too light for MuJoCo.
    """
    if mechanism.space == "sphere":
        raise NotComputedYet(
            "space", _("models of MuJoCo are made of planar linkages"), _("take it from the plane")
        )
    if mechanism.rolling:
        what = _("models of MuJoCo have no wheels that roll")
        raise NotComputedYet(f"[[rolling]] {mechanism.rolling[0].id}", what, _("take it out"))
    return _Model(mechanism, motion).text()


class _Model:
    """A linkage in its initial position, while its model is written."""

    def __init__(self, mechanism: Mechanism, motion: xarray.Dataset) -> None:
        self.mechanism = mechanism
        first = motion.isel(sample=0)
        self.places: dict[str, Place] = {
            name: (float(x), float(y))
            for name, (x, y) in zip(first["point"].values.tolist(), first["position"].values, strict=True)
        }
        self.angles = dict(zip(first["link"].values.tolist(), first["angle"].values.tolist(), strict=True))
        self.angles[FRAME] = 0.0
        directions = {guide.id: self._direction(guide) for guide in mechanism.guides}
        self.spins, self.slides = _speeds(mechanism, first)
        self.tree: Tree = tree_of(mechanism, self.places, directions)
        self.masses: dict[str, Mass] = {mass.link: mass for mass in masses_of(mechanism)}
        spread = [max(values) - min(values) for values in zip(*self.places.values(), strict=True)]
        self.size = max(spread)
        self.pace = max(_pace(drive, self.size) for drive in mechanism.drives) or 1.0
        self.step = min(LONGEST_STEP, 2 * math.pi / self.pace / STEPS)

        self.greatest = max((float(mass.mass) for mass in self.masses.values()), default=1.0) or 1.0
        self.least = NOMINAL * self.greatest
        if min(self.least, self._nominal_inertia) < LIGHTEST:
            what = _("MuJoCo has no bodies with a mass or moment of inertia below {least} kg or kg*m^2")
            raise NotComputedYet(
                "links", what.format(least=LIGHTEST), _("export it enlarged, or in other units")
            )

    @property
    def _nominal_inertia(self) -> float:
        """Moment of inertia of a body that the description gives none."""
        return float(self.least * (0.1 * self.size) ** 2)

    def _direction(self, guide: Guide) -> Place:
        return _turned(guide.unit, self.angles[guide.on])

    def text(self) -> str:
        """The whole document."""
        root = ET.Element("mujoco", model=self.mechanism.title or "linkage")
        ET.SubElement(root, "compiler", angle="radian", autolimits="true")
        gravity = self.mechanism.gravity or (0.0, 0.0)
        ET.SubElement(root, "option", gravity=_numbers((*gravity, 0.0)), timestep=_number(self.step),
                      integrator="implicitfast", tolerance="1e-12", iterations="200")  # fmt: skip
        solref = f"{_number(3 * self.step)} 1"
        defaults = ET.SubElement(root, "default")
        ET.SubElement(defaults, "equality", solref=solref, solimp=HARD)
        ET.SubElement(defaults, "geom", contype="0", conaffinity="0", mass="0", rgba="0.3 0.45 0.6 1")
        ET.SubElement(defaults, "site", size=_number(1.5 * THIN * self.size))
        world = ET.SubElement(root, "worldbody")
        for point in self.mechanism.frame.points:
            ET.SubElement(world, "site", name=f"{FRAME}.{point}", pos=_numbers((*self.places[point], 0.0)))
        for body in self.tree.children(FRAME):
            self._body(world, body, (0.0, 0.0))
        self._closures(root)
        self._drives(root)
        ET.indent(root)
        return ET.tostring(root, encoding="unicode") + "\n"

    def _body(self, parent: ET.Element, name: str, origin: Place) -> None:
        """A body with its joint, its mass and what is drawn of it, and the bodies that hang on it."""
        pair, _on = self.tree.joints[name]
        own = pair.place
        body = ET.SubElement(parent, "body", name=name, pos=_numbers((*_less(own, origin), 0.0)))
        if pair.direction is None:
            ET.SubElement(body, "joint", name=pair.name, type="hinge", axis="0 0 1")
        else:
            sign = 1.0 if pair.second == name else -1.0
            axis = (sign * pair.direction[0], sign * pair.direction[1], 0.0)
            ET.SubElement(body, "joint", name=pair.name, type="slide", axis=_numbers(axis))
        self._inertial(body, name, own)
        self._shape(body, name, own)
        for child in self.tree.children(name):
            self._body(body, child, own)

    def _inertial(self, body: ET.Element, name: str, own: Place) -> None:
        known = self.masses.get(name)
        mass = max(float(known.mass), self.least) if known else self.least
        inertia = known.inertia if known is not None and not isinstance(known.inertia, tuple) else 0.0
        about = max(float(inertia), self._nominal_inertia)
        centre = (0.0, 0.0)
        if known is not None and isinstance(known.centre, Centre):
            way = _turned((float(known.centre.along), float(known.centre.across)), self.angles[name])
            base = self.places[known.centre.base]
            centre = _less((base[0] + way[0], base[1] + way[1]), own)
        # a flat body: MuJoCo wants moments that some body in space can have
        ET.SubElement(body, "inertial", pos=_numbers((*centre, 0.0)), mass=_number(mass),
                      diaginertia=_numbers((0.5 * about, 0.5 * about, about)))  # fmt: skip

    def _shape(self, body: ET.Element, name: str, own: Place) -> None:
        """Lines between the points of a link, a box for a slider, and a site for each point."""
        if name not in self.mechanism.links:
            size = 3.0 * THIN * self.size
            ET.SubElement(body, "geom", type="box", size=_numbers((size, 0.6 * size, 0.6 * size)))
            return
        points = list(self.mechanism.links[name].coordinates)
        for start, end in outline([_less(self.places[point], own) for point in points]):
            if math.dist(start, end) > 0.0:
                ET.SubElement(body, "geom", type="capsule", size=_number(THIN * self.size),
                              fromto=_numbers((*start, 0.0, *end, 0.0)))  # fmt: skip
        for point in points:
            at = _numbers((*_less(self.places[point], own), 0.0))
            ET.SubElement(body, "site", name=f"{name}.{point}", pos=at)

    def _closures(self, root: ET.Element) -> None:
        """Loops and gears as equality constraints."""
        gears = self.mechanism.gears
        if not self.tree.closures and not gears:
            return
        if gears:
            tendons = ET.SubElement(root, "tendon")
            for gear in gears:
                first, second = gear.links
                _fixed(tendons, f"gear {gear.id}", self._turns({second: 1.0, gear.carrier: gear.ratio - 1.0,
                                                                first: -gear.ratio}))  # fmt: skip
        equality = ET.SubElement(root, "equality")
        for pair in self.tree.closures:
            self._closure(equality, pair)
        for gear in gears:
            ET.SubElement(equality, "tendon", name=f"gear {gear.id}", tendon1=f"gear {gear.id}")

    def _closure(self, equality: ET.Element, pair: Pair) -> None:
        first, second = ("world" if body == FRAME else body for body in (pair.first, pair.second))
        # the anchor is told in the axes of the first body
        body, other = (second, first) if first == "world" else (first, second)
        own = self.tree.joints[body][0].place
        ET.SubElement(equality, "connect", name=pair.name, body1=body, body2=other,
                      anchor=_numbers((*_less(pair.place, own), 0.0)))  # fmt: skip

    def _turns(self, factors: Mapping[str, float]) -> dict[str, float]:
        """A sum of links' turns as joints and their factors."""
        found: dict[str, float] = {}
        for body, factor in factors.items():
            for joint, share in self.tree.turn(body).items():
                found[joint] = found.get(joint, 0.0) + factor * share
        return {joint: factor for joint, factor in found.items() if factor}

    def _drives(self, root: ET.Element) -> None:
        """An actuator for each drive, and the key frame that turns them on."""
        actuators: list[tuple[str, dict[str, str]]] = []
        tendons = root.find("tendon")
        for drive in self.mechanism.drives:
            joints = self._joints(drive)
            if len(joints) == 1 and next(iter(joints.values())) == 1.0:
                actuators.append((f"drive {drive.id}", {"joint": next(iter(joints))}))
                continue
            if tendons is None:
                tendons = ET.SubElement(root, "tendon")
            _fixed(tendons, f"drive {drive.id}", joints)
            actuators.append((f"drive {drive.id}", {"tendon": f"drive {drive.id}"}))
        if not actuators:
            return
        parent = ET.SubElement(root, "actuator")
        for (name, what), drive in zip(actuators, self.mechanism.drives, strict=True):
            self._actuator(root, parent, drive, {"name": name} | what)
        controls = [drive.speed or 0.0 for drive in self.mechanism.drives]
        frames = ET.SubElement(root, "keyframe")
        rates = [self._rate(name) for name in self._order(FRAME)]
        ET.SubElement(frames, "key", name="initial", ctrl=_numbers(controls), qvel=_numbers(rates))

    def _actuator(self, root: ET.Element, parent: ET.Element, drive: Drive, said: Mapping[str, str]) -> None:
        """A drive that keeps its speed, or follows the value of its law."""
        heavy = sum(float(mass.mass) for mass in self.masses.values()) or NOMINAL * len(self.tree.joints)
        scale = heavy * (self.size**2 if drive.kind == "angle" else 1.0)
        if drive.speed is not None:
            ET.SubElement(parent, "velocity", {"kv": _number(scale / (REACHED * self.step)), **said})
            return
        pause = FOLLOWED * self.step
        gains = {"kp": _number(scale / pause**2), "kv": _number(2.0 * scale / pause)}
        ET.SubElement(parent, "position", {**gains, **said})
        for kind, place in (("joint", ".//body/joint"), ("tendon", "./tendon/fixed")):
            for one in root.iterfind(place):
                if one.get("name") == said.get(kind):
                    one.set("armature", _number(ROTOR * scale))

    def _order(self, body: str) -> list[str]:
        """Bodies below one in the order of the document, which is that of MuJoCo's coordinates."""
        return [name for child in self.tree.children(body) for name in (child, *self._order(child))]

    def _rate(self, name: str) -> float:
        """Initial speed of the joint by which a body hangs."""
        pair, parent = self.tree.joints[name]
        if pair.direction is None:
            return self.spins[name] - self.spins[parent]
        return self.slides[pair.name]

    def _joints(self, drive: Drive) -> dict[str, float]:
        """The value of a drive since the beginning, as joints and their factors."""
        if drive.link is not None:
            return self._turns({drive.link: 1.0, drive.relative_to: -1.0})
        if drive.guide is None:
            return {f"drive {drive.id}": 1.0}
        return {f"guide {drive.guide}": 1.0}


def _pace(drive: Drive, size: float) -> float:
    """How fast a drive runs [rad/s]: an angle, a way in sizes of the mechanism, the cam of a law; 1 of others."""
    if drive.speed is not None:
        return abs(drive.speed) if drive.kind == "angle" else abs(drive.speed) / size
    if drive.table is not None:
        return 2.0 * math.pi / (drive.table[-1][0] - drive.table[0][0])
    return abs(drive.turning or 1.0)


def _speeds(mechanism: Mechanism, first: xarray.Dataset) -> tuple[dict[str, float], dict[str, float]]:
    """Angular velocities of bodies and velocities of what slides, initially."""
    links, guides = first["link"].values.tolist(), first["guide"].values.tolist()
    spins = dict(zip(links, first["angular_velocity"].values.tolist(), strict=True)) | {FRAME: 0.0}
    along = dict(zip(guides, first["slide_velocity"].values.tolist(), strict=True))
    slides = {f"guide {guide}": speed for guide, speed in along.items()}
    spins |= {slider_name(guide.id): spins[guide.on] for guide in mechanism.guides}
    for drive in mechanism.drives:
        if drive.distance is None:
            continue
        start, end = (first.sel(point=point) for point in drive.distance)
        (x, y), (u, v) = (
            end["position"].values - start["position"].values,
            end["velocity"].values - start["velocity"].values,
        )
        length = math.hypot(x, y)
        slides[f"drive {drive.id}"] = (x * u + y * v) / length
        spins |= dict.fromkeys(cylinder_names(drive.id), (x * v - y * u) / length**2)
    return spins, slides


def _fixed(tendons: ET.Element, name: str, joints: Mapping[str, float]) -> None:
    """A tendon whose length is a sum of coordinates."""
    tendon = ET.SubElement(tendons, "fixed", name=name)
    for joint, factor in joints.items():
        ET.SubElement(tendon, "joint", joint=joint, coef=_number(factor))


def _turned(vector: Sequence[float], angle: float) -> Place:
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]


def _less(place: Place, origin: Place) -> Place:
    return place[0] - origin[0], place[1] - origin[1]


def _number(value: float) -> str:
    return repr(float(value))


def _numbers(values: Sequence[float]) -> str:
    return " ".join(_number(value) for value in values)
