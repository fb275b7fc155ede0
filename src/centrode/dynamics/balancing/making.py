"""How counterweights are made: mass, radius and inertia that go with a product of mass and radius."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

STEEL = 7800.0
"""Density [kg/m^3] where none is given."""
LEAST = 1e-12
"""Share of the greatest product below which slopes are those there: the root of a disc's size has none at zero."""


@dataclass(frozen=True)
class Made:
    """A counterweight of one product of mass and radius.

    Attributes
    ----------
    mass : float [kg]
    radius : float [m]
        Distance of its centre from the hinge it is measured from.
    inertia : float [kg m^2]
        About its own centre.
    mass_slope, inertia_slope : float [1/m], [m]
        Derivatives of the mass, and of the inertia about the hinge, by the product.
    """

    mass: float
    radius: float
    inertia: float
    mass_slope: float
    inertia_slope: float

    @property
    def about_hinge(self) -> float:
        """Moment of inertia about the hinge [kg m^2]."""
        return self.inertia + self.mass * self.radius**2


@dataclass(frozen=True)
class Making:
    """How one counterweight is made.

    Attributes
    ----------
    radius : float or None [m]
        Distance of its centre from the hinge; None for a disc whose edge passes through the hinge, which has the
        least inertia of all discs of one product.
    thickness : float or None [m]
        Of a disc; None for a mass in one point.
    density : float [kg/m^3]
    most : float or None [kg]
        Greatest mass.
    """

    radius: float | None
    thickness: float | None = None
    density: float = STEEL
    most: float | None = None

    @property
    def sheet(self) -> float:
        """Mass of a disc over the square of its radius [kg/m^2]."""
        return pi * self.density * (self.thickness or 0.0)

    def made(self, product: float, floor: float = 0.0) -> Made:
        """The counterweight of a product of mass and radius [kg m]; slopes are those at `floor` if it is less."""
        if self.radius is not None:
            mass, slope, inertia = product / self.radius, self.radius, 0.0
            if self.thickness is not None:
                inertia = 0.5 * mass**2 / self.sheet
                slope += mass / (self.sheet * self.radius)
            return Made(mass, self.radius, inertia, 1.0 / self.radius, slope)
        # a disc touching its hinge: product = sheet radius^3
        radius = (product / self.sheet) ** (1 / 3)
        smooth = (max(product, floor) / self.sheet) ** (1 / 3)
        mass = self.sheet * radius**2
        return Made(mass, radius, 0.5 * mass * radius**2, 2 / (3 * smooth) if smooth else 0.0, 2.0 * smooth)

    @property
    def greatest(self) -> float | None:
        """Greatest product of mass and radius [kg m]; None without a greatest mass."""
        if self.most is None:
            return None
        if self.radius is not None:
            return self.most * self.radius
        return float(self.sheet * (self.most / self.sheet) ** 1.5)

    def disc(self, made: Made) -> float | None:
        """Radius of the disc [m]; None of a mass in one point."""
        return None if self.thickness is None else (made.mass / self.sheet) ** 0.5
