"""Mutated drawings: imported or refused in words, never with a traceback."""
