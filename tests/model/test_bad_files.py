"""Descriptions that are wrong, hostile or not there at all are told plainly, and soon."""

import os
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode import laws
from centrode.errors import InputError
from centrode.model import reading
from centrode.model.files import mechanism_text, parse_mechanism, read_mechanism

from .conftest import FOUR_BAR, FULL, SPHERE

Complaint = Callable[[str], str]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("length = 3.5", "length = -0.85", "press.toml, [links.AB]: length must be positive, got -0.85"),
        ("length = 3.5", "length = 0", "press.toml, [links.AB]: length must be positive, got 0"),
        (
            "length = 3.5",
            "lenght = 3.5",
            'press.toml, [links.AB]: unknown key "lenght"; did you mean "length"?',
        ),
        (
            "length = 3.5",
            'length = "0.5 kg"',
            'press.toml, [links.AB] length: expected a length (m), got "0.5 kg"',
        ),
        (
            "length = 3.5",
            'length = "3,5 mm"',
            'expected a length (m), got "3,5 mm"; decimals have a point, not a comma: write "3.5 mm"',
        ),
        ("length = 3.5", "length = nan", "press.toml, [links.AB] length: expected a finite number, got nan"),
        ("length = 3.5", "length = inf", "press.toml, [links.AB] length: expected a finite number, got inf"),
        ("length = 3.5", "length = 1e200", "press.toml, [links.AB] length: 1e+200 is outside"),
        ("length = 3.5", "length = 1e-200", "press.toml, [links.AB] length: 1e-200 is outside"),
        ("length = 3.5", "length = true", "[links.AB] length: expected a length (m), got true"),
        ("length = 3.5", "length = [1]", "[links.AB] length: expected a length (m), got a list of 1 value"),
        (
            "length = 3.5",
            "length = 1979-05-27",
            "[links.AB] length: expected a length (m), got a value of another",
        ),
        (
            "length = 3.5",
            "angle = 1",
            "press.toml, [links.AB]: length is missing; give the distance of A and B",
        ),
        ("length = 3.5", 'points = ["A", "B"]', "press.toml, [links.AB]: length is missing"),
        ("length = 3.5", 'points = ["A", "B", "C"]', "three or more points need coordinates"),
        ("length = 3.5", 'points = ["A", "A"]\nlength = 1', "a point is named twice"),
        ("length = 3.5", 'points = ["A"]\nlength = 1', "a link of one point has no length"),
        ("length = 3.5", "points = {}", "the link has no points"),
        (
            "length = 3.5",
            "points = { A = [0] }",
            "press.toml, [links.AB.points] A: expected [x, y], got a list of 1",
        ),
        ("length = 3.5", "points = 3", 'expected names ["A", "B"] or coordinates { A = [x, y] }, got 3'),
        ("length = 3.5", "points = { A = [0, 0], B = [1, 0] }\nlength = 1", "has no length of its own"),
        ("length = 3.5", 'length = 1\ncentre = "Z"', "press.toml, [links.AB] centre: AB has no point"),
        (
            "length = 3.5",
            'length = 1\nshape = "rods"',
            '[links.AB] shape: expected one of "rod", "disc", "ring", "arc", got "rods"',
        ),
        ("length = 3.5", "length = 1\nmass = -1", "[links.AB]: mass must not be negative, got -1"),
        ("[links.AB]", "[links.coupler]", "press.toml, [links.coupler]: points are missing"),
        ("[links.AB]", "[links.frame]", '"frame" is the fixed link'),
        ("[links.AB]", '[links."A/B"]', "characters a name may not have"),
        ("[links.AB]", '[links."A\\nB"]', "characters a name may not have"),
        ("[links.AB]", '[links.".AB"]', "characters a name may not have"),
        ("[links.AB]", '[links."A,B"]', "characters a name may not have"),
        ("[links.AB]", "[links.'A\"B']", "characters a name may not have"),
        ("[links.AB]", "[links." + "A" * 41 + "]", "a name has at most 40 characters, got 41"),
        ("[links.AB]", '[links.""]', "is not a name"),
        ("O = [0, 0]", 'O = "plcaed"', 'press.toml, [frame.points] O: expected coordinates or "placed"'),
        (
            "O = [0, 0]",
            "O = [0, 0, 0]",
            "press.toml, [frame.points] O: expected [x, y], got a list of 3 values",
        ),
        (
            "O = [0, 0]",
            "O = [0,5, 0,25]",
            "press.toml, [frame.points] O: expected [x, y], got a list of 4 values; decimals have a point",
        ),
        ("O = [0, 0]", 'O = ["1 m", "1 kg"]', "[frame.points] O: expected a length (m)"),
        ("O = [0, 0]", "placed = [0, 0]", '"placed" cannot be a name'),
        (
            'link = "OA"',
            'link = "AO"',
            'press.toml, [[drives]] 1, link: unknown link "AO"; did you mean "OA"?',
        ),
        ('link = "OA"', 'guide = "B"', 'press.toml, [[drives]] 1, guide: unknown guide "B"'),
        ('link = "OA"', 'distance = ["A", "Z"]', 'press.toml, [[drives]] 1, distance: unknown point "Z"'),
        ('link = "OA"', 'distance = ["A", "A"]', "two different points are needed"),
        ('link = "OA"', "", "press.toml, [[drives]] 1: one of link, guide, distance is missing"),
        ('link = "OA"', 'link = "OA"\nguide = "B"', "[[drives]] 1: link, guide are given together; keep one"),
        ("speed = 1", "speed = 1\nlaw = 't'", "[[drives]] 1: speed, law are given together"),
        ("speed = 1", 'speed = "3 Hz"', "write rpm or rad/s"),
        (
            "speed = 1",
            'law = "2*q"',
            'press.toml, [[drives]] 1, law: unknown name "q", at character 3 of "2*q"',
        ),
        (
            "speed = 1",
            'law = "tg(t)"',
            'unknown function "tg", at character 1 of "tg(t)"; did you mean "tan"? known',
        ),
        ("speed = 1", 'law = "sinn(t)"', 'did you mean "sin"? known are: abs acos'),
        ("speed = 1", "table = [[0, 0]]", "press.toml, [[drives]] 1, table: a table needs at least two rows"),
        ("speed = 1", "table = [[0, 0], [0, 1]]", "they do not at row 2"),
        ("speed = 1", "table = [[0, 0], [1]]", "expected [time, value]"),
        ("speed = 1", 'table = "none.csv"', '[[drives]] 1, table: "none.csv": there is no such file'),
        ("speed = 1", 'table = "../../etc/passwd"', "is not in the folder of the description"),
        ("speed = 1", 'table = "/etc/passwd"', "is not in the folder of the description"),
        ("speed = 1", 'speed = 1\nrelative_to = "OA"', "a link cannot be driven relative to itself"),
        ("[[drives]]", "[drives]", "press.toml, drives: expected a list, got a table"),
        (
            "[frame.points]",
            "[frame.point]",
            'press.toml, [frame]: unknown key "point"; did you mean "points"?',
        ),
    ],
)
def test_bad_descriptions_are_told(complaint: Complaint, old: str, new: str, message: str) -> None:
    told = complaint(FOUR_BAR.replace(old, new, 1))
    assert message in told
    assert told.startswith("press.toml")
    assert "pydantic" not in told


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "",
            "press.toml: nothing is described: no line has key = value; begin with a built-in one: centrode exam",
        ),
        ("# words\n", "press.toml: nothing is described"),
        (
            'title = "x"',
            'press.toml: "links" is missing; write each link below a heading, [links.AB], or begin',
        ),
        ("links = {}", "there are no links"),
        ("x = ", "press.toml, line 1, column 5: not TOML: a value is missing, or a text without quotes"),
        ("a = 1\n[links\n", "press.toml, line 2, column 7: not TOML"),
        ('a = "', "press.toml, line 1, column 6: not TOML"),
        ("a = " + "[" * 20_000, "press.toml: the text nests too deeply"),
        ("a = " + "[" * 20 + "]" * 20, "press.toml: the text nests too deeply"),
        ("a = " + "{a=" * 5000, "press.toml: the text nests too deeply"),
        (".".join("a" * 100_000) + " = 1", "press.toml: the text nests too deeply"),
        ("[" + ".".join(["'a'"] * 50_000) + "]", "press.toml: the text nests too deeply"),
        ("a = 2000-13-45", "not TOML"),
        ("a = " + "9" * 5000, "press.toml: not TOML"),
        ("x" * (reading.FILE_SIZE + 1), "press.toml: the text has 1000001 characters"),
        (
            FOUR_BAR + "[study]\nsamples = 1000000000",
            "[study]: samples must lie between 1 and 1000000, got 1000000000",
        ),
        (
            FOUR_BAR + "[study]\nsamples = 0",
            "samples must lie between 1 and 1000000, got 0; choose more samples",
        ),
        (FOUR_BAR + "[study]\nsamples = 3.5", "samples must be a whole number, got 3.5"),
        (FOUR_BAR + '[study]\ninstants = ["3 mm"]', "[study] instants: expected an angle (rad)"),
        (FOUR_BAR + '[display]\nlength = "kg"', 'press.toml, [display] length: expected one of "m", "mm"'),
        (FOUR_BAR + '[assembly]\nsides = { B = "up" }', '[assembly.sides] B: expected one of "left"'),
        (FOUR_BAR + '[assembly]\nsides = { Z = "left" }', "unknown point, link or guide"),
        (FOUR_BAR + '[[loads]]\nkind = "push"', "[[loads]] 1, kind: expected one of"),
        (FOUR_BAR + '[[loads]]\nkind = "force"\npoint = "A"', '[[loads]] 1: "vector" is missing'),
        (
            FOUR_BAR + '[[loads]]\nkind = "force"\npoint = "A"\nvector = [0, "2*z"]',
            'expected a force (N), got "2*z" (as a formula: unknown name "z", at character 3',
        ),
        (FOUR_BAR + '[[loads]]\nkind = "torque"\nlink = "OA"\nvalue = "3 N"', "expected a torque"),
        (
            FOUR_BAR + '[[loads]]\nkind = "force"\npoint = "A"\nvector = [0, 1]\nstiffness = 3',
            "is not used with a force",
        ),
        (
            FOUR_BAR + '[[loads]]\nkind = "weight"\nlink = "OA"\npoint = "A"',
            "a weight acts on one of: link, point",
        ),
        (FOUR_BAR + '[[gears]]\nlinks = ["OA", "OA"]\nratio = 2', "a gear needs two different links"),
        (FOUR_BAR + '[[gears]]\nlinks = ["OA", "AB"]\nratio = 0', "[[gears]] 1: ratio must not be zero"),
        (FOUR_BAR + '[[guides]]\npoint = "B"\nthrough = [0, 0]', '[[guides]] 1: "direction" is missing'),
        (
            FOUR_BAR + '[[guides]]\npoint = "B"\nthrough = "Z"\ndirection = 0',
            "[[guides]] 1, through: the frame has no point",
        ),
        (
            FOUR_BAR + '[[guides]]\npoint = "B"\non = "BD"\nthrough = [0, 0]\ndirection = 0',
            "[[guides]] 1, on: unknown link",
        ),
        (
            FOUR_BAR + '[[guides]]\npoint = "B"\nthrough = [0, 0]\ndirection = [0, 0]',
            "a direction must not be zero",
        ),
        (
            FOUR_BAR + '[[guides]]\npoint = "B"\nthrough = [0, 0]\ndirection = 0\nlink = "OA"',
            'link OA does not contain the guided point "B"',
        ),
        (
            FOUR_BAR + '[[guides]]\npoint = "B"\non = "AB"\nthrough = [0, 0]\ndirection = 0',
            "already belongs to AB",
        ),
        (
            FOUR_BAR + '[[guides]]\npoint = "B"\nthrough = [0, 0]\ndirection = 0\n' * 2,
            'there are two guides "B"',
        ),
        (FOUR_BAR + '[[drives]]\nlink = "OA"\nspeed = 1', '"OA" has two drives'),
        (FOUR_BAR + "[links.EF]\nlength = 1", "[links.EF]: nothing connects EF to the frame; hinge it"),
        (
            FOUR_BAR
            + '[[guides]]\npoint = "Z"\non = "EF"\nthrough = [0, 0]\ndirection = 0\n[links.EF]\nlength = 1',
            "nothing",
        ),
        ('title = "a\\u001bb"\n' + FOUR_BAR, "press.toml, title: "),
        ('title = "' + "a" * 1001 + '"\n' + FOUR_BAR, "a text has at most 1000 characters, got 1001"),
        ('space = "plain"\n' + FOUR_BAR, '"sphere", got "plain"; did you mean "plane"?'),
        ("gravity = 9.81\n" + FOUR_BAR, "press.toml, gravity: expected [x, y], got 9.81"),
        ("links = 3", "press.toml, links: expected a table, got 3"),
        ("links = { OA = 3 }", "press.toml, [links.OA]: expected a table, got 3"),
        ("guides = [3]\n" + FOUR_BAR, "press.toml, [[guides]] 1: expected a table, got 3"),
    ],
)
def test_bad_texts_are_told(complaint: Complaint, text: str, message: str) -> None:
    assert message in complaint(text)


@pytest.mark.parametrize(
    ("curve", "proposed"),
    [
        ("cycloid", "cycloidal"),
        ("Harmonic", "harmonic"),
        ("cosine", "harmonic"),
        ("Sinusoidal", "cycloidal"),
        ("modified-sine", "modified sine"),
        ("345", "3-4-5"),
        ("linear", "uniform"),
        ("wobbly", None),
    ],
)
def test_unknown_curves_name_those_known_and_the_nearest(
    complaint: Complaint, curve: str, proposed: str | None
) -> None:
    segment = f'segments = [{{ to = 1, time = 1, curve = "{curve}" }}]'
    told = complaint(FOUR_BAR.replace("speed = 1", segment))
    assert told.startswith("press.toml, [[drives]] 1, segments: segment 1, curve: expected one of")
    assert all(f'"{known}"' in told for known in laws.SEGMENT_CURVES)
    assert told.partition(f'got "{curve}"')[2] == (f'; did you mean "{proposed}"?' if proposed else "")


def test_synonyms_of_curves_are_of_known_ones() -> None:
    assert set(laws.CURVE_SYNONYMS.values()) <= set(laws.SEGMENT_CURVES)
    assert not set(laws.CURVE_SYNONYMS) & set(laws.SEGMENT_CURVES)


def test_first_problems_of_a_file_are_told_together(complaint: Complaint) -> None:
    told = complaint("\n".join(f"[links.L{i}]\nlength = -1" for i in range(9))).splitlines()
    assert len(told) == reading.PROBLEMS_SHOWN + 1
    assert told[-1] == "and 4 more problems"


def test_too_many_links_are_refused(complaint: Complaint) -> None:
    assert "at most 200 entries" in complaint("\n".join(f"[links.L{i}]\nlength = 1" for i in range(501)))


def test_missing_file_folder_pipe_and_binary(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none.toml: there is no such file; check the path"):
        read_mechanism(tmp_path / "none.toml")
    with pytest.raises(InputError, match="this is not a file"):
        read_mechanism(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")  # no whole text in UTF-16
    with pytest.raises(InputError, match=r"binary.toml: the file is not text in UTF-8 \(byte 0\)"):
        read_mechanism(tmp_path / "binary.toml")
    with pytest.raises(InputError, match="cannot be read"):
        read_mechanism("a\0b")
    with pytest.raises(InputError, match="cannot be read"):
        read_mechanism("a" * 5000)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (FOUR_BAR.encode("utf-16"), "the file is text in UTF-16, not in UTF-8; save it as UTF-8"),
        (FOUR_BAR.encode("utf-16-le"), "the file is text in UTF-16"),
        (FOUR_BAR.encode("utf-16-be"), "the file is text in UTF-16"),
        ('title = "Пресс"'.encode("utf-16"), "the file is text in UTF-16"),
        ('title = "Пресс"'.encode("cp1251"), r"not text in UTF-8 \(byte 9\); save it as UTF-8"),
        (b"%PDF-1.7\n%", "this is a PDF, not plain text; give a file of plain text"),
        (b"PK\x03\x04\x14\x00\x06\x00", "a document of an office program, or an archive"),
        (b"{\\rtf1\\ansi [links.AB]}", "a document of an office program"),
        (b"\x89PNG\r\n\x1a\n", "this is a picture"),
    ],
)
def test_files_that_are_no_text_in_utf_8_are_called_what_they_are(
    tmp_path: Path, content: bytes, message: str
) -> None:
    (tmp_path / "press.toml").write_bytes(content)
    with pytest.raises(InputError, match=rf"^press.toml: .*{message}"):
        read_mechanism(tmp_path / "press.toml")


def test_a_mark_of_utf_8_and_line_ends_of_windows_are_read(tmp_path: Path) -> None:
    (tmp_path / "press.toml").write_bytes(b"\xef\xbb\xbf" + FOUR_BAR.replace("\n", "\r\n").encode())
    assert read_mechanism(tmp_path / "press.toml") == parse_mechanism(FOUR_BAR)


@pytest.mark.parametrize(
    ("given", "there"),
    [("pres.toml", "press.toml"), ("Press.toml", "press.toml"), ("report.toml", "report.toml.txt")],
)
def test_a_file_that_is_meant_is_named(tmp_path: Path, given: str, there: str) -> None:
    for name in ("press.toml", "report.toml.txt", "press.txt"):
        (tmp_path / name).write_text(FOUR_BAR)
    if given == "Press.toml" and (tmp_path / given).exists():
        pytest.skip("a file system without capitals")
    with pytest.raises(InputError, match=f'there is no such file; did you mean "{there}"'):
        read_mechanism(tmp_path / given)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="this is not a file"):
        read_mechanism(tmp_path / "pipe")


def test_a_huge_file_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with (tmp_path / "huge.toml").open("wb") as stream:
        stream.truncate(100_000_000)

    def unread(*_anything: object) -> None:
        raise AssertionError("it was opened")

    monkeypatch.setattr(Path, "open", unread)
    with pytest.raises(
        InputError, match=r"huge.toml: the file has 100000000 bytes, at most 1000000 are allowed"
    ):
        read_mechanism(tmp_path / "huge.toml")


@given(st.data())
def test_mutated_files_are_read_or_told(data: st.DataObject) -> None:
    text = data.draw(st.sampled_from([FULL, SPHERE, FOUR_BAR]))
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        stop = start + data.draw(st.integers(0, 12))
        other = data.draw(
            st.sampled_from(["", '"', "]", "[", "=", "nan", "-", "1e400", "\n", "{}", "true", '"x y"', "A"])
        )
        text = text[:start] + other + text[stop:]
    try:
        mechanism = parse_mechanism(text, "press.toml")
    except InputError as error:
        assert str(error).startswith("press.toml")
        return
    assert parse_mechanism(mechanism_text(mechanism)) == mechanism


@pytest.mark.parametrize(
    "piece", ["a", "a.", '"', "a . ", "a.a.a.a.a.a.a.a=1\n", "[[guides]]\n", "a='a'\n", "[", "{a="]
)
def test_hostile_texts_are_refused_in_linear_work(piece: str) -> None:
    """Twice the text is twice the lines that run, and no more than some hundred a letter."""
    lines = [lines_run(piece * (letters // len(piece))) for letters in (5_000, 10_000)]
    assert lines[1] <= 2.2 * lines[0] + 1000
    assert lines[1] <= 100 * 10_000


def lines_run(text: str) -> int:
    """Lines of Python that run until a text is refused."""
    count = 0

    def traced(_frame: FrameType, event: str, _argument: object) -> Callable[..., Any]:
        nonlocal count
        count += event == "line"
        return traced

    before = sys.gettrace()
    sys.settrace(traced)
    try:
        with pytest.raises(InputError):
            parse_mechanism(text)
    finally:
        sys.settrace(before)
    return count
