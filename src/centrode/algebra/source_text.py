"""The text of a formula as Python reads it, with the way back to the user's characters."""

from __future__ import annotations

import ast
import re
import unicodedata

from centrode.errors import InputError
from centrode.locale import _

_STRANGE = re.compile(r"[^\w\s.+\-*/^(),]")
_PASTED = re.compile(r"(?<![\w.])(?:\d++\.?+\d*+|\.\d++)(?:[eE][+-]?\d++)?+(?=[^\W\d])")


class SourceText:
    """A formula's text; complaints about it name the character that the user wrote."""

    def __init__(self, text: str, where: str) -> None:
        self.text = text
        self.where = where
        # A power is commonly written ^; `columns` leads from each character that Python reads to the user's.
        self.source, self.columns = "", [0]
        for column, character in enumerate(text):
            read = " " if character.isspace() else character.replace("^", "**")
            if self.source or read != " ":
                self.columns[-1:] = [column] * (len(read) + 1)
                self.source += read

    def tree(self) -> ast.expr:
        """The syntax tree of what the text says."""
        if not self.text.strip():
            raise InputError(self.where, _("the formula is empty"), _("write a formula or a number"))
        self._characters()
        repair = _("use + - * / ** and parentheses")
        try:
            return ast.parse(self.source, mode="eval").body
        except SyntaxError as error:
            column = self.columns[min(max((error.offset or 1) - 1, 0), len(self.columns) - 1)]
            raise self.error(column, _("this is not a formula"), repair) from None
        except (ValueError, MemoryError, RecursionError):
            raise self.error(0, _("this is not a formula"), repair) from None

    def error(self, column: int, what: str, repair: str = "") -> InputError:
        """Complaint about a character (from 0) of the user's text."""
        place = _('{what}, at character {column} of "{text}"')
        shown = "".join(c if c.isprintable() else " " for c in self.text)
        return InputError(self.where, place.format(what=what, column=column + 1, text=shown), repair)

    def at(self, node: ast.expr, what: str, repair: str = "") -> InputError:
        """Complaint about a node, at its place in the user's text."""
        before = self.source.encode()[: node.col_offset].decode(errors="ignore")
        return self.error(self.columns[len(before)], what, repair)

    def _characters(self) -> None:
        """Refuse what Python would read otherwise than a formula: other signs, look-alikes, names pasted to numbers."""
        strange = _STRANGE.search(self.text)
        if strange:
            what = _("a formula has no such character")
            raise self.error(strange.start(), what, _("use + - * / ** and parentheses"))
        for column, character in enumerate(self.text):
            # Python reads full-width and other compatibility letters as the plain ones (NFKC)
            if not character.isspace() and unicodedata.normalize("NFKC", character) != character:
                what = _("a formula has no such character")
                raise self.error(column, what, _("write plain letters and digits"))
        pasted = _PASTED.search(self.text)
        if pasted:
            repair = _('write "{number}*..."').format(number=pasted.group())
            raise self.error(pasted.end(), _("a sign is missing after a number"), repair)
