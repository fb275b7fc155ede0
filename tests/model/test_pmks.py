"""Links of PMKS+: read as they are drawn, refused where they are damaged or hold what is not read."""

from __future__ import annotations

import random
from urllib.parse import quote

import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.model.pmks import DIGITS, LENGTH_MARKS, _hash_of, from_pmks

ADDRESS = "https://app.pmksplus.com/?"


def whole(number):
    """A whole number in digits of base 64: the test's own writer of addresses."""
    rest, written = abs(number), ""
    while rest or not written:
        rest, digit = divmod(rest, 64)
        written = DIGITS[digit] + written
    return f"0{written}" if number < 0 else written


def decimal(number):
    return whole(round(number * 1000))


def joint(name, x, y, flags, angle=0.0, more=""):
    return f"{DIGITS[flags]}{name},{name},{decimal(x)},{decimal(y)},{decimal(angle)}{more}"


def link(name, joints, mass=1.0, inertia=1.0, centre=(0.0, 0.0), kind="R", mark="Y"):
    numbers = ",".join(map(decimal, (mass, inertia, *centre)))
    return f"{mark}{kind}{name},{name},{numbers},303e9f,{','.join(joints)},,"


def address(joints, links, forces=(), *, speed=20, switches=0, units="1011", tail="N", digest=False):
    parts = [
        whole(switches),
        "Fe,1E8",
        f"{whole(speed)},0",
        units,
        *joints,
        "",
        *links,
        "",
        *forces,
        "",
        tail,
    ]
    body = ".".join(parts)
    body += LENGTH_MARKS[len(body) % 62]
    return ADDRESS + (f"{body}*{_hash_of(body)}" if digest else body)


FIXED, DRIVEN, SLIDES, WELDED = 4, 2, 1, 8
BARS = (
    [joint("A", 0, 0, FIXED + DRIVEN), joint("B", 1, 0.5, 0), joint("C", 4, 2, 0), joint("D", 4, -1, FIXED)],
    [link("AB", "AB"), link("BC", "BC"), link("CD", "CD")],
)


def test_a_four_bar_stands_and_turns_as_it_is_drawn():
    mechanism = from_pmks(address(*BARS, speed=30, switches=1))
    assert mechanism.display.length == "cm"
    start = ct.motion(mechanism, 3).isel(sample=0)
    assert start.position.sel(point="C").values == pytest.approx([0.04, 0.02], abs=1e-12)
    # 30 rpm clockwise: pi rad/s
    assert float(start.angular_velocity.sel(link="AB")) == pytest.approx(-3.141592653589793)
    other = from_pmks(address(*BARS, speed=30, units="2011"))
    assert other.links["AB"].length == pytest.approx(100 * mechanism.links["AB"].length)
    assert ct.motion(other, 3).angular_velocity.sel(link="AB")[0] > 0


def test_sliders_slots_and_welded_sliders():
    crank = [joint("A", 0, 0, FIXED + DRIVEN), joint("B", 0.6, 0.8, 0)]
    slider = from_pmks(
        address(
            [*crank, joint("C", 3, 0, 0), joint("P", 3, 0, SLIDES + FIXED, 0.0)],
            [link("AB", "AB"), link("BC", "BC"), link("CP", "CP", kind="P", inertia=0.0)],
        )
    )
    motion = ct.motion(slider, 721)
    assert float(motion.slide.max() - motion.slide.min()) == pytest.approx(0.02, abs=1e-6)  # twice the crank
    slot = from_pmks(
        address(
            [
                *crank, joint("C", 0, -2, FIXED), joint("D", 1.2, 3.6, 0),
                joint("P", 0.6, 0.8, SLIDES, 0.0, ",CD,C,D"),
            ],
            [link("AB", "AB"), link("CD", "CD"), link("BP", "BP", kind="P", inertia=0.0)],
        )
    )  # fmt: skip
    assert slot.guides[0].on == "CD"
    place = ct.motion(slot, 3).isel(sample=0).position.sel(point="D").values
    assert place == pytest.approx([0.012, 0.036], abs=2e-5)
    welded = from_pmks(
        address(
            [
                *crank, joint("C", 0.6, -1, WELDED), joint("D", 0.6, 2, 0),
                joint("P", 0.6, 0.8, SLIDES, 0.0, ",CD,C,D"), joint("Q", 0.6, -1, SLIDES + FIXED, 0.0),
            ],
            [
                link("AB", "AB"), link("CD", "CD"), link("BP", "BP", kind="P", inertia=0.0),
                link("CQ", "CQ", kind="P", inertia=0.0),
            ],
        )
    )  # fmt: skip
    yoke = ct.motion(welded, 13)
    assert abs(yoke.angular_velocity.sel(link="CD")).max() < 1e-12  # the yoke does not turn
    assert yoke.position.sel(point="C", axis="x").values == pytest.approx(
        yoke.position.sel(point="B", axis="x").values
    )


def test_masses_and_forces():
    joints, links = BARS
    heavy = [link("AB", "AB", 2.0, 3.0, (0.5, 0.25)), *links[1:]]
    force = f"{DIGITS[2]}F1,BC,F1,{decimal(4)},{decimal(2)},{decimal(4)},{decimal(5)},{decimal(7)}"
    mechanism = from_pmks(address(joints, heavy, [force]))
    assert mechanism.links["AB"].mass == pytest.approx(0.002)
    assert mechanism.links["AB"].inertia == pytest.approx(3e-4)
    assert mechanism.links["AB"].centre == pytest.approx((0.005590169943749474, 0.0))
    assert mechanism.loads[0].point == "C"
    assert [float(x) for x in mechanism.loads[0].vector] == pytest.approx([0.0, 7.0])
    assert mechanism.gravity == (0, -9.81)
    assert from_pmks(address(*BARS)).gravity is None


def test_addresses_may_be_quoted_and_have_a_hash():
    plain = from_pmks(address(*BARS))
    assert from_pmks(address(*BARS, digest=True)) == plain
    assert from_pmks(ADDRESS + quote(address(*BARS).removeprefix(ADDRESS))) == plain
    assert from_pmks(address(*BARS).removeprefix(ADDRESS)) == plain


MOTOR = [joint("A", 0, 0, FIXED), joint("B", 1, 0.5, DRIVEN), *BARS[0][2:]]
REFUSED = [
    ("", "length does not fit"),
    (ADDRESS + "abc", "length does not fit"),
    (address(*BARS)[:-9] + address(*BARS)[-8:], "length does not fit"),
    (address(*BARS, digest=True).replace("Fe", "Ff"), "hash does not fit"),
    (address(*BARS, tail="N.G1"), "newer version"),
    (address(MOTOR, BARS[1]), "between two moving links"),
    (address(BARS[0], [*BARS[1], link("AX", "AX")]), "names a joint that is not there"),
    (address(BARS[0], [*BARS[1], link("AA", "AA")]), "names a joint twice"),
    (address(BARS[0], [*BARS[1], BARS[1][0]]), "have one name"),
    (address(BARS[0], [*BARS[1], link("AC", "AC")]), "turns several links"),
    (address(BARS[0], []), "has no link"),
    (address(*BARS, speed=0), "speed is zero"),
    (address(*BARS, units="7011"), "units are not those"),
    (address([*BARS[0][:2], joint("C", 4, 2, 0, 0.0, ",,,,Fe"), BARS[0][3]], BARS[1]), "speed of its own"),
    ("x" * 200_000, "at most 100000 are allowed"),
]


@pytest.mark.parametrize(("url", "said"), REFUSED)
def test_what_is_damaged_or_not_read_is_refused(url, said):
    with pytest.raises(InputError, match=said):
        from_pmks(url)


def test_mutated_addresses_give_a_mechanism_or_a_refusal():
    """Whatever changes on the way: never another failure, and a change that keeps the hash's length is noticed."""
    source = random.Random(7)
    plain, hashed = address(*BARS), address(*BARS, digest=True)
    kept = from_pmks(plain)
    noticed = 0
    for _k in range(1000):
        text = source.choice([plain, hashed])
        start = len(ADDRESS)
        for _change in range(source.randrange(1, 4)):
            at = source.randrange(start, len(text))
            letter = source.choice(DIGITS + ",.*%\u00df")
            match source.randrange(3):
                case 0:
                    text = text[:at] + letter + text[at + 1 :]
                case 1:
                    text = text[:at] + letter + text[at:]
                case _:
                    text = text[:at] + text[at + 1 :]
        # half of them with a length that fits again, so that what is behind is reached
        if source.random() < 0.5 and "*" not in text:
            body = text[start:-1]
            text = ADDRESS + body + LENGTH_MARKS[len(body) % 62]
        try:
            found = from_pmks(text)
        except InputError:
            noticed += 1
            continue
        assert isinstance(found, ct.Mechanism)
        if "*" in text:
            assert found == kept  # a hash that fits belongs to the same drawing
    assert noticed > 300


def test_a_hash_notices_every_letter():
    hashed = address(*BARS, digest=True)
    for at in range(len(ADDRESS), len(hashed) - 7):
        other = "1" if hashed[at] != "1" else "2"
        with pytest.raises(InputError):
            from_pmks(hashed[:at] + other + hashed[at + 1 :])
