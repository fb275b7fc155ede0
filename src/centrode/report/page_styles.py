"""How a page looks by each standard: margins, sizes of letters, indents, where numbers and captions stand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from centrode.model.page_standards import Standard


@dataclass(frozen=True)
class PageStyle:
    """A page of A4.

    Attributes
    ----------
    left, right, top, bottom : margins [mm]
    size : of letters [points]
    tables : sizes of letters in tables, the first that fits
    indent : of the first line of a paragraph [mm]
    leading : between lines, in sizes of letters
    number : where the number of a page stands
    by_standard : headings and captions as the standards have them
    capital_parts : titles of numbered parts are set in capitals, as those without numbers are
    """

    left: float
    right: float
    top: float
    bottom: float
    size: float
    tables: tuple[float, ...]
    indent: float
    leading: float
    number: Literal["bottom", "top-right"]
    by_standard: bool = True
    capital_parts: bool = False

    @property
    def separator(self) -> str:
        """What stands between the number of a caption and its words."""
        return " \u2013 " if self.by_standard else ". "

    def typst(self) -> str:
        """Definitions that the style of PDF documents reads."""
        sizes = "".join(f"{size:g}pt, " for size in self.tables)
        values = {
            "page-left": f"{self.left:g}mm",
            "page-right": f"{self.right:g}mm",
            "page-top": f"{self.top:g}mm",
            "page-bottom": f"{self.bottom:g}mm",
            "text-size": f"{self.size:g}pt",
            "table-sizes": f"({sizes})",
            "first-indent": f"{self.indent:g}mm",
            "line-gap": f"{self.leading:g}em",
            "number-place": f'"{self.number}"',
            "caption-separator": f'"{self.separator}"',
            "by-standard": "true" if self.by_standard else "false",
            "capital-parts": "true" if self.capital_parts else "false",
        }
        return "".join(f"#let {name} = {value}\n" for name, value in values.items())


PLAIN = PageStyle(20, 20, 17, 20, 10, (8.6, 8.2, 7.5), 0, 0.6, "bottom", by_standard=False)
GOST = PageStyle(30, 15, 20, 20, 14, (12, 11, 10), 12.5, 1.05, "bottom")
DSTU = PageStyle(30, 10, 20, 20, 14, (12, 11, 10), 12.5, 1.05, "top-right", capital_parts=True)


def page_style(standard: Standard) -> PageStyle:
    """The page of a standard."""
    return {"plain": PLAIN, "gost": GOST, "dstu": DSTU}[standard]
