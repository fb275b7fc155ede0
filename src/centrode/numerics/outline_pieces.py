"""Smooth pieces of outlines: places with exact slopes, from which renderers draw cubic curves."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OutlinePiece:
    """A smooth piece of an outline.

    Attributes
    ----------
    layer : str
        What it belongs to.
    parameter : (n)
        Growing; where a formula gives a falling one, `rising` turns its sign.
    places, slopes : (n, 2) [m], [m per unit of the parameter]
        Points and derivatives by the parameter.
    normals : (n, 2), optional
        Unit vectors out of the body, where they are known.
    """

    layer: str
    parameter: Array
    places: Array
    slopes: Array
    normals: Array | None = None

    def rising(self) -> OutlinePiece:
        """The same curve by a parameter that grows along it."""
        if self.parameter[0] < self.parameter[-1]:
            return self
        return replace(self, parameter=-self.parameter, slopes=-self.slopes)

    def on_layer(self, layer: str) -> OutlinePiece:
        """The same curve as a part of another layer."""
        return replace(self, layer=layer)

    def moved_by(self, angle: float, centre: tuple[float, float] = (0.0, 0.0)) -> OutlinePiece:
        """The curve turned counter-clockwise about the origin by an angle [rad], then shifted by a vector [m]."""
        cosine, sine = math.cos(angle), math.sin(angle)
        turning = np.array([[cosine, sine], [-sine, cosine]])
        normals = None if self.normals is None else self.normals @ turning
        return replace(
            self, places=self.places @ turning + centre, slopes=self.slopes @ turning, normals=normals
        )

    def mirror_image(self) -> OutlinePiece:
        """The mirror image in the y axis, run through from its other end."""
        mirror = np.array([-1.0, 1.0])
        normals = None if self.normals is None else self.normals[::-1] * mirror
        return replace(
            self,
            parameter=-self.parameter[::-1],
            places=self.places[::-1] * mirror,
            slopes=-self.slopes[::-1] * mirror,
            normals=normals,
        )
