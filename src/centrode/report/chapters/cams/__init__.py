"""Chapters of cams."""
