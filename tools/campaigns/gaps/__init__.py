"""Chains that do not close over an interval of the drive much narrower than a cell of the mesh."""
