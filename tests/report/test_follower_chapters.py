"""Chapters of cams with followers: printed formulas evaluated, hand calculations, checks that can fail."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest

import centrode as ct
from centrode.cams.followers import motion_results
from centrode.cams.followers.closed_forms import ClosedForms
from centrode.cams.followers.curve_formulas import CURVES, PEAKS, shares_of
from centrode.cams.followers.force_results import virtual_work_difference
from centrode.cams.followers.forces import follower_forces
from centrode.cams.followers.motion import FollowerMotion
from centrode.cams.followers.profile_results import instant_centre_difference, profile_difference
from centrode.laws import CURVES as LAWS
from centrode.laws import LawSegment, SegmentedLaw
from centrode.model.examples.catalogue import load_cam
from centrode.render.document import cam_player
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    CheckBlock,
    FormulaBlock,
    Moving,
    Outline,
    ParagraphBlock,
    TableBlock,
)
from centrode.render.document.numbers import Numbers
from centrode.render.document.spelling import DocumentSpelling
from centrode.report.chapters import CHAPTERS
from centrode.report.study import ReportOptions, ReportStudy, settle_options
from centrode.sheets.texts import Leaf
from centrode.views.follower_formulas import FollowerFormulas
from report.formula_values import value_of

EPS = float(np.finfo(float).eps)
NAMES = ("data", "motion", "lift", "laws", "base-radius", "profile", "cam-forces")
FOLLOWERS = {
    "roller": 'contact = "roller"\nroller_radius = "9 mm"\noffset = "7 mm"',
    "knife": 'contact = "knife"\noffset = "-6 mm"',
    "flat": 'contact = "flat"\noffset = "3 mm"',
    "arm with roller": 'kind = "oscillating"\nroller_radius = "9 mm"\narm = "90 mm"\npivot_distance = "110 mm"',
    "arm with edge": 'kind = "oscillating"\ncontact = "knife"\narm = "90 mm"\npivot_distance = "110 mm"',
    "swinging face": 'kind = "oscillating"\ncontact = "flat"\npivot_distance = "110 mm"\nface_offset = "6 mm"',
}
BODY = """
kind = "cam"
display = { length = "mm", angle = "deg" }
[cam]
base_radius = "40 mm"
turn = "TURN"
speed = "300 rpm"
thickness = "10 mm"
material = { elasticity = "206 GPa" }
[follower]
FOLLOWER
[[segments]]
angle = "120 deg"
to = "LIFT"
curve = "cycloidal"
[[segments]]
angle = "60 deg"
curve = "dwell"
[[segments]]
angle = "180 deg"
to = 0
curve = "4-5-6-7"
"""


def described(follower: str = "roller", turn: str = "counter-clockwise", more: str = "") -> ct.PlateCam:
    text = BODY.replace("TURN", turn).replace("FOLLOWER", FOLLOWERS[follower] + more)
    found = ct.parse_cam(text.replace("LIFT", "8 deg" if "oscillating" in text else "14 mm"))
    assert isinstance(found, ct.PlateCam)
    return found


def study_of(cam: object, **wishes: object) -> ReportStudy:
    options = ReportOptions(**wishes)  # type: ignore[arg-type]
    return ReportStudy(cam, settle_options(cam, options, CHAPTERS))  # type: ignore[arg-type]


def spelled(cam: ct.PlateCam, *lines: tuple[Leaf, ...]) -> list[tuple[str, ...]]:
    """Lines of formulas as a document of twelve digits has them."""
    spelling = DocumentSpelling(Numbers(cam.display, 12))
    return [tuple(map(spelling.mathematics, line)) for line in lines]


def blocks_of(chapter: ChapterBlocks | None, kind: type) -> list:
    assert chapter is not None
    return [block for section in chapter.sections for block in section.blocks if isinstance(block, kind)]


@pytest.fixture(scope="module")
def valve() -> ReportStudy:
    return study_of(load_cam("valve-cam"))


@pytest.fixture(scope="module")
def indexing() -> ReportStudy:
    return study_of(load_cam("indexing-cam"))


def plate_of(study: ReportStudy) -> ct.PlateCam:
    assert isinstance(study.description, ct.PlateCam)
    return study.description


@pytest.mark.parametrize("curve", list(LAWS))
def test_printed_laws_are_the_laws(curve: str) -> None:
    """Every formula as it is printed, evaluated at 40 digits, against the law's jets and against its own function."""
    law = SegmentedLaw((LawSegment(1.3, 0.7, curve),))
    motion = FollowerMotion(law)
    before = 0.0
    for rule in CURVES[curve]:
        assert value_of(rule.mark) == rule.upto
        u = before + (rule.upto - before) * np.linspace(0.1, 0.9, 5)
        before = rule.upto
        lifts = motion.lift(1.3 * u, 2)
        with mpmath.workdps(40):
            spelled = np.array(
                [[value_of(text, {"u": x, "h": 0.7, "beta": 1.3}) for x in u] for text in rule.spelled]
            )
        scale = 0.7 / 1.3 ** np.arange(3)[:, None]
        sizes = np.array([[100.0], [500.0], [2000.0]])  # sums of the coefficients of the highest polynomial
        assert np.all(np.abs(lifts - spelled) <= 64 * EPS * sizes * scale)
        assert np.all(np.abs(shares_of(curve, u) * scale - spelled) <= 64 * EPS * sizes * scale)


@pytest.mark.parametrize("curve", list(LAWS))
def test_closed_forms_of_the_peaks(curve: str) -> None:
    texts, numbers = PEAKS[curve]
    assert [value_of(text) for text in texts] == pytest.approx(numbers, rel=8 * EPS, abs=0)


@pytest.mark.parametrize("turn", ["counter-clockwise", "clockwise"])
@pytest.mark.parametrize("follower", list(FOLLOWERS))
def test_numbers_of_printed_formulas(follower: str, turn: str) -> None:
    """Each worked line with its numbers, evaluated, gives what stands at its end, to the digits that are printed."""
    cam = described(follower, turn)
    body = ct.follower_cam(cam)
    lines = 0
    for phi in (0.3, 1.1, 4.2):
        formulas = FollowerFormulas(body, phi)
        for line in spelled(cam, *formulas.start(), *formulas.pressure(), *formulas.radius()):
            if len(line) < 3 or line[0] in ("u_x", "u_y", "w_x", "w_y"):
                continue
            lines += 1
            worked, told = value_of(line[-2]), value_of(line[-1])
            # twelve digits each, of differences of numbers some hundred times as large
            assert worked == pytest.approx(told, rel=1e-8, abs=1e-9), line
    assert lines >= 3


@pytest.mark.parametrize("turn", ["counter-clockwise", "clockwise"])
@pytest.mark.parametrize("follower", list(FOLLOWERS))
def test_letters_of_printed_formulas(follower: str, turn: str) -> None:
    """The same in letters: profile, pressure angle and curvature against differences of the follower's places."""
    cam = described(follower, turn)
    body = ct.follower_cam(cam)
    guide, roller = body.guide, 0.0 if math.isinf(body.touch.roller) else body.touch.roller
    for phi in (0.3, 1.1, 4.2):
        rows = body.motion.lift(np.array([phi]), 3)[:, 0]
        formulas = FollowerFormulas(body, phi)
        known = {
            "r_0": body.base_radius, "r": roller, "phi": phi, "e": getattr(guide, "offset", 0.0),
            "d": getattr(guide, "distance", 0.0), "l": getattr(guide, "arm", 0.0),
            "f": getattr(guide, "face_offset", 0.0),
        }  # fmt: skip
        name = "psi" if cam.swings else "s"
        known |= {name + "'" * order: float(rows[order]) for order in range(3)}
        lines = [
            *formulas.start(),
            *formulas.radius(),
            *formulas.pressure(),
            *formulas.aids(),
            *formulas.place(),
        ]
        for line in spelled(cam, *lines):
            if line[0] != "alpha":
                known[line[0]] = value_of(line[1], known)
        contact = body.contact(np.array([phi]))
        size = 256 * EPS * body.base_radius
        assert abs(known["x"] - contact.place[0, 0]) <= size and abs(known["y"] - contact.place[0, 1]) <= size
        assert known["R"] == pytest.approx(float(contact.bend[0]), rel=1e4 * EPS)
        if "tan alpha" in known:
            assert known["tan alpha"] == pytest.approx(
                math.tan(float(contact.pressure_angle[0])), abs=1e4 * EPS
            )


@pytest.fixture
def short_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    """The player of a cam has few pictures: that they are right is looked at with all of them, below."""
    monkeypatch.setattr(cam_player, "TURN", 12)


@pytest.mark.usefixtures("short_turn")
@pytest.mark.parametrize("follower", list(FOLLOWERS))
def test_every_follower_has_all_chapters(follower: str) -> None:
    turn = "clockwise" if "with" in follower else "counter-clockwise"
    spring = '\nspring = { stiffness = "40 N*m/rad", preload = "30 N*m" }\ninertia = "0.01 kg*m^2"'
    if "oscillating" not in FOLLOWERS[follower]:
        spring = '\nspring = { stiffness = "9 N/mm", preload = "120 N" }\nmass = "300 g"\nfriction = 0.05'
    study = study_of(described(follower, turn, spring))
    for name in NAMES:
        chapter = CHAPTERS[name].make(study)
        assert chapter is not None and not chapter.missing, name
        failed = [one.text for one in blocks_of(chapter, CheckBlock) if not one.holds]
        assert failed == [], name


@pytest.mark.usefixtures("short_turn")
@pytest.mark.parametrize("name", [pytest.param("valve-cam", marks=pytest.mark.drawn), "indexing-cam"])
def test_chapters_of_the_examples(name: str) -> None:
    report = ct.report(load_cam(name), ReportOptions(full=True))
    assert [chapter.name for chapter in report.chapters] == list(NAMES)
    checks = [one for chapter in report.chapters for one in blocks_of(chapter, CheckBlock)]
    assert len(checks) >= 9 and all(one.holds for one in checks)


def test_hand_calculation_of_the_valve_cam(valve: ReportStudy) -> None:
    """3-4-5 by 8 mm over 75 deg: 15/8 h/beta, 10/sqrt 3 h/beta^2; at the nose 180 + 25 * 8 N, no acceleration."""
    beta = math.radians(75)
    lines = [line for block in blocks_of(CHAPTERS["lift"].make(valve), FormulaBlock) for line in block.lines]
    told = {line[0]: line[-1] for line in lines}
    assert value_of(told['abs(s\')_"max"']) == pytest.approx(15 / 8 * 8 / beta, rel=1e-4)
    assert value_of(told["abs(s'')_\"max\""]) == pytest.approx(10 / 3**0.5 * 8 / beta**2, rel=1e-4)
    forces = [
        line for block in blocks_of(CHAPTERS["cam-forces"].make(valve), FormulaBlock) for line in block.lines
    ]
    assert ("N", "frac(Q, b_n + mu b_t)", "frac(380, 1 + 0.08 dot.op 0)", '380 thin "N"') in forces
    least = [
        line for block in blocks_of(CHAPTERS["base-radius"].make(valve), FormulaBlock) for line in block.lines
    ]
    decided = [line for line in least if line[0] == "R" and len(line) > 2]
    assert decided[0][-1].startswith("0 ")


def test_worked_forces_give_what_they_say(indexing: ReportStudy) -> None:
    for block in blocks_of(CHAPTERS["cam-forces"].make(indexing), FormulaBlock):
        for line in block.lines:
            if len(line) == 4 and not line[0].startswith("frac"):
                scale = 1e6 if "MPa" in line[-1] else 1.0
                assert value_of(line[2]) == pytest.approx(scale * value_of(line[3]), rel=2e-3, abs=1e-6), line


def test_cycloidal_case_of_the_literature() -> None:
    """Rise 1, dwell, fall 1, dwell, 90 deg each, radius of curvature from 0.25 on: base radius 1.893."""
    quarter = '[[segments]]\nangle = "90 deg"\n'
    moves = [quarter + f'to = {to}\ncurve = "cycloidal"\n' for to in (1, 0)]
    dwell = quarter + 'curve = "dwell"\n'
    text = 'kind = "cam"\n[follower]\ncontact = "flat"\n[bounds]\ncurvature_radius = 0.25\n'
    study = study_of(ct.parse_cam(text + moves[0] + dwell + moves[1] + dwell))
    chapter = CHAPTERS["base-radius"].make(study)
    lines = [line for block in blocks_of(chapter, FormulaBlock) for line in block.lines]
    assert ("r_0", '1.8926 thin "m"') in lines
    assert any(line[0] == "R" and line[-1] == '0.25 thin "m"' for line in lines)
    assert any("is made with this radius" in one.text for one in blocks_of(chapter, ParagraphBlock))


def test_a_wrong_motion_is_found(indexing: ReportStudy, monkeypatch: pytest.MonkeyPatch) -> None:
    def formulas_check() -> CheckBlock:
        return blocks_of(CHAPTERS["lift"].make(study_of(plate_of(indexing))), CheckBlock)[0]

    assert "The formulas, evaluated" in formulas_check().text and formulas_check().holds
    monkeypatch.setattr(motion_results, "shares_of", lambda curve, u: shares_of(curve, u) * (1 + 1e-11))
    assert not formulas_check().holds


def test_a_wrong_profile_is_found(indexing: ReportStudy) -> None:
    body = ct.follower_cam(plate_of(indexing))
    rounded = motion_results.ROUNDED * body.base_radius
    assert instant_centre_difference(body) <= rounded and profile_difference(body) <= rounded
    other = replace(body, touch=replace(body.touch, roller=body.touch.roller * (1 + 1e-11)))
    monkey = ClosedForms(other).place(np.array([1.0]), body.motion.lift(np.array([1.0]), 3))
    assert np.abs(monkey - body.contact(np.array([1.0])).place).max() > rounded * 1e-3


@pytest.mark.usefixtures("short_turn")
def test_an_undercut_profile_is_told() -> None:
    cam = load_cam("valve-cam")
    steep = cam.model_copy(update={
        "body": cam.body.model_copy(update={"base_radius": 0.015}),
        "study": cam.study.model_copy(update={"show_undercut": True}),
    })  # fmt: skip
    study = study_of(steep)
    failed = [one.text for one in blocks_of(CHAPTERS["profile"].make(study), CheckBlock) if not one.holds]
    assert any("is undercut at" in text for text in failed)
    refused = ct.report(steep.model_copy(update={"study": cam.study}), ReportOptions(full=True))
    missing = {chapter.name: chapter.missing for chapter in refused.chapters if chapter.missing}
    assert "undercuts the profile" in missing["profile"]
    assert not {"data", "lift", "laws"} & set(missing)


def test_a_cam_that_no_radius_makes_is_told() -> None:
    """The choice of the base radius says why there is none; what needs a size is left out."""
    text = BODY.replace("TURN", "clockwise").replace("FOLLOWER", FOLLOWERS["roller"]).replace("LIFT", "14 mm")
    text = text.replace('base_radius = "40 mm"\n', "").replace('"cycloidal"', '"uniform"')
    made = ct.report(ct.parse_cam(text + '[bounds]\npressure_angle = "30 deg"\n'), ReportOptions(full=True))
    assert [chapter.name for chapter in made.chapters if not chapter.missing] == [
        "data",
        "lift",
        "laws",
        "base-radius",
    ]
    (failed,) = blocks_of(made.chapters[3], CheckBlock)
    assert not failed.holds and "the velocity of the lift jumps" in failed.text


def test_a_follower_that_jumps_is_told() -> None:
    cam = load_cam("valve-cam")
    fast = cam.model_copy(update={"body": cam.body.model_copy(update={"speed": 400.0})})
    chapter = CHAPTERS["cam-forces"].make(study_of(fast))
    failed = [one.text for one in blocks_of(chapter, CheckBlock) if not one.holds]
    assert len(failed) == 1 and "leaves the cam" in failed[0]
    needed = [
        line
        for block in blocks_of(chapter, FormulaBlock)
        for line in block.lines
        if line[0].startswith("F_(0")
    ]
    assert value_of(needed[0][-1]) > 180.0


def test_virtual_work_finds_a_wrong_torque(indexing: ReportStudy, monkeypatch: pytest.MonkeyPatch) -> None:
    forces = follower_forces(plate_of(indexing))

    def holds() -> bool:
        apart, size = virtual_work_difference(forces)
        return apart / size <= motion_results.ROUNDED

    assert holds()
    real = type(forces).at
    monkeypatch.setattr(
        type(forces), "at", lambda self, phi: replace(real(self, phi), torque=real(self, phi).torque * 1.001)
    )
    assert not holds()


def test_cams_without_a_size_tell_their_motion() -> None:
    text = 'kind = "cam"\n[follower]\ncontact = "knife"\n'
    text += '[[segments]]\nangle = "180 deg"\nto = "5 mm"\ncurve = "harmonic"\n'
    text += '[[segments]]\nangle = "180 deg"\nto = 0\ncurve = "b-spline"\n'
    text += 'through = [["60 deg", "4 mm"], ["90 deg", "3 mm"]]\nat_start = [0, 0]\nat_end = [0, 0]\n'
    made = ct.report(ct.parse_cam(text), ReportOptions(full=True))
    assert [chapter.name for chapter in made.chapters] == ["data", "lift", "laws"]
    tables = blocks_of(made.chapters[1], TableBlock)
    assert any(table.caption == "Coefficients of segment 2" for table in tables)


def test_wishes_of_a_cam(valve: ReportStudy) -> None:
    cam = described()
    asked = ct.parse_cam(
        ct.cam_text(cam) + '\n[report]\nchapters = ["lift"]\ninstants = ["30 deg", "60 deg"]\ndigits = 7\n'
    )
    made = ct.report(asked, ReportOptions(full=True))
    assert [chapter.name for chapter in made.chapters] == ["lift"]
    table = next(
        one for one in blocks_of(made.chapters[0], TableBlock) if one.caption == "At the chosen angles"
    )
    assert [row[0] for row in table.rows] == ["30.00000", "60.00000"]
    # h (u - sin(2 pi u)/(2 pi)) at u = 1/4 and 1/2
    assert [float(row[1]) for row in table.rows] == pytest.approx([14 * (0.25 - 1 / math.tau), 7.0], abs=1e-6)
    del valve


def test_the_cam_turns_under_its_follower(indexing: ReportStudy) -> None:
    """The roller touches the moving profile in every picture: its centre is a radius away, as far as corners go."""
    moving = blocks_of(CHAPTERS["motion"].make(indexing), Moving)[0]
    assert moving.driven == ("K",) and len(moving.drive) == len(moving.drive_texts) == 181
    profile = moving.shapes[0]
    assert isinstance(profile, Outline)
    # 361 corners about a profile of some 40 to 80 mm: the sagitta of a chord of a degree
    sagitta = 0.08 * math.radians(1.0) ** 2 / 8 * 4
    for sample in (0, 17, 60, 121):
        _x, _y, turn = profile.poses[sample]
        cosine, sine = math.cos(turn), math.sin(turn)
        placed = profile.corners @ np.array([[cosine, sine], [-sine, cosine]])
        apart = np.hypot(*(_dense(placed) - moving.places["A"][sample]).T).min()
        assert abs(apart - 0.012) <= sagitta
    assert np.hypot(*(moving.places["A"] - moving.places["C"]).T) == pytest.approx(0.09, rel=16 * EPS)


def _dense(corners: np.ndarray) -> np.ndarray:
    """Points along the sides of a polygon."""
    following = np.roll(corners, -1, axis=0)
    share = np.linspace(0.0, 1.0, 20)[:, None, None]
    return (corners + share * (following - corners)).reshape(-1, 2)


def test_a_linkage_shows_and_tells_its_cam() -> None:
    study = study_of(ct.example("cam-driven-linkage"))
    captions = [one.caption for one in blocks_of(CHAPTERS["data"].make(study), TableBlock)]
    assert "Cam Indexing cam, which moves drive lever" in captions and "Segments of a turn" in captions
    moving = blocks_of(CHAPTERS["motion"].make(study), Moving)[0]
    profile = next(one for one in moving.shapes if isinstance(one, Outline) and one.filled)
    for sample in (0, 100, 250):
        x, y, turn = profile.poses[sample]
        cosine, sine = math.cos(turn), math.sin(turn)
        placed = profile.corners @ np.array([[cosine, sine], [-sine, cosine]]) + [x, y]
        apart = np.hypot(*(_dense(placed) - moving.places["R"][sample]).T).min()
        assert abs(apart - 0.012) <= 0.08 * math.radians(1.0) ** 2 / 2


def test_chapters_of_linkages_are_none_of_follower_cams(valve: ReportStudy) -> None:
    others = set(CHAPTERS) - {*NAMES, "conclusions"}
    assert [key for key in sorted(others) if CHAPTERS[key].make(valve) is not None] == []


@pytest.mark.usefixtures("short_turn")
def test_same_input_same_bytes(tmp_path: object) -> None:
    del tmp_path
    first, second = (
        ct.report(load_cam("valve-cam"), ReportOptions(chapters=("motion", "profile"))) for _k in range(2)
    )

    def blocks(report: object) -> list[Block]:
        return [block for chapter in report.chapters for one in chapter.sections for block in one.blocks]  # type: ignore[attr-defined]

    for one, other in zip(blocks(first), blocks(second), strict=True):
        if not isinstance(one, Moving):
            assert one == other
