"""Angular velocities and accelerations that gears and rolling wheels give."""

from __future__ import annotations

from collections.abc import Mapping

from centrode.analysis.graphic.board import dot
from centrode.analysis.graphic.stage import Stage
from centrode.kinematics.dyads import solved_angles
from centrode.structure.constraints import FRAME, GearRatio, NoSlip, Positions
from centrode.structure.gearing import Straight
from centrode.structure.groups import AngleEquation, AngleGiven, Arm, Meshed, Rolled, Train


def meshed_rate(stage: Stage, gear: GearRatio, link: str) -> float:
    """Turning of one link of a gear from that of the other two (Willis)."""
    weights = gear.weights(stage.drawing.numbers)
    known = sum(weight * stage.turns[other] for other, weight in weights.items() if other != link)
    return float(-known / weights[link])


def wheel_equations(stage: Stage, turning: object) -> list[str]:
    """The equation of a gear (Willis), or of a wheel that rolls on the frame, as a person writes it."""
    letter = "ω" if stage.order == 1 else "ε"
    if isinstance(turning, Meshed):
        turning = turning.gear
    if isinstance(turning, GearRatio):
        weights = turning.weights(stage.drawing.numbers)
        ratio = -weights[turning.first] / weights[turning.second]
        first, second = (_seen(letter, link, turning.carrier) for link in (turning.first, turning.second))
        return [f"{second} = {ratio:.5g}·{first}"]
    if isinstance(turning, Rolled) and turning.rolling.on == FRAME:
        wheel, centre = turning.rolling.link, turning.rolling.centre
        rate = "v" if stage.order == 1 else "aᵗ"
        return [f"|{letter}_{wheel}| = |{rate}_{centre}|/r"]
    return []


def _seen(letter: str, link: str, carrier: str) -> str:
    """Turning of a link as its gear's carrier sees it."""
    parts = ["0" if name == FRAME else f"{letter}_{name}" for name in (link, carrier)]
    return parts[0] if carrier == FRAME else f"({parts[0]} − {parts[1]})"


def rolled_rate(stage: Stage, rolling: NoSlip) -> float:
    """Turning of a wheel against the body it rolls on, from the way of its centre along the track."""
    drawing = stage.drawing
    numbers, centre = drawing.numbers, drawing.point(rolling.centre)
    track = numbers.gearing.track[rolling.rolling]
    velocity = 0j if stage.before is None else stage.before.points[rolling.centre]
    relative = stage.points[rolling.centre] - stage.carried(rolling.on, centre)
    relative -= stage.coriolis(rolling.on, centre, velocity)
    if isinstance(track, Straight):
        heading = drawing.heading(rolling.on, track.direction)
        return float(-dot(heading, relative) / numbers.gearing.radius[rolling.rolling])
    arm = drawing.arm(drawing.inside(rolling.on, track.centre), centre)
    return float(numbers.gearing.spin(rolling.rolling) * dot(1j * arm, relative) / abs(arm) ** 2)


def train_rates(stage: Stage, group: Train) -> dict[str, float]:
    """Turning of all links of a train."""
    rows = [_row(stage, equation) for equation in group.equations]
    return solved_angles(group, rows, Positions({}, {}, {}, dict(stage.turns)))


def _row(stage: Stage, equation: AngleEquation) -> tuple[Mapping[str, float], float]:
    """Factors of the turnings in an equation, and what they sum up to."""
    numbers = stage.drawing.numbers
    if isinstance(equation, GearRatio):
        return dict(equation.weights(numbers)), 0.0
    if isinstance(equation, NoSlip):
        return {equation.link: 1.0, equation.on: -1.0}, rolled_rate(stage, equation)
    if isinstance(equation, Arm):
        spin = numbers.gearing.spin(equation.rolling.rolling)
        return {equation.rolling.link: 1.0, equation.rolling.on: spin - 1.0, equation.link: -spin}, 0.0
    assert isinstance(equation, AngleGiven)
    rate = 0.0 if equation.drive is None else stage.driven[equation.drive]
    return {equation.link: 1.0, equation.relative_to: -1.0}, rate
