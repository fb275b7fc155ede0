"""Make the notebook of the documentation: run its cells and keep what they show.

    python -m tools.notebook

Writes docs/notebook.ipynb. The cells stand here, so that the outputs are always those of the present program.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

TARGET = Path(__file__).parents[1] / "docs" / "notebook.ipynb"

CELLS: tuple[tuple[str, str], ...] = (
    (
        "markdown",
        "# A mechanism in a notebook\n\nMechanisms, structures, motions and equations show themselves.",
    ),
    ("code", 'import centrode as ct\n\nmechanism = ct.example("slider-between-cranks")\nmechanism'),
    ("markdown", "Its structure: mobility by rank and by Chebyshev's formula, Assur groups."),
    ("code", "ct.check(mechanism)"),
    ("markdown", "Its motion is a labelled dataset; every sample has a status and a residual."),
    ("code", "motion = ct.motion(mechanism, samples=37)\nmotion"),
    ("code", 'motion.velocity.sel(point="C", axis="x").to_series().describe()'),
    ("markdown", "Its constraint equations, differentiated and solved as on paper."),
    ("code", "ct.equations(mechanism)"),
    (
        "markdown",
        "Put together the other way, the same links lock; the smallest change after which they turn:",
    ),
    (
        "code",
        'locked = ct.example("slider-between-cranks-locked")\nfound = ct.repair(locked)\nprint(ct.summary(found))',
    ),
    ("code", "found.repaired"),
)


def notebook() -> Any:
    """The notebook without outputs."""
    make: dict[str, Any] = {"markdown": nbformat.v4.new_markdown_cell, "code": nbformat.v4.new_code_cell}
    cells = [make[kind](text, id=f"cell-{number}") for number, (kind, text) in enumerate(CELLS)]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    return nbformat.v4.new_notebook(cells=cells, metadata=kernel)


def executed() -> Any:
    """The notebook with what its cells show; an error of a cell is raised."""
    book = notebook()
    NotebookClient(book, timeout=120, kernel_name="python3").execute()
    for cell in book.cells:
        cell.metadata.pop("execution", None)  # times of the run
    return book


if __name__ == "__main__":
    nbformat.write(executed(), TARGET)
