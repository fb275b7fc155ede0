"""Drawings as mechanisms: lengths as they are drawn, frame, sliders, slots, drives; what is guessed is told."""

from __future__ import annotations

from pathlib import Path

import ezdxf
import pytest

import centrode as ct
from centrode.errors import CentrodeError, InputError
from centrode.sketches.imported_sketch import ImportedSketch, sketch_content


def svg(inside: str, head: str = 'width="140mm" height="120mm" viewBox="0 -120 140 120"') -> ImportedSketch:
    return sketch_content(f"<svg {head}>{inside}</svg>".encode(), "drawing.svg", ".svg")


def lengths(read: ImportedSketch) -> list[float]:
    """Lengths of bars in mm, in their order."""
    return [1000 * link.length for link in read.mechanism.links.values() if link.length is not None]


BARS = '<path d="M0 0L30-40L120-90L140 0"/>'
"""Bars of 50, 102.956 and 92.195 mm: sqrt(90^2 + 50^2), sqrt(20^2 + 90^2)."""
SIDES = [50.0, (90**2 + 50**2) ** 0.5, (20**2 + 90**2) ** 0.5]


@pytest.mark.parametrize(
    ("inside", "head"),
    [
        (BARS, 'width="140mm" height="120mm" viewBox="0 -120 140 120"'),
        (BARS.replace("path", 'path class="x" style="fill:none"'), 'width="14cm" viewBox="0 0 140 10"'),
        ('<polyline points="0,0 30,-40 120,-90 140,0"/>', 'width="0.14m" viewBox="0 -120 140 120"'),
        ('<path d="m0 0l30-40l90-50v0l20,90"/>', 'width="140mm" viewBox="0 -120 140 120"'),
        (f'<g transform="translate(7 8)"><g transform="rotate(33) scale(2)">{BARS}</g></g>',
         'width="70mm" viewBox="0 0 140 140"'),
        (f'<g transform="matrix(0 1 -1 0 3 4)">{BARS}</g>', 'width="140mm" viewBox="0 -120 140 120"'),
    ],
)  # fmt: skip
def test_lengths_are_those_that_are_drawn(inside: str, head: str) -> None:
    read = svg(inside, head)
    assert lengths(read) == pytest.approx(SIDES, rel=1e-8)
    assert list(read.mechanism.frame.points) == ["A", "D"]
    assert any("no layer is named ground" in one for one in read.guesses)
    assert any("AB drives" in one for one in read.guesses)
    assert ct.parse_mechanism(read.text) == read.mechanism
    motion = ct.motion(read.mechanism, 37)
    assert (motion.status == 0).all()  # 50 + 140 < 102.956 + 92.195: a crank


def test_units_and_scale() -> None:
    bare = svg(BARS, 'viewBox="0 0 96 96"')
    assert lengths(bare)[0] == pytest.approx(50 * 25.4 / 96)
    assert any("96 units are an inch" in one for one in bare.guesses)
    inches = svg(BARS, 'width="1in" viewBox="0 0 96 96"')
    assert lengths(inches) == pytest.approx(lengths(bare)) and len(inches.guesses) == len(bare.guesses) - 1
    five = sketch_content(f'<svg width="140mm" viewBox="0 0 140 1">{BARS}</svg>'.encode(), "x", ".svg", 5.0)
    assert lengths(five) == pytest.approx([5 * side for side in SIDES])


def test_circles_are_hinges_and_what_meets_elsewhere_is_one_link() -> None:
    rings = "".join(
        f'<circle cx="{x}" cy="{y}" r="2"/>' for x, y in ((0, 0), (30, -40), (120, -90), (140, 0))
    )
    plate = '<path d="M0 0L30-40M30-40L80-110L120-90M120-90L140 0"/>'
    read = svg(plate + rings)
    assert [len(link.coordinates) for link in read.mechanism.links.values()] == [2, 3, 2]
    # lines that end at the rims, as on a board
    short = '<path d="M1.2-1.6L28.8-38.4M31.7483-40.9713L118.2517-89.0287"/><path d="M139.566-1.953L120.434-88.048"/>'
    board = svg(short + rings)
    assert lengths(board) == pytest.approx(SIDES, rel=1e-8)


def test_ground_is_told_by_layers_and_hatching() -> None:
    marked = svg(
        f'{BARS}<g id="ground"><path d="M-5 0h10"/></g><path d="M135 0h10v4h-10z" fill="url(#hatch)"/>'
    )
    assert not any("ground" in one for one in marked.guesses)
    assert len(marked.mechanism.frame.points) == 2
    plate = '<path d="M0 0L30-40M30-40L120-90L90-120zM120-90L140 0"/>'
    apex = svg(f'{plate}<g class="стойка"><circle cx="0" cy="0" r="1"/><circle cx="140" cy="0" r="1"/></g>'
               '<circle cx="30" cy="-40" r="1"/><circle cx="120" cy="-90" r="1"/>')  # fmt: skip
    assert len(apex.mechanism.frame.points) == 2 and len(apex.mechanism.links) == 3


def test_sliders_by_rectangles_by_lines_and_between_parallel_lines() -> None:
    crank = '<path d="M0 0L30-40M30-40L130 -10"/>'
    ground = '<g id="ground"><path d="M-5 0h10"/></g>'
    block = svg(
        f'{crank}{ground}<g id="ground2"><path d="M60-4h80"/></g><rect x="120" y="-16" width="20" height="12"/>'
    )
    line = svg(f'{crank}{ground}<g id="guide"><path d="M60-10h80"/></g>')
    pair = svg(f'{crank}{ground}<g id="guide"><path d="M60-15h80M60-5h80"/></g>')
    assert any("midway" in one for one in pair.guesses)
    for read in (block, line, pair):
        (guide,) = read.mechanism.guides
        assert (guide.on, read.mechanism.frame.points.keys() & {guide.point}) == ("frame", set())
        slide = ct.motion(read.mechanism, 361).slide.values
        # rod 104.403, offset 10, crank 50: sqrt((r+l)^2 - e^2) - sqrt((l-r)^2 - e^2)
        rod = (100**2 + 30**2) ** 0.5
        stroke = ((50 + rod) ** 2 - 100) ** 0.5 - ((rod - 50) ** 2 - 100) ** 0.5
        assert 1000 * (slide.max() - slide.min()) == pytest.approx(stroke, rel=1e-4)


def test_a_slot_of_a_link() -> None:
    rings = "".join(f'<circle cx="{x}" cy="{y}" r="1"/>' for x, y in ((0, 0), (0, 60), (20, 0)))
    read = svg(
        f'{rings}<path d="M0 0L20 0"/><path d="M0 60L40 -60"/><g id="ground"><path d="M-4 1h8M-4 61h8"/></g>'
        '<rect x="12" y="-3" width="16" height="6" transform="rotate(-71.565051177 20 0)"/>',
        'width="100mm" viewBox="0 0 100 100"',
    )  # the crank is level, and its pin in the lever's slot
    (guide,) = read.mechanism.guides
    assert guide.on != "frame"
    lever = ct.motion(read.mechanism, 721).angle.sel(link=guide.on).values
    assert lever.max() - lever.min() == pytest.approx(2 * 0.3398369, abs=1e-5)  # 2 asin(20/60)


def test_dxf_with_blocks_units_and_arcs(tmp_path: Path) -> None:
    document = ezdxf.new("R2010", units=1)
    block = document.blocks.new("bars")
    for start, end in (((0, 0), (3, 4)), ((3, 4), (12, 9))):
        block.add_line(start, end, dxfattribs={"layer": "links"})
    space = document.modelspace()
    space.add_blockref("bars", (1, 2), dxfattribs={"rotation": 90})
    space.add_lwpolyline([(-8, 14), (1, 16)], dxfattribs={"layer": "звенья"})
    space.add_hatch().paths.add_polyline_path([(0, 1), (2, 1), (2, 2), (0, 2)])
    space.add_lwpolyline(
        [(0, 16, 0, 0, 1), (2, 16, 0, 0, 1)], format="xyseb", close=True, dxfattribs={"layer": "ground"}
    )
    space.add_arc((1, 2), 1, 20, 80, dxfattribs={"layer": "drive"})
    space.add_text("O", dxfattribs={"layer": "names", "insert": (1.5, 1.5)})
    space.add_spline([(0, 0), (1, 1), (2, 0)])
    file = tmp_path / "bars.dxf"
    document.saveas(file)
    read = ct.import_sketch(file)
    assert lengths(read) == pytest.approx([25.4 * x for x in (5, 106**0.5, 85**0.5)], rel=1e-8)
    assert "O" in read.mechanism.frame.points and len(read.mechanism.frame.points) == 2
    assert (
        read.mechanism.drives[0].link is not None
        and "O" in read.mechanism.links[read.mechanism.drives[0].link].coordinates
    )
    assert read.omitted == ("entities SPLINE (1)",)


@pytest.mark.parametrize(
    ("inside", "told"),
    [
        ("", "no straight lines"),
        ('<path d="M0 0C1 1 2 2 3 3"/>', "no straight lines"),
        (BARS + '<g id="gears"><circle cx="0" cy="0" r="20"/></g>', "gears and wheels"),
        ('<path d="M0 0L30-40L80-60L120-90L140 0"/>', "mobility"),
        ('<path d="M0 0L30-40L120-90L140 0M30-40L140-60"/>', "rigidly"),
        (BARS + '<path d="M0 0L140 0"/>', "marked as fixed"),
        ('<g transform="turn(3)"/>', "transform"),
        ('<g transform="rotate(1e400)"/>', "transform"),
        ('<line x1="3em"/>', "x1"),
        (BARS.replace("140", "1e15"), "too large"),
        ('<rect x="115" y="-93" width="10" height="6"/><path d="M0 0L30-40L120-90"/>', "has no guide"),
    ],
)  # fmt: skip
def test_what_is_not_understood_is_refused_in_words(inside: str, told: str) -> None:
    with pytest.raises(CentrodeError, match=told):
        svg(inside)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "not well formed"),
        (b"<svg>", "line 1"),
        (b"<html/>", "root is html"),
        (b'<!DOCTYPE svg [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><svg>&b;</svg>', "entities"),
        (b'<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]><svg>&a;</svg>', "entities"),
        (b"<svg>" + b"<g>" * 100 + b"</g>" * 100 + b"</svg>", "nested too deeply"),
        (b"<svg>" + b"<g/>" * 20_001 + b"</svg>", "too many elements"),
        (b"<svg>" + b'<line x2="1"/>' * 2001 + b"</svg>", "at most 2000"),
        (b'<?xml version="1.0" encoding="nonsense"?><svg/>', "encoding|not well formed"),
    ],
)
def test_files_of_strangers_are_bounded(content: bytes, told: str) -> None:
    with pytest.raises(InputError, match=told):
        sketch_content(content, "drawing.svg", ".svg")


def test_other_files_are_refused(tmp_path: Path) -> None:
    (tmp_path / "x.dwg").write_bytes(b"AC1032")
    with pytest.raises(InputError, match=r"not from \.dwg"):
        ct.import_sketch(tmp_path / "x.dwg")
    (tmp_path / "x.dxf").write_bytes(b"AutoCAD Binary DXF\r\n\x1a\0")
    with pytest.raises(InputError, match="binary"):
        ct.import_sketch(tmp_path / "x.dxf")
    (tmp_path / "big.svg").write_bytes(b" " * 4_000_001)
    with pytest.raises(InputError, match="4000001 bytes"):
        ct.import_sketch(tmp_path / "big.svg")
    for scale in (0, -1, float("nan"), True):
        with pytest.raises(InputError, match="positive number"):
            ct.import_sketch(tmp_path / "x.dxf", scale=scale)
    with pytest.raises(InputError, match="no link XY"):
        sketch_content(f"<svg>{BARS}</svg>".encode(), "x", ".svg", drive="XY")


def test_the_driving_link_can_be_chosen_and_the_gap_too() -> None:
    text = f'<svg width="140mm" viewBox="0 0 140 9">{BARS}</svg>'.encode()
    assert sketch_content(text, "x", ".svg", drive="CD").mechanism.drives[0].link == "CD"
    apart = text.replace(b"L120-90L140 0", b'L120-90M121-90L140 0"/><path d="M200 0h9')
    with pytest.raises(CentrodeError):
        sketch_content(apart, "x", ".svg")
    joined = sketch_content(apart, "x", ".svg", join="2 mm", drive="AB")
    assert any("were joined" in one for one in joined.guesses)
    assert any("do not hang together" in one for one in joined.omitted)
