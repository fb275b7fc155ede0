"""What a description asks to choose: the parameters, the proof, what the choice costs, the cam that comes of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from centrode.cams.choosing.choice import Choice, choose
from centrode.cams.choosing.families import bounds_of, chosen_cam, family_of, start_of
from centrode.cams.choosing.proving import Proof, prove
from centrode.cams.choosing.trade_off import POINTS, TradeOff, trade_off
from centrode.model.cams.description import Cam
from centrode.model.cams.files import AnyCam, curved

MORE = 3
"""So often the search goes on from a neighbour that is better, as there are where a law is not smooth."""


@dataclass(frozen=True)
class CamChoice:
    """A cam with chosen parameters.

    Attributes
    ----------
    cam : Cam
        The description with them.
    choice : Choice
    proof : Proof
        Its bounds and its neighbours along the path itself.
    front : TradeOff or None
        What the bound of another measure costs; None where none is asked for.
    """

    cam: Cam
    choice: Choice
    proof: Proof
    front: TradeOff | None

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of the measures that this cam has: prints are those of a walking wheel."""
        kept = self.choice.chosen.measures
        prints = self.cam.mover is not None or kept["gap"].bound is not None
        return tuple(name for name in kept if name != "gap" or prints)


def choose_cam(
    cam: AnyCam,
    points: int = POINTS,
    *,
    front: bool = True,
    said: Callable[[int, int], None] = lambda _done, _of: None,
) -> CamChoice:
    """Choose the parameters that `[choose]` names, so that its bounds are kept and one measure is least.

    Parameters
    ----------
    cam : Cam
        With `[choose]`.
    points : int
        Of the front, where `trade_off` names a measure.
    front : bool
        Also the front.
    said : callable
        Told how many of the front's points are done, and of how many.

    Returns
    -------
    CamChoice
        Also where no design keeps all bounds: then with the one whose worst miss is least.

    Raises
    ------
    InputError
        Nothing to choose, or ranges that hold no design.
    """
    cam = curved(cam)
    family = family_of(cam)
    assert cam.choose is not None
    start, best, bounds = start_of(cam, family), cam.choose.minimise, bounds_of(cam)
    choice = choose(family, start, best, bounds)
    chosen = chosen_cam(cam, choice)
    proof = prove(chosen, bounds, best)
    for _again in range(MORE):
        if proof.better is None:
            break
        warm = [start_of(proof.better, family), start_of(chosen, family)]
        choice = choose(family, start, best, bounds, warm=warm)
        chosen = chosen_cam(cam, choice)
        proof = prove(chosen, bounds, best)
    against = cam.choose.trade_off
    wanted = front and against is not None
    found = trade_off(family, start, best, against or "", bounds, points, said) if wanted else None
    return CamChoice(chosen, choice, proof, found)
