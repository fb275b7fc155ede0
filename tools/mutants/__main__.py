"""`python -m tools.mutants` puts faults into the package and tells which ones the tests notice.

A run goes on where it was:

    python -m tools.mutants --count 300              # of the working tree
    python -m tools.mutants --count 300 --rev main   # of a revision
    python -m tools.mutants --number 17              # this fault alone, in full
    python -m tools.mutants --compare ONE OTHER      # two records: what one run kills and the other does not

The tests are watched once for the functions that they call, with pytest's words after `--`: `-- -n 2` shares them out,
`-- tests/laws` takes some. Records, and a copy of the tree, stand in `mutants-output`.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from collections import Counter
from pathlib import Path
from typing import Any

from tools.mutants.mutation import Mutant, draw_mutants
from tools.mutants.reach import Reach
from tools.mutants.trial import ROOT, Tree, try_mutant, watch_tests

FOLDER = ROOT / "mutants-output"
MOST = 300.0


def main(words: list[str] | None = None) -> int:
    """Do what the words of the command line ask for; returns the exit code."""
    given, own = parse(words)
    if given.compare:
        return compare(*given.compare)
    name = hashlib.sha256(" ".join([given.rev or "tree", *own]).encode()).hexdigest()[:12]
    folder = given.folder / name
    tree = Tree.make(folder / "tree", given.rev)
    heading = {
        "seed": given.seed,
        "rev": given.rev,
        "tests": own,
        "state": tree.fingerprint(),
        "most": given.most,
    }
    mutants = draw_mutants(tree.package, given.seed, given.count)
    reach = known_reach(tree, folder / f"reach-{heading['state'][:12]}", own)
    if given.number is not None:
        show(tree, mutants[given.number], reach, given.most)
        return 0
    record = folder / f"mutants-{given.seed}.jsonl"
    verdicts = known_verdicts(record, heading)
    for number, mutant in enumerate(mutants):
        if number in verdicts:
            continue
        line = {"number": number, **told(tree, mutant), **try_mutant(tree, mutant, reach, given.most).plain()}
        verdicts[number] = line
        with record.open("a", encoding="utf-8", newline="\n") as stream:
            stream.write(json.dumps(line) + "\n")
        print(
            f"{number}: {line['verdict']} {line['file']}:{line['line']} {line['change']} {line['by']}",
            flush=True,
        )
    counted = Counter(line["verdict"] for line in verdicts.values())
    print(", ".join(f"{count} {word}" for word, count in sorted(counted.items())), f"; {record}")
    return 0


def parse(words: list[str] | None) -> tuple[argparse.Namespace, list[str]]:
    """The options of a command line, and pytest's words after `--`."""
    words = sys.argv[1:] if words is None else words
    own = words[words.index("--") + 1 :] if "--" in words else []
    parser = argparse.ArgumentParser(
        prog="python -m tools.mutants",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--seed", type=int, default=1, help="what faults are drawn from")
    parser.add_argument("--count", type=int, default=300, help="how many there are")
    parser.add_argument("--number", type=int, help="try this one alone and show it")
    parser.add_argument("--rev", help="a revision instead of the working tree")
    parser.add_argument(
        "--most", type=float, default=MOST, help="most processor time of the tests for one fault [s]"
    )
    parser.add_argument("--folder", type=Path, default=FOLDER, help="of records and copies")
    parser.add_argument("--compare", nargs=2, type=Path, metavar=("ONE", "OTHER"), help="two records")
    return parser.parse_args(words[: words.index("--")] if "--" in words else words), own


def known_reach(tree: Tree, folder: Path, words: list[str]) -> Reach:
    """Which functions each test file calls; watched anew for another state of the sources or tests."""
    if folder.exists():
        return Reach.read(folder)
    print("watching the tests without a fault", flush=True)
    return watch_tests(tree, folder, words)


def known_verdicts(record: Path, heading: dict[str, Any]) -> dict[int, dict[str, Any]]:
    """What a record has by number; begun anew where it belongs to another state. A line cut short is dropped."""
    lines = record.read_text(encoding="utf-8").splitlines(keepends=True) if record.exists() else []
    whole = [json.loads(line) for line in lines if line.endswith("\n")]
    if not whole or whole[0] != heading:
        whole = [heading]
    record.write_text("".join(json.dumps(line) + "\n" for line in whole), encoding="utf-8")
    return {line["number"]: line for line in whole[1:]}


def told(tree: Tree, mutant: Mutant) -> dict[str, Any]:
    """Where a fault is and what it changes."""
    change = mutant.change((tree.package / mutant.file).read_bytes())
    return {"file": mutant.file, "line": mutant.line, "kind": mutant.kind, "change": change}


def show(tree: Tree, mutant: Mutant, reach: Reach, most: float) -> None:
    """Print a fault, the test files that call it, and its verdict."""
    for name, value in told(tree, mutant).items():
        print(f"{name}: {value}")
    files = reach.files(mutant.file, mutant.function.removesuffix(".<locals>"))
    print("called by", ", ".join(f"{name} ({reach.seconds[name]:.1f} s)" for name in files) or "no test file")
    for name, value in try_mutant(tree, mutant, reach, most).plain().items():
        print(f"{name}: {value}")


def compare(one: Path, other: Path) -> int:
    """Print the faults that the tests of one record kill and those of the other do not; the exit code says if any."""
    first, second = (
        {(line["file"], line["line"], line["change"]): line for line in map(json.loads, lines[1:])}
        for lines in (file.read_text(encoding="utf-8").splitlines() for file in (one, other))
    )
    both = [key for key in first if key in second]
    lost = [key for key in both if first[key]["verdict"] == "killed" != second[key]["verdict"]]
    won = [key for key in both if second[key]["verdict"] == "killed" != first[key]["verdict"]]
    print(
        f"{len(both)} faults in both records; {len(lost)} killed before alone, {len(won)} killed after alone"
    )
    for file, line, change in lost:
        print(f"killed before alone: {file}:{line} {change}; by {first[file, line, change]['by']}")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main())
