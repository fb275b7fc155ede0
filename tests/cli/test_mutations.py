"""Built-in files, spoilt at random: every run ends with 0, 2 or 3, a failure with a message, in little time.

More of the same, at random: HYPOTHESIS_PROFILE=explore pytest tests/cli/test_mutations.py
"""

from __future__ import annotations

import contextlib
import io
import json
import re
import shutil
import time
from pathlib import Path

from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

import centrode as ct
from centrode.cli.main import main
from centrode.model.examples import example_text

SECONDS = 60.0
"""A guard against hanging, of processor time: a triad over a hundred turns takes a fifth of it."""
KEYS = [
    *("title", "space", "gravity", "display", "length", "angle", "frame", "points", "links", "guides"),
    *("point", "on", "through", "direction", "link", "drives", "start", "speed", "law", "table", "guide"),
    *("relative_to", "distance", "assembly", "sides", "continuation", "gears", "rolling", "loads"),
    *("machine", "study", "samples", "instants", "from", "to", "mass", "centre", "shape", "name", "pole"),
]
VALUES = [
    *("0", "-0.0", "-1", "1e-300", "1e-49", "1e-12", "1e12", "1e49", "1e51", "1e300", "nan", "inf", "-inf"),
    *("500", "3100", "1e6", "1000000000", "9" * 400, "true", "[]", "{}", "[0, 0]", "[1e50, 0]", "1979-05-27"),
    *(
        '"1 kg"',
        '"90 deg"',
        '"1 mm"',
        '"2 s"',
        '"pi"',
        '"1/0"',
        '"1e999"',
        '"placed"',
        '"frame"',
        '"O"',
        '"A"',
    ),
    *('"t"', '"sqrt(t)"', '"1/t"', '"exp(t)"', '"t**9"', '"sin(1e9*t)"', '"abs(t)"', "[[0, 0], [1, 1]]"),
]
LETTERS = "\x00\t\r\n\u2028\u202e\ufeffé´’Ж漢😀\\\"'[]{}=,#.-0e"
ADDED = [
    '[assembly]\ncontinuation = "keep"',
    '[[drives]]\nlink = "OA"\nspeed = 1',
    '[[guides]]\npoint = "A"\non = "frame"\nthrough = [0, 0]\ndirection = [1, 0]',
    "[links.OA]\nlength = 1",
    "[study]\nsamples = 2\nfrom = 0\nto = 1e3",
]
NUMBER_OR_TEXT = re.compile(r'(?<![\w.])-?\d+\.?\d*(?:[eE][+-]?\d+)?|"[^"\n]*"')
KEY = re.compile(r"\b[a-z_]+\b(?=\s*=)")


def replaced(draw: st.DrawFn, pattern: re.Pattern[str], text: str, new: str) -> str:
    """The text with one of the places where the pattern fits replaced."""
    places = [match.span() for match in pattern.finditer(text)]
    if not places:
        return text
    begin, end = draw(st.sampled_from(places))
    return text[:begin] + new + text[end:]


def with_other_lines(draw: st.DrawFn, text: str) -> str:
    lines = text.split("\n")
    one, other = (draw(st.integers(0, len(lines) - 1)) for _ in range(2))
    match draw(st.sampled_from(["drop", "repeat", "overwrite", "swap"])):
        case "drop":
            del lines[one]
        case "repeat":
            lines.insert(other, lines[one])
        case "overwrite":
            lines[other] = lines[one]
        case "swap":
            lines[one], lines[other] = lines[other], lines[one]
    return "\n".join(lines)


def spoilt(draw: st.DrawFn, text: str) -> str:
    match draw(
        st.sampled_from(["value", "number", "number", "number", "lines", "cut", "letter", "key", "add"])
    ):
        case "value":
            return replaced(draw, NUMBER_OR_TEXT, text, draw(st.sampled_from(VALUES)))
        case "number":
            return replaced(draw, NUMBER_OR_TEXT, text, repr(draw(st.floats(-10, 10, width=32))))
        case "lines":
            return with_other_lines(draw, text)
        case "cut":
            at = draw(st.integers(0, len(text)))
            return text[:at] + text[at + draw(st.integers(1, 20)) :]
        case "letter":
            at = draw(st.integers(0, len(text)))
            return text[:at] + draw(st.sampled_from(LETTERS)) + text[at:]
        case "key":
            return replaced(draw, KEY, text, draw(st.sampled_from(KEYS)))
    return f"{text}\n{draw(st.sampled_from(ADDED))}\n"


@st.composite
def spoilt_examples(draw: st.DrawFn) -> str:
    text = example_text(draw(st.sampled_from(ct.example_names())))
    for _ in range(draw(st.integers(1, 3))):
        text = spoilt(draw, text)
    return text


@given(text=spoilt_examples())
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
def test_spoilt_files_end_in_an_orderly_way(folder: Path, text: str) -> None:
    (folder / "spoilt.toml").write_text(text, encoding="utf-8", newline="")
    out, said, complained = folder / "result", io.StringIO(), io.StringIO()
    shutil.rmtree(out, ignore_errors=True)
    began = time.process_time()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
        code = main(["run", "spoilt.toml", "--out", "result", "--no-figures", "--samples", "7"])
    assert time.process_time() - began < SECONDS
    event(f"exit code {code}")
    message = complained.getvalue()
    assert code in (0, 2, 3), message
    assert "Traceback" not in message
    assert message.startswith("Error: ") if code else message == ""
    left = sorted(path.name for path in folder.iterdir())
    if code == 2:
        assert said.getvalue() == ""
        assert left == ["spoilt.toml"]
    else:
        assert left == ["result", "spoilt.toml"]
        assert json.loads((out / "summary.json").read_text(encoding="utf-8"))["samples"]["value"] == 7
