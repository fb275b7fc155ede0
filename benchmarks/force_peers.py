"""The six-bar press in KinePy 0.1.7 and a four-bar linkage in fourbarhinge 0.1.2: their joint forces, to compare."""

from __future__ import annotations

import contextlib
import io
import itertools
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import lazy_loader
import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.model.links import Link
from centrode.model.mechanism import Mechanism

Array = npt.NDArray[np.float64]
MOST_KNOWN = 0.999
"""Share of the samples at which a peer has to have positions."""
HAS_KINEPY = find_spec("kinepy") is not None
HAS_FOURBARHINGE = find_spec("fourbarhinge") is not None


def _loaded(module: str, there: bool) -> Any:
    # a module of a package that is not there cannot even be named
    return lazy_loader.load(module) if there else None


kinepy_system = _loaded("kinepy.interface.system", HAS_KINEPY)
fourbarhinge = _loaded("fourbarhinge", HAS_FOURBARHINGE)


@dataclass(frozen=True)
class ForcePeer:
    """A peer's mechanism, ready to be solved.

    Attributes
    ----------
    solve : kinematics and joint forces at all samples
    forces : side of a joint -> force on the link there (samples, 2) [N], after `solve`
    drive : what the drive gives (samples) [N m], after `solve`
    """

    solve: Callable[[], object]
    forces: Callable[[], dict[str, Array]]
    drive: Callable[[], Array]


def kinepy_press(press: Mechanism, motion: xr.Dataset, rate: float) -> ForcePeer:
    """The six-bar press at the samples of a motion, at a speed of its crank.

    Its second derivatives are differences of neighbouring samples, so the first and the last have none. The load
    that changes with the velocity is given to it as numbers.
    """
    units = kinepy_system.units
    units.SYSTEM.dct[units.LENGTH] = units.METER
    with contextlib.redirect_stdout(io.StringIO()):
        system = kinepy_system.System()
        bodies: dict[str, Any] = {"frame": system.ground}
        for name, link in press.links.items():
            centre = link.coordinates[link.centre] if isinstance(link.centre, str) else (0.0, 0.0)
            bodies[name] = system.add_solid(name, *_weight(link), tuple(map(float, centre)))
        joints = {}
        for point, first, second in (
            ("O", "frame", "OA"), ("A", "OA", "AB"), ("B", "AB", "CD"), ("C", "frame", "CD"), ("D", "CD", "DH"),
            ("H", "DH", "slider"),
        ):  # fmt: skip
            places = [
                tuple(
                    press.frame.coordinates[point]
                    if body == "frame"
                    else press.links[body].coordinates[point]
                )
                for body in (first, second)
            ]
            joints[point] = (first, second, system.add_revolute(bodies[first], bodies[second], *places))
        system.add_prismatic(bodies["frame"], bodies["slider"], 0.0, 0.9, 0.0, 0.0)
        system.add_gravity(tuple(map(float, press.gravity or (0.0, 0.0))))
        advances = motion["slide_velocity"].sel(guide="H").to_numpy() > 0.0
        load = np.stack([np.where(advances, -9000.0, 0.0), np.zeros(len(advances))])
        bodies["slider"].add_force(lambda: load, (0.0, 0.0))
        system.pilot(joints["O"][2])
        system.compile()
    crank = motion["angle"].sel(link="OA").to_numpy()[None, :]
    step = abs(float(crank[0, 1] - crank[0, 0]) / rate)
    _choose_signs(system, bodies, crank, motion)

    def solve() -> None:
        system.solve_dynamics(crank.copy(), step * crank.shape[1])

    def forces() -> dict[str, Array]:
        # a joint's force is that of its second body on its first; the load of H acts on the slider here
        found = {f"{point}/{second}": -joint.force.T for point, (_first, second, joint) in joints.items()}
        del found["H/slider"]
        return found | {"H/DH": joints["H"][2].force.T}

    return ForcePeer(
        solve,
        forces,
        lambda: -np.asarray(joints["O"][2].torque),
    )


def _weight(link: Link) -> tuple[float, float]:
    """Mass and moment of inertia."""
    inertia = link.inertia or 0.0
    assert isinstance(inertia, float)
    return float(link.mass or 0.0), inertia


def _choose_signs(system: Any, bodies: dict[str, Any], crank: Array, motion: xr.Dataset) -> None:
    """The assembly that is the motion's; raises ValueError if none is."""
    names = list(system._object.signs)
    for signs in itertools.product((1, -1), repeat=len(names)):
        system._object.signs.update(zip(names, signs, strict=True))
        system._formula = True
        with np.errstate(all="ignore"):
            system.solve_kinematics(crank.copy())
        apart = np.concatenate(
            [
                np.abs(bodies[link].origin.T - motion["position"].sel(point=point).to_numpy())
                for link, point in (("CD", "C"), ("DH", "D"), ("slider", "H"))
            ]
        )
        # where its cosine is rounded beyond one the peer has no position: at one sample of thousands
        known = np.isfinite(apart)
        if known.mean() > MOST_KNOWN and np.max(apart[known]) < 1e-6:
            return
    raise ValueError("no assembly of the peer is that of the motion")


def hinge(linkage: Mechanism, motion: xr.Dataset, rate: float) -> ForcePeer:
    """A four-bar linkage O, A, B, D at the samples of a motion, one sample after another as its interface has it."""
    ids = {"OA": fourbarhinge.BarId.INPUT, "AB": fourbarhinge.BarId.COUPLER, "DB": fourbarhinge.BarId.OUTPUT}
    ground = float(linkage.frame.coordinates["D"][0])
    bars = {
        fourbarhinge.BarId.GROUND: fourbarhinge.Bar(
            length=ground, mass=1.0, inertia=1.0, center_of_mass=fourbarhinge.Point(x=0.0, y=0.0)
        )
    }
    for name, which in ids.items():
        link = linkage.links[name]
        assert link.length is not None and link.centre is not None and not isinstance(link.centre, str)
        centre = fourbarhinge.Point(x=float(link.centre[0]), y=float(link.centre[1]))
        bars[which] = fourbarhinge.Bar(
            length=float(link.length),
            center_of_mass=centre,
            **dict(zip(("mass", "inertia"), _weight(link), strict=True)),
        )
    geometry = fourbarhinge.FourBarGeometry(position_ground=fourbarhinge.Point(x=0.0, y=0.0), bar=bars)
    kinematics = fourbarhinge.FourBarKinematics(geometry, theta_ground=0.0)
    dynamics = fourbarhinge.FourBarDynamics(
        kinematics, gravity=tuple(map(float, linkage.gravity or (0.0, 0.0)))
    )
    motor = fourbarhinge.Actuator(bar=fourbarhinge.BarId.INPUT)
    reactions = fourbarhinge.FourBarReactions(dynamics)
    crank = motion["angle"].sel(link="OA").to_numpy().tolist()
    found: list[Any] = []

    def solve() -> None:
        found.clear()
        for angle in crank:
            kinematics.solve_configuration(angle, branch=-1)
            kinematics.solve_theta_dot(rate)
            dynamics.solve_required_effort(motor, theta_input_ddot=0.0)
            found.append(reactions.solve(motor))

    def forces() -> dict[str, Array]:
        sides = {"A": "O/OA", "B": "A/AB", "C": "B/DB", "D": "D/DB"}
        return {side: np.array([one.reactions[name] for one in found]) for name, side in sides.items()}

    return ForcePeer(solve, forces, lambda: np.array([one.actuator_value for one in found]))
