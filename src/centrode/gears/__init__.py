"""Gears: pairs of involute wheels, their teeth, and what happens between them."""
