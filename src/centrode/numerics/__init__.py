"""Numerical methods that know nothing of mechanisms."""
