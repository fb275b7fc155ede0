"""Numerical methods that know nothing of mechanisms: jets, rounding, expressions, searches, machine code."""
