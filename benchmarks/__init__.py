"""Ratios of centrode's speed to a peer's, to bare NumPy's and to the machine's own bounds, measured in one run."""
