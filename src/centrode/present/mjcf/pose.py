"""A linkage in its initial position, as a model of MuJoCo takes it: places, speeds, masses, the tree of its bodies."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from centrode.dynamics.masses import masses_of
from centrode.errors import NotComputedYet
from centrode.locale import _
from centrode.model.mechanism import FRAME
from centrode.present.mjcf.spelled import turned
from centrode.present.mjcf.tree import Place, Tree, cylinder_names, slider_name, tree_of

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.state import Mass
    from centrode.model.mechanism import Drive, Guide, Mechanism

NOMINAL = 1e-3
"""Mass of a body that the description gives none, as a part of the greatest (of 1 kg where there is none)."""
LIGHTEST = 1e-15
"""What MuJoCo divides by at the least."""
STEPS = 4000
"""Steps of time in a turn of the drive, at least."""
LONGEST_STEP = 1e-3


class Pose:
    """The initial position of a linkage.

    Attributes
    ----------
    places, angles : of points [m] and links [rad]
    spins, slides : angular velocities of bodies, velocities of what slides
    tree : bodies below each other, and what closes their loops
    masses : of the links that have any; `least` and `nominal_inertia` are those of the others
    size : longer side of all places [m]
    pace, step : how fast the drives run [rad/s], and the step of time [s] that this asks for
    """

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
        self.spins, self.slides = speeds_of(mechanism, first)
        self.tree: Tree = tree_of(mechanism, self.places, directions)
        self.masses: dict[str, Mass] = {mass.link: mass for mass in masses_of(mechanism)}
        spread = [max(values) - min(values) for values in zip(*self.places.values(), strict=True)]
        self.size = max(spread)
        self.pace = max(pace_of(drive, self.size) for drive in mechanism.drives) or 1.0
        self.step = min(LONGEST_STEP, 2 * math.pi / self.pace / STEPS)

        self.greatest = max((float(mass.mass) for mass in self.masses.values()), default=1.0) or 1.0
        self.least = NOMINAL * self.greatest
        if min(self.least, self.nominal_inertia) < LIGHTEST:
            what = _("MuJoCo has no bodies with a mass or moment of inertia below {least} kg or kg*m^2")
            raise NotComputedYet(
                "links", what.format(least=LIGHTEST), _("export it enlarged, or in other units")
            )

    @property
    def nominal_inertia(self) -> float:
        """Moment of inertia of a body that the description gives none."""
        return float(self.least * (0.1 * self.size) ** 2)

    def _direction(self, guide: Guide) -> Place:
        return turned(guide.unit, self.angles[guide.on])

    def turns(self, factors: Mapping[str, float]) -> dict[str, float]:
        """A sum of links' turns as joints and their factors."""
        found: dict[str, float] = {}
        for body, factor in factors.items():
            for joint, share in self.tree.turn(body).items():
                found[joint] = found.get(joint, 0.0) + factor * share
        return {joint: factor for joint, factor in found.items() if factor}

    def order(self, body: str) -> list[str]:
        """Bodies below one in the order of the document, which is that of MuJoCo's coordinates."""
        return [name for child in self.tree.children(body) for name in (child, *self.order(child))]

    def rate(self, name: str) -> float:
        """Initial speed of the joint by which a body hangs."""
        pair, parent = self.tree.joints[name]
        if pair.direction is None:
            return self.spins[name] - self.spins[parent]
        return self.slides[pair.name]


def pace_of(drive: Drive, size: float) -> float:
    """How fast a drive runs [rad/s]: an angle, a way in sizes of the mechanism, the cam of a law; 1 of others."""
    if drive.speed is not None:
        return abs(drive.speed) if drive.kind == "angle" else abs(drive.speed) / size
    if drive.table is not None:
        return 2.0 * math.pi / (drive.table[-1][0] - drive.table[0][0])
    return abs(drive.turning or 1.0)


def speeds_of(mechanism: Mechanism, first: xarray.Dataset) -> tuple[dict[str, float], dict[str, float]]:
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
