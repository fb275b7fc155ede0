"""Command: `python -m tools.moves TABLE [--check]` at the root of the repository."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from tools.moves.engine import Moves
from tools.moves.sources import SOURCE, Unresolved, repository
from tools.moves.table import read_table


def main() -> int:
    """Make the moves, or with --check say what they would leave open."""
    parser = argparse.ArgumentParser(prog="python -m tools.moves", description=__doc__)
    parser.add_argument("table", type=Path)
    parser.add_argument(
        "--check", action="store_true", help="write nothing; print what the table leaves open"
    )
    parser.add_argument(
        "--no-catalogues", action="store_true", help="leave the catalogues' places as they are"
    )
    parser.add_argument("--sizes", action="store_true", help="print the lines of the new modules")
    arguments = parser.parse_args()
    root = Path.cwd()
    try:
        moves = Moves(read_table(arguments.table), repository(root))
        texts, gone = moves.results()
        moves.questions += [f"a circle: {' <- '.join(circle)}" for circle in moves.circles()]
    except Unresolved as question:
        print(question, file=sys.stderr)
        return 1
    for note in dict.fromkeys(moves.notes):
        print(f"note: {note}")
    for open_question in dict.fromkeys(moves.questions):
        print(open_question, file=sys.stderr)
    if arguments.sizes:
        for path, text in sorted(texts.items()):
            if path.is_relative_to(SOURCE) and path.suffix == ".py":
                print(f"{text.count(chr(10)):6d} {path}")
    if moves.questions:
        return 1
    if not arguments.check:
        write(root, texts, gone, not arguments.no_catalogues)
    return 0


def write(root: Path, texts: dict[Path, str], gone: set[Path], catalogues: bool) -> None:
    """Write and remove files, drop folders that are left without code, sort imports, format, renew the catalogues."""
    for path in gone:
        (root / path).unlink()
    for path, text in texts.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(text, encoding="utf-8")
    for folder in sorted({parent for path in gone for parent in path.parents}, reverse=True):
        _drop_empty(root / folder)
    code = [str(path) for path in texts if path.suffix == ".py"]
    ruff = [sys.executable, "-m", "ruff"]
    subprocess.run([*ruff, "check", "--quiet", "--fix", "--select", "I,F401", *code], cwd=root, check=False)
    subprocess.run([*ruff, "format", "--quiet", *code], cwd=root, check=True)
    if catalogues and (root / "tools" / "catalogues.py").exists():
        subprocess.run([sys.executable, "tools/catalogues.py", "update"], cwd=root, check=False)


def _drop_empty(folder: Path) -> None:
    """Remove a folder that has nothing but the file of an empty package."""
    if not folder.is_dir():
        return
    left = [path for path in folder.iterdir() if path.name != "__pycache__"]
    names = {path.name for path in left}
    if names == {"__init__.py"} and (folder / "__init__.py").read_text(encoding="utf-8").count("\n") <= 1:
        (folder / "__init__.py").unlink()
        left = []
    if not left:
        for cached in (folder / "__pycache__").glob("*"):
            cached.unlink()
        if (folder / "__pycache__").is_dir():
            (folder / "__pycache__").rmdir()
        folder.rmdir()


if __name__ == "__main__":
    sys.exit(main())
