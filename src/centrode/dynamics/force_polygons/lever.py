"""Zhukovsky's lever: the velocity diagram, turned by a right angle, as a rigid lever with all forces on it.

Its velocities are constructed as on a drawing board for a unit rate of one drive. Forces act at the images of their
places; a moment on a link acts on the lever times (side of the image / side of the link). The lever is in
equilibrium about the pole with the balancing moment.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from centrode.analysis.graphic.construction import construct
from centrode.analysis.graphic.stage import Drawing, Stage
from centrode.dynamics.force_polygons.actions import Action
from centrode.dynamics.force_polygons.bodies import Bodies
from centrode.model.mechanism import FRAME, Drive
from centrode.structure.plan import Structure


@dataclass(frozen=True)
class LeverForce:
    """A force or moment on the lever.

    Attributes
    ----------
    name, label : of the force
    force [N] : complex number, as in the mechanism
    image : where it acts, from the pole [m, or 1 of a displacement drive; per radian or metre of the drive]
    couple : moment on the lever of what is a moment in the mechanism [N m, N of a displacement drive]
    moment : about the pole, counter-clockwise positive, the couple included
    """

    name: str
    label: str
    body: str
    force: complex
    image: complex
    couple: float
    moment: float


@dataclass(frozen=True)
class Lever:
    """The lever of one drive.

    Attributes
    ----------
    drive : its id
    images : point -> place on the lever, a complex number from the pole; points of the frame at the pole
    links : link -> its points, for its outline
    forces : what acts on it, moments included
    balancing : moment [N m] or force [N] of the drive, positive as its value grows
    """

    drive: str
    unit: str
    images: Mapping[str, complex]
    links: Mapping[str, tuple[str, ...]]
    forces: tuple[LeverForce, ...]

    @property
    def balancing(self) -> float:
        """What the drive must give, so that the lever stands still."""
        return -sum(one.moment for one in self.forces)


def lever_of(
    structure: Structure, drawing: Drawing, bodies: Bodies, outer: Sequence[Action], drive: Drive
) -> Lever:
    """The lever of one drive, the others held; raises as velocity diagrams do at dead points."""
    stage = Stage(drawing, {one.id: float(one.id == drive.id) for one in structure.mechanism.drives})
    stage.points |= dict.fromkeys(drawing.numbers.frame, 0j)
    construct(structure, stage)
    forces = []
    for action in outer:
        image = -1j * _rate(stage, bodies, action)
        couple = action.moment * _turn(stage, bodies, action.body)
        arm = image.conjugate() * action.force
        forces.append(
            LeverForce(
                action.symbol, action.label, action.body, action.force, image, couple, arm.imag + couple
            )
        )
    links = {name: tuple(link.coordinates) for name, link in structure.mechanism.links.items()}
    images = {name: -1j * rate for name, rate in stage.points.items()}
    return Lever(
        drive.id,
        structure.mechanism.motion_parameter.drive(drive.id).force_unit,
        images,
        links,
        tuple(forces),
    )


def _rate(stage: Stage, bodies: Bodies, action: Action) -> complex:
    """Velocity of the place of a body where an action acts."""
    if action.force == 0 or action.body == FRAME:
        return 0j
    if action.body in bodies.sliders:
        return stage.points[bodies.sliders[action.body].point]
    if action.body in bodies.pins:
        return stage.points[bodies.pins[action.body]]
    return stage.carried(action.body, action.place)


def _turn(stage: Stage, bodies: Bodies, body: str) -> float:
    """Turning of a link; of sliders no moment is asked."""
    return stage.turns.get(body, 0.0)
