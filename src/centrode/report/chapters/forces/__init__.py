"""Chapters on what moves a mechanism and what its joints bear."""
