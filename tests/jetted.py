"""Motions as jets along the drive, made from their values and derivatives."""

from __future__ import annotations

from centrode.geometry.plane import PlanePose, rotate_vector, subtract
from centrode.kinematics.path import JETS
from centrode.kinematics.solve import Solved
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Positions


def jet_positions(solved: Solved, sample: int) -> Positions:
    """Everything at a sample as jets of second order along the drive, from the motion's values and derivatives."""
    kinematics = solved.ready.kinematics
    at = Positions.of_frame(
        kinematics.numbers, {"link0": Jet((solved.span.parameter[sample], 1.0, 0.0))}, JETS
    )
    for k, name in enumerate(solved.layout.points):
        x, y = (solved.points[:, 0, sample, k, axis] for axis in (0, 1))
        at.points[name] = (Jet((x[0], x[1], x[2] / 2)), Jet((y[0], y[1], y[2] / 2)))
    for k, name in enumerate(solved.layout.links):
        a = solved.angles[:, 0, sample, k]
        angle = Jet((a[0], a[1], a[2] / 2))
        rotor = (JETS.cos(angle), JETS.sin(angle))
        point, local = next(iter(kinematics.numbers.local[name].items()))
        at.angles[name] = angle
        at.poses[name] = PlanePose(subtract(at.points[point], rotate_vector(local, rotor)), rotor)
    return at
