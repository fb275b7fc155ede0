"""How the centre of mass of each link moves per unit of the drive: a route to the reduced inertia of its own.

The centre's place and coefficient follow from one point of the link and its turning; the reduction goes by other ways.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.dynamics.masses import masses_of

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class LinkMotion:
    """A link with its mass at one instant of a planar motion with one drive.

    Attributes
    ----------
    mass, inertia : float [kg], [kg m^2] about the centre of mass
    velocity, acceleration : complex
        First and second derivative of the centre's place by the drive's value [m per unit of it, and its square].
    turning, bending : float
        First [-] and second derivative of the link's angle by the drive's value.
    """

    link: str
    mass: float
    inertia: float
    velocity: complex
    acceleration: complex
    turning: float
    bending: float

    @property
    def reduced_share(self) -> float:
        """Share of the link in the reduced inertia [kg m^2; of a displacement kg]."""
        return self.mass * abs(self.velocity) ** 2 + self.inertia * self.turning**2

    @property
    def slope(self) -> float:
        """Share of the link in the derivative of the reduced inertia by the drive's value."""
        along = (self.velocity.conjugate() * self.acceleration).real
        return 2.0 * (self.mass * along + self.inertia * self.turning * self.bending)

    @property
    def slope_terms(self) -> float:
        """Bound on the terms of `slope`: their size if nothing cancelled, by which rounding is measured."""
        moved = self.mass * abs(self.velocity) * abs(self.acceleration)
        return 2.0 * (moved + self.inertia * abs(self.turning * self.bending))


def motions_of_links(mechanism: Mechanism, here: xr.Dataset) -> list[LinkMotion]:
    """Every link with mass at one sample of a motion."""
    motions = []
    for mass in masses_of(mechanism):
        centre = mass.planar_centre
        first = _vector(here["velocity_coefficient"], centre.base)
        second = _vector(here["acceleration_coefficient"], centre.base)
        turning = float(here["angular_velocity_coefficient"].sel(link=mass.link))
        bending = float(here["angular_acceleration_coefficient"].sel(link=mass.link))
        angle = float(here["angle"].sel(link=mass.link))
        # the centre's arm in the frame's axes; its derivatives are i phi' and i phi'' - phi'^2 times it
        arm = complex(centre.along, centre.across) * cmath.exp(1j * angle)
        motions.append(
            LinkMotion(
                mass.link,
                float(mass.mass),
                float(mass.moment_of_inertia),
                first + 1j * turning * arm,
                second + (1j * bending - turning**2) * arm,
                turning,
                bending,
            )
        )
    return motions


def _vector(values: xr.DataArray, point: str) -> complex:
    components = values.sel(point=point)
    return complex(float(components.sel(axis="x")), float(components.sel(axis="y")))
