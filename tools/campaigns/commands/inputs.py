"""Descriptions changed at random: keys dropped and renamed, numbers replaced, text cut and torn, names of files."""

from __future__ import annotations

import random
import re
import tomllib
from collections.abc import Callable
from functools import cache
from typing import Any

import tomli_w

import centrode as ct
from centrode.errors import CentrodeError
from centrode.model.examples import example_text

NUMBERS = (
    *(0.0, -0.0, -1.0, 1.0, 2.0, 1e-300, 1e-49, 1e-12, 1e-7, 1e7, 1e12, 1e49, 1e51, 1e300, 5e-324),
    *(float("nan"), float("inf"), float("-inf"), 500, 3100, 10**6, 10**9, 2**63, -(2**31), True, False),
)
TEXTS = (
    *(
        "1 kg",
        "90 deg",
        "1 mm",
        "2 s",
        "65 rpm",
        "pi",
        "1/0",
        "1e999",
        "placed",
        "frame",
        "O",
        "A",
        "",
        " ",
        ".",
    ),
    *(
        "t",
        "sqrt(t)",
        "1/t",
        "exp(t)",
        "t**9",
        "t**100",
        "sin(1e9*t)",
        "abs(t)",
        "sign(t)",
        "sign(v)",
        "log(q)",
    ),
    *(
        "10 - 2*sign(omega)",
        "min(t, 1)",
        "max(x)",
        "9**9**9",
        "t**t**t",
        "(" * 500,
        "__import__('os')",
        "left",
    ),
    *(
        "../up",
        "/dev/null",
        "a/b",
        "con",
        "\x00",
        "\u202e",
        "\ufeff",
        "é´",
        "漢😀",
        "[bold]",
        "{0}",
        "%s",
        "x" * 5000,
    ),
)
VALUES: tuple[Any, ...] = (
    *NUMBERS, *TEXTS, [], {}, [0, 0], [1e50, 0], [[0, 0], [1, 1]], [[]], {"": {}}, [1, "a", []], {"placed": [0, 0]},
)  # fmt: skip
KEYS = (
    *(
        "title",
        "space",
        "gravity",
        "display",
        "length",
        "angle",
        "frame",
        "points",
        "links",
        "guides",
        "point",
        "on",
    ),
    *(
        "through",
        "direction",
        "link",
        "drives",
        "start",
        "speed",
        "law",
        "table",
        "guide",
        "relative_to",
        "distance",
    ),
    *(
        "assembly",
        "sides",
        "continuation",
        "gears",
        "rolling",
        "loads",
        "machine",
        "study",
        "samples",
        "from",
        "to",
    ),
    *(
        "mass",
        "centre",
        "inertia",
        "shape",
        "name",
        "pole",
        "simulation",
        "driving",
        "cylinders",
        "report",
        "kind",
    ),
)
LETTERS = "\x00\t\r\n\u2028\u202e\ufeffé´’Ж漢😀\\\"'[]{}=,#.-0e"
NAMES = (
    *(
        "given.toml",
        "given.toml",
        "given.toml",
        "a b.toml",
        "-dash.toml",
        "ü漢😀.toml",
        "$(x).toml",
        "[bold].toml",
    ),
    *(
        "x" * 200 + ".toml",
        "given",
        "given.csv",
        "given.TOML",
        "..toml",
        "a\nb.toml",
        "%s{0}.toml",
        "result.toml",
    ),
    *(
        "motion.csv",
        "summary.json",
        "motion.nc",
        "reactions.csv",
        "result.html",
        "report.html",
        "positions.svg",
    ),
)
"""Some are those of files that commands write."""
SWEEP = """mechanism = "crank-rocker"
outputs = ["angle.DB", "position.B"]
samples = 9
reduce = "range"
executor = "arrays"
[grid]
links.AB.length = { from = "3.4 m", to = "3600 mm", count = 3 }
frame.points.D.x = [3.9, 4.1]
"""
VARIANTS = "variant,links.AB.length [m],drives.OA.speed [rad/s]\n1,3.5,1\n2,3.6,2\n3,,1\n"
NUMBER_OR_TEXT = re.compile(r'(?<![\w.])-?\d+\.?\d*(?:[eE][+-]?\d+)?|"[^"\n]*"')


@cache
def example(name: str) -> str:
    """The text of a built-in description."""
    return example_text(name)


def formula(draw: random.Random) -> str:
    """A formula of the kind that laws, loads and moments are written in."""
    terms = []
    for _ in range(draw.choice((1, 1, 2, 3))):
        inner = draw.choice(("t", "q", "v", "x", "t - 1", "v**2", "q/2", "1/t", "1/v", "0", "-t", "1e9*t"))
        function = draw.choice(("sin", "cos", "tan", "sqrt", "exp", "log", "abs", "sign", "asin", "", "", ""))
        power = draw.choice(("", "", "", "**2", "**100", "**0.5", "**-1", "**t"))
        terms.append(f"{draw.choice(('100', '-3', '0.1', '1e6', '1e300'))}*{function}({inner}){power}")
    return draw.choice((" + ", " - ", "*", "/")).join(terms)


def content(draw: random.Random, kind: str) -> bytes:
    """What stands in the file that a command is given."""
    shape = draw.random()
    if shape < 0.02:
        return draw.choice(
            (b"", b"\n", b"\xff\xfe\x00", bytes(range(256)), b"\xef\xbb\xbf", b"[" * 5000, b"a.b=1\n" * 20000)
        )
    text = base(draw, kind)
    if shape < 0.3:
        return text.encode()
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        text = draw.choice(CHANGES)(draw, text)
    return text.encode(errors="surrogatepass")


@cache
def machines() -> tuple[str, ...]:
    """Built-in linkages with masses: commands about forces need them."""
    return tuple(name for name in ct.example_names("linkage") if "mass" in example(name))


def base(draw: random.Random, kind: str) -> str:
    """A description that is right."""
    if kind == "study":
        return SWEEP
    if kind == "table":
        return VARIANTS
    if kind == "cam":
        return example(draw.choice(ct.example_names("cam")))
    text = example(draw.choice(machines() if draw.random() < 0.5 else ct.example_names("linkage")))
    return beside_an_event(draw, text) if draw.random() < 0.08 else text


def beside_an_event(draw: random.Random, text: str) -> str:
    """The description started very near a limit or change point of its motion, where it has one."""
    tables = tomllib.loads(text)
    drive = tables["drives"][0]
    try:
        motion = ct.motion(ct.parse_mechanism(text), samples=3)
    except CentrodeError:
        return text
    places = motion.event_value.to_numpy()
    if not len(places) or "link" not in drive:
        return text
    drive["start"] = float(draw.choice(list(places))) + draw.choice((-1.0, 1.0)) * 10.0 ** -draw.uniform(
        2.0, 9.0
    )
    for link in tables["links"].values():
        link.pop("angle", None)
    drive["start"] = float(drive["start"])
    return tomli_w.dumps(tables)


def names_in(text: str) -> list[str]:
    """Words that a description uses for its parts."""
    return re.findall(r"[A-Za-z][\w.-]*", text)[:400] or ["A"]


def of_tables(draw: random.Random, text: str) -> str:
    """One place of the tables changed: dropped, replaced, renamed, doubled or nested."""
    try:
        tables = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError):
        return text
    spots = list(places(tables))
    if not spots:
        return text
    holder, key = draw.choice(spots)
    match draw.choice(("drop", "value", "value", "number", "number", "key", "copy", "nest")):
        case "drop":
            del holder[key]
        case "value":
            holder[key] = formula(draw) if draw.random() < 0.25 else draw.choice(VALUES)
        case "number":
            holder[key] = scaled(draw, holder[key])
        case "key" if isinstance(holder, dict):
            holder[draw.choice(KEYS)] = holder.pop(key)
        case "copy":
            other, there = draw.choice(spots)
            if there in other if isinstance(other, dict) else there < len(other):
                other[there] = (
                    holder[key] if not isinstance(holder[key], dict | list) else draw.choice(VALUES)
                )
        case "nest":
            holder[key] = {"a": [{"b": holder[key]}]} if draw.random() < 0.5 else [holder[key]] * 3
    try:
        return tomli_w.dumps(tables)
    except (TypeError, ValueError):
        return text


def places(tree: Any) -> Any:
    """(table or list, key or index) of everything in nested tables."""
    entries = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in list(entries):
        yield tree, key
        if isinstance(value, dict | list):
            yield from places(value)


def scaled(draw: random.Random, value: Any) -> Any:
    """A number near or far from another."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return draw.choice(NUMBERS)
    return value * draw.choice((0, -1, 0.5, 1.0 + 1e-9, 1.001, 3, 1e3, 1e-3)) + draw.choice(
        (0.0, 0.0, 0.1, -1e-7)
    )


def of_text(draw: random.Random, text: str) -> str:
    """A number or a text replaced."""
    found = [match.span() for match in NUMBER_OR_TEXT.finditer(text)]
    if not found:
        return text
    begin, end = draw.choice(found)
    new = draw.choice(VALUES)
    return text[:begin] + (repr(new) if not isinstance(new, bool) else "true") + text[end:]


def of_lines(draw: random.Random, text: str) -> str:
    """Lines dropped, doubled or swapped."""
    lines = text.split("\n")
    one, other = (draw.randrange(len(lines)) for _ in range(2))
    match draw.choice(("drop", "repeat", "swap")):
        case "drop":
            del lines[one]
        case "repeat":
            lines.insert(other, lines[one])
        case "swap":
            lines[one], lines[other] = lines[other], lines[one]
    return "\n".join(lines)


def of_letters(draw: random.Random, text: str) -> str:
    """A letter put in, or some cut out."""
    at = draw.randrange(len(text) + 1)
    if draw.random() < 0.5:
        return text[:at] + draw.choice(LETTERS) + text[at:]
    return text[:at] + text[at + draw.randint(1, 20) :]


CHANGES: tuple[Callable[[random.Random, str], str], ...] = (
    of_tables, of_tables, of_tables, of_tables, of_text, of_text, of_lines, of_letters,
)  # fmt: skip
