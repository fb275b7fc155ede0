"""Reports as PDF, set by typst: no network, no fonts but its own, the same bytes from the same report."""
