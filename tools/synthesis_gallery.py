"""Make the pictures of syntheses in the gallery: a path, a function and a construction from strokes.

    python -m tools.synthesis_gallery

Each is a figure that `centrode synthesise FILE --out DIR` writes for a request of docs/gallery.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

DOCS = Path(__file__).parents[1] / "docs"
REQUESTS = DOCS / "gallery"
FOLDER = DOCS / "images" / "gallery"
SIZE, COLOURS = (560, 560), 48
SYNTHESES = {
    "synthesis-path": ("Coupler of a conveyor", "answers.png"),
    "synthesis-function": ("Logarithm of a four-bar linkage", "errors.png"),
    "synthesis-strokes": ("Lever of a press", "construction.png"),
}
"""Name of the request -> its title, and which of its figures is shown."""
HEAD = """## Syntheses

Answers of `centrode synthesise` to [requests](synthesis.md): a path, the errors of a function,
limit positions from strokes.
"""


def section() -> str:
    """The part of the page that shows them."""
    cells = [
        f"![{title}](images/gallery/{name}.png)<br>{title}<br>[`{name}.toml`](gallery/{name}.toml)"
        for name, (title, _) in SYNTHESES.items()
    ]
    return (
        f"{HEAD}\n|" + " |" * len(cells) + "\n|" + "---|" * len(cells) + "\n| " + " | ".join(cells) + " |\n"
    )


def main() -> None:
    """Write the pictures."""
    for name, (_, figure) in SYNTHESES.items():
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out"
            command = [sys.executable, "-m", "centrode", "synthesise", f"{name}.toml", "--out", str(out)]
            subprocess.run(command, cwd=REQUESTS, check=True, stdout=subprocess.DEVNULL)
            with Image.open(out / figure) as written:
                drawn = written.convert("RGB")
                drawn.thumbnail(SIZE, Image.Resampling.LANCZOS)
                drawn.quantize(COLOURS).save(FOLDER / f"{name}.png", optimize=True)


if __name__ == "__main__":
    main()
