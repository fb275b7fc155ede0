"""Conditions of closure in closed form, against the search for events and 50 digits."""
