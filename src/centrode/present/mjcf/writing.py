"""The model as XML: bodies below each other, constraints of the loops and gears, actuators of the drives."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from centrode.errors import NotComputedYet
from centrode.locale import _
from centrode.model.mechanism import FRAME
from centrode.present.mjcf.bodies import THIN, add_body
from centrode.present.mjcf.joining import add_constraints, add_drives
from centrode.present.mjcf.pose import Pose
from centrode.present.mjcf.spelled import number, numbers

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

HARD = "0.9999 0.9999 0.001"
"""How nearly rigid constraints are (MuJoCo's solimp)."""


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
    return _document(Pose(mechanism, motion))


def _document(pose: Pose) -> str:
    """The whole document."""
    root = ET.Element("mujoco", model=pose.mechanism.title or "linkage")
    ET.SubElement(root, "compiler", angle="radian", autolimits="true")
    gravity = pose.mechanism.gravity or (0.0, 0.0)
    ET.SubElement(root, "option", gravity=numbers((*gravity, 0.0)), timestep=number(pose.step),
                  integrator="implicitfast", tolerance="1e-12", iterations="200")  # fmt: skip
    solref = f"{number(3 * pose.step)} 1"
    defaults = ET.SubElement(root, "default")
    ET.SubElement(defaults, "equality", solref=solref, solimp=HARD)
    ET.SubElement(defaults, "geom", contype="0", conaffinity="0", mass="0", rgba="0.3 0.45 0.6 1")
    ET.SubElement(defaults, "site", size=number(1.5 * THIN * pose.size))
    world = ET.SubElement(root, "worldbody")
    for point in pose.mechanism.frame.points:
        ET.SubElement(world, "site", name=f"{FRAME}.{point}", pos=numbers((*pose.places[point], 0.0)))
    for body in pose.tree.children(FRAME):
        add_body(pose, world, body, (0.0, 0.0))
    add_constraints(pose, root)
    add_drives(pose, root)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"
