"""Chapters about linkages in the plane: from the description to the check by drawing."""
