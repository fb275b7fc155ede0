"""Motion laws of one variable: what a drive does in time, over any algebra."""

from centrode.laws.law import Law
from centrode.laws.table import TableLaw
from centrode.laws.text import TextLaw
from centrode.laws.uniform import Uniform

__all__ = ["Law", "TableLaw", "TextLaw", "Uniform"]
