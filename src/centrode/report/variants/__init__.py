"""Reports of the variants of a table, and the sheet of their answers."""
