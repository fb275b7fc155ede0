"""The chapter of what is given: names and formulas as the user wrote them, numbers in the language of the document."""

from __future__ import annotations

import pytest

import centrode as ct
from centrode.dynamics.masses import link_masses
from centrode.locale import speaking
from centrode.render.document.blocks import ParagraphBlock, TableBlock
from centrode.render.document.chapters import document_chapter
from centrode.render.document.numbers import Numbers
from centrode.views.masses_and_loads import sheet


@pytest.mark.parametrize("hostile", ["No 1.23456", "run 30 deg", "2.50 kg", "$x_1$", "<b>", "#a"])
def test_names_come_out_character_by_character(hostile: str) -> None:
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={hostile: {"points": ["O", "A"], "length": 1, "mass": 2.5, "shape": "rod"}},
        drives=[{"link": hostile, "speed": 1}],
        loads=[
            {"kind": "torque", "link": hostile, "value": "2.5*t", "name": f"{hostile} too"},
            {"kind": "torque", "link": hostile, "value": 1.25, "name": "other"},
        ],
        machine={"mean_speed": 1.5, "shafts": [{"inertia": 0.5, "name": hostile}]},
    )
    with speaking("ru"):
        chapter = document_chapter(
            "masses-and-loads", sheet(link_masses(mechanism)), Numbers(mechanism.display)
        )
    masses, loads, machine = (
        [[cell.replace(r"\$", "$") for cell in row] for row in block.rows]
        for section in chapter.sections
        for block in section.blocks
        if isinstance(block, TableBlock)
    )
    assert masses[0][:2] == [hostile, "2,5"]
    assert loads[0] == [f"{hostile} too", "момент", hostile, "2.5*t"]
    assert loads[1][3] == "1,25"
    assert machine[0][1] == "1,5 рад/с" and machine[1][0] == hostile


def test_a_mass_that_is_not_complete_leaves_the_others_as_they_are() -> None:
    """A table has what is given of every link, and the reason below it says what is missing."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"points": ["O", "A"], "length": 1, "mass": 2.5, "shape": "rod"},
            "AC": {"points": {"A": [0, 0], "B": [1, 0], "C": [1, 1]}, "mass": 3.25, "inertia": 0.125},
            "CD": {"points": ["C", "D"], "length": 1},
        },
        drives=[{"link": name, "speed": 1} for name in ("OA", "AC", "CD")],
    )
    found = link_masses(mechanism)
    assert [mass.link for mass in found.masses] == ["OA"] and found.massless == ("CD",)
    assert found.incomplete["AC"].what == "the position of its centre of mass is not given"
    chapter = document_chapter("masses-and-loads", sheet(found), Numbers(mechanism.display))
    table, reason, massless = chapter.sections[0].blocks
    assert isinstance(table, TableBlock)
    assert [row[0] for row in table.rows] == ["OA", "AC"]
    assert table.rows[1][1] == "3.25" and table.rows[1][3] == "0.125"
    assert isinstance(reason, ParagraphBlock) and isinstance(massless, ParagraphBlock)
    assert "links.AC" in reason.text and "give centre, or shape" in reason.text
    assert "CD" in massless.text
