"""Documents: their blocks, how they spell numbers and formulas, their pictures."""
