"""Equilibria of mechanisms under their loads, small motions about them, and how both change with a number."""
