"""Linkages that pass change points, against closed forms in which the passage is a factor."""
