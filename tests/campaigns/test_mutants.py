"""Faults that are put into the package: which there are, where they belong, and records of what became of them."""

from __future__ import annotations

import json
from pathlib import Path

from tools.mutants.__main__ import compare, known_verdicts
from tools.mutants.mutation import ROOMS, Mutant, draw_mutants, sites
from tools.mutants.reach import Reach

SOURCE = """\
'''A module.'''

from __future__ import annotations

LIMIT: float = 2.5


class Gear:
    def ratio(self, teeth: int = 12) -> float | None:
        if teeth < 1 or not self:
            raise ValueError(f"{teeth + 1} teeth")
        total = -LIMIT
        total += (teeth - 3) * LIMIT
        return total if total is not None else None

    def name(self) -> str:
        return "gear " + str(self)
"""
FAULTS = [
    ("constant", "", "2.5 -> (2.75)"),
    ("constant", "Gear.ratio", "12 -> (13)"),
    ("comparison", "Gear.ratio", "teeth < 1 -> (teeth <= 1)"),
    ("comparison", "Gear.ratio", "not self -> (self)"),
    ("constant", "Gear.ratio", "1 -> (2)"),
    ("constant", "Gear.ratio", "3 -> (4)"),
    ("sign", "Gear.ratio", "-LIMIT -> (LIMIT)"),
    ("sign", "Gear.ratio", "total += (teeth - 3) * LIMIT -> total -= (teeth - 3) * LIMIT"),
    ("sign", "Gear.ratio", "teeth - 3 -> (teeth + 3)"),
    ("operand", "Gear.ratio", "teeth < 1 or not self -> (teeth < 1)"),
    ("operand", "Gear.ratio", "(teeth - 3) * LIMIT -> (LIMIT)"),
    ("operand", "Gear.ratio", "(teeth - 3) * LIMIT -> (teeth - 3)"),
    ("operand", "Gear.ratio", "teeth - 3 -> (teeth)"),
    ("operand", "Gear.ratio", "teeth - 3 -> (3)"),
    ("comparison", "Gear.ratio", "total is not None -> (total is None)"),
    ("return", "Gear.ratio", "return total if total is not None else None -> return None"),
    ("return", "Gear.name", 'return "gear " + str(self) -> return None'),
]
"""Neither annotations nor what tells an error have faults, nor texts that are put together."""


def package(folder: Path) -> Path:
    for room in ROOMS:
        (folder / room).mkdir(parents=True)
        (folder / room / "gears.py").write_text(SOURCE, encoding="utf-8")
    return folder


def test_the_faults_of_a_source() -> None:
    content = SOURCE.encode()
    found = []
    for site in sites(content):
        mutant = site.mutant("gears.py", content)
        compile(mutant.source(content), "gears.py", "exec")
        found.append((mutant.kind, mutant.function, mutant.change(content)))
    assert sorted(found) == sorted(FAULTS)


def test_faults_follow_from_the_seed(tmp_path: Path) -> None:
    folder = package(tmp_path)
    drawn = draw_mutants(folder, 3, 40)
    assert draw_mutants(folder, 3, 50)[:40] == drawn
    assert len(set(drawn)) == 40
    assert draw_mutants(folder, 4, 40) != drawn
    assert len(draw_mutants(folder, 3, 10_000)) == len(ROOMS) * len(FAULTS)


def test_test_files_of_a_function_come_cheapest_first() -> None:
    calls = {
        "tests/a.py": {"gears.py:Gear.ratio"},
        "tests/b.py": {"gears.py:Gear.ratio", "gears.py:Gear.name"},
    }
    reach = Reach(calls, {"tests/a.py": 2.0, "tests/b.py": 1.0})
    assert reach.files("gears.py", "Gear.ratio") == ["tests/b.py", "tests/a.py"]
    assert reach.files("gears.py", "Gear.name") == ["tests/b.py"]
    # what stands in no function, or in one that nothing calls: all that call anything of the file
    assert reach.files("gears.py", "") == ["tests/b.py", "tests/a.py"]
    assert reach.files("wheels.py", "") == []


def verdict(number: int, word: str) -> dict[str, object]:
    return {
        "number": number,
        "file": "gears.py",
        "line": number,
        "change": "x",
        "verdict": word,
        "by": "tests/a.py",
    }


def test_a_record_goes_on_and_belongs_to_one_state(tmp_path: Path) -> None:
    record, heading = tmp_path / "mutants.jsonl", {"seed": 1, "state": "this"}
    assert known_verdicts(record, heading) == {}
    with record.open("a", encoding="utf-8") as stream:
        stream.write(json.dumps(verdict(0, "killed")) + "\n" + json.dumps(verdict(1, "killed"))[:20])
    assert known_verdicts(record, heading) == {0: verdict(0, "killed")}
    assert record.read_text(encoding="utf-8").count("\n") == 2
    assert known_verdicts(record, {**heading, "state": "another"}) == {}


def test_two_records_are_compared(tmp_path: Path) -> None:
    files = tmp_path / "before.jsonl", tmp_path / "after.jsonl"
    for file, words in zip(
        files, (("killed", "killed", "survived"), ("killed", "survived", "killed")), strict=True
    ):
        known_verdicts(file, {"seed": 1})
        with file.open("a", encoding="utf-8") as stream:
            stream.writelines(json.dumps(verdict(k, word)) + "\n" for k, word in enumerate(words))
    assert compare(*files) == 1
    assert compare(files[0], files[0]) == 0


def test_a_fault_at_the_beginning_and_after_letters_beyond_ascii() -> None:
    content = "φ = 'угол'; x = 1\n".encode()
    (mutant,) = (site.mutant("a.py", content) for site in sites(content))
    assert mutant == Mutant("a.py", "constant", "", 1, mutant.begin, mutant.end, "(2)")
    assert mutant.source(content).decode() == "φ = 'угол'; x = (2)\n"
