"""Sweeps on a cluster whose processes are killed at random."""
