"""Positions of a mechanism with their derivatives by the path's parameter, as jets, at many samples."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.dynamics.masses import Centre
from centrode.kinematics.layout import Layout
from centrode.kinematics.paths import JETS
from centrode.kinematics.sampling import Samples
from centrode.kinematics.solve import Solved
from centrode.model.mechanism import FRAME, Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
Place: TypeAlias = tuple[Jet, Jet]
Getter: TypeAlias = Callable[[int], Array]


@dataclass(frozen=True)
class State:
    """A mechanism at samples of one path.

    Arrays have shape (lanes, n): lanes are mechanisms of a batch. Jets are of second order, by the path's
    parameter; velocities are first derivatives times `rate`.

    Attributes
    ----------
    mechanism : the description, for local coordinates
    time [s], parameter [rad, m or s] : (n)
    rate : (n)
        Derivative of the parameter by time.
    side : -1, 0 or 1
        At a jump: the side of the parameter that counts; 0 where a one-sided load counts as acting.
    scale : float [m]
        The greatest length, by which velocities of zero are told from rounding.
    columns : kind -> what gives value and two derivatives of its k-th number
    m : functions of jets, over arrays or over expressions
    """

    mechanism: Mechanism
    layout: Layout
    time: Array
    parameter: Array
    rate: Array
    side: int
    scale: float
    columns: Mapping[str, Getter]
    m: JetFunctions = JETS
    known: dict[str, Place | Jet] = field(default_factory=dict)

    @classmethod
    def of_samples(
        cls, mechanism: Mechanism, samples: Samples, moving: Moving, scale: float, side: int = 0
    ) -> State:
        """The state that columns of samples hold."""
        layout, columns = samples.layout, samples.columns
        getters: dict[str, Getter] = {
            "point": lambda k: columns[:, k],
            "angle": lambda k: samples.angles[:, k],
            "slide": lambda k: columns[:, layout.first_slide + k],
        }
        return cls(mechanism, layout, moving.time, moving.parameter, moving.rate, side, scale, getters)

    @classmethod
    def of(cls, solved: Solved, moving: Moving, side: int = 0) -> State:
        """The state of a motion."""
        points = solved.points
        getters: dict[str, Getter] = {
            "point": lambda k: points[..., k // 2, k % 2],
            "angle": lambda k: solved.angles[..., k],
            "slide": lambda k: solved.slides[..., k],
        }
        mechanism, scale = solved.ready.mechanism, solved.ready.kinematics.path.scale
        return cls(mechanism, solved.layout, moving.time, moving.parameter, moving.rate, side, scale, getters)

    def point(self, name: str) -> Place:
        """Coordinates of a point [m]."""
        fixed = self.mechanism.frame.points
        if name in fixed:
            x, y = self.mechanism.frame.coordinates[name]
            return _constant(x), _constant(y)
        place = self.known.get(f"point {name}")
        if place is None:
            k = 2 * self.layout.points.index(name)
            place = _jet(self.columns["point"](k)), _jet(self.columns["point"](k + 1))
            self.known[f"point {name}"] = place
        assert isinstance(place, tuple)
        return place

    def angle(self, link: str) -> Jet:
        """Angle of a link or of the frame [rad]."""
        if link == FRAME:
            return _constant(0.0)
        return self._jet("angle", link, self.layout.angles)

    def slide(self, guide: str) -> Jet:
        """Displacement along a guide [m]."""
        return self._jet("slide", guide, self.layout.guides)

    def rotor(self, link: str) -> Place:
        """Cosine and sine of a link's angle."""
        rotor = self.known.get(f"rotor {link}")
        if rotor is None:
            angle = self.angle(link)
            rotor = self.m.cos(angle), self.m.sin(angle)
            self.known[f"rotor {link}"] = rotor
        assert isinstance(rotor, tuple)
        return rotor

    def centre(self, centre: Centre) -> Place:
        """Centre of mass of a link."""
        x, y = self.point(centre.base)
        along, across = centre.along, centre.across
        if isinstance(along, float) and isinstance(across, float) and along == across == 0.0:
            return x, y
        cosine, sine = self.rotor(centre.link)
        return x + cosine * along - sine * across, y + sine * along + cosine * across

    def _jet(self, kind: str, name: str, names: tuple[str, ...]) -> Jet:
        found = self.known.get(f"{kind} {name}")
        if found is None:
            found = _jet(self.columns[kind](names.index(name)))
            self.known[f"{kind} {name}"] = found
        assert isinstance(found, Jet)
        return found


@dataclass(frozen=True)
class Moving:
    """How the path is run through at samples: time [s], parameter, and its derivative by time, each (n)."""

    time: Array
    parameter: Array
    rate: Array


def _jet(orders: Array) -> Jet:
    return Jet((orders[0], orders[1], 0.5 * orders[2]))


def _constant(value: float) -> Jet:
    return Jet((value, 0.0, 0.0))
