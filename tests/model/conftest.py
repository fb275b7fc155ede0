"""Texts of descriptions that the tests of the model share."""

from collections.abc import Callable

import pytest

from centrode.errors import InputError
from centrode.model.files import parse_mechanism

FULL = """
title = "Шатун «A'»"
gravity = [0, "-9.81 m/s^2"]
display = { length = "mm", angle = "deg" }
[frame.points]
O = [0, 0]
D = "placed"
[links.OA]
length = 0.5
angle = 0.0
[links.AC]
length = "1 m"
angle = "0.5 rad"
mass = 9
centre = [0.7225, 0]
inertia = 0.45
[links.rocker]
points = { C = [0, 0], B = [0.85, 0], D = [1.7, 0] }
angle = "1.9 rad"
centre = "B"
[links.block]
points = { H = [0, 0] }
mass = 3.5
[links.CH]
length = "850 mm"
shape = "rod"
[links.wheel]
points = ["C"]
[links."палец A"]
points = ["A", "A’"]
length = 0.1
[[guides]]
point = "C"
on = "frame"
through = "placed"
direction = [1, 0]
[[guides]]
point = "H"
name = "way"
on = "frame"
through = "O"
direction = "30 deg"
link = "block"
angle = "0.1 rad"
[[gears]]
links = ["OA", "wheel"]
carrier = "frame"
ratio = "-40/20"
[[gears]]
name = "ring gear"
links = ["frame", "wheel"]
carrier = "AC"
ratio = 3
[[rolling]]
link = "wheel"
centre = "C"
radius = 0.3
on = "frame"
along = { through = [0, 0], direction = [1, 0] }
[[rolling]]
link = "wheel"
name = "ring"
centre = "C"
radius = 0.3
on = "block"
along = { centre = "H", radius = 2, inside = true }
[[drives]]
link = "OA"
start = "90 deg"
speed = "60 rpm"
[[drives]]
distance = ["A", "H"]
law = "0.3*sin(2*t)"
[[drives]]
guide = "C"
start = "3 mm"
table = [[0, 0], [0.5, 0.1], ["1500 ms", "20 cm"]]
[assembly]
sides = { B = "left", way = "ahead" }
continuation = "keep"
[[loads]]
kind = "force"
point = "H"
vector = [-9000, "1 kN"]
while_moving = [1, 0]
[[loads]]
kind = "torque"
link = "OA"
value = "-0.1*v*abs(v)"
relative_to = "AC"
[[loads]]
kind = "spring"
points = ["A", "D"]
stiffness = "2 N/mm"
free_length = 0.2
[[loads]]
kind = "spring"
link = "OA"
stiffness = "3 N*m/rad"
free_angle = "5 deg"
[[loads]]
kind = "damper"
points = ["A", "D"]
damping = "2 N*s/m"
[[loads]]
kind = "weight"
link = "AC"
value = "90 N"
[[loads]]
kind = "friction"
guide = "C"
value = 3
[machine]
mean_speed = "65 rpm"
fluctuation = 0.11
[study]
samples = 361
instants = ["99 ms", 2]
from = 0
to = "6 s"
"""

SPHERE = """
space = "sphere"
[frame.points]
A = [1, 0, 0]
D = ["90 deg", 0]
E = [0, 0, 1]
[links.AB]
length = "15 deg"
reference = ["A", "D"]
angle = 0.2
[links.BC]
length = 1.3
[links.rocker]
points = { D = [0, 0, 1], C = ["90 deg", 0], G = ["10 deg", "-5 deg"] }
reference = ["D", "E"]
angle = -0.7
[[guides]]
point = "C"
on = "frame"
pole = "D"
[[guides]]
point = "B"
name = "small"
on = "frame"
pole = [0.1, 0.2]
radius = "10 deg"
[[drives]]
link = "AB"
start = 0
speed = 1
"""

FOUR_BAR = """
[frame.points]
O = [0, 0]
D = [4, 0]
[links.OA]
length = 1
[links.AB]
length = 3.5
[links.DB]
length = 3
[[drives]]
link = "OA"
start = 1
speed = 1
"""


@pytest.fixture
def complaint() -> Callable[[str], str]:
    """What reading a text complains about."""

    def read(text: str) -> str:
        with pytest.raises(InputError) as caught:
            parse_mechanism(text, "press.toml")
        assert caught.value.exit_code == 2
        return str(caught.value)

    return read
