"""Files of the program Linkage, written here as its public source writes them."""

from __future__ import annotations

import math

import pytest
from tools.campaigns.imports.drawings import LINKAGE

import centrode as ct
from centrode.errors import CentrodeError
from centrode.sketches.imported_sketch import ImportedSketch, sketch_content

UNIT = 0.0254 / 96


def read(text: str) -> ImportedSketch:
    return sketch_content(text.encode(), "drawing.linkage2", ".linkage2")


def connector(number: int, x: float, y: float, marks: str = "", inside: str = "") -> str:
    return f'<connector id="{number}" x="{x}" y="{y}" {marks}>{inside}</connector>'


def link(number: int, *connectors: int, marks: str = "") -> str:
    inside = "".join(f'<connector id="{k}"/>' for k in connectors)
    return f'<Link id="{number}" {marks}>{inside}</Link>'


def test_a_four_bar_with_a_drawn_point() -> None:
    four_bar = read(LINKAGE[0]).mechanism
    crank, rod, rocker = four_bar.links.values()
    assert crank.length == pytest.approx(96 * UNIT) and rocker.length == pytest.approx(
        math.hypot(96, 192) * UNIT
    )
    assert len(rod.coordinates) == 3 and "rod" in four_bar.links
    assert four_bar.drives[0].speed == pytest.approx(-math.pi)  # 30 rpm
    assert (ct.motion(four_bar, 37).status == 0).all()


def test_sliders_slots_and_actuators() -> None:
    slotted = read(LINKAGE[1]).mechanism
    (guide,) = slotted.guides
    assert guide.on in slotted.links
    cylinder = read(LINKAGE[2]).mechanism
    assert cylinder.drives[0].distance is not None and cylinder.guides[0].on == "frame"
    # 21 units out and back 15 times a minute: 42 * 15 / 60 units a second
    assert cylinder.drives[0].speed == pytest.approx(10.5 * UNIT)


def test_a_pin_of_the_frame_in_a_slot_of_a_link() -> None:
    """Two pins of the frame hold a bar: it slides as in a guide."""
    limits = '<slidelimit id="0"/><slidelimit id="2"/>'
    parts = [
        connector(0, 238, -237), connector(1, 340, -192), connector(2, 430, -237),
        connector(3, 298, -237, 'anchor="true" slider="true"', limits),
        connector(4, 375, -237, 'anchor="true" slider="true"', limits),
        connector(5, 534, -187, 'anchor="true" input="true" rpm="-15"'), connector(6, 534, -150),
        link(0, 0, 1, 2), link(1, 3), link(2, 4), link(3, 5, 6), link(4, 1, 6),
    ]  # fmt: skip
    found = read(f"<linkage2>{''.join(parts)}</linkage2>").mechanism
    motion = ct.motion(found, 73)
    bar = next(name for name, one in found.links.items() if len(one.coordinates) == 3)
    angle = motion.angle.sel(link=bar).values
    assert (motion.status == 0).all() and abs(angle - angle[0]).max() < 1e-9
    assert found.drives[0].speed == pytest.approx(math.pi / 2)


def test_links_of_the_frame_fastened_links_and_other_layers() -> None:
    parts = [
        connector(0, 0, 0, 'anchor="true" input="true" rpm="10"'), connector(1, 0, 96), connector(2, 288, 192),
        connector(3, 384, 0, 'anchor="true"'), connector(4, 100, 250), connector(9, 1, 1, 'layer="1"'),
        link(0, 0, 1), link(1, 1, 2), link(2, 2, 3), link(3, 0, 3), link(4, 2, 4, marks='fastenlink="1"'),
    ]  # fmt: skip
    found = read(f"<linkage2>{''.join(parts)}</linkage2>")
    assert [len(one.coordinates) for one in found.mechanism.links.values()] == [2, 3, 2]
    assert found.omitted == ("measurements and parts of the drawing layer (1)",)
    factor = read(f"<linkage2><program scalefactor='2'/>{''.join(parts)}</linkage2>")
    assert any("scale factor 2" in one for one in factor.guesses)
    assert next(iter(factor.mechanism.links.values())).length == pytest.approx(2 * 96 * UNIT)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("<linkage/>", "root is linkage"),
        ("<linkage2/>", "no connectors"),
        ("<linkage2>" + connector(0, 0, 0) + "</linkage2>", "no anchor"),
        ("<linkage2>" + connector(0, 0, 0) * 2 + "</linkage2>", "one name"),
        ("<linkage2>" + connector(0, 0, 0).replace('"0"', '"nan"') + "</linkage2>", "no number"),
        (LINKAGE[0].replace("</linkage2>", "<ratios><ratio/></ratios></linkage2>"), "gears and chains"),
        (LINKAGE[1].replace('slider="true"', 'slider="true" slideradius="3"'), "curved slots"),
        (LINKAGE[0].replace('<Link id="0"><connector id="0"/>', '<Link id="0"><connector id="7"/>'), "not there"),
        (LINKAGE[0].replace('anchor="true" input', 'input'), "input of it does not turn|no anchor"),
    ],
)  # fmt: skip
def test_what_is_not_read_is_refused(text: str, told: str) -> None:
    with pytest.raises(CentrodeError, match=told):
        read(text)
