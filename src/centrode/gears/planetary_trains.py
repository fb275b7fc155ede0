"""Planetary trains: ratio, conditions of their tooth numbers, efficiency.

A sun of z_1 teeth drives planets on a carrier, which roll on a fixed wheel of z_3 teeth; planets of one row have z_2
teeth, stepped ones z_2 and z_2' on one shaft. All wheels have one module and no shift. Angles are those of R. Willis,
"Principles of mechanism" (1841): against the carrier the train is an ordinary one of ratio u_0 = omega_1/omega_3.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import Literal

from centrode.gears.pair_faults import pair_faults
from centrode.gears.pair_geometry import PairGeometry

EXTERNAL, INTERNAL = -1, 1
"""Sign of the ratio of a mesh against the carrier."""
TIP, ROOT = 2.0, 2.5
"""Twice the addendum and twice the dedendum of a tooth in modules."""

Driver = Literal["sun", "carrier"]


@dataclass(frozen=True)
class PlanetaryScheme:
    """Which wheels a planetary train has.

    Attributes
    ----------
    name : of the description
    sun, fixed : sign of the mesh of the planets with wheel 1 and with the fixed wheel 3: `EXTERNAL` or `INTERNAL`
    stepped : whether a planet has two rims
    driver : what usually drives
    """

    name: str
    sun: int
    fixed: int
    stepped: bool
    driver: Driver


SCHEMES: Mapping[str, PlanetaryScheme] = {
    scheme.name: scheme
    for scheme in (
        PlanetaryScheme("single planets", EXTERNAL, INTERNAL, False, "sun"),
        PlanetaryScheme("stepped planets", EXTERNAL, INTERNAL, True, "sun"),
        PlanetaryScheme("external meshes", EXTERNAL, EXTERNAL, True, "carrier"),
        PlanetaryScheme("internal meshes", INTERNAL, INTERNAL, True, "carrier"),
    )
}
"""The four planetary schemes of the courses, by their names."""


@dataclass(frozen=True)
class MeshEfficiency:
    """Efficiency of a mesh of fixed axes: of two external wheels, and of an internal one."""

    external: float = 0.98
    internal: float = 0.99

    def of_mesh(self, sign: int) -> float:
        """That of an external or an internal mesh."""
        return self.external if sign == EXTERNAL else self.internal


@dataclass(frozen=True)
class PlanetaryTrain:
    """A planetary train with a fixed wheel.

    Attributes
    ----------
    scheme : PlanetaryScheme
    teeth : z_1, z_2, z_2', z_3; z_2' = z_2 of planets with one rim
    planets : number of them
    driver : "sun" (wheel 1) or "carrier"; the other one is driven
    """

    scheme: PlanetaryScheme
    teeth: tuple[int, int, int, int]
    planets: int = 1
    driver: Driver = "sun"

    @property
    def fixed_carrier_ratio(self) -> Fraction:
        """U_0 = omega_1/omega_3 against the carrier."""
        sun, planet, other, fixed = self.teeth
        return Fraction(self.scheme.sun * self.scheme.fixed * planet * fixed, sun * other)

    @property
    def sun_ratio(self) -> Fraction:
        """Omega_1/omega_H = 1 - u_0 with wheel 3 at rest."""
        return 1 - self.fixed_carrier_ratio

    @property
    def ratio(self) -> Fraction:
        """Speed of what drives over that of what is driven."""
        return self.sun_ratio if self.driver == "sun" else 1 / self.sun_ratio

    @property
    def planet_ratio(self) -> Fraction:
        """Omega_2/omega_H: the planets roll on the fixed wheel."""
        return 1 - self.scheme.fixed * Fraction(self.teeth[3], self.teeth[2])

    @property
    def arms(self) -> tuple[int, int]:
        """Twice the radius of the carrier in modules, by the mesh with wheel 1 and by that with wheel 3."""
        sun, planet, other, fixed = self.teeth
        return sun - self.scheme.sun * planet, fixed - self.scheme.fixed * other

    @property
    def is_coaxial(self) -> bool:
        """Whether sun, carrier and fixed wheel turn about one axis."""
        first, second = self.arms
        return first == second > 0

    @property
    def planets_clear(self) -> bool:
        """Whether neighbouring planets pass each other: the distance of their axes exceeds their tip diameter."""
        return (
            self.planets == 1 or self.arms[0] * math.sin(math.pi / self.planets) > max(self.teeth[1:3]) + TIP
        )

    @property
    def most_planets(self) -> int:
        """The greatest number of planets beside each other."""
        sine = (max(self.teeth[1:3]) + TIP) / self.arms[0]
        if not 0 < sine < 1:
            return 1
        most = math.ceil(math.pi / math.asin(sine)) - 1
        return max(most, 1)

    @property
    def assembles(self) -> bool:
        """Whether equally spaced planets fit between wheels 1 and 3, rims of one shaft aligned alike on all of them.

        By the phases of both meshes: k gcd(z_2, z_2') has to divide z_1 z_2' - s z_2 z_3, with s the product of the
        signs of both meshes; of planets with one rim k has to divide z_1 + z_3.
        """
        sun, planet, other, fixed = self.teeth
        sign = self.scheme.sun * self.scheme.fixed
        return (sign * sun * other - planet * fixed) % (self.planets * math.gcd(planet, other)) == 0

    @property
    def meshes_work(self) -> bool:
        """Whether both pairs mesh without interference; see `pair_works`."""
        sun, planet, other, fixed = self.teeth
        return _mesh_works(self.scheme.sun, sun, planet) and _mesh_works(self.scheme.fixed, fixed, other)

    @property
    def can_be_built(self) -> bool:
        """Whether all conditions hold."""
        return self.is_coaxial and self.planets_clear and self.assembles and self.meshes_work

    @cached_property
    def diameter(self) -> float:
        """The greatest diameter of all wheels about the main axis, in modules."""
        sun, planet, other, fixed = self.teeth
        reach = [self.arms[0] + max(planet, other) + TIP]
        for sign, teeth in ((self.scheme.sun, sun), (self.scheme.fixed, fixed)):
            reach.append(teeth + (ROOT if sign == INTERNAL else TIP))
        return max(reach)

    def efficiency(self, meshes: MeshEfficiency) -> float:
        """Efficiency from what drives to what is driven; negative where the train locks itself.

        Where power flows against the carrier decides the sign of the exponent (M. A. Kreines; E. I. Radzimovsky,
        "A simplified approach for determining power losses and efficiency of planetary gear drives", 1956).
        """
        fixed_carrier = meshes.of_mesh(self.scheme.sun) * meshes.of_mesh(self.scheme.fixed)
        ratio = float(self.fixed_carrier_ratio)
        # Against the carrier wheel 1 drives if its moment there does work: 1 - 1/u_1H > 0 where the sun drives.
        sun_drives = (ratio / (ratio - 1) > 0) == (self.driver == "sun")
        effective = ratio * (fixed_carrier if sun_drives else 1 / fixed_carrier)
        if self.driver == "sun":
            return (1 - effective) / (1 - ratio)
        return (1 - ratio) / (1 - effective)


def _mesh_works(sign: int, wheel: int, planet: int) -> bool:
    if sign == EXTERNAL:
        return pair_works("external", *sorted((wheel, planet)))
    return pair_works("internal", planet, wheel)


@cache
def pair_works(kind: Literal["external", "internal"], pinion: int, wheel: int) -> bool:
    """Whether unshifted wheels of the standard rack mesh: contact, tips, fillets, and no tips that meet."""
    if kind == "internal" and wheel <= pinion:
        return False
    pair = PairGeometry(kind, 1.0, (pinion, wheel), (0.0, 0.0))
    return next(pair_faults(pair), None) is None


@dataclass(frozen=True)
class CarrierSeries:
    """Two planetary trains one behind the other: the carrier of the first is the sun of the second.

    Attributes
    ----------
    stages : in the flow of power
    """

    stages: tuple[PlanetaryTrain, PlanetaryTrain]

    @property
    def ratio(self) -> Fraction:
        """The product of those of both."""
        return self.stages[0].ratio * self.stages[1].ratio

    @property
    def teeth(self) -> tuple[int, ...]:
        """Those of both, in their order."""
        return self.stages[0].teeth + self.stages[1].teeth

    @property
    def diameter(self) -> float:
        """The greater one of both, in modules."""
        return max(stage.diameter for stage in self.stages)

    def efficiency(self, meshes: MeshEfficiency) -> float:
        """The product of those of both."""
        return self.stages[0].efficiency(meshes) * self.stages[1].efficiency(meshes)


@dataclass(frozen=True)
class OrdinaryTrain:
    """External pairs one behind the other, on fixed axes.

    Attributes
    ----------
    pairs : teeth of driving and driven wheel of each
    """

    pairs: tuple[tuple[int, int], ...]

    @property
    def ratio(self) -> Fraction:
        """Speed of the first shaft over that of the last; each external pair turns the sense round."""
        value = Fraction(1)
        for driving, driven in self.pairs:
            value *= Fraction(-driven, driving)
        return value

    @property
    def teeth(self) -> tuple[int, ...]:
        """Those of all wheels, in their order."""
        return tuple(teeth for pair in self.pairs for teeth in pair)

    @property
    def diameter(self) -> float:
        """Length with all axes in one line, in modules: from the tip of the first wheel to that of the last."""
        first, last = self.pairs[0][0], self.pairs[-1][1]
        return sum(sum(pair) for pair in self.pairs) / 2 + (first + last) / 2 + TIP

    def efficiency(self, meshes: MeshEfficiency) -> float:
        """That of a mesh for each pair."""
        return meshes.external ** len(self.pairs)
