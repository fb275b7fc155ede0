"""Bad descriptions: one message with the place and the repair, exit code 2, nothing written."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from centrode.model.examples import example_text

Refused = Callable[..., str]

CHANGES = {
    "unknown key": (
        "length = 1\n", "lenght = 1\n",
        'press.toml, [links.OA]: unknown key "lenght"; did you mean "length"?',
    ),
    "unknown table": (
        "[assembly]", "[asembly]",
        'press.toml: unknown key "asembly"; did you mean "assembly"?',
    ),
    "text for a number": (
        "length = 1\n", 'length = "long"\n',
        'press.toml, [links.OA] length: expected a length (m), got "long"; write a number in m,'
        ' or a text with a unit such as "5 mm"',
    ),
    "list for a number": (
        "length = 1\n", "length = [1]\n",
        "press.toml, [links.OA] length: expected a length (m), got a list of 1 value; write",
    ),
    "number for a list": (
        "O = [0, 0]", "O = 0",
        "press.toml, [frame.points] O: expected [x, y], got 0",
    ),
    "list for a table": (
        "[links.OA]", "[[links.OA]]",
        "press.toml, [links.OA]: expected a table, got a list of 1 value",
    ),
    "negative length": (
        "length = 1\n", "length = -1\n",
        "press.toml, [links.OA]: length must be positive, got -1",
    ),
    "zero length": (
        "length = 1\n", "length = 0\n",
        "press.toml, [links.OA]: length must be positive, got 0",
    ),
    "not a number": (
        "length = 1\n", "length = nan\n",
        "press.toml, [links.OA] length: expected a finite number, got nan",
    ),
    "infinite": (
        "O = [0, 0]", "O = [inf, 0]",
        "press.toml, [frame.points] O: expected a finite number, got inf",
    ),
    "infinite with a unit": (
        "speed = 1", 'speed = "1e999 rad/s"',
        'press.toml, [[drives]] 1, speed: expected a finite number, got "1e999 rad/s"',
    ),
    "huge": (
        "length = 1\n", "length = 1e300\n",
        "press.toml, [links.OA] length: 1e+300 is outside the range that can be computed; stay below 1e+50",
    ),
    "huge angle": (
        "length = 3.5\n", "length = 3.5\nangle = 1e49\n",
        "press.toml, [links.AB] angle: 1e+49 is outside the range that can be computed; stay below 1e+06",
    ),
    "unknown point": (
        'B = "left"', 'E = "left"',
        'press.toml, [assembly.sides] E: unknown point, link or guide "E"; known are: O, D, A, B, OA, AB, DB',
    ),
    "unknown link": (
        'link = "OA"', 'link = "OB"',
        'press.toml, [[drives]] 1, link: unknown link "OB"; did you mean "OA"?',
    ),
    "disconnected part": (
        "[[drives]]", "[links.EF]\nlength = 1\n[links.FG]\nlength = 1\n[[drives]]",
        "press.toml, [links.EF]: nothing connects EF, FG to the frame; hinge it to a link that is connected,"
        " or give it a guide",
    ),
    "no drive": (
        '[[drives]]\nlink = "OA"\nstart = 1\nspeed = 1\n', "",
        "[[drives]]: the mechanism has no drive; give one drive per degree of freedom",
    ),
    "more drives than the mobility": (
        "[assembly]", '[[drives]]\nlink = "DB"\nspeed = 1\n[assembly]',
        "[[drives]]: 2 drives are given, but the mobility (by rank) is 1",
    ),
    "fewer drives than the mobility": (
        "[links.DB]\nlength = 3\n", "[links.BC]\nlength = 1\n[links.DC]\nlength = 3\n",
        "[[drives]]: 1 drive is given, but the mobility (by rank) is 2; add drives, or constrain",
    ),
    "one link driven twice": (
        "[assembly]", '[[drives]]\nlink = "OA"\nspeed = 2\n[assembly]',
        'press.toml, [[drives]] 2: "OA" has two drives; keep one of the drives',
    ),
    "does not assemble": (
        "length = 3.5", "length = 0.5",
        "group AB-DB (point B): it does not close in the initial position: links AB and DB together are too"
        " short by 0.06056 m; change a length, or the initial position",
    ),
    "does not assemble as drawn": (
        "length = 3.5\n", "length = 3.5\nangle = 2\n",
        "[links.AB] angle: the position cannot be assembled at 114.6 deg: it has 36.61 deg, a difference of 78 deg",
    ),
    "start against the initial angle": (
        "length = 1\n", "length = 1\nangle = 0.5\n",
        "drive of link OA: it starts at 1 rad, but the initial angle is 0.5 rad; omit one of the two",
    ),
    "no side": (
        'sides = { B = "left" }', "",
        "group AB-DB (point B): the side on which it is assembled is not given; give the initial angle of AB or"
        ' DB, or [assembly] sides, B = "left" | "right"',
    ),
    "a side of the wrong kind": (
        '"left"', '"ahead"',
        '[assembly] sides.B: "ahead" does not apply to a group RRR; write B = "left" | "right"',
    ),
    "coinciding points": (
        "[links.AB]\nlength = 3.5", "[links.AB]\npoints = { A = [0, 0], B = [0, 0] }",
        "[links.AB]: points A and B coincide and do not determine the rotation of the link; correct",
    ),
    "coinciding pivots": (
        "D = [4, 0]",
        "D = [0.5403023058681398, 0.8414709848078965]",
        "group AB-DB (point B): it does not close in the initial position: link AB is too long for link DB by"
        " 0.5 m; change a length, or the initial position",
    ),
    "mass for a length": (
        "length = 1\n", 'length = "0.5 kg"\n',
        'press.toml, [links.OA] length: expected a length (m), got "0.5 kg"; write a number in m, or a text',
    ),
    "speed of the wrong kind": (
        "speed = 1", 'speed = "1 m/s"',
        'press.toml, [[drives]] 1, speed: expected an angular speed (rad/s), got "1 m/s"; write a number',
    ),
    "no unit at all": (
        "length = 1\n", 'length = "1 foo"\n',
        'press.toml, [links.OA] length: expected a length (m), got "1 foo"; "foo" is not a known unit, write',
    ),
    "range of the wrong kind": (
        "[assembly]", '[study]\nto = "1 m"\n[assembly]',
        'press.toml, [study] to: expected an angle (rad), got "1 m"; write a number in rad',
    ),
    "range of a law": (
        "speed = 1\n", 'law = "sin(t)"\n[study]\nto = "90 deg"\n',
        'press.toml, [study] to: expected a time (s), got "90 deg"; write a number in s',
    ),
    "instants too far": (
        "[assembly]",
        "[study]\ninstants = [3200]\n[assembly]",
        "[study] instants: it is too long: 509 turns; give at most 500",
    ),
    "law without an end": (
        "speed = 1", 'law = "sin(t)"',
        "[study]: the drive is a law of time, and its duration is not given; give",
    ),
    "law that is no formula": (
        "speed = 1", 'law = "sin(t"',
        'press.toml, [[drives]] 1, law: this is not a formula, at character 4 of "sin(t"; use',
    ),
    "law that is a program": (
        "speed = 1", "law = \"__import__('os')\"",
        "press.toml, [[drives]] 1, law: ",
    ),
    "law without a value": (
        "speed = 1", 'law = "1/t"',
        "[[drives]] OA: its law has no finite value at t = 0, where the initial position is",
    ),
    "table that is missing": (
        "speed = 1", 'table = "crank.csv"',
        'press.toml, [[drives]] 1, table: "crank.csv": there is no such file; check the path',
    ),
    "table elsewhere": (
        "speed = 1", 'table = "../../etc/passwd"',
        'press.toml, [[drives]] 1, table: "../../etc/passwd" is not in the folder of the description; put',
    ),
    "a billion samples": (
        "[assembly]", "[study]\nsamples = 1000000000\n[assembly]",
        "press.toml, [study]: samples must lie between 1 and 1000000, got 1000000000; choose fewer samples",
    ),
    "name with a newline": (
        "[links.OA]", '[links."O\\nA"]',
        'press.toml, links: "O\\nA" has characters a name may not have; use letters, digits, primes',
    ),
    "name with a path": (
        "[links.OA]", '[links."../OA"]',
        'press.toml, links: "../OA" has characters a name may not have; use letters, digits, primes',
    ),
    "title with a newline": (
        'title = "Press"', 'title = "a\\nb"',
        'press.toml, title: "a\\nb" has control characters; write one line of text',
    ),
    "title of a page": (
        'title = "Press"', f'title = "{"a" * 5000}"',
        "press.toml, title: a text has at most 1000 characters, got 5000; shorten it",
    ),
    "deep list": (
        "length = 1\n", f"length = {'[' * 100}{']' * 100}\n",
        "press.toml: the text nests too deeply; tables and lists may be nested at most 12 deep",
    ),
    "very deep list": (
        "length = 1\n", f"length = {'[' * 100_000}\n",
        "press.toml: the text nests too deeply; ",
    ),
    "deep tables": (
        "length = 1\n", f"length = {'{a=' * 200}1{'}' * 200}\n",
        "press.toml: the text nests too deeply; ",
    ),
    "deep dotted key": (
        "[links.OA]", f"[{'a.' * 5000}b]\n[links.OA]",
        "press.toml: the text nests too deeply; ",
    ),
    "a million digits": (
        "length = 1\n", f"length = {'9' * 10**6}\n",
        "press.toml: the file has 1000197 bytes, at most 1000000 are allowed",
    ),
    "thousands of digits": (
        "length = 1\n", f"length = {'9' * 900_000}\n",
        "press.toml: not TOML: a date is impossible, or a number has too many digits",
    ),
    "unknown unit to show": (
        '[frame.points]', 'display = { length = "kg" }\n[frame.points]',
        'press.toml, [display] length: ',
    ),
    "gears": (
        "[assembly]", '[[gears]]\nlinks = ["OA", "DB"]\nratio = 2\n[assembly]',
        "[[drives]]: 1 drive is given, but the mobility (by rank) is 0; give as many drives as the mobility",
    ),
    "gear ratio": (
        "[assembly]", '[[gears]]\nlinks = ["OA", "DB"]\nratio = 0\n[assembly]',
        "[[gears]] 1: ratio must not be zero",
    ),
    "rolling": (
        "[assembly]",
        '[[rolling]]\nlink = "OA"\ncentre = "A"\nradius = 1\n'
        "along = { through = [0, 0], direction = [1, 0] }\n[assembly]",
        "[[rolling]] OA: the wheel does not touch its track in the initial position: its centre is 0.1585 m too near;"
        " correct the radius or the line; its direction has the wheel's centre on its left",
    ),
    "sphere": (
        'title = "Press"', 'title = "Press"\nspace = "sphere"',
        "[links.AB]: length must be shorter than half a great circle, got 3.5; stay below 180 deg",
    ),
    "cylinder": (
        'link = "OA"', 'distance = ["A", "D"]',
        "group OA (point A): it does not close in the initial position: link OA and cylinder A-D together are too"
        " short by 2 m; change a length, or the initial position",
    ),
    "cylinder shorter than zero": (
        'link = "OA"\nstart = 1', 'distance = ["A", "D"]\nstart = -1', "[[drives]] 1: a cylinder shorter than zero",
    ),
}  # fmt: skip


def in_file(message: str) -> str:
    """The message as it must begin: whatever is wrong with a file starts with its name, an option with its own."""
    return message if message.startswith(("press.toml", "--")) else f"press.toml, {message}"


@pytest.mark.parametrize("name", CHANGES)
def test_wrong_descriptions(refused: Refused, four_bar: str, name: str) -> None:
    old, new, message = CHANGES[name]
    assert old in four_bar
    told = refused(four_bar.replace(old, new, 1))
    assert told.startswith(in_file(message))


def test_a_flat_triangle_without_a_side(refused: Refused, four_bar: str) -> None:
    flat = four_bar.replace("D = [4, 0]", "D = [7.5, 0]").replace("start = 1", "start = 0")
    told = refused(flat.replace('sides = { B = "left" }', ""))
    assert told == in_file(
        "group AB-DB (point B): its triangle is degenerate in the initial position, where both assembly modes coincide;"
        ' give the side on which the motion continues: [assembly] sides, B = "left" | "right"'
    )


def test_a_group_of_higher_class_without_initial_angles(refused: Refused) -> None:
    told = refused("""
        [frame.points]
        O = [0, 0]
        D = [3, 0]
        E = [3, 3]
        [links.OA]
        length = 1
        [links.plate]
        points = { B = [0, 0], C = [1, 0], F = [0.5, 1] }
        [links.AB]
        length = 2
        [links.DC]
        length = 2
        [links.EF]
        length = 2
        [[drives]]
        link = "OA"
        start = 0
        speed = 1
        """)
    assert told.startswith("press.toml, group ")
    assert "it is a group of higher class: its initial angles select one of its positions" in told
    assert told.endswith("; give the initial angle of plate, AB, DC, EF")


def test_hundreds_of_links(refused: Refused, four_bar: str) -> None:
    links = "".join(f'[links.L{i}]\npoints = ["O", "P{i}"]\nlength = 1\n' for i in range(500))
    assert refused(four_bar + links) == "press.toml, links: at most 200 entries are allowed, got 503"


def test_several_problems_are_told_together(refused: Refused, four_bar: str) -> None:
    told = refused(four_bar.replace("length = 1\n", "length = -1\n").replace("length = 3\n", "lengt = 3\n"))
    assert "[links.OA]: length must be positive" in told
    assert '[links.DB]: unknown key "lengt"; did you mean "length"?' in told


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            b"",
            "press.toml: nothing is described: no line has key = value; begin with a built-in one: centrode examp",
        ),
        (
            b"[frame]\n",
            'press.toml: "links" is missing; write each link below a heading, [links.AB], or begin with',
        ),
        (b'{"links": {}}', "press.toml, line 1, column 1: not TOML: "),
        (b"[frame.points]\nO = \n", "press.toml, line 2, column 5: not TOML: "),
        (b"[links.OA\n", "press.toml, line 1, column 10: not TOML: "),
        (b"\0" * 100, "press.toml, line 1, column 1: not TOML: "),
        (bytes(range(256)), "press.toml: the file is not text in UTF-8 (byte 128); save it as UTF-8"),
        ('title = "Пресс"'.encode("cp1251"), "press.toml: the file is not text in UTF-8 (byte 9); save it"),
        ('title = "Press"'.encode("utf-16"), "press.toml: the file is text in UTF-16, not in UTF-8; save it"),
    ],
)
def test_files_that_are_no_descriptions(refused: Refused, content: bytes, message: str) -> None:
    assert refused(content).startswith(message)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--samples", "1000000000"], "samples: 1000000000 samples are given; give 1 to 1000000"),
        (["--samples", "0"], "samples: 0 samples are given; give 1 to 1000000"),
        (["--samples", "-5"], "samples: -5 samples are given; give 1 to 1000000"),
        (["--from", "1 kg"], '--from: expected an angle (rad), got "1 kg"; write a number in rad, or a text'),
        (["--to", "2 s"], '--to: expected an angle (rad), got "2 s"; write a number in rad, or a text'),
        (["--to", "inf"], '--to: expected an angle (rad), got "inf"; write'),
        (["--to", ""], '--to: expected an angle (rad), got ""; write'),
        (["--to", "1e9 deg"], "range: it is too long: 2.78e+06 turns; give at most 500"),
    ],
)
def test_wrong_ranges(refused: Refused, four_bar: str, arguments: list[str], message: str) -> None:
    assert refused(four_bar, *arguments).startswith(in_file(message))


def test_pivots_of_a_group_on_one_place(refused: Refused) -> None:
    lift = example_text("scissor-lift").replace('start = "600 mm"', "start = 0")
    assert "\nstart = 0\n" in lift
    assert refused(lift) == in_file(
        "group OC-AB (point M): the initial position is undetermined there: two of its points coincide, or its"
        " lines are parallel; start the drive elsewhere, or change the dimensions"
    )
