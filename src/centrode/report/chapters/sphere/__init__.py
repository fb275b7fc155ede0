"""Chapters of linkages on the sphere."""
