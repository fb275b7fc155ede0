"""Single samples of a batch as the arrays compute them, put into their places among those of machine code."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.angles import NodeTurns, angle_and_rates
from centrode.kinematics.compiled.writing import ORDERED, ROOMS
from centrode.kinematics.contacts import contacts_at
from centrode.kinematics.continuation import Continuation
from centrode.kinematics.layout import positions_from
from centrode.kinematics.pace import nearest_node
from centrode.kinematics.residuals import CLOSED, open_what_does_not_close, residuals
from centrode.kinematics.rooms import Room
from centrode.kinematics.sampling import Samples, sample, settle
from centrode.kinematics.solve import Solved, of_lanes
from centrode.kinematics.spans import Span

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Patches:
    """Computes samples of the mechanisms of a batch whose events are known.

    `plan` is a motion of one sample whose arrays hold nodes: angles that stand are numbers there. `turns` are those, on
    the mesh, of the links that turn and whose turns the plan does not give.
    """

    continuation: Continuation
    span: Span
    plan: Solved
    turns: Mapping[str, NodeTurns]
    mesh: Array

    def put(
        self, lanes: Lanes, places: Lanes, found: Mapping[str, Array], status: npt.NDArray[np.int8]
    ) -> Lanes:
        """Put samples, one of each of these mechanisms, into the arrays of all; returns those that do not close."""
        arrays, status[lanes, places], broken = self._computed(lanes, places)
        for name in ROOMS:
            if name in found:
                if name in ORDERED:
                    found[name][:, lanes, places] = arrays[name][:, :, 0]
                else:
                    found[name][lanes, places] = arrays[name][:, 0]
        return lanes[broken]

    def _computed(self, lanes: Lanes, places: Lanes) -> tuple[dict[str, Array], npt.NDArray[np.int8], Mask]:
        """The samples as motions (k, 1) of one sample each."""
        parameter = self.span.parameter[places]
        kinematics = of_lanes(self.continuation.kinematics, lanes)
        room = Room.of(self.plan.layout, kinematics.numbers, len(lanes), 1)
        samples = room.samples
        single = Samples(
            self.plan.layout,
            samples.columns[..., 0],
            samples.angles[..., 0],
            samples.status[:, 0],
            samples.followed,
        )
        sample(self.continuation, parameter, single, lanes)
        settle(single)
        self._fill_angles(samples, lanes, parameter)
        at = positions_from(
            kinematics, self.plan.layout, samples.columns[0], samples.angles[0], parameter[:, None]
        )
        residual, _worst = residuals(kinematics, samples, at)
        with np.errstate(invalid="ignore"):
            broken = residual[:, 0] > CLOSED
        open_what_does_not_close(samples, residual)
        contacts = contacts_at(kinematics, at, samples)
        room.fill_frame(kinematics.numbers)
        arrays = {
            "all_points": room.all_points,
            "angles": room.turned,
            "slides": room.slides,
            "contacts": contacts,
            "residual": residual,
        }
        if room.spins is not None and room.attitudes is not None:
            arrays["spins"], arrays["attitudes"] = room.spins, room.attitudes
        return arrays, room.status[:, 0], broken

    def _fill_angles(self, samples: Samples, lanes: Lanes, parameter: Array) -> None:
        nearest = nearest_node(self.mesh, parameter)
        for link, nodes in self.turns.items():
            rotor = samples.columns[:, self.plan.layout.rotor(link)]
            cosine, sine = rotor[0, :, :, 0]
            turns = nodes.at_single(lanes, nearest, cosine, sine, parameter)
            angle = self.plan.layout.angles.index(link)
            angle_and_rates(rotor, turns[:, None], samples.angles[:, angle])
        for angle, link in enumerate(self.plan.layout.angles):
            if link not in self.turns and link not in samples.followed:
                samples.angles[:, angle] = 0.0 * samples.columns[:, self.plan.layout.rotor(link).start]
                samples.angles[0, angle] += self.plan.angles[0, 0, 0, angle]
