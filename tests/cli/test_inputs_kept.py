"""No command writes over a file that it reads: by its name, a link, another name of it, another spelling."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import pytest

import centrode as ct
from centrode.cli import main as command_line
from centrode.cli import output
from centrode.model.examples import example_text
from centrode.model.examples.catalogue import load

Centrode = Callable[..., Any]

FEW = ("--samples", "3", "--no-figures")
EXAMPLES = {
    "cam": "valve-cam",
    "gears": "shifted-gear-pair",
    "trains": "single-planet-train",
    "region": "five-bar-two-drives",
    "simulate": "six-bar-press-run-up",
    "equilibrium": "double-pendulum",
    "modes": "double-pendulum",
}
"""What a command is tried on; the others on a press."""
REQUEST = '[synthesis]\nkind = "strokes"\ntopology = "shaper"\nstroke = "0.4 m"\ntime_ratio = 1.6\n'
FOLDERS: dict[str, tuple[str, tuple[str, ...]]] = {
    "run": ("summary.json", FEW),
    "report": ("report.html", ("--format", "html", "--chapters", "data")),
    "integrate": ("integration.csv", ("--steps", "60", "--no-figures")),
    "reduce": ("reduction.csv", FEW),
    "reactions": ("reactions.csv", FEW),
    "sheets": ("sheet-1.pdf", ("--format", "pdf")),
    "polygons": ("polygons.csv", ("--at", "1 rad", "--no-figures")),
    "region": ("region.csv", ("--samples", "5", "--no-figures")),
    "flywheel": ("summary.json", ("--samples", "9", "--no-figures")),
    "simulate": ("simulation.csv", ("--duration", "0.01", "--no-figures")),
    "equilibrium": ("equilibria.csv", ("--no-figures",)),
    "modes": ("modes.csv", ("--no-figures",)),
    "balance": ("balance.csv", ("--no-figures", "--samples", "9")),
    "tolerances": ("outputs.csv", ("--no-figures", "--draws", "10", "--output", "angle.DB")),
    "cam": ("summary.json", FEW),
    "gears": ("summary.json", ("--no-figures",)),
    "trains": ("summary.json", ("--no-figures",)),
    "synthesise": ("summary.json", ("--no-figures",)),
    "centres": ("centres.csv", ("--at", "1 rad", "--no-figures")),
    "centrodes": ("centrodes.csv", ("--link", "AB", *FEW)),
    "diagrams": ("check.csv", ("--at", "1 rad", "--no-figures")),
    "plan": ("plan.png", ("--positions", "2")),
    "angles": ("transmission.csv", ("--samples", "3")),
}
"""Commands that write a folder: one of its files, and options that make them quick."""
FILES: dict[str, tuple[str, tuple[str, ...]]] = {
    "animate": ("press.gif", ("--frames", "2", "--size", "64x64")),
    "equations": ("press.md", ()),
    "rotatability": ("press.json", ()),
    "limits": ("press.csv", ()),
    "draw": ("press.svg", ("--samples", "3")),
    "describe": ("press.md", ()),
    "export": ("press.xml", ()),
    "page": ("press.html", ("--samples", "3")),
}
"""Commands that write one file, and its name."""
STUDIES = {"sweep", "variants"}
"""Commands that read a study or a table beside a mechanism; tested below."""
ELSEWHERE = {"improve", "import"}
"""Tested with what they do: a search, and drawings."""
READ_NO_FILE = {"examples", "schema", "chains"}
WRITE_NO_FILE = {"check", "app"}


def described(command: str) -> str:
    """The description that a command is tried on, or what it is requested to find."""
    if command == "synthesise":
        return REQUEST
    if command == "tolerances":
        return example_text("crank-rocker") + '\n[tolerances]\ndefault = "±0.1 mm"\n'
    return example_text(EXAMPLES.get(command, "six-bar-press"))


def linked(here: Path, there: Path) -> None:
    there.symlink_to(here)


def again(here: Path, there: Path) -> None:
    there.hardlink_to(here)


def moved(here: Path, there: Path) -> None:
    """The file itself in the place of the output, and a link where it was: the command reads through the link."""
    here.rename(there)
    here.symlink_to(there)


WAYS = (linked, again, moved)


def test_every_command_is_walked() -> None:
    known = FOLDERS.keys() | FILES.keys() | STUDIES | ELSEWHERE | READ_NO_FILE | WRITE_NO_FILE
    assert known == {command.name for command in command_line.COMMANDS}
    for command in command_line.COMMANDS:
        writes = any("--out" in option.opts for option in command.params)
        assert writes != (command.name in WRITE_NO_FILE | {"schema"})


def kept(centrode: Centrode, folder: Path, text: str, *arguments: str) -> None:
    """The command refuses with code 2, names what it reads, and leaves everything as it is."""
    before = {str(path): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    done = centrode(*arguments)
    assert done.code == 2, (arguments, done)
    assert "which this command reads" in done.err
    assert {str(path): path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before
    assert text.encode() in before.values()


@pytest.mark.parametrize("command", sorted(FOLDERS))
def test_a_folder_with_the_input_in_it(centrode: Centrode, folder: Path, command: str) -> None:
    name, options = FOLDERS[command]
    text = described(command)
    (folder / "mine.toml").write_text(text, encoding="utf-8")
    (folder / "out").mkdir()
    way = WAYS[sorted(FOLDERS).index(command) % len(WAYS)]
    way(folder / "mine.toml", folder / "out" / name)
    kept(centrode, folder, text, command, "mine.toml", "--out", "out", *options)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("command", sorted(FILES))
def test_a_file_that_is_the_input(
    centrode: Centrode, folder: Path, command: str, way: Callable[[Path, Path], None]
) -> None:
    name, options = FILES[command]
    text = described(command)
    (folder / "mine.toml").write_text(text, encoding="utf-8")
    way(folder / "mine.toml", folder / name)
    kept(centrode, folder, text, command, "mine.toml", "--out", name, *options, "--force")


def test_the_description_under_its_own_name(centrode: Centrode, folder: Path) -> None:
    """A description called summary.json, computed into its own folder."""
    text = described("run")
    (folder / "summary.json").write_text(text, encoding="utf-8")
    kept(centrode, folder, text, "run", "summary.json", "--out", ".", *FEW)
    kept(centrode, folder, text, "rotatability", "summary.json", "--out", "summary.json", "--force")


def test_the_table_of_a_drive(centrode: Centrode, folder: Path, four_bar: str) -> None:
    """`table = "motion.csv"` and `--out .`; the table is read while the description is."""
    (folder / "press.toml").write_text(four_bar.replace("speed = 1", 'table = "motion.csv"'))
    table = "time [s],angle [deg]\n0,0\n1,10\n2,40\n3,90\n"
    (folder / "motion.csv").write_text(table)
    kept(centrode, folder, table, "run", "press.toml", "--out", ".", *FEW)
    assert centrode("run", "press.toml", "--out", "elsewhere", *FEW).code == 0
    assert (folder / "motion.csv").read_text() == table


def test_a_spelling_that_differs_in_case(centrode: Centrode, folder: Path) -> None:
    """Where the file system takes no notice of case, the names differ and the file is the same."""
    (folder / "Summary.JSON").write_text(described("run"), encoding="utf-8")
    if not (folder / "summary.json").exists():
        pytest.skip("this file system tells cases apart")
    kept(centrode, folder, described("run"), "run", "Summary.JSON", "--out", ".", *FEW)


def test_a_workbook_beside_a_table(centrode: Centrode, folder: Path) -> None:
    (folder / "press.xlsx").write_text(described("limits"), encoding="utf-8")
    kept(
        centrode,
        folder,
        described("limits"),
        "limits",
        "press.xlsx",
        "--out",
        "press.csv",
        "--xlsx",
        "--force",
    )


VARIANTS = "variant,links.OA.length\n1,0.5\n2,0.51\n"


@pytest.mark.parametrize(
    ("name", "jobs"),
    [
        ("variant-2/mechanism.toml", "1"),
        ("variant-2/.draft/mine.toml", "1"),
        ("variant-2/variant.json", "1"),
        ("variant-2/.draft/mine.toml", "2"),  # what guards the inputs reaches the other processes
    ],
)
def test_variants_over_their_topology(centrode: Centrode, folder: Path, name: str, jobs: str) -> None:
    (folder / "t.csv").write_text(VARIANTS)
    text = example_text("slider-between-cranks")
    (folder / name).parent.mkdir(parents=True)
    (folder / name).write_text(text, encoding="utf-8")
    done = centrode("variants", "t.csv", "--topology", name, "--out", ".", "--jobs", jobs)
    assert (done.code, done.out) == (2, "")
    assert "which this command reads" in done.err
    assert (folder / name).read_text(encoding="utf-8") == text


@pytest.mark.parametrize("name", ["summary.csv", ".lock"])
def test_variants_over_their_table(centrode: Centrode, folder: Path, name: str) -> None:
    (folder / name).write_text(VARIANTS)
    kept(
        centrode, folder, VARIANTS, "variants", name, "--topology", "slider-between-cranks", "--out", "."
    )  # fmt: skip


STUDY = """\
mechanism = "mine.toml"
outputs = ["angle.DB"]
samples = 3
reduce = "max"
[grid]
"links.AB.length" = [3.4, 3.5]
"""


def test_a_sweep_over_its_study_and_its_mechanism(centrode: Centrode, folder: Path) -> None:
    (folder / "study.csv").write_text(STUDY)
    (folder / "mine.toml").write_text(example_text("crank-rocker"), encoding="utf-8")
    kept(centrode, folder, STUDY, "sweep", "study.csv", "--out", "study.csv", "--force")
    (folder / "r.csv").symlink_to("mine.toml")
    kept(centrode, folder, STUDY, "sweep", "study.csv", "--out", "r.csv", "--force")


def test_a_sweep_into_a_store_with_its_mechanism_in_it(centrode: Centrode, folder: Path) -> None:
    """A store whose making was cut short is cleared, but not of what the command reads."""
    pytest.importorskip("zarr", reason="stores need the extra sweeps")
    (folder / "r.zarr" / "angle.DB").mkdir(parents=True)
    (folder / "r.zarr" / "progress").mkdir()
    (folder / "r.zarr" / "progress" / "lock").touch()
    text = example_text("crank-rocker")
    (folder / "r.zarr" / "angle.DB" / "mine.toml").write_text(text, encoding="utf-8")
    (folder / "study.toml").write_text(STUDY.replace("mine.toml", "r.zarr/angle.DB/mine.toml"))
    kept(centrode, folder, text, "sweep", "study.toml", "--out", "r.zarr")


PACKAGE = Path(ct.__file__).parent
MAY_REPLACE = re.compile(r"\b(?:os|shutil|unlink|rmtree)\b")
"""What a module holds that takes a file away; the others are not parsed."""
REPLACING = {"replace", "rename", "renames", "unlink", "remove", "rmtree", "move"}
"""Functions of `os` and `shutil`, and methods of paths, that take a file away."""
OWN_FILES = {
    "files/drafts.py",
    "numerics/machine_code/cache.py",
    "sweeps/storage.py",
    "app/synthesis_bench.py",
}


def test_files_are_replaced_in_one_place() -> None:
    """In `files.drafts`, which asks first, so no command can forget to.

    The kernels' cache and stores of sweeps have drafts of their own.
    """
    found = set()
    for module in PACKAGE.rglob("*.py"):
        name, text = module.relative_to(PACKAGE).as_posix(), module.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)) if MAY_REPLACE.search(text) else ():
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                of = node.func.value.id if isinstance(node.func.value, ast.Name) else ""
                call = node.func.attr
                if (of in ("os", "shutil") and call in REPLACING) or call in ("unlink", "rmtree"):
                    found.add((name, call))
    assert {name for name, _call in found} <= OWN_FILES, found


def test_commands_write_through_drafts() -> None:
    """A command opens no file itself: what it writes goes into what `cli.output` gives it."""
    for module in (PACKAGE / "cli").glob("*.py"):
        tree = ast.parse(module.read_text(encoding="utf-8"))
        calls = [node.func for node in ast.walk(tree) if isinstance(node, ast.Call)]
        assert not [call for call in calls if isinstance(call, ast.Name) and call.id == "open"], module.name
        for call in calls:
            if isinstance(call, ast.Attribute) and call.attr in (
                "write_text",
                "write_bytes",
                "open",
                "mkdir",
            ):
                written = ast.unparse(call.value)
                assert "draft" in written or "folder /" in written or written == "os", (module.name, written)


def test_a_command_made_elsewhere_is_guarded_too(
    centrode: Centrode, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The rule is that of what reads and what writes, not of the commands."""

    def work() -> None:
        load("summary.json")
        with output.output_folder(Path()) as draft:
            (draft / "summary.json").write_text("new")

    text = described("run")
    (folder / "summary.json").write_text(text, encoding="utf-8")
    monkeypatch.setattr(command_line, "COMMANDS", (click.Command("work", callback=work),))
    kept(centrode, folder, text, "work")
