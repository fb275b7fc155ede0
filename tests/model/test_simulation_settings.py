"""`[simulation]` of a description: free drives, drives that keep their law, initial speeds, instants."""

from __future__ import annotations

import math

import pytest

import centrode as ct

ARM = """\
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
X = [2, 0]
[links.OA]
length = 1
mass = 1
shape = "rod"
angle = 0
[links.AB]
length = 1
mass = 1
shape = "rod"
angle = 0
[[drives]]
link = "OA"
[[drives]]
distance = ["A", "X"]
LAW
[simulation]
duration = "2 s"
SETTINGS
"""


def arm(settings: str = "", law: str = "") -> str:
    return ARM.replace("SETTINGS", settings).replace("LAW", law)


def read(settings: str = "", law: str = "") -> ct.Simulation:
    simulation = ct.parse_mechanism(arm(settings, law)).simulation
    assert simulation is not None
    return simulation


def test_speeds_are_read_by_their_paths_and_in_their_units() -> None:
    lines = """\
[simulation.speeds]
links.OA = "60 rpm"
drives.A-X = "20 mm/s"
drives.OA = "180 deg/s"
points.B = ["1 m/s", 2]
"""
    speeds = read(lines).speeds
    assert speeds == {
        "links.OA": 2.0 * math.pi,
        "drives.A-X": 0.02,
        "drives.OA": math.pi,
        "points.B": (1.0, 2.0),
    }
    quoted = lines.replace("links.OA =", '"links.OA" =').replace("points.B =", '"points.B" =')
    assert read(quoted).speeds == speeds
    nested = '[simulation.speeds.links]\nOA = "60 rpm"\n'
    assert read(nested).speeds == {"links.OA": 2.0 * math.pi}


def test_everything_is_written_back() -> None:
    settings = """\
speed = "10 deg/s"
keeps = ["A-X"]
equations = "multibody"
at = [0, "500 ms", 1]
[simulation.speeds]
points.B = [0, 1]
"""
    mechanism = ct.parse_mechanism(arm(settings, "speed = 0.1"))
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
    assert mechanism.simulation is not None
    assert mechanism.simulation.at == (0.0, 0.5, 1.0)
    assert mechanism.simulation.keeps == ("A-X",)
    degrees = ct.parse_mechanism(
        arm(settings + 'links.AB = "0.5 rad/s"', "speed = 0.1") + "[display]\nangle = 'deg'\n"
    )
    assert ct.parse_mechanism(ct.mechanism_text(degrees)) == degrees


def test_start_and_speed_are_those_of_the_first_drive() -> None:
    """With several drives the parameter of a motion is time, but the start stays an angle."""
    simulation = read('start = "90 deg"\nspeed = "30 rpm"', "speed = 0.1")
    assert simulation.start == math.pi / 2
    assert simulation.speed == math.pi


@pytest.mark.parametrize(
    ("settings", "law", "message"),
    [
        ('keeps = ["BC"]', "", '[simulation] keeps: there is no drive "BC"; known are: OA, A-X'),
        ('keeps = ["A-X"]', "", 'drive "A-X" has no law that it could keep; give it speed, law'),
        (
            'keeps = ["A-X"]\n[simulation.speeds]\ndrives.A-X = 1',
            "speed = 0.1",
            'drive "A-X" keeps its law, which gives its speed; remove the speed',
        ),
        (
            "[simulation.speeds]\nlinks.OAA = 1",
            "",
            '[simulation.speeds] links.OAA: unknown link "OAA"; did you mean "OA"?',
        ),
        ("[simulation.speeds]\nguides.K = 1", "", 'unknown guide "K"'),
        ("[simulation.speeds]\npoints.O = [1, 0]", "", 'unknown point "O"'),
        ("[simulation.speeds]\ndrives.K = 1", "", 'there is no drive "K"'),
        (
            "[simulation.speeds]\nOA = 1",
            "",
            'a speed is that of a link, a guide, a drive or a point, got "OA"',
        ),
        ('[simulation.speeds]\nlinks.OA = "1 m/s"', "", "expected an angular speed"),
        ('[simulation.speeds]\ndrives.A-X = "1 rad/s"', "", "expected a speed"),
        ("[simulation.speeds]\npoints.B = 1", "", "expected [x, y], got 1"),
        ('[simulation.speeds]\nlinks.OA = 1\n"links.OA" = 2', "", "links.OA"),
        ("speeds = 3", "", "expected a table, got 3"),
        ("at = [1, 1]", "", "at must hold instants that grow"),
        ("at = [-1]", "", "must not be negative"),
        ('at = ["1 m"]', "", "expected a time"),
        ('equations = "lagrange"', "", 'expected one of "reduced", "multibody"'),
        (
            'equations = "multibody"\nscheme = "runge-kutta-4"',
            "",
            "fixed steps are those of the reduced equation",
        ),
    ],
)
def test_wrong_settings_are_refused_by_name(settings: str, law: str, message: str) -> None:
    with pytest.raises(ct.InputError) as caught:
        read(settings, law)
    assert message in str(caught.value)


def test_kinematics_refuses_a_drive_without_law_by_name() -> None:
    mechanism = ct.parse_mechanism(arm(law="speed = 0.1"))
    for compute in (ct.motion, ct.check, ct.limits):
        with pytest.raises(ct.InputError) as caught:
            compute(mechanism)
        assert "[[drives]] OA: it has no law of motion" in str(caught.value)
        assert "give speed, law, table, segments or cam" in str(caught.value)


def test_settings_in_python() -> None:
    settings = ct.Simulation(speeds={"drives.K": "1 m/s", "links.OA": "60 rpm"}, at=["1 s", 2])
    assert settings.speeds["drives.K"] == 1.0
    assert settings.at == (1.0, 2.0)
