"""Chapters of cams that are given by their follower's lift."""
