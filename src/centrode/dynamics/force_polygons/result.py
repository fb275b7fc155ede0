"""Force polygons of an instant as a result: groups, polygons, reactions, balancing moments, levers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import xarray as xr

from centrode.dynamics.force_polygons.actions import Action
from centrode.dynamics.force_polygons.joints import Joint
from centrode.dynamics.force_polygons.lever import Lever
from centrode.dynamics.force_polygons.polygon import Polygon
from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class GroupForces:
    """What was done for one group.

    Attributes
    ----------
    bodies : its links and sliders; `numbers` those in the names of forces
    kind : "RRR", "RRP", "RPR", "PRP", "RPP", "triad", "input", "single" or "together"
    actions : what acts on its bodies before it is solved: loads, weights, inertia, reactions of groups behind it
    reactions : of its outer joints and drives, on its bodies
    steps : what was done, in words
    polygon : of the whole group
    link_polygons : of each of its bodies
    joints : its own joints, inner and outer
    marks : special points of the construction: S of a triad is its Assur point
    """

    bodies: tuple[str, ...]
    numbers: tuple[int, ...]
    kind: str
    actions: tuple[Action, ...]
    reactions: tuple[Action, ...]
    steps: tuple[str, ...]
    polygon: Polygon
    link_polygons: tuple[Polygon, ...]
    joints: tuple[Joint, ...]
    marks: tuple[tuple[str, complex], ...] = ()


@dataclass(frozen=True)
class ForcePolygons:
    """Forces of a mechanism at an instant, by hand.

    Attributes
    ----------
    exact : the motion at the instant
    speed : rate of each drive at which inertia and loads are taken [rad/s or m/s]; `speed_from` "machine" or "drive"
    names : bodies by number
    groups : in the order in which they were solved, the input link at the end
    reactions : name -> force [N] as a complex number, R12 of body 1 on body 2
    moments : name -> moment [N m] of guides and meshes
    balancing : drive -> moment [N m] or force [N] that it must give, positive as its value grows
    work : the same by virtual work, of one drive
    levers : Zhukovsky's lever of each drive
    outer : loads, weights and inertia
    places : point -> place [m]
    paper : the sheet that scales are chosen for
    """

    mechanism: Mechanism
    exact: xr.Dataset
    speed: Mapping[str, float]
    speed_from: str
    names: tuple[str, ...]
    groups: tuple[GroupForces, ...]
    reactions: Mapping[str, complex]
    moments: Mapping[str, float]
    balancing: Mapping[str, float]
    work: Mapping[str, float]
    levers: tuple[Lever, ...]
    outer: tuple[Action, ...]
    places: Mapping[str, complex]
    paper: str

    @property
    def polygons(self) -> tuple[Polygon, ...]:
        """Of every group, in the order in which they were solved."""
        return tuple(group.polygon for group in self.groups)

    @property
    def steps(self) -> tuple[str, ...]:
        """All steps in words."""
        return tuple(line for group in self.groups for line in group.steps)

    @property
    def lever(self) -> Lever:
        """The lever of the first drive; KeyError where it cannot be drawn."""
        if not self.levers:
            raise KeyError("lever")
        return self.levers[0]
