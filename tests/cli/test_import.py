"""`centrode import`: descriptions on the terminal and in files, with what was guessed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import centrode as ct

Centrode = Callable[..., Any]
BARS = '<svg width="140mm" height="90mm" viewBox="0 -90 140 90"><path d="M0 0L30-40L120-90L140 0"/></svg>'
PMKS = (
    "https://app.pmksplus.com/?0.Fe.A,0.2111.6A,A,0,0,0.0B,B,0,Fe,0.0C,C,ku,V8,0.4D,D,_W,0,0"
    "..YRAB,AB,Fe,Fe,0,0,,A,B,,.YRBC,BC,Fe,Fe,0,0,,B,C,,.YRCD,CD,Fe,Fe,0,0,,C,D,,...NH"
)


def test_a_drawing_is_printed_or_written_and_runs(centrode: Centrode, tmp_path: Path) -> None:
    drawing, file = tmp_path / "bars.svg", tmp_path / "bars.toml"
    drawing.write_text(BARS, encoding="utf-8")
    printed = centrode("import", drawing)
    assert printed.code == 0, printed
    assert printed.out.startswith("# read from bars.svg\n# guessed: ")
    assert "guessed: no layer is named ground" in printed.err
    written = centrode("import", drawing, "--out", file)
    assert written.code == 0, written
    assert file.read_text(encoding="utf-8") == printed.out
    again = centrode("import", drawing, "--out", file)
    assert (again.code, "exists already" in again.err) == (2, True), again
    checked = centrode("check", file)
    assert checked.code == 0, checked
    scaled = centrode(
        "import", drawing, "--scale", "2", "--drive", "CD", "--join", "0.1 mm", "--out", file, "--force"
    )
    assert scaled.code == 0, scaled
    mechanism = ct.read_mechanism(file)
    assert mechanism.drives[0].link == "CD"
    assert abs(next(iter(mechanism.links.values())).length - 0.1) < 1e-12  # type: ignore[operator]


def test_a_link_of_pmks_is_read(centrode: Centrode) -> None:
    done = centrode("import", PMKS)
    assert done.code == 0 and ct.parse_mechanism(done.out) == ct.from_pmks(PMKS)


def test_what_is_not_read_is_said(centrode: Centrode, tmp_path: Path) -> None:
    drawing = tmp_path / "bars.svg"
    drawing.write_text(BARS, encoding="utf-8")
    for words, told in (
        ((tmp_path / "nothing.svg",), "no such file"),
        ((drawing, "--scale", "-1"), "positive number"),
        ((drawing, "--join", "3 kg"), "--join"),
        ((drawing, "--drive", "XY"), "no link XY"),
        ((drawing, "--out", drawing, "--force"), "which this command reads"),
        ((PMKS, "--scale", "2"), "belong to drawings"),
    ):
        done = centrode("import", *words)
        assert (done.code, told in done.err) == (2, True), done.err
