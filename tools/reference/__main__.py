"""`python -m tools.reference` writes the pages that are made from the program; `check` compares them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

from tools import gallery
from tools.reference import commands, face, grammar
from tools.validation import page as validation

FOLDER = Path(__file__).parents[2] / "docs"
PAGES: dict[str, Callable[[], str]] = {
    "reference/commands.md": commands.page,
    **{f"reference/{name}.md": partial(commands.page_of, name) for name in commands.PAGES},
    **{f"reference/{name}.md": partial(str, text) for name, text in face.pages().items()},
    **{f"reference/{name}.md": partial(str, text) for name, text in grammar.mechanisms().items()},
    "reference/cam-grammar.md": grammar.cams,
    "validation.md": validation.page,
    "gallery.md": gallery.page,
}


def main(check: bool) -> int:
    """Write the pages, or tell which of them are not as the program has it."""
    old = []
    for name, page in PAGES.items():
        file, text = FOLDER / name, page()
        if not check:
            file.write_text(text, encoding="utf-8")
        elif not file.exists() or file.read_text(encoding="utf-8") != text:
            old.append(name)
    if old:
        print(f"docs: {', '.join(old)}: not as the program has it; run make reference", file=sys.stderr)
    return 1 if old else 0


if __name__ == "__main__":
    sys.exit(main(check=sys.argv[1:] == ["check"]))
