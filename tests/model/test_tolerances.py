"""The [tolerances] of a description: every spelling, and what is refused, with its place and its repair."""

from __future__ import annotations

import pytest

import centrode as ct
from centrode.tolerances.dimension_limits import length_paths, limits_of

PRESS = ct.mechanism_text(ct.example("six-bar-press"))


def press(tolerances: str) -> ct.Mechanism:
    return ct.parse_mechanism(f"{PRESS}\n[tolerances]\n{tolerances}\n", "press.toml")


SPELLINGS = {
    '"links.OA.length" = "±0.1 mm"': (-1e-4, 1e-4),
    '"links.OA.length" = "+-0.1 mm"': (-1e-4, 1e-4),
    '"links.OA.length" = "+/- 0.1 mm"': (-1e-4, 1e-4),
    '"links.OA.length" = 1e-4': (-1e-4, 1e-4),
    'links.OA.length = ["-0.1 mm", "0.3 mm"]': (-1e-4, 3e-4),
    'links.OA.length = [0, "1 mm"]': (0.0, 1e-3),
    'links.OA.length = "IT7"': (-28.5e-6, 28.5e-6),
    'links.OA.length = "H7"': (0.0, 57e-6),
    'links.OA.length = "h 7"': (-57e-6, 0.0),
    'links.OA.length = "js9"': (-70e-6, 70e-6),
    'dimensions = { "links.OA.length" = "±0.1 mm" }': (-1e-4, 1e-4),
}


@pytest.mark.parametrize("text", SPELLINGS)
def test_spellings(text: str) -> None:
    limits = limits_of(press(text))
    assert limits.paths == ("links.OA.length",)
    assert (limits.lower[0], limits.upper[0]) == pytest.approx(SPELLINGS[text], rel=1e-12, abs=1e-20)


def test_files_lose_nothing() -> None:
    mechanism = press(
        """default = "±0.1 mm"
distribution = "uniform"
links.OA.length = "H7"
frame.points.C.x = ["-1 mm", 0]
clearances = { B = "0.05 mm", "D/DH" = "0.1 mm", H = { play = "0.1 mm", length = "80 mm" } }
correlations = [{ paths = ["links.OA.length", "frame.points.C.x"], value = 0.5 }]
[tolerances.outputs]
stroke = { formula = "range(position_H_x)", within = ["1.57 m", "1.59 m"] }
place = { formula = "position.H.x", deviation = "±1 mm" }
D = "position.D.x"
"""
    )
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
    assert isinstance(hash(mechanism), int)
    settings = mechanism.tolerances
    assert settings is not None
    assert settings.clearances["H"].length == 0.08
    assert settings.outputs["stroke"].within == (1.57, 1.59)
    assert settings.outputs["place"].deviation == 1e-3


def test_angles_keep_their_unit_where_degrees_are_displayed() -> None:
    text = ct.mechanism_text(ct.example("single-cylinder-engine"))
    assert 'angle = "deg"' in text
    guide = ct.parse_mechanism(text).guides[0].id
    mechanism = ct.parse_mechanism(f'{text}\n[tolerances]\nguides.{guide}.direction = "±0.1 deg"\n')
    assert limits_of(mechanism).upper[0] == pytest.approx(0.1 * 3.141592653589793 / 180, rel=1e-15)
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
    with pytest.raises(ct.InputError, match="unit"):
        ct.parse_mechanism(f'{text}\n[tolerances]\nguides.{guide}.direction = "±0.1"\n')


def test_default_is_that_of_all_lengths() -> None:
    mechanism = press('default = "±0.1 mm"\nlinks.OA.length = "±1 mm"')
    limits = limits_of(mechanism)
    assert set(limits.paths) == set(length_paths(mechanism))
    assert limits.upper[limits.paths.index("links.OA.length")] == 1e-3
    assert limits.upper[limits.paths.index("links.DH.points.H.x")] == 1e-4
    # coordinates have no grade
    assert limits_of(press('default = "IT9"')).paths == ("links.OA.length",)


def test_lengths_of_a_drawing() -> None:
    """The first joint of a link is its origin; centres of mass and the datum O of the frame have no tolerance."""
    found = length_paths(ct.example("six-bar-press"))
    assert "links.CD.points.D.y" in found
    assert not [
        path for path in found if "S2" in path or "S4" in path or ".O." in path or "points.C.y" in path
    ][1:]
    assert length_paths(ct.example("spherical-four-bar"))[:3] == [
        "links.AB.length",
        "links.BC.length",
        "links.DC.length",
    ]


REFUSALS = {
    '"links.OA.lenght" = "±1 mm"': (r"\[tolerances\] links.OA.lenght", "did you mean"),
    '"links.OX.length" = "±1 mm"': ("links.OX.length", '"OX"'),
    '"links.OA.length" = "1 mm"': ("links.OA.length", 'write "±1 mm"'),
    '"links.OA.length" = "±-1 mm"': ("links.OA.length", "negative"),
    '"links.OA.length" = ["2 mm", "1 mm"]': ("links.OA.length", "exchange"),
    '"links.OA.length" = [1]': ("links.OA.length", "lower and an upper"),
    '"links.OA.length" = "±1 deg"': ("links.OA.length", "expected a length"),
    '"links.OA.length" = "±2 m"': ("links.OA.length", "all of the length"),
    '"links.OA.length" = "IT19"': ("links.OA.length", "IT1 to IT18"),
    '"links.OA.length" = "g6"': ("links.OA.length", "not known"),
    '"links.OA.length" = true': ("links.OA.length", "expected a length"),
    '"frame.points.C.x" = "H7"': ("frame.points.C.x", "not for angles, arcs, ratios or coordinates"),
    '"guides.H.direction" = "IT7"': ("guides.H.direction", "not for angles"),
    '"drives.OA.speed" = "±1 rpm"': ("drives.OA.speed", "dimension"),
    'defualt = "±1 mm"': ("defualt", '"default"'),
    'default = "0.1 mm"': ("default", "±0.1 mm"),
    'distribution = "gaussian"': ("distribution", "triangular"),
    'clearances = { Q = "1 mm" }': (r"clearances\] Q", "no pin or guide"),
    'clearances = { S2 = "1 mm" }': (r"clearances\] S2", "no joint"),
    'clearances = { B = "-1 mm" }': ("clearances.B", "positive"),
    'clearances = { B = 0 }': ("clearances.B", "positive"),
    'clearances = { "B/OA" = "1 mm" }': ("B/OA", "known are"),
    'clearances = { B = { play = "1 mm", length = "1 mm" } }': (r"clearances\] B", "remove length"),
    'clearances = 3': ("clearances", "a table"),
    'outputs = { x = { formula = "range(position_H_x)", within = [2, 1] } }': ("outputs.x", "nothing between"),
    'outputs = { x = { formula = "position.H.x", within = [1, 2], deviation = 1 } }': ("outputs] x", "within"),
    'outputs = { x = 3 }': ("outputs.x", "text"),
    'correlations = [{ paths = ["links.OA.length"], value = 0.5 }]': ("correlations", "two paths"),
    'correlations = [{ paths = ["links.OA.length", "frame.points.C.x"], value = 1 }]': ("correlations", "no tolerance"),
    'correlations = [{ paths = ["links.OA.length", "a"], value = 2 }]': ("correlations", "between -1 and 1"),
}  # fmt: skip


@pytest.mark.parametrize("text", REFUSALS)
def test_refusals_say_where_and_what(text: str) -> None:
    with pytest.raises(ct.InputError) as failure:
        press(text)
    assert str(failure.value).startswith("press.toml")
    for part in REFUSALS[text]:
        assert part.replace("\\", "") in str(failure.value)


def test_grade_beyond_the_table() -> None:
    with pytest.raises(ct.InputError, match=r"links\.OA\.length: standard grades end at 3150 mm"):
        ct.parse_mechanism(
            PRESS.replace("length = 0.347", "length = 3.347") + '\n[tolerances]\nlinks.OA.length = "IT7"\n'
        )


def test_impossible_correlations_are_refused() -> None:
    text = """default = "±1 mm"
links.OA.length = "±1 mm"
frame.points.C.x = "±1 mm"
links.AB.points.B.x = "±1 mm"
correlations = [
  { paths = ["links.OA.length", "frame.points.C.x"], value = 0.9 },
  { paths = ["links.OA.length", "links.AB.points.B.x"], value = 0.9 },
  { paths = ["frame.points.C.x", "links.AB.points.B.x"], value = -0.9 },
]"""
    with pytest.raises(ct.InputError, match="negative eigenvalue"):
        _ = limits_of(press(text)).correlation
