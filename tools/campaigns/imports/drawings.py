"""Drawings that imports are tried on: as this program draws them, as people draw them, and spoilt."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from functools import cache

CIRCLES = "".join(f'<circle cx="{x}" cy="{y}" r="3"/>' for x, y in ((0, 0), (30, -40), (120, -90), (140, 0)))
LINES = (
    '<g id="links"><line x1="0" y1="0" x2="30" y2="-40"/><path d="M30-40 120-90 90-120z"/>'
    '<polyline points="120,-90 140,0"/></g>'
)
SVG = (
    f'<svg width="140mm" height="120mm" viewBox="0 -120 140 120">{LINES}</svg>',
    f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-10 -130 160 140"><g transform="translate(5 3) rotate(20) '
    f'scale(1.5)">{LINES}{CIRCLES}<g id="ground"><rect x="-8" y="2" width="16" height="4"/>'
    '<path d="m132 2h16v6h-16z"/></g><text x="2" y="-44">A</text></g></svg>',
    '<svg width="4in" viewBox="0 0 96 48"><g id="ground"><path d="M2 40h12"/></g><g id="links">'
    '<path d="M8 40 20 24 70 40"/></g><g id="guide"><path d="M50 36h44M50 44h44"/></g></svg>',
    '<svg width="200mm" viewBox="0 0 200 100"><g id="ground"><circle cx="20" cy="80" r="2"/>'
    '<path d="M90 86h100"/></g>'
    '<circle cx="20" cy="80" r="2"/><circle cx="40" cy="60" r="2"/>'
    '<circle cx="140" cy="80" r="2"/>'
    '<path d="M20 80 40 60" class="crank"/><path d="M40 60 140 80"/>'
    '<rect x="128" y="74" width="24" height="12"/></svg>',
)  # fmt: skip
LINKAGE = (
    """<linkage2><program zoom="1" scalefactor="1" units="Millimeters"/>
<connector anchor="true" input="true" rpm="30" x="0" y="0" id="0"/><connector x="0" y="96" id="1"/>
<connector x="288" y="192" id="2"/><connector anchor="true" x="384" y="0" id="3"/>
<connector draw="true" x="150" y="250" id="4"/>
<Link id="0"><connector id="0"/><connector id="1"/></Link><Link id="1" name="rod"><connector id="1"/><connector id="2"/>
<connector id="4"/></Link><Link id="2"><connector id="2"/><connector id="3"/></Link></linkage2>""",
    """<linkage2><connector anchor="true" input="true" rpm="15" x="0" y="0" id="0"/>
<connector x="20" y="10" id="1" slider="true"><slidelimit id="4"/><slidelimit id="5"/></connector>
<connector anchor="true" x="-130" y="-20" id="4"/><connector x="170" y="40" id="5"/>
<Link id="0"><connector id="0"/><connector id="1"/></Link>
<Link id="2" fastenlink="3"><connector id="4"/><connector id="5"/></Link>
<Link id="3"><connector id="5"/></Link></linkage2>""",
    """<linkage2><connector anchor="true" x="207" y="-237" id="0"/>
<connector x="316.5" y="-306" id="1" slider="true"><slidelimit id="3"/><slidelimit id="4"/></connector>
<connector x="427.5" y="-241" id="2"/><connector anchor="true" x="250" y="-306" id="3"/>
<connector anchor="true" x="383" y="-306" id="4"/><connector anchor="true" x="436" y="-207" id="5"/>
<Link id="0" actuator="true" throw="21" cpm="15"><connector id="0"/><connector id="1"/></Link>
<Link id="1"><connector id="2"/><connector id="1"/></Link><Link id="2"><connector id="3"/><connector id="4"/></Link>
<Link id="3"><connector id="5"/><connector id="2"/></Link></linkage2>""",
)
STRAIGHT = (
    ("0", 0, 0, 30, 40),
    ("0", 30, 40, 120, 90),
    ("0", 120, 90, 140, 0),
    ("ground", -5, 0, 5, 0),
    ("ground", 135, 0, 145, 0),
)
ROUND = ((0, 0, 3), (30, 40, 3), (120, 90, 3), (140, 0, 3))
SPITEFUL = (
    *(
        "nan",
        "inf",
        "1e400",
        "-1e308",
        "1e-320",
        "0",
        "-0",
        "1e15",
        "99999999999999999999",
        "0.0001",
        "-1",
        "1e",
    ),
    *("", " ", "\0", "%", "1,2", "x", "true", "url(#h)", "Ж", "\U0001f600", "--"),
    *("&#0;", "&amp;", "&x;", "<!--", "]]>", "<![CDATA["),
)
SWAPS = (
    *(("circle", "ellipse"), ("line", "use"), ("rect", "image"), ("id", "class"), ("rotate", "skewX")),
    *(("link", "ground"), ("ground", "gear"), ("scale", "matrix"), ("h", "a"), ("z", "Z M")),
    *(
        ("Link", "ratios"),
        ("anchor", "slider"),
        ("slider", "anchor"),
        ("connector", "Link"),
        ("true", "false"),
    ),
    *(("LINE", "SPLINE"), ("LINE", "INSERT"), ("CIRCLE", "ARC"), ("SECTION", "ENDSEC")),
)


@cache
def dxf() -> tuple[str, ...]:
    """DXF texts: as old programs write them, and with the header of newer ones."""
    lines = "".join(
        f"0\nLINE\n8\n{layer}\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n" for layer, a, b, c, d in STRAIGHT
    )
    rings = "".join(f"0\nCIRCLE\n8\nhinges\n10\n{x}\n20\n{y}\n40\n{r}\n" for x, y, r in ROUND)
    words = "0\nTEXT\n8\nnames\n10\n31\n20\n44\n40\n3\n1\nA\n"
    outline = "0\nLWPOLYLINE\n100\nAcDbEntity\n8\nlinks\n100\nAcDbPolyline\n90\n3\n70\n1\n"
    outline += "".join(f"10\n{x}\n20\n{y}\n" for x, y in ((30, 40), (120, 90), (90, 120)))
    block = (
        "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nB\n70\n0\n10\n0\n20\n0\n"
        + lines
        + rings
        + "0\nENDBLK\n8\n0\n0\nENDSEC\n"
    )
    header = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n{version}\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n"
    entities, end = "0\nSECTION\n2\nENTITIES\n", "0\nENDSEC\n0\nEOF\n"
    return (
        entities + lines + rings + words + end,
        header.format(version="AC1015") + entities + outline + lines + rings + end,
        header.format(version="AC1009")
        + block
        + entities
        + "0\nINSERT\n8\n0\n2\nB\n10\n5\n20\n5\n50\n30\n"
        + end,
    )


KINDS = (".svg", ".svg", ".svg", ".linkage2", ".linkage2", ".dxf")
"""Endings by how often they are drawn."""


def drawing(draw: random.Random) -> tuple[str, bytes]:
    """The ending of a file, and its spoilt content."""
    ending = draw.choice(KINDS)
    texts = {".svg": SVG, ".linkage2": LINKAGE, ".dxf": dxf()}[ending]
    text = draw.choice(texts)
    for _k in range(draw.choice((1, 1, 1, 2, 2, 3, 5, 9))):
        text = draw.choice(SPOILERS)(draw, text)
    content = text.encode("utf-8", "replace")
    if draw.random() < 0.1:
        place = draw.randrange(max(1, len(content)))
        content = content[:place] + bytes([draw.randrange(256)]) + content[place + 1 :]
    return ending, content


def _number(draw: random.Random, text: str) -> str:
    """Another number, or what is none, in the place of one."""
    found = list(re.finditer(r"-?\d+\.?\d*", text))
    if not found:
        return text
    at = draw.choice(found)
    value = draw.choice(
        (*SPITEFUL, f"{draw.uniform(-200, 200):.3f}", f"{float(at[0]) + draw.uniform(-2, 2):.4f}")
    )
    return text[: at.start()] + value + text[at.end() :]


def _cut(draw: random.Random, text: str) -> str:
    start = draw.randrange(max(1, len(text)))
    return text[:start] + text[start + draw.choice((1, 3, 20, 200)) :]


def _double(draw: random.Random, text: str) -> str:
    start = draw.randrange(max(1, len(text)))
    piece = text[start : start + draw.choice((1, 5, 40, 300))]
    return text[:start] + piece * draw.choice((2, 2, 3, 60)) + text[start + len(piece) :]


def _swap(draw: random.Random, text: str) -> str:
    one, other = draw.choice(SWAPS)
    return text.replace(one, other, draw.choice((1, 1, -1)))


def _insert(draw: random.Random, text: str) -> str:
    start = draw.randrange(len(text) + 1)
    return text[:start] + draw.choice(SPITEFUL) + text[start:]


def _shuffle(draw: random.Random, text: str) -> str:
    """Elements, or groups of a DXF file, in another order."""
    pieces = re.split(r"(?<=>)" if "<" in text else r"(?<=\n)(?=0\n)", text)
    one, other = (draw.randrange(len(pieces)) for _k in range(2))
    pieces[one], pieces[other] = pieces[other], pieces[one]
    return "".join(pieces)


SPOILERS: tuple[Callable[[random.Random, str], str], ...] = (
    *(_number,) * 10, _cut, _double, _swap, _swap, _insert, _shuffle, _shuffle,
)  # fmt: skip
